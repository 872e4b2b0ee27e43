"""Outline of a mechanism: lines between the points of each body."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..elements.bodies import Body, Link, Particle, Point
from ..elements.drawing import Drawing, Inertias
from ..elements.frames import turned
from ..elements.numbers import Numbers

APART = 1e-9        # of the drawing's size: smaller distances count as zero


def outline(drawing: Drawing, numbers: Numbers, poses: np.ndarray) -> np.ndarray:
    """Points (n, 2) in m to be joined by lines, NaN between bodies, with the mass centres at poses (bodies, 3)."""
    inertias, lines, held = Inertias(drawing, numbers), list[Any](), attached(drawing, numbers)
    for body, pose in zip(drawing.parts(), poses, strict=True):
        lines += [*_line(body, pose, around(held[body.name], numbers), numbers, inertias), (np.nan, np.nan)]
    for point in held["ground"]:
        lines += [point.local_with(numbers), np.array([np.nan, np.nan])]
    return np.array(lines[:-1] if lines and np.isnan(lines[-1][0]) else lines, dtype=float).reshape(-1, 2)


def attached(drawing: Drawing, numbers: Numbers) -> dict[str, list[Point]]:
    """Points of each body at joints, springs and bushings, and its named points, each position once."""
    found: dict[str, list[Point]] = {body.name: [] for body in drawing.of(Body)}
    for link in drawing.of(Link):
        found[link.name] += [link.start, link.end]
    for point in [*drawing.joined_points(), *drawing.of(Point)]:
        found[point.body.name].append(point)
    return {name: _different(points, numbers) for name, points in found.items()}


def _different(points: list[Point], numbers: Numbers) -> list[Point]:
    """Points at different positions."""
    different: list[Point] = []
    places: list[np.ndarray] = []
    for point in points:
        place = point.local_with(numbers)
        if all(np.hypot(*(place - other)) > APART for other in places):
            different.append(point)
            places.append(place)
    return different


def around(points: list[Point], numbers: Numbers) -> list[Point]:
    """Points sorted by angle around their centroid, if there are more than two."""
    if len(points) < 3:
        return points
    middle = np.mean([point.local_with(numbers) for point in points], axis=0)
    return sorted(points, key=lambda point: np.arctan2(*(point.local_with(numbers) - middle)[::-1]))


def _line(body: Body, pose: np.ndarray, points: list[Point], numbers: Numbers, inertias: Inertias) -> list[np.ndarray]:
    """Points of one body, sorted around it if there are more than two."""
    if isinstance(body, Particle):
        return [pose[:2]]
    places = [np.array(inertias.local(point, numbers)) for point in points]
    if not places:
        places = [np.zeros(2)]
    if len(places) == 1 and np.hypot(*places[0]) > APART:
        places.append(np.zeros(2))      # the mass centre shows the body's angle
    if len(places) > 2:
        places.append(places[0])
    return [pose[:2] + turned(pose[2], place) for place in places]
