"""Search for a steady motion with prescribed speeds: all bodies keep their rates in a frame that turns about gravity's direction.

Positions and velocities are found together, on the constraints (3) and (5) and with the prescribed speeds, by a damped
Gauss-Newton method from the condition that the accelerations of all bodies, as the equations of motion give them, are those of
the frame: acc = Omega x w, and their derivatives with them, see `frames`. It starts with the velocities nearest to those of the
start.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..errors import EquilibriumFailed, InconsistentStart, ZerodriftError
from ..systems.base import BaseSystem
from .flow import Flow
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


class Motion(NamedTuple):
    """A state on the way to a steady motion.

    `at`: terms at (t, p, v); `u` (j,): efforts that act there; `left`: its differences from a steady motion, see `Flow.left`;
    `size`: the size of accelerations, to which they are compared.
    """

    at: State
    u: np.ndarray
    left: np.ndarray
    size: float


class Steady:
    """The search for a steady motion.

    Parameters
    ----------
    system : BaseSystem
    t : float
    speeds : dict of str to float
        Rates that are prescribed.
    held : list of str
        Scalar quantities that efforts keep constant.
    """

    def __init__(self, system: BaseSystem, t: float, speeds: Mapping[str, float], held: Sequence[str]) -> None:
        self.system, self.t, self.speeds, self.held = system, t, speeds, list(held)
        self.iterations = 0

    def motion(self, p: np.ndarray, v: np.ndarray, u: np.ndarray) -> Motion:
        """The motion at a position with the prescribed speeds, its velocities otherwise near to v."""
        at = with_speeds(state(self.system, self.t, p, v), self.speeds)
        return Motion(at, u, *self._flow(at, u).left)

    def _flow(self, at: State, u: np.ndarray) -> Flow:
        """The flow at a state under the efforts u (j,)."""
        return Flow(at, efforts=dict(zip(self.held, u, strict=True)))

    def run(self, p: np.ndarray, v: np.ndarray) -> Motion:
        """The steady motion that is found from a state.

        Raises
        ------
        EquilibriumFailed
        """
        here = self.motion(onto(self.system, self.t, p), v, np.zeros(len(self.held)))
        for _ in range(ITERATIONS):
            if np.abs(here.left).max(initial=0.0) <= 1e-12 * here.size:
                break
            found = self._step(here)
            if found is None:
                break
            here = found
            self.iterations += 1
        if not self._flow(here.at, here.u).is_steady:
            raise EquilibriumFailed(self._nothing(here))
        return here

    def _nothing(self, here: Motion) -> str:
        """The message of a search that found nothing."""
        share = np.abs(self._flow(here.at, here.u).vdot) / scales(self.system, here.at.p).v
        return (f"{self.system.name} must have a steady motion with these speeds, and none was found near the start: "
                f"accelerations of {np.abs(here.left).max():.3g} m/s^2 or rad/s^2 remain, most at "
                f"{self.system.velocities[int(share.argmax())].name!r}; prescribe more speeds or fewer in v=, name in hold= what "
                "an effort keeps constant, or start nearer with near=")

    def _step(self, here: Motion) -> Motion | None:
        """The motion after a step that reduces what is left; None: no step does."""
        scale, nv, j = scales(self.system, here.at.p), self.system.nv, len(self.held)
        tangent = Tangent(here.at)
        W, Z = tangent.displacements, free_velocities(here.at, self.speeds)
        directions = np.zeros((2 * nv + j, W.shape[1] + Z.shape[1] + j))
        directions[:nv, :W.shape[1]], directions[nv:2 * nv, W.shape[1]:W.shape[1] + Z.shape[1]] = W, Z
        acting = [np.linalg.norm(tangent.velocities.T @ find(here.at, name, "hold").row.T) for name in self.held]
        directions[2 * nv:, directions.shape[1] - j:] = np.diag(1 / np.maximum(acting, 1e-300))
        units = np.concatenate([np.tile(scale.v, 2), 1 / np.maximum(acting, 1e-300)])
        sizes = np.maximum(np.abs(directions / units[:, None]).max(axis=0, initial=0.0), 1e-300)
        ends = [[self._moved(here, d, h / size).left for h in (DIFFERENCE, -DIFFERENCE)]
                for d, size in zip(directions.T, sizes, strict=True)]
        if not ends:
            return None
        columns = [(ahead - back) / (2 * DIFFERENCE) for ahead, back in ends]
        step = directions / sizes @ np.linalg.lstsq(np.array(columns).T, -here.left, rcond=RANK)[0]
        return self._damped(here, step, LARGEST_STEP / max(float(np.abs(step[:nv] / scale.v).max(initial=0.0)), 1e-300))

    def _damped(self, here: Motion, step: np.ndarray, most: float) -> Motion | None:
        """The motion after at most that part of a step, with less left."""
        part = min(1.0, most)
        while part > 1e-8:
            try:
                there = self._moved(here, step, part)
                if np.linalg.norm(there.left) < np.linalg.norm(here.left):
                    return there
            except ZerodriftError:
                pass
            part /= 4
        return None

    def _moved(self, here: Motion, step: np.ndarray, part: float) -> Motion:
        """The motion after a part of a step in displacements, velocities (2 nv,) and efforts."""
        delta, dv, du = np.split(part * step, [self.system.nv, 2 * self.system.nv])
        return self.motion(onto(self.system, self.t, moved(here.at, delta)), here.at.v + dv, here.u + du)
