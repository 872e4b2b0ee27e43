"""Directional derivatives of the residuals of a system and of its accelerations.

The residuals are r = M vdot + d - f + C^T lambda of (2) and s = C vdot - xi of (6), with vdot and lambda frozen. The derivative
of the acceleration follows from theirs by one solve with the leading matrix; of redundant constraints it is unique along
tangent directions. Systems with a Jacobian of their own (symbolic and compiled ones) give the derivative of the acceleration
exactly; of all others the residuals are differenced with the step control of `differences`, 1e-12 for functions that are smooth
on their characteristic scale.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..systems.base import BaseSystem, core_of
from . import differences
from .state import Scales, State, scales, state
from .tangent import Tangent, multipliers


class Direction(NamedTuple):
    """A direction: dt, dp (nq,), dv (nv,), and rates of parameters by name; None: zero."""

    dt: float = 0.0
    dp: np.ndarray | None = None
    dv: np.ndarray | None = None
    dparameters: Mapping[str, float] | None = None

    def size(self, scale: Scales, at: State) -> float:
        """Its size in characteristic scales."""
        speed = np.maximum(scale.v, np.abs(at.v))
        sizes = [abs(self.dt), *(np.abs(each / by).max(initial=0.0) for each, by in ((self.dp, scale.p), (self.dv, speed))
                                 if each is not None)]
        for name, rate in (self.dparameters or {}).items():
            sizes.append(abs(rate) / (abs(float(at.system.parameters[name])) or 1.0))
        return float(max(sizes))

    def step(self, at: State, h: float) -> State:
        """The terms that far along it."""
        p = at.p if self.dp is None else at.p + h * self.dp
        v = at.v if self.dv is None else at.v + h * self.dv
        system = at.system
        if self.dparameters:
            system = system.with_parameters({name: float(system.parameters[name]) + h * rate
                                             for name, rate in self.dparameters.items()})
        return state(system, at.t + h * self.dt, p, v)


def residuals(at: State, vdot: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """R of (2) and s of (6), one behind the other, (nv + m,)."""
    return np.concatenate([at.M @ vdot - at.force + at.C.T @ lam, at.C @ vdot - at.xi])


def of_residuals(at: State, vdot: np.ndarray, lam: np.ndarray, direction: Direction) -> tuple[np.ndarray, np.ndarray]:
    """Directional derivatives of r (nv,) and s (m,), with vdot and the multipliers frozen."""
    def along(h: float) -> np.ndarray:
        return residuals(direction.step(at, h), vdot, lam)

    found = differences.along(along, direction.size(scales(at.system, at.p), at))
    return found[:at.system.nv], found[at.system.nv:]


class Derivatives:
    """Derivatives of accelerations and multipliers at a state.

    Parameters
    ----------
    tangent : Tangent
        The tangent space there.
    vdot, lam : ndarray (nv,), (m,)
        Accelerations and multipliers there.
    """

    def __init__(self, tangent: Tangent, vdot: np.ndarray, lam: np.ndarray) -> None:
        self.tangent, self.at, self.vdot, self.lam = tangent, tangent.at, vdot, lam
        self._jacobian = jacobian(self.at)

    @property
    def is_exact(self) -> bool:
        """The system has a Jacobian of its own."""
        return self._jacobian is not None

    def of_accelerations(self, dp: np.ndarray, dv: np.ndarray) -> np.ndarray:
        """The derivative (nv,) of vdot along a tangent direction."""
        if self._jacobian is not None:
            return self._jacobian @ np.concatenate([dp, dv])
        return self.solve(*of_residuals(self.at, self.vdot, self.lam, Direction(dp=dp, dv=dv)))[0]

    def both(self, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of vdot (nv,) and of the multipliers (m,) along a tangent direction."""
        return self.solve(*of_residuals(self.at, self.vdot, self.lam, Direction(dt, dp, dv)))

    def solve(self, r: np.ndarray, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Changes of vdot and lambda that make up for changes r, s of the residuals."""
        at, V = self.at, self.tangent.velocities
        x = self.tangent.solve_rows(-s) if at.system.m else np.zeros(at.system.nv)
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
