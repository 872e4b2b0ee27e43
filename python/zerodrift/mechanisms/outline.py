"""The plain drawing of a mechanism: lines between the points of each body."""

from __future__ import annotations

import numpy as np

from .bodies import Body, Link, Particle, Point
from .drawing import Drawing, Inertias
from .numbers import Numbers
from .plane import turned

APART = 1e-9        # of the drawing: points that are nearer are one


def outline(drawing: Drawing, numbers: Numbers, poses: np.ndarray) -> np.ndarray:
    """Points (n, 2) in m to be joined by lines, NaN between bodies, with the mass centres at poses (bodies, 3)."""
    inertias, lines = Inertias(drawing, numbers), []
    for body, pose in zip(drawing.parts(), poses, strict=True):
        lines += [*_line(body, pose, drawing, numbers, inertias), (np.nan, np.nan)]
    lines += _ground(drawing, numbers)
    return np.array(lines[:-1] if lines and np.isnan(lines[-1][0]) else lines, dtype=float).reshape(-1, 2)


def _attached(body: Body, drawing: Drawing, numbers: Numbers) -> list[Point]:
    """The points at which joints and springs hold a body, each place once."""
    points = [body.start, body.end] if isinstance(body, Link) else []
    points += [point for point in drawing.joined_points() if point.body is body]
    points += [point for point in drawing.of(Point) if point.body is body]
    different: list[Point] = []
    for point in points:
        place = point.local_with(numbers)
        if all(np.hypot(*(place - other.local_with(numbers))) > APART for other in different):
            different.append(point)
    return different


def around(body: Body, drawing: Drawing, numbers: Numbers) -> list[Point]:
    """The same, in the order in which they stand around their middle where there are more than two."""
    points = _attached(body, drawing, numbers)
    if len(points) > 2:
        middle = np.mean([point.local_with(numbers) for point in points], axis=0)
        points.sort(key=lambda point: np.arctan2(*(point.local_with(numbers) - middle)[::-1]))
    return points


def _line(body: Body, pose: np.ndarray, drawing: Drawing, numbers: Numbers, inertias: Inertias) -> list[np.ndarray]:
    """The points of one body, around it where there are more than two."""
    if isinstance(body, Particle):
        return [pose[:2]]
    places = [np.array(inertias.local(point, numbers)) for point in around(body, drawing, numbers)]
    if not places:
        places = [np.zeros(2)]
    if len(places) == 1 and np.hypot(*places[0]) > APART:
        places.append(np.zeros(2))      # the mass centre shows which way it hangs
    if len(places) > 2:
        places.append(places[0])
    return [pose[:2] + turned(pose[2], place) for place in places]


def _ground(drawing: Drawing, numbers: Numbers) -> list[np.ndarray]:
    """The points of the ground, each by itself."""
    points = []
    for point in _attached(drawing.ground, drawing, numbers):
        points += [point.local_with(numbers), np.array([np.nan, np.nan])]
    return points
