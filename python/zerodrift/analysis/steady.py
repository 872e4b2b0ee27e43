"""Search for a steady motion with prescribed speeds: all bodies keep their rates in a frame that turns about gravity's direction.

Positions and velocities are found together, on the constraints (3) and (5) and with the prescribed speeds, by a damped
Gauss-Newton method from the condition that the accelerations of all bodies, as the equations of motion give them, are those of
the frame: acc = Omega x w, and their derivatives with them, see `frames`. It starts with the velocities nearest to those of the
start. Where that leads to a state that is steady for an instant only, Omega is varied, too, from the angular velocities of the
bodies, and in place of the derivatives accelerations are compared at several instants of the orbit, see `orbit`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..errors import EquilibriumFailed, InconsistentStart, ZerodriftError
from ..systems.base import BaseSystem
from .flow import Flow
from .frames import STEADY
from .orbit import Orbit
from .quantities import find
from .retraction import moved, onto
from .state import State, scales, state
from .tangent import DEPENDENT, Tangent

ITERATIONS, ITERATIONS_ON_ORBIT = 60, 20
LARGEST_STEP = 0.2      # characteristic scales
STALLED = 6, 0.98       # iterations after which less than this part must be left, or the search ends
RANK = 1e-7      # of the largest singular value: directions that change nothing, to the error of the differences
INSTANTS = 3        # of an orbit at which accelerations are compared, a radian apart
GUESSES = 2         # angular velocities of each kind that are tried
DIFFERENCE = 1e-4                       # characteristic scales: half of a central difference


def with_speeds(at: State, speeds: Mapping[str, np.ndarray]) -> State:
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


def free_velocities(at: State, speeds: Mapping[str, np.ndarray]) -> np.ndarray:
    """Basis (nv, j) of the velocity changes that keep the constraints and the prescribed speeds."""
    rows = [find(at, name, "v").row for name in speeds]
    return Tangent(at, np.vstack(rows) if rows else None).velocities


class Motion(NamedTuple):
    """A state on the way to a steady motion.

    `at`: terms at (t, p, v); `u` (j,): efforts that act there; `Omega` (a,): angular velocities about the axes of `Frame.axes`,
    or (0,) for those that fit best; `left`: its differences from a steady motion, see `Flow.left`; `size`: the size of
    accelerations, to which they are compared.
    """

    at: State
    u: np.ndarray
    Omega: np.ndarray
    left: np.ndarray
    size: float


class Steady:
    """The search for a steady motion.

    Parameters
    ----------
    system : BaseSystem
    t : float
    speeds : dict of str to ndarray (size,)
        Rates that are prescribed.
    held : list of str
        Scalar quantities that efforts keep constant.
    """

    def __init__(self, system: BaseSystem, t: float, speeds: Mapping[str, np.ndarray], held: Sequence[str]) -> None:
        self.system, self.t, self.speeds, self.held = system, t, speeds, list(held)
        self.iterations, self.instants, self.is_Omega_known = 0, [0.0], False

    def motion(self, p: np.ndarray, v: np.ndarray, u: np.ndarray, Omega: np.ndarray) -> Motion:
        """The motion at a position with the prescribed speeds, its velocities otherwise near to v."""
        at = with_speeds(state(self.system, self.t, p, v), self.speeds)
        flow = self._flow(at, u)
        return Motion(at, u, Omega, self._left_on_orbit(flow, Omega) if Omega.size else flow.left, flow.size)

    def _flow(self, at: State, u: np.ndarray) -> Flow:
        """The flow at a state under the efforts u (j,)."""
        return Flow(at, efforts=dict(zip(self.held, u, strict=True)))

    def _left_on_orbit(self, flow: Flow, Omega: np.ndarray) -> np.ndarray:
        """Differences of accelerations from those of the orbit, at its first instant and at later ones."""
        orbit = Orbit(flow.at, flow.frame, flow.w, Omega @ flow.frame.axes)
        acc = flow.frame.rotation(orbit.Omega, flow.w.size) @ flow.w
        later = [orbit.turned(s).T @ Flow(orbit.state(s), efforts=flow.efforts).acc - acc for s in self.instants]
        return np.concatenate([flow.acc - acc, *later])

    def run(self, p: np.ndarray, v: np.ndarray) -> tuple[Flow, np.ndarray]:
        """The flow of the steady motion that is found from a state, and its efforts (j,).

        Omega is the one that fits best, then one of those of its bodies.

        Raises
        ------
        EquilibriumFailed
        """
        start = self.motion(onto(self.system, self.t, p), v, np.zeros(len(self.held)), np.zeros(0))
        here = self._searched(start)
        first = flow = self._flow(here.at, here.u)
        for Omega, is_known in () if flow.is_steady else self._guesses(start):
            self.is_Omega_known = is_known
            self.instants = [k / float(np.linalg.norm(Omega)) for k in range(1, INSTANTS + 1)]
            try:
                there = self._searched(self.motion(start.at.p, start.at.v, start.u, Omega), ITERATIONS_ON_ORBIT)
            except ZerodriftError:
                continue
            flow = self._flow(there.at, there.u)
            if flow.is_steady:
                return flow, there.u
        if not first.is_steady:
            raise EquilibriumFailed(self._nothing(first))
        return first, here.u

    def _searched(self, here: Motion, iterations: int = ITERATIONS) -> Motion:
        """The motion with which iterations end."""
        (steps, part), norms = STALLED, []
        for k in range(iterations):
            norms.append(float(np.linalg.norm(here.left)))
            is_stalled = k >= steps and norms[k] > part * norms[k - steps]
            if is_stalled or np.abs(here.left).max(initial=0.0) <= 1e-12 * here.size:
                break
            found = self._step(here)
            if found is None:
                break
            here = found
            self.iterations += 1
        return here

    def _guesses(self, start: Motion) -> list[tuple[np.ndarray, bool]]:
        """Angular velocities (a,) about the axes of the frame, each with True for those of bodies, which are kept, and False for
        those of their places about the origin.
        """
        flow = self._flow(start.at, start.u)
        axes, found = flow.frame.axes, []
        for are_kept, group in zip((True, False), flow.frame.angular_velocities(start.at, flow.w), strict=True):
            distinct: list[np.ndarray] = []
            for guess in group @ axes.T:
                if np.linalg.norm(guess) > RANK and not any(np.allclose(guess, each) for each in distinct):
                    distinct.append(guess)
            found += [(guess, are_kept) for guess in distinct[:GUESSES]]
        return found

    def _nothing(self, flow: Flow) -> str:
        """The message of a search that found nothing."""
        share, left = np.abs(flow.vdot) / scales(self.system, flow.at.p).v, float(np.abs(flow.left).max(initial=0.0))
        remains = "the motion is steady for an instant only" if left <= STEADY * flow.size else (
            f"accelerations of {left:.3g} m/s^2 or rad/s^2 remain, most at {self.system.velocities[int(share.argmax())].name!r}")
        changes = f"{flow.change} along its orbit, and " if flow.change else ""
        return (f"{self.system.name} must have a steady motion with these speeds, and none was found near the start: "
                f"{changes}{remains}; prescribe more speeds or fewer in v=, name in hold= what an effort keeps constant, or "
                "start nearer with near=")

    def _step(self, here: Motion) -> Motion | None:
        """The motion after a step that reduces what is left; None: no step does."""
        scale = scales(self.system, here.at.p)
        directions, units = self._directions(here)
        sizes = np.maximum(np.abs(directions / units[:, None]).max(axis=0, initial=0.0), 1e-300)
        ends = [[self._moved(here, d, h / size).left for h in (DIFFERENCE, -DIFFERENCE)]
                for d, size in zip(directions.T, sizes, strict=True)]
        if not ends:
            return None
        columns = [(ahead - back) / (2 * DIFFERENCE) for ahead, back in ends]
        step = directions / sizes @ np.linalg.lstsq(np.array(columns).T, -here.left, rcond=RANK)[0]
        moves = np.abs(step[:self.system.nv] / scale.v).max(initial=0.0)
        return self._damped(here, step, LARGEST_STEP / max(float(moves), 1e-300))

    def _directions(self, here: Motion) -> tuple[np.ndarray, np.ndarray]:
        """Columns of displacements, velocities, efforts and angular velocities that are varied, and units of these entries."""
        tangent, Z = Tangent(here.at), free_velocities(here.at, self.speeds)
        acting = [np.linalg.norm(tangent.velocities.T @ find(here.at, name, "hold").row.T) for name in self.held]
        parts = [tangent.displacements, Z, np.diag(1 / np.maximum(acting, 1e-300)),
                 np.eye(len(here.Omega))[:, self.is_Omega_known * len(here.Omega):]]
        rows, columns = (np.cumsum([0, *(part.shape[i] for part in parts)]) for i in (0, 1))
        directions = np.zeros((rows[-1], columns[-1]))
        for part, row, column in zip(parts, rows, columns, strict=False):
            directions[row:row + part.shape[0], column:column + part.shape[1]] = part
        scale = scales(self.system, here.at.p).v
        rate = max(float(np.abs(here.Omega).max(initial=0.0)), 1e-300)
        return directions, np.concatenate([scale, scale, 1 / np.maximum(acting, 1e-300), np.full(len(here.Omega), rate)])

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
        nv, j = self.system.nv, len(self.held)
        delta, dv, du, dOmega = np.split(part * step, [nv, 2 * nv, 2 * nv + j])
        return self.motion(onto(self.system, self.t, moved(here.at, delta)), here.at.v + dv, here.u + du, here.Omega + dOmega)
