"""Outline of a mechanism in space: lines between the points of each body."""

from __future__ import annotations

import numpy as np

from ..._private.rotations import rotation_of
from ..elements.bodies import Body, Link, Particle, Point
from ..elements.drawing import Drawing
from ..elements.numbers import Numbers
from ..elements.space_bodies import SpaceInertias

APART = 1e-9        # m: smaller distances count as zero


def space_outline(drawing: Drawing, numbers: Numbers, poses: np.ndarray) -> np.ndarray:
    """Points (n, 3) in m to be joined by lines, NaN between bodies, with the mass centres at poses (bodies, 7)."""
    inertias, gap, lines = SpaceInertias(drawing, numbers), np.full((1, 3), np.nan), []
    held: dict[str, list[Point]] = {body.name: [] for body in drawing.of(Body)}
    for link in drawing.of(Link):
        held[link.name] += [link.start, link.end]
    for point in [*drawing.joined_points(), *drawing.of(Point)]:
        held[point.body.name].append(point)
    for body, pose in zip(drawing.parts(), poses, strict=True):
        places = different([inertias.local(point, numbers) for point in held[body.name]])
        if isinstance(body, Particle) or not places or (len(places) == 1 and np.linalg.norm(places[0]) > APART):
            places.append(np.zeros(3))      # the mass centre shows the body's orientation
        if len(places) > 2:
            places.append(places[0])
        lines += [pose[:3] + np.array(places) @ rotation_of(pose[3:]).T, gap]
    for point in held["ground"]:
        lines += [point.local_with(numbers)[None], gap]
    return np.vstack(lines[:-1]) if lines else np.zeros((0, 3))


def different(places: list[np.ndarray]) -> list[np.ndarray]:
    """Places without those that are already there."""
    found: list[np.ndarray] = []
    for place in places:
        if all(np.linalg.norm(place - other) > APART for other in found):
            found.append(place)
    return found
