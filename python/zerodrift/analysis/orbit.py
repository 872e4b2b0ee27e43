"""Orbit of a symmetry: the motion along which a state goes on if all rates turn with one constant angular velocity Omega.

With R(s) the rotation by Omega s, the rates w of a body (velocity of its mass centre, angular velocity omega) at time s are
R(s) w, so that

    centre(s) = centre + int_0^s R(x) w dx        attitude(s) = R(s) exp((omega - Omega) s) attitude

A motion is steady if the equations of motion give the accelerations Omega x R(s) w all along this orbit: on a circle about
a fixed axis, on a line, or on a screw. They are compared at 16 instants of one turn of each rate, or of one characteristic
length of a translation.
"""

from __future__ import annotations

import numpy as np

from .._private.rotations import product, rotation_of, turn
from ..runs.states.instant import Reading
from .frames import CoordinateFrame, Frame, mechanism_core_of
from .state import State, scales, state

INSTANTS = 16       # of one turn of each rate
CHANGED = 1e-7      # of the largest action: its change on an orbit
ALIKE = 1e-3        # rates of which one stands for both
ACTIONS = (".force", ".torque", ".tension")


def _path(w: np.ndarray, Omega: np.ndarray, s: float) -> np.ndarray:
    """Displacements (k, 3) int_0^s R(x) w dx of velocities w (k, 3)."""
    rate = float(np.linalg.norm(Omega))
    if not rate:
        return s * w
    axis, angle = Omega / rate, rate * s
    along = np.outer(w @ axis, axis)
    half = np.sin(angle / 2)
    return s * along + np.sin(angle) / rate * (w - along) + 2 * half * half / rate * np.cross(axis, w)


class Orbit:
    """The orbit of a state with the angular velocity Omega (3,), in 1/s."""

    def __init__(self, at: State, frame: Frame, w: np.ndarray, Omega: np.ndarray) -> None:
        self.at, self.frame, self.w, self.Omega = at, frame, w, Omega

    def turned(self, s: float) -> np.ndarray:
        """The rotation (n, n) of all vectors by Omega s, one elsewhere."""
        R, size = rotation_of(turn(self.Omega * s)), self.frame.dimension
        matrix = np.eye(self.w.size)
        for first in self.frame.vectors:
            matrix[first:first + size, first:first + size] = R[:size, :size]
        return matrix

    def state(self, s: float) -> State:
        """The state after the time s."""
        at = self.at
        frame = self.frame
        p = self._of_coordinates(s, frame) if isinstance(frame, CoordinateFrame) else self._of_bodies(s)
        there = state(at.system, at.t + s, p, np.zeros(at.system.nv))
        rows, scale = self.frame.rows(there), scales(at.system, p).v
        v = scale * np.linalg.lstsq(rows * scale, self.turned(s) @ self.w, rcond=None)[0]
        return state(at.system, at.t + s, p, v)

    def _of_coordinates(self, s: float, frame: CoordinateFrame) -> np.ndarray:
        """Coordinates (nq,) of a system without bodies, whose rates are constant."""
        p, pdot = self.at.p.copy(), self.at.A @ self.at.v
        p[frame.places] += s * pdot[frame.places]
        for first, to in zip(frame.turning, self.at.system.quaternions, strict=True):
            p[to:to + 4] = product(turn(self.w[first:first + 3] * s), p[to:to + 4])
        return p

    def _of_bodies(self, s: float) -> np.ndarray:
        """Coordinates (nq,) of a mechanism."""
        at, core = self.at, mechanism_core_of(self.at.system)
        poses, rates = core.poses(at.p, at.v)
        if self.frame.dimension == 2:
            w = np.hstack([rates[:, :2], np.zeros((len(rates), 1))])
            return core.state(poses + np.hstack([_path(w, self.Omega, s)[:, :2], s * rates[:, 2:]]))[0]
        omega = np.einsum("kij,kj->ki", rotation_of(poses[:, 3:]), rates[:, 3:])
        attitude = product(turn(self.Omega * s)[None], product(turn((omega - self.Omega) * s), poses[:, 3:]))
        there = np.hstack([poses[:, :3] + _path(rates[:, :3], self.Omega, s), attitude])
        return core.state(there, angles=core.angles(at.p) + s * core.angles(at.A @ at.v))[0]

    def times(self, slow: float) -> np.ndarray:
        """Instants in s, of one turn of each rate above `slow` and of one characteristic length of each translation."""
        frame, w, length = self.frame, self.w, scales(self.at.system, self.at.p).length
        rates, left = [float(np.linalg.norm(self.Omega))], np.ones(w.size, dtype=bool)
        for first in {*frame.vectors, *frame.turning}:
            vector = w[first:first + frame.dimension]
            left[first:first + frame.dimension] = False
            parts = (vector, vector - self.Omega) if first in frame.turning else (2 * np.pi * vector / length,)
            rates += [float(np.linalg.norm(part)) for part in parts]
        rates += list(np.abs(w[left]))
        distinct: list[float] = []
        for rate in sorted(rates, reverse=True):
            if rate > slow and not (distinct and rate > (1 - ALIKE) * distinct[-1]):
                distinct.append(rate)
        return np.array([2 * np.pi * k / INSTANTS / rate for rate in distinct for k in range(1, INSTANTS + 1)])


def changed(one: Reading, other: Reading, turned: np.ndarray) -> str:
    """The action that differs most between two states of an orbit, which turns by `turned` (3, 3); then of joints."""
    drawing = getattr(one.system, "_drawing", None)
    if drawing is None:
        return "its forces do not balance"
    joints = {each.name for each in drawing.elements.values() if hasattr(each, "bodies")}
    change: dict[bool, dict[str, float]] = {False: {}, True: {}}
    largest = 0.0
    for name in one.system._names_of_measures():
        if name.endswith(ACTIONS) and not name.startswith("ground."):     # which is the sum of the others
            before, after = np.atleast_1d(one[name]), np.atleast_1d(other[name])
            R = turned[:before.size, :before.size] if before.size == drawing.dimension else np.eye(before.size)
            change[name.rpartition(".")[0] in joints][name] = float(np.abs(after - R @ before).max())
            largest = max(largest, float(np.abs(np.stack([before, after])).max()))
    for group in change.values():
        name = max(group, key=group.__getitem__, default="")
        if name and group[name] > CHANGED * largest:
            return f"{name!r} changes"
    return "its forces do not balance"
