"""A second program for machines with few contacts, of which the package knows nothing: Lagrange's equations by SymPy in
independent coordinates, SciPy's integrator between events, and at each of them the one consistent set of modes, found by trial.

The laws are those of the package: at impacts Newton's restitution in Moreau's form, with Coulomb's bound on impulses and no
tangential restitution; between them Coulomb's friction, static and sliding.
"""

import itertools
from typing import NamedTuple

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

TOUCHES = 1e-9          # m, m/s: what is less is none
NOTHING = 1e-14         # m: contacts that have just opened are open
MODES = {False: ("open", "closed"), True: ("open", "stick", "+", "-")}


class Contact(NamedTuple):
    """A gap of q and t, positive while open; slip, a velocity, linear in v; coefficients of restitution and friction."""

    gap: sp.Expr
    slip: sp.Expr | None = None
    restitution: float = 0.0
    friction: tuple[float, float] = (0.0, 0.0)


class Impact(NamedTuple):
    """An impact: its time, the contacts that take part with an impulse, and the velocities before and after."""

    t: float
    contacts: tuple[int, ...]
    before: np.ndarray
    after: np.ndarray


class Machine:
    """Motion of coordinates q with velocities v and energies T(q, v, t) and V(q, t), generalized forces and contacts.

    `fixed` are constraints of q and t that always hold. Simulated from (q, v) on with `run`.
    """

    def __init__(self, q, v, t, kinetic, potential, contacts, forces=None, fixed=()):
        q, v = sp.Matrix(q), sp.Matrix(v)
        moment = sp.Matrix([kinetic]).jacobian(v).T
        rest = sp.Matrix(forces or [0] * len(q)) + sp.Matrix([kinetic - potential]).jacobian(q).T
        rest -= moment.jacobian(q) * v + moment.diff(t)
        self.contacts, self.count, self.fixed = list(contacts), len(q), len(fixed)
        gaps = sp.Matrix([each.gap for each in contacts] + list(fixed))
        rates = gaps.jacobian(q) * v + gaps.diff(t)
        slips = sp.Matrix([each.slip if each.slip is not None else sp.S(0) for each in contacts] or [0])

        def of(speeds):
            return speeds.jacobian(v), speeds.jacobian(q) * v + speeds.diff(t)
        terms = [moment.jacobian(v), rest, gaps, rates, *of(rates), slips, *of(slips)]
        read = sp.lambdify([list(q), list(v), t], terms, "numpy", cse=True)
        self.read = lambda q, v, t: [np.array(each, float) if i in (0, 4, 7) else np.array(each, float).ravel()
                                     for i, each in enumerate(read(q, v, t))]

    def _rows(self, modes):
        """Closed contacts, those of them that stick, and the friction of the others as a multiple of their normal force."""
        closed = [i for i, mode in enumerate(modes) if mode != "open"] + list(range(len(modes), len(modes) + self.fixed))
        stuck = [i for i, mode in enumerate(modes) if mode == "stick"]
        return closed, stuck, {i: -1.0 if mode == "+" else 1.0 for i, mode in enumerate(modes) if mode in "+-"}

    def _solve(self, modes, at, target, force, mu):
        """Accelerations, or velocities, with their forces: M a = force + G' n + T' f, with rows that reach a target."""
        M, _, _, _, G, _, _, T, _ = at
        closed, stuck, sliding = self._rows(modes)
        into = [G[i] + (sliding[i] * mu[i] * T[i] if i in sliding else 0) for i in closed] + [T[i] for i in stuck]
        rows = [G[i] for i in closed] + [T[i] for i in stuck]
        n, k = self.count, len(rows)
        K, b = np.zeros((n + k, n + k)), np.concatenate([force, [target[0][i] for i in closed], [target[1][i] for i in stuck]])
        K[:n, :n] = M
        if k:
            K[:n, n:], K[n:, :n] = -np.array(into).T, np.array(rows)
        x = np.linalg.solve(K, b)
        normal, friction = dict(zip(closed, x[n:], strict=False)), dict(zip(stuck, x[n + len(closed):], strict=True))
        return x[:n], normal, friction | {i: sign * mu[i] * normal[i] for i, sign in sliding.items()}

    def accelerations(self, modes, q, v, t):
        at = self.read(q, v, t)
        return self._solve(modes, at, (-at[5], -at[8]), at[1], [each.friction[1] for each in self.contacts])

    def _modes(self, touching, q, v, t, ended=None):
        """The modes of contacts that touch and do not separate, with forces and accelerations that agree with them.

        One that has just ended, (contact, mode), is not among them.
        """
        at = self.read(q, v, t)
        choices = []
        for i, each in enumerate(self.contacts):
            slip = at[6][i] if any(each.friction) else 0.0
            moves = ("open", "+" if slip > 0 else "-") if abs(slip) > TOUCHES else MODES[any(each.friction)]
            choices.append([mode for mode in moves if (i, mode) != ended] if i in touching else ["open"])
        for modes in itertools.product(*choices):
            try:
                a, normal, friction = self.accelerations(modes, q, v, t)
            except np.linalg.LinAlgError:
                continue
            if all(self._agrees(i, modes[i], at, a, normal, friction) for i in touching):
                return modes
        raise RuntimeError(f"no modes agree at t = {t}")

    def _agrees(self, i, mode, at, a, normal, friction):
        scale = 1e-9 * (1 + np.abs(at[1]).max())
        if mode == "open":
            return at[4][i] @ a + at[5][i] >= -scale
        if normal[i] < -scale:
            return False
        if mode == "stick":
            return abs(friction[i]) <= self.contacts[i].friction[0] * normal[i] + scale
        slips = at[7][i] @ a + at[8][i]
        return mode == "closed" or abs(at[6][i]) > TOUCHES or slips * (1 if mode == "+" else -1) >= -scale

    def _impact(self, touching, closed, q, v, t):
        """Velocities after an impact, and the contacts with an impulse."""
        at, mu = self.read(q, v, t), [each.friction[1] for each in self.contacts]
        M, rates, slips = at[0], at[3], at[6]
        e = np.array([0.0 if i in closed else each.restitution for i, each in enumerate(self.contacts)] + [0.0] * self.fixed)
        G, T = at[4], at[7]
        target = -e * rates + G @ v - rates, T @ v - slips        # rates are G v plus those of moving contacts
        kinds = [MODES[any(each.friction)] if i in touching else ("open",) for i, each in enumerate(self.contacts)]
        for modes in itertools.product(*kinds):
            try:
                after, normal, friction = self._solve(modes, at, target, M @ v, mu)
            except np.linalg.LinAlgError:
                continue
            change = after - v
            ok = True
            for i in touching:
                rate, slip = rates[i] + G[i] @ change, slips[i] + T[i] @ change
                ok &= (rate + e[i] * rates[i] >= -1e-12 if modes[i] == "open" else normal[i] >= -1e-12)
                ok &= modes[i] != "stick" or abs(friction[i]) <= mu[i] * normal[i] + 1e-12
                ok &= modes[i] not in ("+", "-") or slip * (1 if modes[i] == "+" else -1) >= -1e-12
            if ok and any(mode != "open" for mode in modes):
                return after, tuple(i for i in touching if modes[i] != "open")
        raise RuntimeError(f"no impulses agree at t = {t}")

    def run(self, q, v, end, t=0.0, until=None, rest=1e-6, rtol=1e-11, atol=1e-13, max_step=np.inf):
        """Samples of the end, impacts and changes of mode: (t, q, v, impacts, [(t, modes), ...])."""
        impacts, history, y, closed, ended = [], [], np.concatenate([q, v]).astype(float), set(), None
        n = self.count
        while True:
            at = self.read(y[:n], y[n:], t)
            touching = {i for i in range(len(self.contacts)) if at[2][i] < TOUCHES}
            if any(at[3][i] < -TOUCHES for i in touching):
                after, hit = self._impact(sorted(touching), closed, y[:n], y[n:], t)
                impacts.append(Impact(t, hit, y[n:].copy(), after))
                y[n:] = after
                ended = None
                at = self.read(y[:n], y[n:], t)
            staying = sorted(i for i in touching if at[3][i] < rest)
            modes = self._modes(staying, y[:n], y[n:], t, ended)
            closed = {i for i in staying if modes[i] != "open"}
            history.append((t, modes))
            events = self._events(modes, at[2]) + ([until] if until else [])
            for each in events:
                each.terminal = True
            found = solve_ivp(lambda t, y, modes=modes: np.concatenate([y[n:], self.accelerations(modes, y[:n], y[n:], t)[0]]),
                              (t, end), y, "DOP853", rtol=rtol, atol=atol, events=events, max_step=max_step)
            t, y = float(found.t[-1]), found.y[:, -1].copy()
            if found.status == 0 or (until and len(found.t_events[-1])):
                return t, y[:n], y[n:], impacts, history
            fired = next(each for each, times in zip(events, found.t_events, strict=True) if len(times))
            ended = fired.contact, modes[fired.contact]

    def _events(self, modes, gaps):
        """Functions that pass through zero downward where the modes end."""
        n, found = self.count, []

        def add(function, contact):
            function.direction, function.contact = -1, contact
            found.append(function)
        for i, (mode, each) in enumerate(zip(modes, self.contacts, strict=True)):
            if mode == "open":
                zero = min(gaps[i], 0.0) - NOTHING
                add(lambda t, y, i=i, zero=zero: self.read(y[:n], y[n:], t)[2][i] - zero, i)
                continue
            add(lambda t, y, i=i: self.accelerations(modes, y[:n], y[n:], t)[1][i], i)
            if mode == "stick":
                def left(t, y, i=i, mu=each.friction[0]):
                    _, normal, friction = self.accelerations(modes, y[:n], y[n:], t)
                    return mu * normal[i] - abs(friction[i])
                add(left, i)
            elif mode in "+-":
                add(lambda t, y, i=i, sign=1 if mode == "+" else -1: sign * self.read(y[:n], y[n:], t)[6][i], i)
        return found
