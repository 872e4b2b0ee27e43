"""Points of a drawing in the axes of the bodies that carry them, so that a page draws it from poses.

Bodies are placed at random, without regard to constraints: the one whose axes a point keeps carries it. Ends of rails and
grooves depend on the motion of their joints, and are found from a motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .._private.rotations import rotation_of
from ..mechanisms.pictures.plane_shapes import sketches
from ..mechanisms.pictures.space_shapes import space_sketches
from ..systems.shapes import Shape
from .scene import count_places

MOMENTS = 3         # of random poses
CARRIED = 1e-9      # m: deviation of a point from its place in the body, at random poses; in a motion the least is taken


class BodyPoints(NamedTuple):
    """Shapes, and for each of their points its body (0: the ground), whether it is a direction, and its coordinates there."""

    shapes: list[Shape]
    bodies: np.ndarray          # (points,)
    directions: np.ndarray      # (points,) bool
    local: np.ndarray           # (points, dimension)
    of_motion: np.ndarray       # (points,) bool: found from the motion


def body_points(system: Any, positions: Sequence[np.ndarray]) -> BodyPoints:
    """Points of the drawing of a mechanism, for positions (times, nq) of its motion."""
    moments = system._sketches(positions)
    is_place = [i < count_places(shape) for shape in moments[0] for i in range(len(shape.points))]
    directions = ~np.array(is_place, dtype=bool)
    places = np.array([np.concatenate([shape.points for shape in shapes]) for shapes in moments])
    poses = np.array([system._first_core.poses(np.ascontiguousarray(p))[0] for p in positions])
    own, spread = _in_bodies(places, directions, poses)
    random, of_motion = _places(system, _anywhere(system)), np.ones(len(directions), dtype=bool)
    if random.shape[1] == len(directions):
        anywhere, known = _in_bodies(random, directions, _anywhere(system))
        body = known.argmin(axis=1)[:, None]
        apart = np.take_along_axis(anywhere[0] - own[0], body[..., None], axis=1)
        of_motion = (np.take_along_axis(known, body, axis=1)[:, 0] > CARRIED) | (np.abs(apart).max(axis=(1, 2)) > CARRIED)
        spread[~of_motion] = known[~of_motion]
    found = spread.argmin(axis=1)
    return BodyPoints(moments[0], found, directions, own[0, np.arange(len(found)), found], of_motion)


def moved(system: Any, known: BodyPoints) -> np.ndarray:
    """Coordinates (points, dimension) of the same points in their bodies, of the system with other parameters."""
    places = _places(system, _anywhere(system))
    if places.shape[1] != len(known.bodies):
        return known.local
    own, _ = _in_bodies(places, known.directions, _anywhere(system))
    return np.where(known.of_motion[:, None], known.local, own[0, np.arange(len(known.bodies)), known.bodies])


def _places(system: Any, poses: np.ndarray) -> np.ndarray:
    """Points (moments, points, dimension) of the shapes at poses."""
    draw = space_sketches if system._drawing.dimension == 3 else sketches
    return np.array([np.concatenate([shape.points for shape in shapes])
                     for shapes in draw(system._drawing, system._numbers, list(poses))])


def _anywhere(system: Any) -> np.ndarray:
    """Random poses (moments, bodies, 3 or 7); particles in space do not turn."""
    random, parts = np.random.default_rng(0), system._drawing.parts()
    if system._drawing.dimension == 2:
        return random.normal(size=(MOMENTS, len(parts), 3))
    poses = random.normal(size=(MOMENTS, len(parts), 7))
    poses[:, [not body.turns for body in parts], 3:] = (1, 0, 0, 0)
    return poses


def _in_bodies(places: np.ndarray, directions: np.ndarray, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates of points and directions in the axes of all bodies, (moments, points, bodies + 1, dimension), and their largest
    change (points, bodies + 1).
    """
    at, R = _frames(poses)
    offsets = places[:, :, None] - np.where(directions[:, None, None], 0.0, at[:, None])
    own = np.einsum("kbji,kpbj->kpbi", R, offsets)
    return own, np.ptp(own, axis=0).max(axis=2)


def _frames(poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Origins (moments, bodies + 1, d) and rotations (moments, bodies + 1, d, d), the ground first."""
    count, width = len(poses), poses.shape[2]
    d = 3 if width == 7 else 2
    at = np.concatenate([np.zeros((count, 1, d)), poses[:, :, :d]], axis=1)
    return at, np.concatenate([np.tile(np.eye(d), (count, 1, 1, 1)), rotation_of(poses[:, :, 3:]) if d == 3 else _turned(poses)],
                              axis=1)


def _turned(poses: np.ndarray) -> np.ndarray:
    """Rotations (moments, bodies, 2, 2) of poses in the plane."""
    c, s = np.cos(poses[:, :, 2]), np.sin(poses[:, :, 2])
    return np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
