"""How the parts of mechanisms look: a function for each kind of shape, which draws one and returns what it drew.

`size` is the length of a pin's radius in m. Bodies are coloured, all else is black, white and grey.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from ..systems.shapes import Shape
from .style import COLOURS

BODY = COLOURS[0]
DARK, LIGHT = "black", "0.55"
COILS = 7           # of a spring
IN_LINE = 1e-3      # of a body: how far its points are from a line at most that is drawn as a bar
STROKES = 5         # of the hatching under a support


def _line(ax: Axes, points: Any, **style: Any) -> Any:
    look = {"color": DARK, "linewidth": 1.2, "solid_capstyle": "round"} | style
    (line,) = ax.plot(*np.asarray(points, dtype=float).T, **look)
    return line


def _patch(ax: Axes, patch: Any) -> Any:
    return ax.add_patch(patch)


def _across(axis: np.ndarray) -> np.ndarray:
    return np.array([-axis[1], axis[0]])


def _hatched(ax: Axes, start: np.ndarray, end: np.ndarray, size: float) -> list[Any]:
    """A line with hatching to the right of its direction."""
    along = (end - start) / max(np.hypot(*(end - start)), 1e-300)
    down, length = -_across(along), np.hypot(*(end - start))
    strokes = max(STROKES, int(length / (1.2 * size)))
    feet = start + np.linspace(0, 1, strokes + 1)[1:, None] * (end - start)
    points = [point for foot in feet for point in (foot, foot + size * (0.9 * down - 0.7 * along), (np.nan, np.nan))]
    return [_line(ax, [start, end], zorder=1.5), _line(ax, points, linewidth=0.8, zorder=1.4)]


def link(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """Points (n, 2) of a body: a bar where they are in line, else a plate."""
    if np.linalg.matrix_rank(shape.points - shape.points[0], tol=IN_LINE * np.ptp(shape.points)) < 2:
        return [_line(ax, shape.points, color=BODY, linewidth=3.5, zorder=2)]
    style = {"closed": True, "facecolor": BODY, "edgecolor": "none", "alpha": 0.25, "zorder": 1.9}
    edge = np.vstack([shape.points, shape.points[:1]])
    return [_patch(ax, Polygon(shape.points, **style)), _line(ax, edge, color=BODY, linewidth=2.5, zorder=2)]


def pin(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """The place (1, 2) of a hinge."""
    return [_patch(ax, Circle(shape.points[0], size, facecolor="white", edgecolor=DARK, linewidth=1.2, zorder=4))]


def ground(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A place (1, 2) of the ground that holds something: a hatched support."""
    tip = shape.points[0]
    left, right = tip + size * np.array([[-1.8, -3.0], [1.8, -3.0]])
    support = Polygon([tip, left, right], closed=True, facecolor="white", edgecolor=DARK, linewidth=1.2, zorder=1.6)
    wider = 0.9 * size * np.array([1.0, 0.0])
    return [_patch(ax, support), *_hatched(ax, left - wider, right + wider, size), *pin(ax, shape, 0.8 * size)]


