"""User functions u of forces that read reactions: forces are affine in u, and u depends on accelerations and multipliers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from ..errors import NoUniqueMotion
from ..runs.states.instant import KnownInstant
from ..systems.base import core_of
from . import differences
from .quantities import rates_of, rows_of
from .state import State, sizes_of, state
from .tangent import Tangent, multipliers

ITERATIONS = 30
LEFT = 1e-14        # of the largest value: Newton's method ends
DISAGREE = 1e-9     # of the largest generalized force before cancellation: user functions and reactions that do not agree

Motion = tuple[np.ndarray, ...]             # accelerations (nv,), multipliers (m,) and efforts (j,)


def rows(at: State) -> np.ndarray:
    """Generalized forces (nv, k) of unit values of the user functions."""
    return core_of(at.system).forces_of_functions(at.t, np.ascontiguousarray(at.p), np.ascontiguousarray(at.v))


class Held:
    """Efforts along quantities, besides the forces of the system: those that keep them at rest, or constant ones (j,).

    `is_moving`: accelerations are those of the constraints, C vdot = xi; drives stand still otherwise.
    """

    def __init__(self, names: Iterable[str], efforts: np.ndarray | None = None, *, is_moving: bool = False) -> None:
        self.names, self.efforts, self._is_moving = tuple(names), efforts, is_moving

    def motion(self, at: State) -> tuple[np.ndarray, np.ndarray, Motion]:
        """Values (k,) of the user functions, the generalized force of the system (nv,) and the motion with them."""
        m, efforts = at.system.m, self.efforts
        G = rows_of(at, self.names)
        tangent, C = (Tangent(at, G), np.vstack([at.C, G])) if efforts is None else (Tangent(at), at.C)
        V, x = tangent.velocities, tangent.solve_rows(at.xi) if self._is_moving and m else np.zeros(at.system.nv)

        def respond(force: np.ndarray) -> Motion:
            force = force if efforts is None else force + G.T @ efforts
            vdot = x + V @ (V.T @ (force - at.M @ x))
            lam = multipliers(at, force - at.M @ vdot, C)
            return vdot, lam[:m], -lam[m:] if efforts is None else efforts

        return solved(at, self.names, respond)

    def instant(self, at: State, p: np.ndarray, v: np.ndarray, vdot: np.ndarray, multipliers: np.ndarray) -> KnownInstant:
        """Any quantity there with constant efforts."""
        efforts = None if self.efforts is None else at.system._watching.acting(self.names, self.efforts[None])
        return KnownInstant(at.system, at.t, p, v, vdot, multipliers, efforts)

    def along(self, at: State, efforts: np.ndarray, dp: np.ndarray, dt: float, *, is_rough: bool) -> np.ndarray:
        """Derivatives (nv, k) of the generalized forces of efforts, along directions dp (k, nq) with dt."""
        def force(which: np.ndarray, h: np.ndarray) -> np.ndarray:
            return efforts @ rates_of(at.system, self.names, "hold", at.t + h * dt, at.p + h[:, None] * dp[which])["row"]

        sizes = sizes_of(at, dp, np.zeros((len(dp), at.system.nv)), dt)
        return (differences.each_roughly if is_rough else differences.each)(force, sizes, at.system.nv).T


def along(at: State, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0, *, is_rough: bool, held: Held) -> np.ndarray:
    """Derivatives (k, j) of their values in the motion, along directions dp (j, nq), dv (j, nv) of its state, all with dt."""
    core = core_of(at.system)

    def values(which: np.ndarray, h: np.ndarray) -> np.ndarray:
        states = at.t + h * dt, at.p + h[:, None] * dp[which], at.v + h[:, None] * dv[which]
        if not held.names:
            return core.read_solved(*states)
        return np.array([held.motion(state(at.system, float(t), p, v))[0] for t, p, v in zip(*states, strict=True)])

    return (differences.each_roughly if is_rough else differences.each)(values, sizes_of(at, dp, dv, dt), core.functions).T


def _check_agreement(at: State, off: np.ndarray) -> None:
    """Refuse generalized forces that differ by `off` (nv,) from those of the reactions that they cause."""
    if (np.abs(off) > DISAGREE * np.maximum(at.magnitudes, np.abs(at.force)).max(initial=0.0)).any():
        raise NoUniqueMotion(f"user functions of {at.system.name} must agree with the reactions that they read: after "
                             f"{ITERATIONS} iterations generalized forces differ by up to {np.abs(off).max():.3g}")


def solved(at: State, names: Sequence[str], respond: Callable[[np.ndarray], Motion]) -> tuple[np.ndarray, np.ndarray, Motion]:
    """As `Held.motion`; `respond` gives the motion by the generalized forces of the system, in which it is affine."""
    core, B = core_of(at.system), rows(at)
    where = [np.ascontiguousarray(each, dtype=float)[None] for each in (at.t, at.p, at.v)]
    u = here = core.read_solved(*where)[0]
    start = respond(at.force)
    ends = [respond(at.force + column) for column in B.T]
    slopes = [np.array([end[i] - each for end in ends]).reshape(len(u), each.size) for i, each in enumerate(start)]

    def motions(u: np.ndarray) -> list[np.ndarray]:
        return [each + (u - here) @ slope for each, slope in zip(start, slopes, strict=True)]

    def left(u: np.ndarray) -> np.ndarray:
        vdot, lam, efforts = motions(u)
        t, p, v = (np.repeat(each, len(u), axis=0) for each in where)
        return u - core.read_given(t, p, v, np.ascontiguousarray(vdot), np.ascontiguousarray(lam),
                                   acting=at.system._watching.acting(names, efforts))

    for _ in range(ITERATIONS):
        off = left(u[None])[0]
        if np.abs(off).max(initial=0.0) <= LEFT * max(float(np.abs(u).max(initial=0.0)), 1e-300):
            break
        size = np.maximum(np.abs(u), np.abs(off))
        unit = np.diag(np.where(size > 0, size, size.max()))

        def moved(which: np.ndarray, h: np.ndarray, u: np.ndarray = u, unit: np.ndarray = unit) -> np.ndarray:
            return left(u + h[:, None] * unit[which])

        matrix = differences.each_roughly(moved, np.ones(len(u)), len(u))
        if not np.linalg.slogdet(matrix)[0] > 0:
            raise NoUniqueMotion(f"{at.system.name} must have one force that makes this motion, and friction has several or none")
        u = u - unit @ np.linalg.solve(matrix.T, off)
    else:
        _check_agreement(at, B @ left(u[None])[0])
    return u, at.force + B @ (u - here), tuple(motions(u))
