"""Lines and areas of which glyphs consist, as data that is drawn elsewhere."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np
from matplotlib.path import Path

ROUND, SMOOTH = 32, 128     # corners of a small circle, and of a large one
DARK, GREY, WHITE = "#000000", "#8C8C8C", "#FFFFFF"
BODY, EDGE = "#A6CEE4", "#00476F"           # of bodies: a light blue, and a dark one around it
PLATE = BODY + "C0"                         # of plates, through which others are seen
TINT = "#D3E7F2"                            # of wheels, gears and cams, which others are seen in front of
LOAD = "#C44E00"                            # of forces and moments
IN_LINE = 1e-6              # of a body's size: how far its points are from a line at most that are drawn as a bar
DASHED, CHAIN = (0, (4, 2.5)), (0, (9, 2.5, 2, 2.5))        # a chain line, by ISO 128, is that of pitch circles


class Mark(NamedTuple):
    """A line or an area.

    Attributes
    ----------
    path : Path
        In m.
    face, edge : str
        Colours; "none" where there is none.
    width : float
        Width of the edge, in widths of the picture's lines.
    dashes : str or tuple
        As matplotlib's line styles.
    """

    path: Path
    face: str = "none"
    edge: str = DARK
    width: float = 1.2
    dashes: Any = "solid"


def line(points: Any, **look: Any) -> Mark:
    """Line through points (n, 2)."""
    return Mark(Path(np.asarray(points, dtype=float)), **look)


def lines(starts: np.ndarray, ends: np.ndarray, **look: Any) -> Mark:
    """Separate lines from starts (n, 2) to ends (n, 2)."""
    return Mark(Path(np.hstack([starts, ends]).reshape(-1, 2), np.tile([Path.MOVETO, Path.LINETO], len(starts))), **look)


def area(corners: Any, **look: Any) -> Mark:
    """Area with corners (n, 2)."""
    corners = np.asarray(corners, dtype=float)
    return Mark(Path(np.concatenate([corners, corners[:1]]), _closed(len(corners))), **{"face": WHITE, **look})


@functools.lru_cache(maxsize=256)
def _closed(corners: int) -> np.ndarray:
    """Path codes of matplotlib for a closed outline with this number of corners."""
    codes = np.full(corners + 1, Path.LINETO, dtype=Path.code_type)
    codes[0], codes[-1] = Path.MOVETO, Path.CLOSEPOLY
    codes.flags.writeable = False
    return codes


def between(outer: np.ndarray, inner: np.ndarray, **look: Any) -> Mark:
    """Area between an outer outline (n, 2) and an inner one."""
    both = [area(outer), area(inner[::-1])]
    vertices, codes = np.vstack([each.path.vertices for each in both]), np.concatenate([each.path.codes for each in both])
    return Mark(Path(vertices, codes), **look)


def arc(centre: np.ndarray, radius: float, start: float = 0.0, angle: float = 2 * np.pi, corners: int = ROUND) -> np.ndarray:
    """Points of a circle, (n, 2), from one angle on; all around where no angle is given."""
    return centre + radius * _unit_arc(float(start), float(angle), corners)


@functools.lru_cache(maxsize=256)       # most are all around, or half around
def _unit_arc(start: float, angle: float, corners: int) -> np.ndarray:
    """Points of the unit circle, likewise."""
    count = max(3, int(np.ceil(corners * abs(angle) / (2 * np.pi)))) + 1
    angles = start + np.linspace(0, angle, count)
    points = np.column_stack([np.cos(angles), np.sin(angles)])
    points.flags.writeable = False      # as others are handed them, too
    return points


def circle(centre: np.ndarray, radius: float, corners: int = ROUND, **look: Any) -> Mark:
    """Circle about a point (2,)."""
    return area(arc(centre, radius, corners=corners)[:-1], **look)


def rim(centre: np.ndarray, inner: float, outer: float, **look: Any) -> Mark:
    """Ring between two circles about a point."""
    return between(*(arc(centre, radius, corners=SMOOTH)[:-1] for radius in (outer, inner)), **look)


def across(axis: np.ndarray) -> np.ndarray:
    """A direction (2,), turned by a right angle counter-clockwise."""
    return np.array([-axis[1], axis[0]])


def unit(vector: np.ndarray) -> np.ndarray:
    """Unit vector (2,) of a vector; that of x for a zero vector."""
    length = np.hypot(*vector)
    return vector / length if length > 0 else np.array([1.0, 0.0])


def box(place: np.ndarray, along: np.ndarray, half_length: float, half_width: float, **look: Any) -> Mark:
    """A rectangle about a place, along a direction."""
    x, y = half_length * along, half_width * across(along)
    return area([place + x + y, place - x + y, place - x - y, place + x - y], **look)


def hull(points: np.ndarray) -> np.ndarray:
    """The corners of the convex hull of points (n, 2), counter-clockwise (Andrew's monotone chain); two where all are in line."""
    size = float(np.ptp(points, axis=0).max()) or 1.0
    # Places that differ by less are one, so that two of them one above the other are in this order.
    keys = map(tuple, np.round(points / (IN_LINE * size)).tolist())
    apart = dict(zip(keys, points.tolist(), strict=True))
    ordered = [(x, y) for _, (x, y) in sorted(apart.items())]
    if len(ordered) < 3:
        return np.array(ordered)
    least = IN_LINE * size**2

    def half(places: list[tuple[float, float]]) -> list[tuple[float, float]]:
        corners: list[tuple[float, float]] = []
        for place in places:
            while len(corners) > 1 and _turn(corners[-2], corners[-1], place) <= least:
                corners.pop()
            corners.append(place)
        return corners[:-1]

    return np.array(half(ordered) + half(ordered[::-1]))


def _turn(first: tuple[float, float], second: tuple[float, float], third: tuple[float, float]) -> float:
    return (second[0] - first[0]) * (third[1] - first[1]) - (second[1] - first[1]) * (third[0] - first[0])


def rounded(points: np.ndarray, radius: float) -> np.ndarray:
    """The outline (n, 2) of all that is within a radius of the convex hull of points: a bar of two, a plate of three."""
    corners = hull(points)
    if len(corners) == 1:
        return arc(corners[0], radius)[:-1]
    if len(corners) == 2:       # as most are
        along = unit(corners[1] - corners[0])
        end = radius * _unit_arc(-np.pi / 2, np.pi, ROUND) @ np.array([along, across(along)])
        return np.concatenate([corners[0] - end, corners[1] + end])
    sides = np.roll(corners, -1, axis=0) - corners
    outward = np.arctan2(-sides[:, 0], sides[:, 1])
    turns = np.mod(outward - np.roll(outward, 1), 2 * np.pi)
    return np.vstack([arc(corner, radius, end - turn, turn) for corner, end, turn in zip(corners, outward, turns, strict=True)])


def arrow(tail: np.ndarray, tip: np.ndarray, size: float, **look: Any) -> Mark:
    """An arrow with a shaft, which is all head where it is short."""
    along, length = unit(tip - tail), float(np.hypot(*(tip - tail)))
    head = min(2.6 * size, length)
    side, neck = across(along), tip - head * along
    wide, narrow = 0.45 * head * side, 0.13 * head * side
    return area([tail - narrow, neck - narrow, neck - wide, tip, neck + wide, neck + narrow, tail + narrow], **look)


def turning_arrow(centre: np.ndarray, radius: float, start: float, angle: float, size: float, colour: str) -> list[Mark]:
    """An arc with a head at its end."""
    points = arc(centre, radius, start, angle)
    head = min(2.4 * size, radius)
    tip = points[-1]
    back = centre + radius * np.array([np.cos(end := start + angle - np.sign(angle) * head / radius), np.sin(end)])
    along = unit(tip - back)
    wide = 0.45 * head * across(along)
    shaft = points[:max(2, int(len(points) * (1 - 0.7 * head / (radius * abs(angle)))))]
    return [line(shaft, edge=colour, width=1.6),
            area([back - wide, back + head * along, back + wide], face=colour, edge=colour, width=0.5)]


def hatched(start: np.ndarray, end: np.ndarray, size: float, *, aligned: bool = False) -> list[Mark]:
    """The surface of the ground from one place to another, with hatching to the right of that direction; where it is aligned,
    strokes of surfaces that lie on each other do, too.
    """
    length, along, step = np.hypot(*(end - start)), unit(end - start), 1.3 * size
    first = float(-(start @ along) % step if aligned else (length % step + step) / 2)
    feet = start + np.arange(first, length, step)[:, None] * along
    return [line([start, end], width=1.4), lines(feet, feet - step * (0.75 * across(along) + 0.65 * along), width=0.8)]
