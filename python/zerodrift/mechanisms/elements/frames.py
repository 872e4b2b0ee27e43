"""Vectors, poses and rotations in the plane and in space."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..._private import checks
from ..._private.rotations import quaternion_of, rotation_of, turn
from ...errors import WrongValue


def turned(angle: float | np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Vector (2,), rotated counter-clockwise by an angle in rad."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def turned_back(angle: float, vector: np.ndarray) -> np.ndarray:
    """Vector (2,), rotated clockwise by an angle in rad."""
    return turned(-angle, vector)


class Pose(NamedTuple):
    """Pose of a frame in the plane: origin (2,) in m, and angle of its x axis from the drawing's, in rad."""

    origin: np.ndarray
    angle: float

    def point(self, local: np.ndarray) -> np.ndarray:
        """Position (2,) in the drawing of a point of the frame, in m."""
        return self.origin + turned(self.angle, local)

    def local(self, drawn: np.ndarray) -> np.ndarray:
        """Coordinates (2,) in the frame of a point of the drawing."""
        return turned_back(self.angle, drawn - self.origin)

    def direction(self, local: np.ndarray) -> np.ndarray:
        """Direction (2,) in the drawing, from one in the frame."""
        return turned(self.angle, local)

    def local_direction(self, drawn: np.ndarray) -> np.ndarray:
        """Direction (2,) in the frame, from one in the drawing."""
        return turned_back(self.angle, drawn)


ROTATION = 1e-6         # deviation of a given matrix from a rotation, and of a quaternion's length from 1, at most


class Pose3(NamedTuple):
    """Pose of a frame in space: origin (3,) in m, and its axes in the drawing, the columns of `rotation` (3, 3)."""

    origin: np.ndarray
    rotation: np.ndarray

    def point(self, local: np.ndarray) -> np.ndarray:
        """Position (3,) in the drawing of a point of the frame, in m."""
        return self.origin + self.rotation @ local

    def local(self, drawn: np.ndarray) -> np.ndarray:
        """Coordinates (3,) in the frame of a point of the drawing."""
        return self.rotation.T @ (drawn - self.origin)

    def direction(self, local: np.ndarray) -> np.ndarray:
        """Direction (3,) in the drawing, from one in the frame."""
        return self.rotation @ local

    def local_direction(self, drawn: np.ndarray) -> np.ndarray:
        """Direction (3,) in the frame, from one in the drawing."""
        return self.rotation.T @ drawn


def given_rotation(argument: str, value: Any) -> np.ndarray:
    """Rotation (3, 3) from a matrix whose columns are the axes in the drawing, or from a unit quaternion (w, x, y, z)."""
    if value is None:
        return np.eye(3)
    if np.shape(value) == (4,):
        q = checks.vector(argument, value, 4)
        length = float(np.sqrt(q @ q))
        if abs(length - 1) > ROTATION:
            raise WrongValue(f"{argument} must be a quaternion of length 1, and {tuple(map(float, q))} has length {length:g}",
                             "geometry")
        return rotation_of(q / length)
    if np.shape(value) != (3, 3):
        raise WrongValue(f"{argument} must be a (3, 3) matrix or a quaternion (w, x, y, z), not {checks.shown(value)}", "shape")
    R = checks.vector(argument, np.ravel(value), 9).reshape(3, 3)
    if np.abs(R.T @ R - np.eye(3)).max() > ROTATION or np.linalg.det(R) < 0:
        raise WrongValue(f"{argument} must be a rotation, its columns right-handed, perpendicular and of length 1", "geometry")
    return rotation_of(quaternion_of(R))        # orthogonal to rounding


def about(axis: Any, angle: float) -> np.ndarray:
    """Rotation (3, 3) about an axis (3,) by an angle in rad, right-handed."""
    axis = np.asarray(axis, dtype=float)
    return rotation_of(turn(axis / np.linalg.norm(axis) * angle))


def perpendicular(axis: np.ndarray, wished: np.ndarray | None = None) -> np.ndarray:
    """Unit vector (3,) perpendicular to an axis, from the wished one or from the drawing's axis farthest from it."""
    if wished is None:
        wished = np.eye(3)[int(np.argmin(np.abs(axis)))]
    left = wished - (wished @ axis) * axis
    left = left - (left @ axis) * axis
    return left / np.sqrt(left @ left)


def triple(vector: Any) -> tuple[float, float, float]:
    """Vector as three floats, for the core's tables."""
    x, y, z = vector
    return float(x), float(y), float(z)
