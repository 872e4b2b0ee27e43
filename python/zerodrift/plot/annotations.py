"""Annotations of pictures of mechanisms: names, forces to scale, paths of points."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.patheffects import withStroke
from matplotlib.text import Text

from ..systems.shapes import Shape
from .glyphs import BAR
from .marks import LOAD, WHITE, across, arrow, hull, unit

PATH = "#00664B"            # of paths of points
THINNEST = 0.8              # points: a path's line
LONGEST = 0.22              # of the picture: the longest arrow
SHORTEST = 0.02             # of the longest arrow; shorter ones are not drawn
KEY = 0.12                  # of the picture: the arrow that says the scale is at least a half of this
FONT = 1.9                  # of a pin's radius: the size of letters
SMALLEST, LARGEST = 5.0, 10.0       # of letters, in points
ASIDE = 0.42                # of a bar: where its name is, as in the middle there may be a pin
BESIDE_PIN = 1.7            # sizes from a pin's middle to its name
NAMED = {"pin": "pin", "mark": "pin", "particle": "pin", "blade": "pin", "weld": "pin", "bushing": "pin", "link": "bar",
         "rod": "bar", "spring": "bar", "damper": "bar", "cylinder": "bar", "disc": "below", "wheel": "below", "slider": "below",
         "motor": "left", "drive": "left", "load": "tip",
         "load_symbol": "tip", "moment": "left"}


class Arrow(NamedTuple):
    """A force: its name, its points of application (k, d) in m and its vectors (k, d) in N; d is 2 or 3."""

    name: str
    places: np.ndarray
    vectors: np.ndarray


def halo(width: float) -> list[Any]:
    """Path effect: white outline around text and lines."""
    return [withStroke(linewidth=width, foreground=WHITE)]


def hold(ax: Axes, *places: Any) -> None:
    """Extend the limits of axes to points (2,), without a margin; later drawing may extend them further."""
    ax.margins(0)
    ax.update_datalim(places)
    ax.autoscale_view()


def draw_path(ax: Axes, places: np.ndarray, width: float, **style: Any) -> Any:
    """Path (n, 2) or (n, 3) of a point, dashed, so that it is recognised without colour."""
    look: dict[str, Any] = {"color": PATH, "linewidth": max(1.4 * width, THINNEST), "linestyle": (0, (5, 1.6)), "zorder": 3.2,
                            "label": "_path"} | style
    return ax.plot(*np.asarray(places).T, **look)[0]


# ---- names ----


class Names:
    """Names of the shapes, each once, beside their shapes; they stay on the same side as the mechanism moves."""

    def __init__(self, ax: Axes, shapes: Sequence[Shape], size: float, points: float, known: Iterable[str]) -> None:
        """`points` are in a pin's radius; names that are known are written elsewhere."""
        self.size = size
        self._texts: dict[tuple[str, str], tuple[Text, np.ndarray]] = {}
        named = set(known)
        font = float(np.clip(FONT * points, SMALLEST, LARGEST))
        at: dict[tuple[float, ...], Text] = {}
        for shape in shapes:
            if shape.kind in NAMED and shape.name and shape.name not in named:
                named.add(shape.name)
                place = tuple(np.round(shape.points[0] / (0.1 * size)))
                if NAMED[shape.kind] == "pin" and place in at:      # hinges of several bodies at one place
                    at[place].set_text(f"{at[place].get_text()}\n{shape.name}")
                    continue
                offset = self._offset(shape, shapes)
                text = ax.text(0, 0, shape.name, fontsize=font, zorder=6, path_effects=halo(0.25 * font), label="_name",
                               ha=_aligned(offset[0], "left", "right"), va=_aligned(offset[1], "bottom", "top"),
                               clip_on=False)
                self._texts[shape.kind, shape.name] = text, offset
                if NAMED[shape.kind] == "pin":
                    at[place] = text

    def show(self, shapes: Sequence[Shape]) -> list[Text]:
        """Move the names to the shapes of another time; return their texts."""
        for shape in shapes:
            if (shape.kind, shape.name) in self._texts:
                text, offset = self._texts[shape.kind, shape.name]
                x, y = _anchor(shape, self.size) + self.size * offset
                text.set_position((x, y))
        return [text for text, _ in self._texts.values()]

    def _offset(self, shape: Shape, shapes: Sequence[Shape]) -> np.ndarray:
        """Offset (2,) of a name from its anchor, in units of the pin radius."""
        how = NAMED[shape.kind]
        if how == "bar":
            corners = hull(shape.points)
            if shape.kind == "link" and len(corners) > 2:
                return np.zeros(2)
            side = across(unit(corners[-1] - corners[0]))
            middle = np.mean([each.points[0] for each in shapes], axis=0)
            away = 1.0 if (corners.mean(axis=0) - middle) @ side >= 0 else -1.0
            return (BAR + 0.5 + (1.5 if shape.number else 0.0)) * away * side
        if how == "pin":
            has_motor, slides = (_is_at(shape.points[0], kind, shapes) for kind in ("motor", "slider"))
            return (4.6 if has_motor else 2.6 if slides else BESIDE_PIN) * self._free_direction(shape.points[0], shapes)
        return {"below": np.array([0.0, -4.4]), "left": np.array([-3.6, 1.8]), "tip": np.array([0.0, 1.0])}[how]

    def _free_direction(self, place: np.ndarray, shapes: Sequence[Shape]) -> np.ndarray:
        """The direction (2,), of eight, that is furthest from all bars that meet at a point."""
        taken = [np.array([0.0, -1.0])] if any(_is_at(place, kind, shapes) for kind in ("ground", "slider")) else []
        for shape in shapes:
            if shape.kind in ("link", "rod", "spring", "cylinder", "damper"):
                apart = shape.points - place
                if (np.hypot(*apart.T) < 0.5 * self.size).any():
                    taken += [unit(each) for each in apart if np.hypot(*each) > self.size]
        angles = np.pi / 4 * np.array([1, 3, 7, 5, 0, 4, 2, 6])
        directions = np.column_stack([np.cos(angles), np.sin(angles)])
        if not taken:
            return directions[0]
        nearest = np.max(directions @ np.array(taken).T, axis=1).round(2)
        return directions[int(np.argmin(nearest))]