def rail(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A line of the ground from one place past another along an axis: (place, place, axis)."""
    start, end, axis = shape.points
    low, high = sorted((0.0, float((end - start) @ axis)))
    return _hatched(ax, start + (low - 5 * size) * axis, start + (high + 5 * size) * axis, size)


def groove(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """The same of a moving body."""
    start, end, axis = shape.points
    low, high = sorted((0.0, float((end - start) @ axis)))
    return [_line(ax, [start + (low - 5 * size) * axis, start + (high + 5 * size) * axis], color=LIGHT, linewidth=5, zorder=1.5)]


def slider(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A block (place, axis)."""
    place, axis = shape.points
    along, across = 2.6 * size * axis, 1.6 * size * _across(axis)
    corners = [place + along + across, place - along + across, place - along - across, place + along - across]
    return [_patch(ax, Polygon(corners, closed=True, facecolor="0.85", edgecolor=DARK, linewidth=1.2, zorder=3))]


def rod(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A massless rod between two places."""
    ends = [each for place in shape.points for each in pin(ax, shape._replace(points=place[None]), 0.7 * size)]
    return [_line(ax, shape.points, linewidth=1.8, zorder=2), *ends]


def spring(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A zigzag between two places."""
    start, end = shape.points
    along = end - start
    across = 1.5 * size * _across(along / max(np.hypot(*along), 1e-300))
    steps = np.linspace(0.15, 0.85, 2 * COILS + 1)
    swings = np.array([0.0, *[(-1.0) ** i for i in range(2 * COILS - 1)], 0.0])
    points = [start, *(start + step * along + swing * across for step, swing in zip(steps, swings, strict=True)), end]
    return [_line(ax, points, zorder=2.5, solid_joinstyle="round")]


def cylinder(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A cylinder between two places: its barrel from the first, its piston rod from the second."""
    start, end = shape.points
    along, middle = end - start, start + 0.55 * (end - start)
    across = 1.2 * size * _across(along / max(np.hypot(*along), 1e-300))
    corners = [start + across, middle + across, middle - across, start - across]
    barrel = Polygon(corners, closed=True, facecolor="0.85", edgecolor=DARK, linewidth=1.2, zorder=2.6)
    ends = [each for place in shape.points for each in pin(ax, shape._replace(points=place[None]), 0.7 * size)]
    return [_patch(ax, barrel), _line(ax, [middle, end], linewidth=2.5, zorder=2.5), *ends]


def spiral(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A spring about a place, wound by an angle."""
    turns = np.linspace(0, 4.5 * np.pi, 120)
    radius = size * (1.2 + 2.2 * turns / turns[-1])
    angles = turns + shape.number * (1 - turns / turns[-1])
    return [_line(ax, shape.points[0] + np.column_stack([radius * np.cos(angles), radius * np.sin(angles)]), zorder=2.5)]


def bushing(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A soft joint at a place: rings."""
    return [_patch(ax, Circle(shape.points[0], radius * size, facecolor=colour, edgecolor=DARK, linewidth=1.0, zorder=3.5))
            for radius, colour in ((1.9, "0.75"), (1.0, "white"))]


def particle(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A mass in a place."""
    return [_patch(ax, Circle(shape.points[0], 1.5 * size, facecolor=BODY, edgecolor=DARK, linewidth=1.0, zorder=3.8))]


def _turning(ax: Axes, shape: Shape, radius: float, **style: Any) -> list[Any]:
    """A circle about a place, with a spoke in a direction."""
    centre, spoke = shape.points
    look = {"facecolor": "none", "edgecolor": BODY, "linewidth": 2.0, "zorder": 1.8} | style
    return [_patch(ax, Circle(centre, radius, **look)),
            _line(ax, [centre, centre + radius * spoke], color=BODY, linewidth=1.5, zorder=1.9)]


def disc(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A body of which one place is known, and a direction that turns with it."""
    return _turning(ax, shape, 3.0 * size, facecolor="white")


def wheel(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A wheel: its centre, a direction that turns with it; its radius."""
    dot = Circle(shape.points[0], 0.6 * size, facecolor=DARK, edgecolor="none", zorder=4)
    return [*_turning(ax, shape, shape.number), _patch(ax, dot)]


def gear(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """The pitch circle of a gear, as of a wheel."""
    return _turning(ax, shape, shape.number, linestyle=(0, (8, 3, 2, 3)), linewidth=1.2)


def blade(ax: Axes, shape: Shape, size: float) -> list[Any]:
    """A blade at a place along a direction."""
    place, axis = shape.points
    return [_line(ax, [place - 3 * size * axis, place + 3 * size * axis], linewidth=3, zorder=3)]


GLYPHS: dict[str, Callable[[Axes, Shape, float], list[Any]]] = {glyph.__name__: glyph for glyph in (
    link, pin, ground, rail, groove, slider, rod, spring, cylinder, spiral, bushing, particle, disc, wheel, gear, blade)}
