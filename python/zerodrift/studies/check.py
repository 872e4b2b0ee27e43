"""`check`: comparison of all terms of a system with derivatives and balances, with the errors found in words."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, SystemLike
from ..analysis.comparison import Compared, derivatives_by_parameters, derivatives_of_accelerations
from ..errors import ZerodriftError
from ..runs.arguments.methods import Projection
from ..runs.states.operations import acceleration, project
from ..systems.base import BaseSystem, Terms, core_of, system_of, unswitched

STEP = np.finfo(float).eps ** (1 / 3)   # of a central difference, relative to the varied quantity
AGREE = 1e-5                            # relative: far above the error 1e-10 of a difference, far below any mistake
NEGLIGIBLE = 1e-9                       # relative: smaller eigenvalues and singular values are zero to rounding
SPREAD = 0.1                            # relative distance of the sampled states from the start


@dataclass(frozen=True, slots=True)
class Report:
    """Result of `check`; true if no problem was found.

    Attributes
    ----------
    system : str
        Name of the system.
    states : int
        Number of states at which terms were compared.
    checks : tuple of str
        Names of the comparisons.
    problems : tuple of str
        Problems found, a sentence each.
    """

    system: str
    states: int
    checks: tuple[str, ...]
    problems: tuple[str, ...]

    def __bool__(self) -> bool:
        return not self.problems

    def __repr__(self) -> str:
        head = f"{self.system}: {', '.join(self.checks)} compared at {self.states} states: "
        return head + ("nothing wrong" if self else "\n".join(["", *(f"  * {problem}" for problem in self.problems)]))


def check(system: SystemLike, p: ArrayLike | None = None, v: ArrayLike | None = None, t: float = 0.0, *, samples: int = 5,
          seed: int = 0) -> Report:
    """Check the terms of a system against derivatives, symmetry, definiteness and the balance of power.

    Derivatives are central differences, which share no code with the terms to which they are compared.

    Parameters
    ----------
    system : system
        System or Mechanism, as in `simulate`.
    p, v : array_like (nq,), (nv,), optional
        First state of the comparison; by default the start of the system.
    t : float
        Time in s.
    samples : int
        Number of further states near it, drawn at random and projected onto the constraints.
    seed : int
        Seed of the random states.

    Returns
    -------
    Report
        True if no problem was found; it prints the problems.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bool(zd.check(zd.systems.four_bar()))
    True
    """
    system = unswitched(system_of(system, p, v), "a check")
    p, v = system._state_or_start(p, v, "p", "v", t)
    t, states = checks.number("t", t), 0
    problems: dict[str, str] = {}
    names: dict[str, bool] = {}
    samples = checks.count("samples", samples, least=0)
    for p_now, v_now in [(p, v), *_samples(system, p, v, t, samples, seed)]:
        states += 1
        for compare in COMPARISONS:
            for name, problem in compare(_State(system, t, p_now, v_now, in_full=states == min(samples, 1) + 1)):
                names[name] = True
                if problem:
                    problems.setdefault(name, f"{name}: {problem}")
    return Report(system.name, states, tuple(names), tuple(problems.values()))


class _State:
    """A state, its terms, and derivatives there by central differences."""

    def __init__(self, system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray, *, in_full: bool) -> None:
        self.system, self.t, self.p, self.v, self.in_full = system, t, p, v, in_full
        self.terms: Terms = system.evaluate(p, v, t)
        if self.terms.C is not None:
            self.terms.C = core_of(system).rows_above_rounding(t, p, v, self.terms.C)
        self.pdot = self.rate(v)

    def rate(self, v: np.ndarray) -> np.ndarray:
        """A v, (1)."""
        return v if self.terms.A is None else self.terms.A @ v

    def derivative_along(self, quantity: Callable[[Terms, np.ndarray], Any], *, pdot: Any = 0.0, tdot: float = 0.0) -> Any:
        """Derivative of quantity(terms, v) in the direction (tdot, pdot)."""
        size = max(np.abs(pdot).max(initial=0.0), abs(tdot), 1e-300)
        h = STEP / size * max(1.0, np.abs(self.p).max(initial=0.0))
        ends = []
        for s in (h, -h):
            ends.append(np.array(quantity(self.system.evaluate(self.p + s * pdot, self.v, self.t + s * tdot), self.v)))
        return (ends[0] - ends[1]) / (2 * h)


def _samples(system: BaseSystem, p: np.ndarray, v: np.ndarray, t: float, samples: int, seed: int) -> Iterator[tuple[Any, Any]]:
    random = np.random.default_rng(seed)
    for _ in range(samples):
        guess = p + SPREAD * random.standard_normal(system.nq) * max(np.abs(p).max(initial=0.0), 1e-3)
        rates = v + random.standard_normal(system.nv) * max(np.abs(v).max(initial=0.0), 1.0)
        try:
            yield project(system, guess, rates, t, projection=Projection(tol=1e-9, max_iterations=50), formulation="augmented")
        except ZerodriftError:      # too far away, or a wrong Jacobian: the state itself will do
            yield guess, rates


def _disagreement(given: Any, derived: Any, what: str) -> str:
    """A sentence where the two differ, else nothing."""
    given, derived = np.atleast_1d(given), np.atleast_1d(derived)
    size = max(np.abs(given).max(initial=0.0), np.abs(derived).max(initial=0.0), 1e-3)
    worst = np.abs(given - derived).max(initial=0.0)
    if worst <= AGREE * size:
        return ""
    where = np.unravel_index(np.abs(given - derived).argmax(), given.shape)
    place = f"entry {tuple(map(int, where))}" if given.size > 1 else "it"
    sentence = f"{what}: {place} is {given[where]:.6g} and should be {derived[where]:.6g}"
    return sentence + (" (the sign is wrong)" if np.abs(given + derived).max() <= AGREE * size else "")


# ---- the comparisons: each yields (name, problem or nothing) ----


def _mass(state: _State) -> Iterator[tuple[str, str]]:
    M = state.terms.M
    yield "symmetry of mass", _disagreement(M, M.T, "M is not its own transpose") if M.size else ""
    free = _free_directions(state.terms.C, M)
    lowest, lowest_free = (np.linalg.eigvalsh(D.T @ (M + M.T) @ D / 2).min(initial=1.0) for D in (np.eye(len(M)), free))
    if lowest < -NEGLIGIBLE * np.abs(M).max():
        yield "definiteness of mass", f"M is not positive definite, its lowest eigenvalue is {lowest:.3g}"
    else:
        problem = "M is singular, even where the constraints leave the velocities free"
        yield "definiteness of mass", "" if lowest_free > 0 else problem


def _free_directions(C: np.ndarray | None, M: np.ndarray) -> np.ndarray:
    """Columns that span the null space of C."""
    if C is None:
        return np.eye(len(M))
    _, values, vectors = np.linalg.svd(C)
    return vectors[(values > NEGLIGIBLE * values.max(initial=0.0)).sum():].T


def _consistency(state: _State) -> Iterator[tuple[str, str]]:
    C, xi = state.terms.C, state.terms.xi
    if C is None:
        return
    length = np.linalg.norm(C, axis=1)
    length = np.maximum(length, NEGLIGIBLE * (length.max() or 1.0))     # a row of zeros consists of rounding
    C, xi = C / length[:, None], xi / length
    vdot = np.linalg.lstsq(C, xi, rcond=NEGLIGIBLE)[0]
    left = np.abs(C @ vdot - xi).max()
    agree = left <= AGREE * max(np.abs(xi).max(), np.abs(state.v).max() ** 2 / (1 + np.abs(state.p).max()))
    yield "agreement of constraints", "" if agree else f"they contradict each other: the best vdot leaves {left:.3g} of (6)"


def _jacobian(state: _State) -> Iterator[tuple[str, str]]:
    terms, mh = state.terms, state.system.mh
    if not mh:
        return
    columns = [state.derivative_along(lambda at, v: at.Phi, pdot=state.rate(unit)) for unit in np.eye(state.system.nv)]
    yield "jacobian", _disagreement(terms.C[:mh], np.stack(columns, axis=1), "C is not dPhi/dp A")
    Phi_t = state.derivative_along(lambda at, v: at.Phi, tdot=1.0)
    given = np.zeros(mh) if terms.Phi_t is None else terms.Phi_t[:mh]
    yield "time derivative of constraints", _disagreement(given, Phi_t, "Phi_t is not dPhi/dt")


def _xi(state: _State) -> Iterator[tuple[str, str]]:
    if state.terms.xi is None:
        return
    Psi_rate = state.derivative_along(_velocity_violation, pdot=state.pdot, tdot=1.0)
    yield "xi", _disagreement(state.terms.xi, -Psi_rate, "xi is not what C vdot has to be")


def _velocity_violation(terms: Terms, v: np.ndarray) -> np.ndarray:
    return terms.C @ v + (0.0 if terms.Phi_t is None else terms.Phi_t)


def _quaternions(state: _State) -> Iterator[tuple[str, str]]:
    for first in state.system.quaternions:
        q, A = state.p[first:first + 4], state.terms.A[first:first + 4]
        growth = A.T @ q
        worst = int(np.abs(growth).argmax())
        kept = abs(growth[worst]) <= AGREE * np.abs(A).max() * max(np.linalg.norm(q), 1e-300)
        yield "length of quaternions", "" if kept else (
            f"A v changes that of the quaternion p[{first}] to p[{first + 3}], by {growth[worst]:.6g} at unit velocity {worst}")


def _complement(state: _State) -> Iterator[tuple[str, str]]:
    terms = state.terms
    if terms.D is None:
        return
    yield "complement", _disagreement(terms.C @ terms.D, np.zeros((state.system.m, len(terms.D.T))), "C D is not zero")
    yield "gamma", _disagreement(terms.C @ terms.gamma, terms.xi, "C gamma is not xi")


def _power(state: _State) -> Iterator[tuple[str, str]]:
    """The balance of power along the motion; where it does not close, the parts of T and of V are compared one by one."""
    terms, v = state.terms, state.v
    if terms.V is None:
        return
    try:
        vdot, multipliers = acceleration(state.system, state.p, v, state.t, "augmented")
    except ZerodriftError:
        return      # said elsewhere: the mass or the constraints are at fault
    zero = np.zeros(state.system.nv)
    f, d = (zero if x is None else x for x in (terms.f, terms.d))
    given = 0.0 if terms.power is None else float(terms.power)
    moving = 0.0 if terms.Phi_t is None else float(multipliers @ terms.Phi_t)
    reaction = float(-multipliers @ (terms.C @ v)) if terms.C is not None else 0.0      # as v may be off the constraints
    rate = float(state.derivative_along(lambda at, v: 0.5 * v @ at.M @ v + at.V, pdot=state.pdot, tdot=1.0) + v @ terms.M @ vdot)
    scale = max(abs(float(v @ f)), abs(float(v @ d)), abs(given), abs(moving), abs(reaction), 1e-3)
    if abs(rate - given - reaction) <= AGREE * scale:
        yield "balance of power", ""
        return
    V_rate = float(state.derivative_along(lambda at, v: at.V, pdot=state.pdot, tdot=1.0))
    T_rate = 0.5 * float(state.derivative_along(lambda at, v: v @ at.M @ v, pdot=state.pdot, tdot=1.0))
    halves = [_disagreement(v @ f, given - V_rate, "v . force is not power - dV/dt"),
              _disagreement(v @ d, T_rate, "v . bias is not the rate of v . M v / 2 at fixed v")]
    yield "balance of power", "; ".join(half for half in halves if half) or (
        f"T + V changes at {rate:.6g} W, and {given + reaction:.6g} W come in")


def _derivatives(state: _State) -> Iterator[tuple[str, str]]:
    """Derivatives of accelerations where differences of accelerations are accurate: along all tangent directions and by all
    parameters at one state, along a random direction at the others.
    """
    system, terms = state.system, state.terms
    violated = [np.zeros(1) if each is None else each for each in (terms.Phi, _velocity_violation(terms, state.v)
                                                                   if terms.C is not None else None)]
    if max(np.abs(each).max(initial=0.0) for each in violated) > NEGLIGIBLE * (1 + np.abs(state.v).max(initial=0.0)):
        return      # sampled off the constraints, where redundant ones contradict each other
    random = None if state.in_full else np.random.default_rng(len(terms.M))
    try:
        found = [("along a tangent direction", each)
                 for each in derivatives_of_accelerations(system, state.t, state.p, state.v, random)]
        if state.in_full:
            by_name = derivatives_by_parameters(system, state.t, state.p, state.v)
            found += [(f"with respect to {name}", each) for name, each in by_name.items() if isinstance(each, Compared)]
    except ZerodriftError:
        return      # said elsewhere, or a neighbouring state is singular
    for along, compared in found:
        if not np.isfinite(compared.expected).all():
            continue
        worst = int(np.abs(compared.given - compared.expected).argmax())
        yield "derivatives of accelerations", "" if compared.agrees else (
            f"that of the acceleration of {system.velocities[worst].name!r} {along} is {compared.given[worst]:.9g} and should be "
            f"{compared.expected[worst]:.9g}")


COMPARISONS = (_mass, _consistency, _jacobian, _xi, _quaternions, _complement, _power, _derivatives)
