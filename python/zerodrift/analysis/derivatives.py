"""Directional derivatives of the residuals of a system and of its accelerations.

The residuals are r = M vdot + d - f + C^T lambda of (2) and s = C vdot - xi of (6), with vdot and lambda frozen. The derivative
of the acceleration follows from theirs by one solve with the leading matrix; of redundant constraints it is unique along
tangent directions. Systems with a Jacobian of their own (symbolic and compiled ones) give the derivative of the acceleration
exactly; of all others the core differences the residuals, 1e-12 for functions that are smooth on their characteristic scale, by
the same function that gives Radau's method its Jacobian.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..systems.base import BaseSystem, core_of
from . import read_forces
from .state import State, sizes_of
from .tangent import Tangent, multipliers

FREE = read_forces.Held((), np.zeros(0))


def residuals(at: State, vdot: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """Residuals r of (2) and s of (6) in one array (nv + m,)."""
    return np.concatenate([at.M @ vdot - at.force + lam @ at.C, at.C @ vdot - at.xi])


def of_residuals_along(at: State, vdot: np.ndarray, lam: np.ndarray, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0,
                       parts: str = "rs", *, is_rough: bool = False, held: read_forces.Held = FREE) -> np.ndarray:
    """Derivatives (nv + m, k) of r and s, or of other parts, along k directions dp (k, nq), dv (k, nv), all with dt.

    The efforts of `held`, which stay as they are, act besides the forces of the system.
    """
    directions = (np.full(len(dp), float(dt)), dp, dv, sizes_of(at, dp, dv, dt))
    p, v, vdot, lam = (np.ascontiguousarray(each, dtype=float) for each in (at.p, at.v, vdot, lam))
    core = core_of(at.system)
    u, _, motion = held.motion(at) if held.names else (None, None, None)
    found = core.residuals_along(parts, (float(at.t), p, v), vdot, lam, tuple(map(np.ascontiguousarray, directions)), u=u,
                                 is_rough=is_rough).T
    if motion:
        found[:at.system.nv] -= held.along(at, motion[2], dp, dt, is_rough=is_rough)
    if core.functions and "r" in parts:
        found[:at.system.nv] -= read_forces.rows(at) @ read_forces.along(at, dp, dv, dt, is_rough=is_rough, held=held)
    return found


class Derivatives:
    """Derivatives of accelerations and multipliers at a state.

    Parameters
    ----------
    tangent : Tangent
        The tangent space there.
    vdot, lam : ndarray (nv,), (m,)
        Accelerations and multipliers there.
    held : Held, optional
        Constant efforts along quantities, which act in addition to the system's forces.
    """

    def __init__(self, tangent: Tangent, vdot: np.ndarray, lam: np.ndarray, held: read_forces.Held = FREE) -> None:
        self.tangent, self.at, self.vdot, self.lam, self.held = tangent, tangent.at, vdot, lam, held
        self._jacobian = None if held.names else jacobian(self.at)

    @property
    def is_exact(self) -> bool:
        """The system has a Jacobian of its own."""
        return self._jacobian is not None

    def of_accelerations(self, dp: np.ndarray, dv: np.ndarray) -> np.ndarray:
        """The derivative (nv,) of vdot along a tangent direction, or (nv, k) along k of them, dp (k, nq) and dv (k, nv)."""
        if self._jacobian is not None:
            return self._jacobian @ np.concatenate([dp.T, dv.T])
        return self.both(dp, dv)[0]

    def both(self, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of vdot (nv,) and of the multipliers (m,) along a tangent direction, or along k of them."""
        found = self._of_residuals(np.atleast_2d(dp), np.atleast_2d(dv), dt)
        dvdot, dlam = self.solve(*np.split(found, [self.at.system.nv]))
        return (dvdot, dlam) if dp.ndim > 1 else (dvdot[:, 0], dlam[:, 0])

    def _of_residuals(self, dp: np.ndarray, dv: np.ndarray, dt: float) -> np.ndarray:
        return of_residuals_along(self.at, self.vdot, self.lam, dp, dv, dt, held=self.held)

    def solve(self, r: np.ndarray, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Changes of vdot and lambda that make up for changes r (nv,), s (m,) of the residuals, or (nv, k), (m, k)."""
        at, V = self.at, self.tangent.velocities
        x = self.tangent.solve_rows(-s) if at.system.m else np.zeros_like(r)
        x = x + V @ (V.T @ (-r - at.M @ x))
        return x, multipliers(at, -r - at.M @ x)


def jacobian(at: State) -> np.ndarray | None:
    """The derivative (nv, nq + nv) of vdot by (p, v) from the system's own Jacobian; None where it has none."""
    system: BaseSystem = at.system
    core: Any = system._with_jacobian(core_of(system))
    if not core.c.jacobian or not core.c.jacobian.evaluate:
        return None
    try:
        found = core.jacobian(at.t, np.ascontiguousarray(at.p), np.ascontiguousarray(at.v))
    except Exception:       # it is not available at this state, as where a pivot is too small
        return None
    return found[system.nq:system.nq + system.nv]
