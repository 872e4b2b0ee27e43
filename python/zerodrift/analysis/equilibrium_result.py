"""The result of `equilibrium`: its position, reactions, efforts, stiffness and stability."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from ..errors import CorrectionFailed
from ..runs.states.instant import Reading
from ..systems.base import BaseSystem
from .flow import Flow
from .large import SparseBalance
from .names import pivots
from .quantities import components, rows_of
from .rest import Balance, nearest
from .retraction import onto
from .spectrum import Spectrum, of_matrix
from .state import scales

SYMMETRIC = 1e-7        # of the largest stiffness: forces with a potential
STEPS_ASIDE = 6
ASIDE = 0.05        # in characteristic scales: distance at which a free direction is verified
SHOWN = 8
REACTION_ROUNDING = 1e-12  # of the largest reaction: a smaller one is printed as zero
REACTIONS = (".force", ".torque", ".tension")


class Equilibrium(Reading):
    """A position of rest, or a steady motion; ``eq["pin.force"]`` reads any measure there.

    Attributes
    ----------
    system : system
    t : float
        Time in s of the drives.
    p, v, vdot : ndarray (nq,), (nv,), (nv,)
    multipliers : ndarray (m,)
        With the sign of (7), ``C.T @ multipliers = f - d`` at rest.
    effort : dict of str to float or ndarray
        Efforts, conjugate to the rates of the held measures, in N or N m.
    stiffness : ndarray (k, k)
        Reduced stiffness matrix, on a mass-orthonormal basis of the directions that are not held: its eigenvalues are squares of
        angular frequencies, in 1/s^2. None in a steady motion, and with `damping` and `basis` of many bodies.
    damping : ndarray (k, k)
        Reduced damping matrix on the same basis, in 1/s.
    basis : ndarray (nv, k)
        The basis, in velocities.
    eigenvalues : ndarray
        Eigenvalues of the motion near the equilibrium, in 1/s, without those of free directions.
    frequencies : ndarray
        In Hz, of the modes, in the order of the eigenvalues.
    stable : bool or None
        True where all eigenvalues decay, or the stiffness is symmetric and positive definite and nothing feeds the motion;
        False where one grows; None where they do not decide.
    residual : float
        Norm of the unbalanced force in the mass metric, in N/sqrt(kg).
    iterations : int
    how : str
        Method that found it.
    phase : dict of str to str
        State of each contact, stop, joint that switches and dry friction: "open", "closed", "sticking", "released", "joined".
    """

    def __init__(self, system: BaseSystem, t: float, state: tuple[np.ndarray, ...], effort: dict[str, Any], **found: Any) -> None:
        self.system, self.t, self.effort = system, t, effort
        self.p, self.v, self.vdot, self.multipliers = state
        self.stiffness, self.damping, self.basis = found["stiffness"], found["damping"], found["basis"]
        self._acting = system._watching.acting(effort, np.array([list(effort.values())]))
        self.stable, self.residual, self._named_free = found["stable"], found["residual"], found["free"]
        self.iterations, self.how = found["iterations"], found["how"]
        self.phase: dict[str, str] = {}
        spectrum: Spectrum = found["spectrum"]
        self.eigenvalues, self.frequencies = spectrum.eigenvalues, spectrum.frequencies

    @functools.cached_property
    def free(self) -> tuple[str, ...]:
        """Directions without stiffness, in which the equilibrium may stand anywhere, each by the coordinate that moves most."""
        return tuple(self._named_free())

    def __repr__(self) -> str:
        word = {True: "stable", False: "unstable", None: "stability not decided by the linearization"}[self.stable]
        what = "steady motion" if np.any(self.v) else "equilibrium"
        word = word if self.basis is None or self.basis.shape[1] else "nothing is free to move"
        lines = [f"<{what} of {self.system.name}: {word}; {self.how}, {self.iterations} iterations>"]
        oscillating = self.frequencies[np.abs(self.eigenvalues.imag) > 0]
        if oscillating.size:
            lines.append(f"  lowest frequency  {oscillating.min():.6g} Hz")
        growing = self.eigenvalues[self.eigenvalues.real > 0]
        if self.stable is False and growing.size:
            lines.append(f"  fastest growth    {growing.real.max():.6g} 1/s")
        if self.phase:
            lines.append(f"  phase             {', '.join(f'{name} {word}' for name, word in self.phase.items())}")
        if self.free:
            lines.append(f"  free              {', '.join(self.free)}")
        lines += [f"  effort            {name} = {_shown(value)}" for name, value in self.effort.items()]
        return "\n".join(lines + self._positions() + self._reactions())

    def _positions(self) -> list[str]:
        named = [f"{variable.name} = {value:.6g} {variable.unit}".rstrip()
                 for variable, value in zip(self.system.coordinates, self.p, strict=True)][:SHOWN]
        return [f"  {'at' if not i else '':18}{each}" for i, each in enumerate(named)]

    def _reactions(self) -> list[str]:
        names = [name for name in self.system._names_of_measures() if name.endswith(REACTIONS)]
        values = [np.asarray(self[name]) for name in names[:2 * SHOWN]]
        least = REACTION_ROUNDING * max((float(np.abs(value).max(initial=0.0)) for value in values), default=0.0)
        values = [np.where(np.abs(value) < least, 0.0, value) for value in values]
        units = (self.system._watching.unit(name) for name in names)
        shown = [f"{name} = {_shown(value)} {unit}" for name, value, unit in zip(names, values, units, strict=False)]
        return [f"  {'reactions' if not i else '':18}{each}" for i, each in enumerate(shown)]


def _shown(value: Any) -> str:
    if np.ndim(value) == 0:
        return f"{float(value):.6g}"
    return np.array2string(np.round(value, 6) + 0.0, precision=6, suppress_small=True)      # + 0.0: no zero has a sign


def at_rest(balance: Balance, iterations: int, how: str) -> Equilibrium:
    """The result for a balance at rest."""
    at, m, k = balance.at, balance.at.system.m, balance.V.shape[1]
    K, D = balance.stiffness, balance.damping
    free = _free(balance)
    kept = np.eye(k) - sum((np.outer(axis, axis) for axis in free), np.zeros((k, k)))
    spectrum = of_matrix(np.block([[np.zeros((k, k)), np.eye(k)], [-kept @ K @ kept, -D]]), has_vectors=False)
    state = (at.p, at.v, np.zeros_like(at.v), balance.multipliers[:m])
    return Equilibrium(at.system, at.t, state, _efforts(balance), stiffness=K, damping=D, basis=balance.V, spectrum=spectrum,
                       stable=_stable(balance, spectrum, len(free)), free=functools.partial(_names, balance, free),
                       residual=balance.residual, iterations=iterations, how=how)


def in_motion(flow: Flow, effort: dict[str, float], iterations: int) -> Equilibrium:
    """The result for a steady motion, whose stability is that of its linearization, with constant efforts."""
    at, spectrum = flow.at, of_matrix(flow.A)
    stable = False if spectrum.grows else True if spectrum.decays else None
    return Equilibrium(at.system, at.t, (at.p, at.v, flow.vdot, flow.lam), effort, stiffness=None, damping=None,
                       basis=flow.tangent.velocities, spectrum=spectrum, stable=stable,
                       free=functools.partial(pivots, at, flow.tangent.basis @ spectrum.removed),
                       residual=0.0, iterations=iterations, how="Gauss-Newton method")


def of_many(balance: SparseBalance, stable: bool | None, iterations: int) -> Equilibrium:
    """The result for a mechanism of many bodies, without its modes and free directions: `stable` is True or None."""
    state = (balance.p, balance.rest, np.zeros_like(balance.rest), balance.lam)
    return Equilibrium(balance.system, balance.t, state, {}, stiffness=None, damping=None, basis=None,
                       spectrum=of_matrix(np.zeros((0, 0))), stable=stable, free=tuple, residual=balance.residual,
                       iterations=iterations, how="Newton's method with sparse factors")


def _efforts(balance: Balance) -> dict[str, Any]:
    """Efforts that hold the quantities that are held: the opposites of their multipliers."""
    effort, at = {}, balance.at.system.m
    for name in balance.names:
        size = len(rows_of(balance.at, [name]))
        part = -balance.multipliers[at:at + size]
        effort.update({each: float(value) for each, value in zip(components(name, size), part, strict=True)})
        at += size
    return effort


def _free(balance: Balance) -> list[np.ndarray]:
    """Directions z (k,) without stiffness, in which the forces balance at a distance, too."""
    curvature, axes = balance.curvature
    flat = list(axes[:, np.abs(curvature) <= balance.flat].T)
    mixed = sum((axis / 2**i for i, axis in enumerate(flat)), np.zeros(len(axes)))      # all at once decides most cases
    return flat if not flat or _balances_along(balance, mixed) else [axis for axis in flat if _balances_along(balance, axis)]


def _names(balance: Balance, free: list[np.ndarray]) -> list[str]:
    """Names of free directions, and of those that nonholonomic constraints forbid."""
    at, moves = balance.at, np.column_stack([*(balance.V @ axis for axis in free), balance.family()])
    return pivots(at, np.vstack([at.A @ moves, np.zeros_like(moves)]))


def _balances_along(balance: Balance, axis: np.ndarray) -> bool:
    """Forces balance at a distance along an axis, after steps of Newton's method aside where the family is curved."""
    at, step = balance.at, balance.V @ axis * (ASIDE / max(balance.size(axis), 1e-300))
    p = at.p
    for _ in range(STEPS_ASIDE):
        try:
            p = onto(at.system, at.t, p + at.A @ step, balance.names)
        except CorrectionFailed:
            return False
        there = Balance(at.system, at.t, p, balance.names, is_rough=True)
        if there.residual <= 1e3 * balance.rounding:
            return bool(np.abs((p - balance.at.p) / scales(at.system, p).p).max(initial=0.0) > ASIDE / 2)
        z = nearest(there)
        if there.size(z) > ASIDE / 2:       # back to where it came from, or away
            return False
        at, step = there.at, there.V @ z
    return False


def _stable(balance: Balance, spectrum: Spectrum, free: int) -> bool | None:
    """Stability by the theorems of Lyapunov and Lagrange, free directions left out; None where they do not decide."""
    K, D = balance.stiffness, balance.damping
    if spectrum.grows:
        return False
    flat = int((balance.curvature[0] <= balance.flat).sum())
    if flat > free:
        return None
    if flat == len(K) or spectrum.decays:
        return True
    size = np.abs(K).max()
    is_conservative = np.abs(K - K.T).max() <= SYMMETRIC * size
    feeds = np.linalg.eigvalsh(D + D.T).min() < -SYMMETRIC * max(np.sqrt(size), np.abs(D).max())
    return True if is_conservative and not feeds else None
