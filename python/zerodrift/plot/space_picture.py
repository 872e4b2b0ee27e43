"""Pictures of mechanisms in space from the shapes of their parts, in axes of matplotlib that show space; `drawing` asks for them.

Collections are moved by films instead of drawn anew. Each face and each part of a bar is a collection of its own, as matplotlib
orders these by depth; of many, all of a kind are one. Bodies are grey, their joints dark.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib import patheffects
from matplotlib.colors import to_rgba
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from ..systems.shapes import Shape
from .mechanism import NOTHING, Extras
from .names_apart import ABOVE, keep_apart
from .points import with_equal_scales
from .space_arrows import SpaceArrows
from .style import COLOURS

SIZE = 0.04         # of the picture: half the length of a pin
COILS = 6           # of a spring
LIGHT = np.array([-0.35, -0.5, 0.8]) / np.linalg.norm([-0.35, -0.5, 0.8])      # direction to the light
DARKEST, BRIGHTEST = 0.72, 1.08     # shares of a face's colour: edge-on to the light, and towards it
FACES = np.array([(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)])     # of a box's corners
MAX_NAMES = 40     # more would hide the picture
TICKS = 4           # of each axis, at most
BEFORE = 0.02       # of the depth of the picture: by which pins stand before bars
MAX_PIECES = 240   # of a picture that are ordered by depth individually
PART = 3.0          # longest part of a bar, in sizes
ROUND = [patheffects.Stroke(linewidth=5.4, foreground="#40505F"), patheffects.Stroke(linewidth=4.0, foreground="#8C9CAD"),
         patheffects.Stroke(linewidth=1.2, foreground="#DCE3EA", offset=(0, 0.8))]     # a rod that is lit from above


def _as_it_is(points: np.ndarray, size: float) -> list[np.ndarray]:
    return [points]


def _bar(points: np.ndarray, size: float) -> list[np.ndarray]:
    """Bar: a line in parts, each sorted by its own depth."""
    count = max(1, int(np.ceil(np.linalg.norm(points[1] - points[0]) / (PART * size))))
    ends = points[0] + np.linspace(0, 1, count + 1)[:, None] * (points[1] - points[0])
    return list(np.stack([ends[:-1], ends[1:]], axis=1))


def _pin(points: np.ndarray, size: float) -> list[np.ndarray]:
    """Pin: a short line along an axis, given by a point and a direction."""
    return [points[0] + size * np.outer((-1, 1), points[1])]


def _sleeve(points: np.ndarray, size: float) -> list[np.ndarray]:
    return _pin(points, 1.5 * size)


def _patch(points: np.ndarray, size: float) -> list[np.ndarray]:
    """Patch: a square in a plane, given by a point and two directions."""
    corners = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) @ points[1:]
    return [points[0] + 2 * size * corners]


def _box(points: np.ndarray, size: float) -> list[np.ndarray]:
    return list(points[FACES])


def _shaded(colour: str, faces: Sequence[np.ndarray], light: np.ndarray = LIGHT) -> np.ndarray:
    """Colours (k, 4) of flat faces, by the angle of their normals to the light."""
    normals = np.array([np.cross(face[1] - face[0], face[2] - face[0]) for face in faces])
    lengths = np.linalg.norm(normals, axis=1)
    towards = np.abs(normals @ light) / np.where(lengths > 0, lengths, 1.0)
    colours = np.tile(to_rgba(colour), (len(faces), 1))
    colours[:, :3] = np.minimum(colours[:, :3] * (DARKEST + (BRIGHTEST - DARKEST) * towards)[:, None], 1.0)
    return colours


def _spring(points: np.ndarray, size: float) -> list[np.ndarray]:
    """Spring: a coil between two ends."""
    start, end = points
    length = np.linalg.norm(end - start) or 1.0
    along = (end - start) / length
    side = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    side /= np.linalg.norm(side)
    s = np.linspace(0, 1, 16 * COILS)
    radius = 0.6 * size * ((s > 0.1) & (s < 0.9))
    turns = 2 * np.pi * COILS * s
    around = np.outer(radius * np.cos(turns), side) + np.outer(radius * np.sin(turns), np.cross(along, side))
    return [start + np.outer(s, end - start) + around]


class InFront(Line3DCollection):
    """Lines that stand before bars and faces at their place."""

    def do_3d_projection(self) -> Any:
        """Depth by which artists are ordered."""
        return super().do_3d_projection() - BEFORE


class Glyph(NamedTuple):
    """Symbol of a kind of shape: function that makes its lines or faces, and their styles for matplotlib."""

    draw: Callable[[np.ndarray, float], list[np.ndarray]]
    looks: dict[str, Any]
    is_face: bool = False


GLYPHS = {
    "bar": Glyph(_bar, {"colors": "#7A8CA0", "linewidths": 4.0, "path_effects": ROUND}),
    "plate": Glyph(_as_it_is, {"facecolors": "#C9D3DE", "edgecolors": "#40505F", "linewidths": 1.5}, True),
    "box": Glyph(_box, {"facecolors": "#C9D3DE90", "edgecolors": "#40505F", "linewidths": 0.8}, True),
    "disc": Glyph(_as_it_is, {"facecolors": "#C9D3DEE0", "edgecolors": "#40505F", "linewidths": 1.8}, True),
    "ring": Glyph(_as_it_is, {"colors": "#40505F", "linewidths": 1.2}),
    "patch": Glyph(_patch, {"facecolors": "#E69F0030", "edgecolors": "#E69F00", "linewidths": 0.8}, True),
    "rod": Glyph(_as_it_is, {"colors": "#40505F", "linewidths": 1.2}),
    "track": Glyph(_as_it_is, {"colors": "#40505F", "linewidths": 0.8, "linestyles": ":"}),
    "spring": Glyph(_spring, {"colors": COLOURS[2], "linewidths": 1.2}),
    "pin": Glyph(_pin, {"colors": COLOURS[1], "linewidths": 2.5}),
    "sleeve": Glyph(_sleeve, {"colors": COLOURS[0], "linewidths": 5.0}),
}
DOTS = {"dot": {"marker": "o", "color": "#40505F", "markersize": 7}, "weld": {"marker": "s", "color": "black", "markersize": 4},
        "ball": {"marker": "o", "color": COLOURS[1], "markersize": 4.5},
        "bushing": {"marker": "o", "color": COLOURS[1], "markersize": 7, "markerfacecolor": "none", "markeredgewidth": 2},
        "ground": {"marker": "^", "color": "black", "markersize": 6}}
FAINT = ("bar", "rod", "disc", "ring")      # what other positions show
FAINTLY = 0.36      # and how opaque they are


class SpacePicture:
    """Picture of shapes in 3D axes with limits that contain all positions; `show` draws one position."""

    def __init__(self, ax: Axes3D, moments: Sequence[list[Shape]], extras: Extras = NOTHING, *,
                 upside_down: bool = False) -> None:
        """`upside_down`: z points down."""
        self.ax, self._moments, paths = ax, moments, extras.paths
        self._drawn: dict[str, list[Any]] = {}
        self._light = LIGHT * ((1, -1, -1) if upside_down else (1, 1, 1))
        places = np.vstack([*(_extent(shape) for shapes in moments for shape in shapes), *paths])
        extent = float(np.ptp(places, axis=0).max()) or 1.0
        self.size = SIZE * extent
        self._arrows = SpaceArrows(ax, extras.arrows, extent, self.size, extras.force_scale) if extras.arrows else None
        if self._arrows:
            places = np.vstack([places, self._arrows.ends()])
        low, high = places.min(axis=0), places.max(axis=0)
        middle, half = (low + high) / 2, np.maximum((high - low) / 2, 4 * self.size) + self.size
        for axis, a, b in zip("xyz", middle - half, middle + half, strict=True):
            getattr(ax, f"set_{axis}lim")(a, b)
            getattr(ax, f"{axis}axis").set_major_locator(MaxNLocator(TICKS))
            getattr(ax, f"{axis}axis").set_pane_color((1, 1, 1, 0))
            getattr(ax, f"{axis}axis").line.set_color("#7A8CA0")
        with_equal_scales(ax)
        if upside_down:         # and y turns with it, as the axes are right-handed
            ax.invert_yaxis()
            ax.invert_zaxis()
        for i, path in enumerate(paths):
            ax.plot(*path.T, color=COLOURS[(i + 3) % len(COLOURS)], linewidth=1.2)
        named = dict.fromkeys(shape.name for shape in moments[0] if shape.name) if extras.names else {}
        self._texts = {name: ax.text(0, 0, 0, name, fontsize="small", zorder=ABOVE) for name in named if len(named) <= MAX_NAMES}

    def faintly(self, moments: Sequence[int]) -> None:
        """Draw other positions as thin lines, permanently."""
        lines = [shape.points for i in moments for shape in self._moments[i] if shape.kind in FAINT]
        if lines:
            ghosts = Line3DCollection(lines, colors="#7A8CA0", alpha=FAINTLY, linewidths=1.0, label="_ghosts")
            self.ax.add_collection3d(ghosts)

    def show(self, moment: int) -> list[Any]:
        """Draw one position."""
        of_kind: dict[str, list[np.ndarray]] = {kind: [] for kind in self._drawn}
        for shape in self._moments[moment]:
            drawn = [shape.points] if shape.kind in DOTS else GLYPHS[shape.kind].draw(shape.points, self.size)
            of_kind.setdefault(shape.kind, []).extend(drawn)
        is_many = sum(map(len, of_kind.values())) > MAX_PIECES
        for kind, pieces in of_kind.items():
            groups = [pieces] if is_many or kind in DOTS else [[piece] for piece in pieces]
            for artist, those in itertools.zip_longest(self._artists(kind, len(groups)), groups, fillvalue=()):
                self._move(kind, artist, those)
        for shape in self._moments[moment]:
            if text := self._texts.get(shape.name):
                text.set_position_3d(_anchor(shape) + 0.5 * self.size)
        arrows = self._arrows.show(moment) if self._arrows else []
        keep_apart(self.ax, [*self._texts.values(), *(artist for artist in arrows if isinstance(artist, Text))])
        return [*itertools.chain(*self._drawn.values()), *self._texts.values(), *arrows]

    def _move(self, kind: str, artist: Any, those: Sequence[np.ndarray]) -> None:
        """Give an artist the lines or faces of one moment; without any it is hidden."""
        artist.set_visible(bool(those))
        if not those:
            return
        if kind in DOTS:
            artist.set_data_3d(*np.vstack(those).T)
        elif GLYPHS[kind].is_face:
            artist.set_verts(those)
            artist.set_facecolor(_shaded(GLYPHS[kind].looks["facecolors"], those, self._light))
        else:
            artist.set_segments(those)

    def _artists(self, kind: str, count: int) -> list[Any]:
        """Artists of matplotlib for shapes of a kind, at least so many."""
        found = self._drawn.setdefault(kind, [])
        while len(found) < count:
            if kind in DOTS:
                found += self.ax.plot([], [], [], linestyle="", label=f"_{kind}", **DOTS[kind])
            else:
                glyph = GLYPHS[kind]
                collection = Poly3DCollection if glyph.is_face else InFront if kind in ("pin", "sleeve") else Line3DCollection
                found.append(self.ax.add_collection3d(collection([np.zeros((4, 3))], label=f"_{kind}", **glyph.looks)))
        return found


def _extent(shape: Shape) -> np.ndarray:
    """Points (n, 3) that determine the extent of a shape."""
    return shape.points[:1] if shape.kind in ("pin", "sleeve", "patch") else shape.points


def _anchor(shape: Shape) -> np.ndarray:
    """Point (3,) in m at which the name of a shape is written."""
    return shape.points[0] if shape.kind in ("pin", "sleeve", "patch") else shape.points.mean(axis=0)
