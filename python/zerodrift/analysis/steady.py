"""Search for a steady motion with prescribed speeds: all bodies keep their rates in a frame that turns about gravity's direction.

For a position, velocities are the smallest in the mass metric that satisfy (5) and the prescribed speeds. The position is found
by a damped Gauss-Newton method from the condition that the accelerations of all bodies, as the equations of motion give them,
are those of the frame: acc = Omega x w, see `frames`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..errors import CorrectionFailed, EquilibriumFailed, InconsistentStart, ZerodriftError
from ..systems.base import BaseSystem
from .flow import accelerate
from .frames import STEADY, Frame, frame_of
from .quantities import find
from .retraction import moved, onto
from .state import State, scales, state
from .tangent import DEPENDENT, Tangent

ITERATIONS, LARGEST_STEP = 60, 0.2      # characteristic scales
DIFFERENCE = 1e-4                       # characteristic scales: half of a central difference


def with_speeds(at: State, speeds: Mapping[str, float]) -> State:
    """The state at the same position with velocities that meet the constraints and the prescribed speeds.

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
    Z = Tangent(at, np.vstack(rows[1:]) if speeds else None).velocities
    return state(at.system, at.t, at.p, v - Z @ (Z.T @ at.M @ v))


class Steady:
    """The search for a steady motion."""

    def __init__(self, system: BaseSystem, t: float, speeds: Mapping[str, float]) -> None:
        self.system, self.t, self.speeds, self.frame = system, t, speeds, frame_of(system)
        self.iterations = 0

    def at(self, p: np.ndarray) -> State:
        """The state at a position, with the prescribed speeds."""
        return with_speeds(state(self.system, self.t, p, np.zeros(self.system.nv)), self.speeds)

    def residual(self, at: State) -> tuple[np.ndarray, float]:
        """What the accelerations lack to those of a steady motion, (n,), and their size."""
        rows = self.frame.rows(at)
        acc, w = rows @ accelerate(at)[0] + self.frame.bias(at), rows @ at.v
        turned = Frame.rotation(self.frame, self.frame.steady_rotation(w, acc), w.size) @ w
        return acc - turned, float(np.abs(acc).max(initial=0.0) + np.abs(turned).max(initial=0.0) + np.abs(w).max(initial=0.0)**2)

    def run(self, p: np.ndarray) -> State:
        """The steady motion that is found from a position.

        Raises
        ------
        EquilibriumFailed
        """
        here = self.at(onto(self.system, self.t, p))
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
        W, scale = Tangent(here).displacements, scales(self.system, here.p).p
        sizes = [max(float(np.abs(here.A @ w / scale).max(initial=0.0)), 1e-300) for w in W.T]
        ends = [[self._moved(here, w, h / size)[1] for h in (DIFFERENCE, -DIFFERENCE)]
                for w, size in zip(W.T, sizes, strict=True)]
        columns = [(ahead - back) * size / (2 * DIFFERENCE) for (ahead, back), size in zip(ends, sizes, strict=True)]
        if not columns:
            return None
        z = np.linalg.lstsq(np.array(columns).T, -left, rcond=1e-7)[0]
        part = min(1.0, LARGEST_STEP / max(float(np.abs(here.A @ (W @ z) / scale).max(initial=0.0)), 1e-300))
        while part > 1e-8:
            try:
                there, now, size = self._moved(here, W @ z, part)
                if np.linalg.norm(now) < np.linalg.norm(left):
                    return there, now, size
            except (CorrectionFailed, ZerodriftError):
                pass
            part /= 4
        return None

    def _moved(self, here: State, delta: np.ndarray, part: float) -> tuple[State, np.ndarray, float]:
        there = self.at(onto(self.system, self.t, moved(here, part * delta)))
        return there, *self.residual(there)
