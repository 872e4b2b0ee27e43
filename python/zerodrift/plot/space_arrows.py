"""Forces as arrows in axes of matplotlib that show space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from .annotations import KEY, LONGEST, SHORTEST, Arrow, round_number, with_prefix
from .marks import LOAD
from .names_apart import ABOVE


class SpaceArrows:
    """Forces as arrows from their points of application, with names, to a common scale given in a line of text."""

    def __init__(self, ax: Axes3D, arrows: Sequence[Arrow], extent: float, size: float, scale: float | None = None) -> None:
        """`scale` in N/m; left out: the longest arrow is a part of the picture, whose size is the extent."""
        self._arrows, self._size = arrows, size
        self.largest = max(float(np.linalg.norm(each.vectors, axis=1).max()) for each in arrows)
        self.scale = scale or self.largest / (LONGEST * extent) or 1.0
        self._drawn = ax.add_collection3d(Line3DCollection([np.zeros((2, 3))], colors=LOAD, linewidths=2.0, label="_forces"))
        self._texts = [ax.text(0, 0, 0, each.name, fontsize="small", color=LOAD, zorder=ABOVE,
                               label="_force") for each in arrows]
        said = round_number(self.scale * KEY * extent)
        if self.largest:
            ax.text2D(0.02, 0.95, f"{with_prefix(said)} is {said / self.scale:.3g} m long", transform=ax.transAxes,
                      fontsize="small", color=LOAD, label="_scale")

    def ends(self) -> np.ndarray:
        """Ends of all arrows at all times, (n, 3) in m."""
        return np.vstack([each.places + each.vectors / self.scale for each in self._arrows])

    def show(self, moment: int) -> list[Any]:
        """Draw the arrows of one time, except those that are too short to be seen; return the artists."""
        lines: list[np.ndarray] = []
        for each, text in zip(self._arrows, self._texts, strict=True):
            place, vector = each.places[moment], each.vectors[moment]
            is_seen = bool(np.linalg.norm(vector) > SHORTEST * self.largest)
            text.set_visible(is_seen)
            if is_seen:
                lines += self._lines(place, vector / self.scale)
                text.set_position_3d(place + vector / self.scale + 0.5 * self._size)
        self._drawn.set_segments(lines)
        return [self._drawn, *self._texts]

    def _lines(self, place: np.ndarray, way: np.ndarray) -> list[np.ndarray]:
        """Lines of an arrow: a shaft and a head of four lines."""
        along, tip = way / np.linalg.norm(way), place + way
        side = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
        side /= np.linalg.norm(side)
        sides = (side, -side, np.cross(along, side), -np.cross(along, side))
        return [np.array([place, tip]), *(np.array([tip - self._size * (0.8 * along + 0.3 * each), tip]) for each in sides)]