def _is_at(place: np.ndarray, kind: str, shapes: Sequence[Shape]) -> bool:
    return any(shape.kind == kind and np.allclose(shape.points[0], place) for shape in shapes)


def _anchor(shape: Shape, size: float) -> np.ndarray:
    """Point (2,) in m beside which the name of a shape is written."""
    if NAMED[shape.kind] == "bar":
        corners = hull(shape.points)
        return corners.mean(axis=0) if len(corners) > 2 else corners[0] + ASIDE * (corners[1] - corners[0])
    if shape.kind in ("load", "load_symbol"):
        return shape.points[0] + 9 * size * shape.points[1]
    return shape.points[0]


def _aligned(offset: float, positive: str, negative: str) -> str:
    return "center" if abs(offset) < 0.7 else positive if offset > 0 else negative


# ---- forces ----


class Arrows:
    """Forces as arrows at their points of application, with names, to a common scale, shown by an arrow in the corner."""

    def __init__(self, ax: Axes, arrows: Sequence[Arrow], extent: float, size: float, line: float, points: float,
                 scale: float | None = None) -> None:
        """`scale` in N/m, by default from the longest arrow; `points` is the pin radius in points of the screen."""
        self._arrows, self.size, self.font = arrows, size, float(np.clip(FONT * points, SMALLEST, LARGEST))
        self.largest = max((float(np.hypot(*each.vectors.T).max()) for each in arrows), default=0.0)
        self.scale = scale or self.largest / (LONGEST * extent) or 1.0
        self.said = round_number(self.scale * KEY * extent)
        self._drawn = PathCollection([], facecolor=LOAD, edgecolor=WHITE, linewidth=0.6 * line, zorder=4.0, label="_forces")
        ax.add_collection(self._drawn, autolim=False)
        self._texts = [ax.text(0, 0, each.name, fontsize=self.font, color=LOAD, zorder=6, ha="center", va="center",
                               path_effects=halo(0.25 * self.font), label="_force") for each in arrows]

    def ends(self) -> np.ndarray:
        """Ends of all arrows at all times, including their names, (n, 2) in m."""
        tips = [each.places + each.vectors / self.scale for each in self._arrows]
        beyond = [2.5 * self.size * each.vectors / (np.hypot(*each.vectors.T)[:, None] + 1e-300) for each in self._arrows]
        return np.vstack([np.zeros((0, 2)), *(tip + more for tip, more in zip(tips, beyond, strict=True))])

    def show(self, moment: int) -> list[Any]:
        """Draw the arrows of one time, except those that are too short to be seen; return the artists."""
        paths = []
        for each, text in zip(self._arrows, self._texts, strict=True):
            place, vector = each.places[moment], each.vectors[moment]
            is_seen = bool(np.hypot(*vector) > SHORTEST * self.largest)
            text.set_visible(is_seen)
            if is_seen:
                tip = place + vector / self.scale
                paths.append(arrow(place, tip, self.size).path)
                text.set_position(tip + 1.8 * self.size * unit(vector))
        self._drawn.set_paths(paths)
        return [self._drawn, *self._texts]

    def say_scale(self, ax: Axes) -> None:
        """Draw the scale in the lower left corner, an arrow for a round number of newtons, unless all forces are zero."""
        if not self.largest:
            return
        low, bottom = ax.get_xlim()[0], ax.get_ylim()[0]
        hold(ax, (low, bottom - 5 * self.size))
        tail = np.array([low + 2.5 * self.size, bottom - 2 * self.size])
        tip = tail + np.array([self.said / self.scale, 0.0])
        ax.add_collection(PathCollection([arrow(tail, tip, self.size).path], facecolor=LOAD, edgecolor="none", zorder=4.0,
                                         label="_scale"), autolim=False)
        ax.text(tip[0] + self.size, tip[1], with_prefix(self.said), fontsize=self.font, va="center", zorder=6, label="_scale")


def round_number(value: float) -> float:
    """Largest number 1, 2 or 5 times a power of ten that does not exceed a value."""
    if not value > 0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(each for each in (1, 2, 5) if each * power <= value * (1 + 1e-9)) * power)


def with_prefix(newtons: float) -> str:
    """A force as text with an SI prefix."""
    for factor, unit_name in ((1e6, "MN"), (1e3, "kN"), (1.0, "N"), (1e-3, "mN")):
        if newtons >= factor * (1 - 1e-9):
            return f"{newtons / factor:g} {unit_name}"
    return f"{newtons:g} N"
