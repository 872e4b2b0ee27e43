"""Vectors and frames in the plane."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


def turned(angle: float, vector: np.ndarray) -> np.ndarray:
    """A vector (2,), turned counter-clockwise."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def turned_back(angle: float, vector: np.ndarray) -> np.ndarray:
    """A vector (2,), turned clockwise."""
    return turned(-angle, vector)


class Pose(NamedTuple):
    """Where a frame is: its origin (2,) in m, and its x axis from the drawing's, in rad."""

    origin: np.ndarray
    angle: float

    def point(self, local: np.ndarray) -> np.ndarray:
        """Where a point of the frame is in the drawing, (2,)."""
        return self.origin + turned(self.angle, local)

    def local(self, drawn: np.ndarray) -> np.ndarray:
        """The coordinates in the frame of a place in the drawing, (2,)."""
        return turned_back(self.angle, drawn - self.origin)

    def direction(self, local: np.ndarray) -> np.ndarray:
        """A direction of the frame in the drawing, (2,)."""
        return turned(self.angle, local)

    def local_direction(self, drawn: np.ndarray) -> np.ndarray:
        """A direction of the drawing in the frame, (2,)."""
        return turned_back(self.angle, drawn)
