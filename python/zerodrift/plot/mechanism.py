"""Pictures of mechanisms of the plane from the shapes of their parts; `drawing` asks for them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ..systems.shapes import Shape
from .glyphs import GLYPHS, LIGHT

SMALL = 0.016       # of the drawing: the radius of a pin
SLENDER = 0.2       # of the shortest bar: no pin is larger
MARGIN = 0.12       # of the drawing, around it
NARROW = 0.4        # of the drawing's longer side: no picture is narrower
DIRECTED = ("rail", "groove", "slider", "disc", "wheel", "gear", "blade")       # whose last point is a direction
FAINT = ("link", "rod")     # what other positions show


class Picture:
    """Shapes in axes, all to the scale that holds every one of them; `show` draws those of one moment instead of those before."""

    def __init__(self, ax: Axes, moments: Sequence[list[Shape]]) -> None:
        self.ax, self._moments, self._drawn = ax, moments, []
        places = np.vstack([_extent(shape) for shapes in moments for shape in shapes] or [np.zeros((1, 2))])
        low, high = places.min(axis=0), places.max(axis=0)
        extent = float((high - low).max()) or 1.0
        bars = [np.hypot(*np.ptp(shape.points, axis=0)) for shape in moments[0] if shape.kind == "link"]
        self.size = min([SMALL * extent, *(SLENDER * float(bar) for bar in bars)])
        middle, half = (low + high) / 2, np.maximum((high - low) / 2, NARROW / 2 * extent) + MARGIN * extent
        ax.set_xlim(middle[0] - half[0], middle[0] + half[0])
        ax.set_ylim(middle[1] - half[1], middle[1] + half[1])
        ax.set_aspect("equal", adjustable="box")

    def faintly(self, moments: Sequence[int]) -> None:
        """Other moments, faintly and for good."""
        for moment in moments:
            for shape in self._moments[moment]:
                if shape.kind in FAINT:
                    points = np.vstack([shape.points, shape.points[:1]]) if len(shape.points) > 2 else shape.points
                    self.ax.plot(*points.T, color=LIGHT, alpha=0.35, linewidth=1.0, zorder=1)

    def show(self, moment: int) -> list[Any]:
        """Draws one moment."""
        for artist in self._drawn:
            artist.remove()
        self._drawn = [artist for shape in self._moments[moment]
                       for artist in GLYPHS[shape.kind](self.ax, shape, self.size)]
        return self._drawn


def _extent(shape: Shape) -> np.ndarray:
    """The places that a shape takes, (n, 2)."""
    places = shape.points[:-1] if shape.kind in DIRECTED else shape.points
    reach = shape.number if shape.kind in ("wheel", "gear") else 0.0
    return np.vstack([places - reach, places + reach])
