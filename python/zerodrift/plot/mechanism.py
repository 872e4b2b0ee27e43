"""Pictures of planar mechanisms from the shapes of their parts, for `drawing`.

All shapes of a kind are one collection of matplotlib, whose label is the kind, so that pictures of a thousand links are quick,
and films move what there is instead of drawing anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.text import Text

from ..systems.shapes import Shape
from .annotations import Arrow, Arrows, Names, draw_path, hold
from .glyphs import GLYPHS
from .marks import SMOOTH, Mark, arc, hull
from .names_apart import keep_apart

PIN_RADIUS = 0.017  # of the picture: the radius of a pin
MIN_PIN_RADIUS = 1.7  # points: no pin is smaller, however small the picture
SLENDER = 0.13      # of the short bars, the quarter of all: no pin is larger
OWN = 0.035         # of the mechanism without its path: no pin is larger
MARGIN = 3.0        # sizes, around all that is drawn
NARROW = 0.4        # of the picture's longer side: no picture is narrower
LINE = 0.22         # points in a picture's line for each point in a pin's radius
THIN, THICK = 0.3, 1.0      # of lines, in points
FAINT = {"link": "#9A9A9A", "rod": "#9A9A9A", "curve": "#9A9A9A", "wheel": "#C8C8C8"}       # colours of faint positions


class Extras(NamedTuple):
    """Additions to the picture of a mechanism: names, paths (k, 2) of points, forces and their scale in N/m."""

    names: bool = False
    paths: Sequence[np.ndarray] = ()
    arrows: Sequence[Arrow] = ()
    force_scale: float | None = None


NOTHING = Extras()


class Picture:
    """Picture of shapes in axes with limits that contain all positions; `show` draws one position instead of the last."""

    def __init__(self, ax: Axes, moments: Sequence[list[Shape]], extras: Extras = NOTHING) -> None:
        shown = {arrow.name for arrow in extras.arrows}
        self.ax = ax
        self._moments = [_beside_arrows(shapes, shown) for shapes in moments] if shown else moments
        self._drawn: dict[str, PathCollection] = {}
        covered = [_extent(shape) for shapes in self._moments for shape in shapes] or [np.zeros((1, 2))]
        places = np.vstack([*covered, *extras.paths])
        extent, per_point = self._scale(places)
        points = self.size / per_point
        self._arrows = self._names = None
        self._are_apart = False
        if extras.arrows:
            self._arrows = Arrows(ax, extras.arrows, extent, self.size, self.line, points, extras.force_scale)
            places = np.vstack([places, self._arrows.ends()])
        self._limit(places, extent)
        if self._arrows:
            self._arrows.say_scale(ax)
        if extras.names:
            self._names = Names(ax, self._moments[0], self.size, points, shown)
        for path in extras.paths:
            draw_path(ax, path, self.line, scalex=False, scaley=False)

    def _scale(self, places: np.ndarray) -> tuple[float, float]:
        """Set the sizes of pins and lines; return the extent of the picture and the size of a typographic point, in m."""
        low, high = places.min(axis=0), places.max(axis=0)
        extent = float((high - low).max()) or 1.0
        per_point = 1.3 * float(((high - low) / np.maximum(points_of(self.ax), 1.0)).max()) or extent / 300
        bars = [float(np.hypot(*np.ptp(shape.points, axis=0))) for shape in self._moments[0] if shape.kind == "link"]
        own = np.ptp(np.vstack([_extent(shape) for shape in self._moments[0]] or [places]), axis=0).max() or extent
        most = [OWN * float(own), *([SLENDER * float(np.quantile(bars, 0.25))] if bars else [])]
        self.size = min(max(PIN_RADIUS * extent, MIN_PIN_RADIUS * per_point), *most)
        self.line = float(np.clip(LINE * self.size / per_point, THIN, THICK))
        return extent, per_point

    def _limit(self, places: np.ndarray, extent: float) -> None:
        """Set limits that contain all points, and the marks of the first position."""
        ends = [places, *(np.asarray(each.path.vertices) for shape in self._moments[0]
                          for each in GLYPHS[shape.kind].draw(shape, self.size))]
        low, high = np.min([each.min(axis=0) for each in ends], axis=0), np.max([each.max(axis=0) for each in ends], axis=0)
        middle, half = (low + high) / 2, np.maximum((high - low) / 2, NARROW / 2 * extent) + MARGIN * self.size
        hold(self.ax, middle - half, middle + half)
        self.ax.set_aspect("equal", adjustable="box")

    def faintly(self, moments: Sequence[int]) -> None:
        """Draw other positions as thin lines, permanently."""
        drawn = [(FAINT[shape.kind], _skeleton(shape)) for i in moments for shape in self._moments[i] if shape.kind in FAINT]
        if drawn:
            colours, segments = zip(*drawn, strict=True)
            self.ax.add_collection(LineCollection(segments, colors=colours, linewidths=self.line, zorder=1.2, label="_ghosts",
                                                  capstyle="round"), autolim=False)

    def show(self, moment: int) -> list[Any]:
        """Draw one position."""
        marks: dict[str, list[Mark]] = {kind: [] for kind in self._drawn}
        for shape in self._moments[moment]:
            marks.setdefault(shape.kind, []).extend(GLYPHS[shape.kind].draw(shape, self.size))
        for kind, those in marks.items():
            self._look(self._collection(kind), those)
        more = self._arrows.show(moment) if self._arrows else []
        names = self._names.show(self._moments[moment]) if self._names else []
        if not self._are_apart:     # at the first moment: in a film names keep their side
            keep_apart(self.ax, [*names, *(artist for artist in more if isinstance(artist, Text))])
            self._are_apart = True
        return [*self._drawn.values(), *more, *names]

    def _collection(self, kind: str) -> PathCollection:
        """Collection of matplotlib for all shapes of a kind."""
        if kind not in self._drawn:
            collection = PathCollection([], zorder=GLYPHS[kind].zorder, label=f"_{kind}", capstyle="round", joinstyle="round")
            self.ax.add_collection(collection, autolim=False)
            self._drawn[kind] = collection
        return self._drawn[kind]

    def _look(self, collection: PathCollection, marks: list[Mark]) -> None:
        """Set the paths and styles of a collection from marks."""
        collection.set_paths([each.path for each in marks])
        collection.set_facecolor([each.face for each in marks])
        collection.set_edgecolor([each.edge for each in marks])
        collection.set_linewidth([self.line * each.width for each in marks])
        collection.set_linestyle([each.dashes for each in marks])


def _beside_arrows(shapes: list[Shape], shown: set[str]) -> list[Shape]:
    """Shapes beside arrows that are drawn to a scale: loads among these arrows have no symbol, other loads a hollow one."""
    kept = [each for each in shapes if each.kind != "load" or each.name not in shown]
    return [each._replace(kind="load_symbol") if each.kind == "load" else each for each in kept]


def points_of(ax: Axes) -> np.ndarray:
    """Width and height of axes, (2,) in points."""
    box = ax.get_window_extent()
    return 72 / ax.figure.dpi * np.array([box.width, box.height])


def _extent(shape: Shape) -> np.ndarray:
    """Points (n, 2) that a shape covers."""
    places = shape.points[:len(shape.points) - GLYPHS[shape.kind].directions]
    reach = shape.number if shape.kind in ("wheel", "gear", "ring") else 0.0
    return np.vstack([places - reach, places + reach]) if reach else places


def _skeleton(shape: Shape) -> np.ndarray:
    """A bar's middle line, a plate's edge, a wheel's rim: points (n, 2)."""
    if shape.kind == "wheel":
        return arc(shape.points[0], shape.number, corners=SMOOTH)
    if shape.kind == "curve":
        return shape.points
    corners = hull(shape.points)
    return np.vstack([corners, corners[:1]]) if len(corners) > 2 else corners
