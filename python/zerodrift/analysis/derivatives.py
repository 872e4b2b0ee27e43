"""Directional derivatives of the residuals of a system and of its accelerations.

The residuals are r = M vdot + d - f + C^T lambda of (2) and s = C vdot - xi of (6), with vdot and lambda frozen. The derivative
of the acceleration follows from theirs by one solve with the leading matrix; of redundant constraints it is unique along
tangent directions. Systems with a Jacobian of their own (symbolic and compiled ones) give the derivative of the acceleration
exactly; of all others the core differences the residuals, 1e-12 for functions that are smooth on their characteristic scale, by
the same function that gives Radau's method its Jacobian.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..systems.base import BaseSystem, core_of
from . import differences, read_forces
from .quantities import rates_of
from .state import Scales, State, scales, state
from .tangent import Tangent, multipliers


class Direction(NamedTuple):
    """A direction: dt, dp (nq,), dv (nv,), and rates of parameters by name; None: zero."""

    dt: float = 0.0
    dp: np.ndarray | None = None
    dv: np.ndarray | None = None
    dparameters: Mapping[str, float] | None = None

    def size(self, scale: Scales, at: State) -> float:
        """Largest entry of the direction in characteristic scales."""
        speed = np.maximum(scale.v, np.abs(at.v))
        sizes = [abs(self.dt), *(np.abs(each / by).max(initial=0.0) for each, by in ((self.dp, scale.p), (self.dv, speed))
                                 if each is not None)]
        for name, rate in (self.dparameters or {}).items():
            sizes.append(abs(rate) / (abs(float(at.system.parameters[name])) or 1.0))
        return float(max(sizes))

    def step(self, at: State, h: float) -> State:
        """Terms of the system at (t, p, v) and parameters moved by h times the direction."""
        p = at.p if self.dp is None else at.p + h * self.dp
        v = at.v if self.dv is None else at.v + h * self.dv
        system = at.system
        if self.dparameters:
            system = system.with_parameters({name: float(system.parameters[name]) + h * rate
                                             for name, rate in self.dparameters.items()})
        return state(system, at.t + h * self.dt, p, v)


def residuals(at: State, vdot: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """Residuals r of (2) and s of (6) in one array (nv + m,)."""
    return np.concatenate([at.M @ vdot - at.force + lam @ at.C, at.C @ vdot - at.xi])


def of_residuals(at: State, vdot: np.ndarray, lam: np.ndarray, direction: Direction) -> tuple[np.ndarray, np.ndarray]:
    """Directional derivatives of r (nv,) and s (m,), with vdot and the multipliers frozen."""
    if direction.dparameters:
        size = direction.size(scales(at.system, at.p), at)
        found = differences.along(lambda h: residuals(direction.step(at, h), vdot, lam), size)
    else:
        dp, dv = (np.zeros((1, n)) if each is None else each[None] for each, n in ((direction.dp, at.system.nq),
                                                                                  (direction.dv, at.system.nv)))
        found = of_residuals_along(at, vdot, lam, dp, dv, direction.dt)[:, 0]
    return found[:at.system.nv], found[at.system.nv:]


def of_residuals_along(at: State, vdot: np.ndarray, lam: np.ndarray, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0,
                       parts: str = "rs", *, is_rough: bool = False) -> np.ndarray:
    """Derivatives (nv + m, k) of r and s, or of other parts, along k directions dp (k, nq), dv (k, nv), all with dt."""
    directions = (np.full(len(dp), float(dt)), dp, dv, sizes_of(at, dp, dv, dt))
    p, v, vdot, lam = (np.ascontiguousarray(each, dtype=float) for each in (at.p, at.v, vdot, lam))
    core = core_of(at.system)
    found = core.residuals_along(parts, (float(at.t), p, v), vdot, lam, tuple(map(np.ascontiguousarray, directions)),
                                 is_rough=is_rough).T
    if core.functions and "r" in parts:
        found[:at.system.nv] -= read_forces.rows(at) @ read_forces.along(at, dp, dv, dt, is_rough=is_rough)
    return found


def sizes_of(at: State, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0) -> np.ndarray:
    """The sizes (k,) of directions dp (k, nq), dv (k, nv), dt in characteristic scales."""
    scale = scales(at.system, at.p)
    speed = np.maximum(scale.v, np.abs(at.v))
    return np.abs(np.hstack([dp / scale.p, dv / speed, np.full((len(dp), 1), dt)])).max(axis=1)


class Derivatives:
    """Derivatives of accelerations and multipliers at a state.

    Parameters
    ----------
    tangent : Tangent
        The tangent space there.
    vdot, lam : ndarray (nv,), (m,)
        Accelerations and multipliers there.
    efforts : dict of str to float, optional
        Constant efforts along quantities, which act in addition to the system's forces.
    """

    def __init__(self, tangent: Tangent, vdot: np.ndarray, lam: np.ndarray, efforts: Mapping[str, float] | None = None) -> None:
        self.tangent, self.at, self.vdot, self.lam, self._efforts = tangent, tangent.at, vdot, lam, efforts or {}
        self._jacobian = None if efforts else jacobian(self.at)

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
        found = of_residuals_along(self.at, self.vdot, self.lam, dp, dv, dt)
        return found - np.vstack([self._of_efforts(dp, dt), np.zeros((self.at.system.m, len(dp)))]) if self._efforts else found

    def _of_efforts(self, dp: np.ndarray, dt: float) -> np.ndarray:
        """Derivatives (nv, k) of the generalized forces of the efforts."""
        at, names, u = self.at, tuple(self._efforts), np.array(list(self._efforts.values()))

        def force(which: np.ndarray, h: np.ndarray) -> np.ndarray:
            return u @ rates_of(at.system, names, "hold", at.t + h * dt, at.p + h[:, None] * dp[which])["row"]

        return differences.each(force, sizes_of(at, dp, np.zeros((len(dp), at.system.nv)), dt), at.system.nv).T

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
