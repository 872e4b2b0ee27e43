"""User functions u of forces that read reactions: forces are affine in u, and u depends on accelerations and multipliers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import NoUniqueMotion
from ..systems.base import core_of
from . import differences
from .state import State, scales

ITERATIONS = 30
LEFT = 1e-14        # of the largest value: Newton's method ends

Linear = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def rows(at: State) -> np.ndarray:
    """Generalized forces (nv, k) of unit values of the user functions."""
    return core_of(at.system).forces_of_functions(at.t, np.ascontiguousarray(at.p), np.ascontiguousarray(at.v))


def along(at: State, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0, *, is_rough: bool = False) -> np.ndarray:
    """Derivatives (k, j) of their values in the motion, along directions dp (j, nq), dv (j, nv) of its state, all with dt."""
    core, scale = core_of(at.system), scales(at.system, at.p)

    def values(which: np.ndarray, h: np.ndarray) -> np.ndarray:
        return core.read_solved(at.t + h * dt, at.p + h[:, None] * dp[which], at.v + h[:, None] * dv[which])

    sizes = np.abs(np.hstack([dp / scale.p, dv / np.maximum(scale.v, np.abs(at.v)), np.full((len(dp), 1), dt)])).max(axis=1)
    return (differences.each_roughly if is_rough else differences.each)(values, sizes, core.functions).T


def _along_reactions(at: State, vdot: np.ndarray, lam: np.ndarray, dvdot: np.ndarray, dlam: np.ndarray) -> np.ndarray:
    """Derivatives (k, j) along changes (nv, j) of the accelerations and (m, j) of the multipliers."""
    core = core_of(at.system)
    j = dvdot.shape[1]
    of_lam, of_vdot = (max(float(np.abs(each).max(initial=0.0)), 1.0) for each in (lam, vdot))

    def values(which: np.ndarray, h: np.ndarray) -> np.ndarray:
        state = [np.repeat(np.asarray(each, dtype=float)[None], len(h), axis=0) for each in (at.t, at.p, at.v)]
        moved = (vdot + h[:, None] * dvdot.T[which], lam + h[:, None] * dlam.T[which])
        return core.read_given(*state, *map(np.ascontiguousarray, moved))

    sizes = np.maximum(np.abs(dvdot).max(axis=0, initial=0.0) / of_vdot, np.abs(dlam).max(axis=0, initial=0.0) / of_lam)
    return differences.each(values, sizes.reshape(j), core.functions).T


def added(at: State, vdot: np.ndarray, lam: np.ndarray, force: np.ndarray, respond: Linear) -> np.ndarray:
    """Generalized forces (nv, j) that the user functions add to small ones (nv, j).

    `respond` gives changes of accelerations and multipliers by generalized forces, those of the user functions included.
    """
    B = rows(at)
    slopes = [_along_reactions(at, vdot, lam, *respond(each)) for each in (force, B)]
    return B @ np.linalg.solve(np.eye(B.shape[1]) - slopes[1], slopes[0])


def at_motion(at: State, vdot: np.ndarray, multipliers: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """The generalized force (nv,) of a motion with these accelerations.

    `multipliers` gives those of a generalized force, in which they are affine.
    """
    core, B = core_of(at.system), rows(at)
    state = tuple(np.ascontiguousarray(each, dtype=float)[None] for each in (at.t, at.p, at.v))
    here = core.read_solved(*state)[0]
    u = here.copy()
    lam = multipliers(at.force)
    slopes = np.column_stack([multipliers(at.force + each) - lam for each in B.T]) if B.size else np.zeros((len(lam), 0))
    for _ in range(ITERATIONS):
        now = lam + slopes @ (u - here)
        left = u - core.read_given(*state, np.ascontiguousarray(vdot)[None], now[None])[0]
        if np.abs(left).max(initial=0.0) <= LEFT * max(float(np.abs(u).max(initial=0.0)), 1e-300):
            break
        matrix = np.eye(len(u)) - _along_reactions(at, vdot, now, np.zeros((len(vdot), len(u))), slopes)
        if not np.linalg.det(matrix) > 0:
            raise NoUniqueMotion(f"{at.system.name} must have one force that makes this motion, and friction has several or none")
        u = u - np.linalg.solve(matrix, left)
    return at.force + B @ (u - here)
