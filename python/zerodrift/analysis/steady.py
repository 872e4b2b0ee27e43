"""Search for a steady motion with prescribed speeds: all bodies keep their rates in a frame that turns about gravity's direction.

Positions and velocities are found together, on the constraints (3) and (5) and with the prescribed speeds, by a damped
Gauss-Newton method from the condition that the accelerations of all bodies, as the equations of motion give them, are those of
the frame: acc = Omega x w, and their derivatives with them, see `frames`. It starts with the velocities nearest to those of the
start.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..errors import EquilibriumFailed, InconsistentStart, ZerodriftError
from ..systems.base import BaseSystem
from .flow import Flow
from .frames import STEADY
from .quantities import find
from .retraction import moved, onto
from .state import State, scales, state
from .tangent import DEPENDENT, Tangent

ITERATIONS, LARGEST_STEP = 60, 0.2      # characteristic scales
RANK = 1e-7      # of the largest singular value: directions that change nothing, to the error of the differences
DIFFERENCE = 1e-4                       # characteristic scales: half of a central difference


def with_speeds(at: State, speeds: Mapping[str, float]) -> State:
    """The state at the same position with the nearest velocities that meet the constraints and the prescribed speeds.

    Raises
    ------
    InconsistentStart
        If they contradict each other.
    """
    rows, right = [at.C], [-at.Phi_t]
    for name, value in speeds.items():
        found = find(at, name, "v")
        rows.append(found.row)
        right.append(np.broadcast_to(np.asarray(value, dtype=float), found.value.shape)
                     - (found.value - found.row @ at.v if found.is_velocity else 0.0))
    G, g = np.vstack(rows), np.concatenate(right)
    scale = scales(at.system, at.p).v
    v = scale * np.linalg.lstsq(G * scale, g, rcond=DEPENDENT)[0]
    if np.abs(G @ v - g).max(initial=0.0) > 1e-9 * (np.abs(G * v).max(initial=0.0) + np.abs(g).max(initial=0.0)):
        raise InconsistentStart(f"v must agree with the constraints of {at.system.name}: {', '.join(speeds)} cannot all be met")
    Z = free_velocities(at, speeds)
    return state(at.system, at.t, at.p, v + Z @ (Z.T @ at.M @ (at.v - v)))


def free_velocities(at: State, speeds: Mapping[str, float]) -> np.ndarray:
    """Basis (nv, j) of the velocity changes that keep the constraints and the prescribed speeds."""
    rows = [find(at, name, "v").row for name in speeds]
    return Tangent(at, np.vstack(rows) if rows else None).velocities


class Steady:
    """The search for a steady motion."""

    def __init__(self, system: BaseSystem, t: float, speeds: Mapping[str, float]) -> None:
        self.system, self.t, self.speeds = system, t, speeds
        self.iterations = 0

    def at(self, p: np.ndarray, v: np.ndarray) -> State:
        """The state at a position with the prescribed speeds, its velocities otherwise near to v."""
        return with_speeds(state(self.system, self.t, p, v), self.speeds)

    def residual(self, at: State) -> tuple[np.ndarray, float]:
        """Differences of accelerations and their derivatives from a steady motion, (2 n,), and their size."""
        return Flow(at).left

    def run(self, p: np.ndarray, v: np.ndarray) -> State:
        """The steady motion that is found from a state.

        Raises
        ------
        EquilibriumFailed
        """
        here = self.at(onto(self.system, self.t, p), v)
        left, size = self.residual(here)
        for _ in range(ITERATIONS):
            if np.abs(left).max(initial=0.0) <= 1e-12 * size:
                break
            found = self._step(here, left)
            if found is None:
                break
            here, left, size = found
            self.iterations += 1
        if np.abs(left).max(initial=0.0) > STEADY * max(size, 1e-300):
            raise EquilibriumFailed(f"{self.system.name} must have a steady motion with these speeds, and none was found near "
                                    f"the start: accelerations of {np.abs(left).max():.3g} m/s^2 or rad/s^2 remain; prescribe "
                                    "more speeds in v=, or start nearer with near=")
        return here

    def _step(self, here: State, left: np.ndarray) -> tuple[State, np.ndarray, float] | None:
        """The state after a step that reduces the residual; None: no step does."""
        scale, nv = scales(self.system, here.p), self.system.nv
        W, Z = Tangent(here).displacements, free_velocities(here, self.speeds)
        directions = np.block([[W, np.zeros((nv, Z.shape[1]))], [np.zeros_like(W), Z]])
        sizes = np.maximum(np.abs(directions / np.tile(scale.v, 2)[:, None]).max(axis=0, initial=0.0), 1e-300)
        ends = [[self._moved(here, d, h / size)[1] for h in (DIFFERENCE, -DIFFERENCE)]
                for d, size in zip(directions.T, sizes, strict=True)]
        if not ends:
            return None
        columns = [(ahead - back) / (2 * DIFFERENCE) for ahead, back in ends]
        step = directions / sizes @ np.linalg.lstsq(np.array(columns).T, -left, rcond=RANK)[0]
        return self._damped(here, left, step, LARGEST_STEP / max(float(np.abs(step[:nv] / scale.v).max(initial=0.0)), 1e-300))

    def _damped(self, here: State, left: np.ndarray, step: np.ndarray, most: float) -> tuple[State, np.ndarray, float] | None:
        """The state after at most that part of a step, with a smaller residual."""
        part = min(1.0, most)
        while part > 1e-8:
            try:
                there, now, size = self._moved(here, step, part)
                if np.linalg.norm(now) < np.linalg.norm(left):
                    return there, now, size
            except ZerodriftError:
                pass
            part /= 4
        return None

    def _moved(self, here: State, step: np.ndarray, part: float) -> tuple[State, np.ndarray, float]:
        """The state after a part of a step in displacements and velocities (2 nv,), with its residual and size."""
        delta, dv = np.split(part * step, 2)
        there = self.at(onto(self.system, self.t, moved(here, delta)), here.v + dv)
        return there, *self.residual(there)
