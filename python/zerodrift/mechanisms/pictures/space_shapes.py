"""Shapes of a mechanism in space in its poses, in m, for `zerodrift.plot.space_picture`.

Which shapes there are does not depend on the pose, so that points of all moments are computed together, (moments, points, 3).

A body is a bar between two joints, a plate between three or more in a plane, otherwise a star of bars; with fewer than two
joints it is a disc or a box of its inertia. A rolling body is a disc or an ellipsoid.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..._private.rotations import rotation_of
from ...systems.shapes import Shape
from ..elements.bodies import Body, Link, Particle, Point
from ..elements.contacts import PlaneContact, SphereContact
from ..elements.drawing import Drawing
from ..elements.forces import Actuator
from ..elements.joints import holds_distance
from ..elements.numbers import Numbers
from ..elements.space_bodies import SpaceInertias
from ..elements.space_joints import SpaceJoint, SpaceRolling, has_torque, is_at_point, is_blade, is_on_plane
from ..elements.table_forces import TableForce, has
from .space_outline import APART, different

FLAT = 1e-6         # of the extent of points: deviation from a plane, at most
ALIKE = 1e-6        # of the largest moment: difference of equal moments, at most
ROUND = np.linspace(0, 2 * np.pi, 49)
ORIGIN = np.zeros((1, 3))
CORNERS = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])


Placed = tuple[np.ndarray, np.ndarray]      # mass centres (moments, 3) and rotations (moments, 3, 3) of a body


class SpaceSketch:
    """Shapes of a mechanism in space that do not depend on the pose. Points are relative to mass centres, in principal axes."""

    def __init__(self, drawing: Drawing, numbers: Numbers) -> None:
        self.drawing, self.numbers, self.inertias = drawing, numbers, SpaceInertias(drawing, numbers)
        round_ones = [joint for joint in drawing.of((PlaneContact, SphereContact)) if joint.radius]
        self.rolling = {joint.bodies[1].name for joint in (*drawing.of(SpaceRolling), *round_ones)}
        self.held = self._held()
        self.carried: dict[str, list[Particle]] = {}
        for particle in drawing.of(Particle):
            if particle.attachment:
                self.carried.setdefault(particle.attachment.body.name, []).append(particle)

    def _held(self) -> dict[str, np.ndarray]:
        """Points (n, 3) of each body that its shape connects."""
        points: dict[str, list[Point]] = {body.name: [] for body in self.drawing.of(Body)}
        for link in self.drawing.of(Link):
            points[link.name] += [link.start, link.end]
        for point in [*self.drawing.joined_points(), *self.drawing.of(Point)]:
            points[point.body.name].append(point)
        for particle in self.drawing.of(Particle):
            if particle.attachment:
                points[particle.attachment.body.name].append(particle.attachment)
        return {name: np.array(different([self.local(point) for point in those])).reshape(-1, 3)
                for name, those in points.items()}

    def local(self, point: Point) -> np.ndarray:
        """Point relative to its body's mass centre."""
        return np.asarray(self.inertias.local(point, self.numbers))

    def shapes(self, poses: np.ndarray) -> list[Shape]:
        """All shapes, with the mass centres at poses (moments, bodies, 7)."""
        parts = self.drawing.parts()
        at = {body.name: (poses[:, i, :3], rotation_of(poses[:, i, 3:])) for i, body in enumerate(parts)}
        at["ground"] = np.zeros((len(poses), 3)), np.tile(np.eye(3), (len(poses), 1, 1))
        bodies = [shape for body in parts for shape in self._body(body, at[body.name])]
        joints = [shape for joint in self.drawing.of(SpaceJoint) for shape in self._joint(joint, at)]
        return [*bodies, *joints, *self._forces(at)]

    def _body(self, body: Body, at: Placed) -> Iterator[Shape]:
        if isinstance(body, Particle):
            yield Shape("dot", _moved(ORIGIN, at), body.name)
            return
        for particle in self.carried.get(body.name, ()):
            if particle.attachment:
                yield Shape("dot", _moved(self.local(particle.attachment)[None], at), particle.name)
        given = self.drawing.shapes.get(body.name)
        if given is not None:
            corners = given[0] + (CORNERS + 0.5) * (given[1] - given[0]) if len(given) == 2 else given
            places = np.array([self.local(Point(body, each)) for each in corners])
            yield Shape("box" if len(given) == 2 else "plate", _moved(places, at), body.name)
            return
        places = self.held[body.name]
        if body.name in self.rolling and len(places) < 2:
            return
        if len(places) == 1 and np.linalg.norm(places[0]) > APART:
            places = np.vstack([places, np.zeros(3)])       # the mass centre shows the body's orientation
        if any(np.linalg.norm(place) < APART for place in places) and len(places) > 1 and not isinstance(body, Link):
            yield Shape("dot", _moved(ORIGIN, at), body.name)
        if len(places) < 2:
            yield from self._by_inertia(body, at)
            return
        plate = _around(places) if len(places) > 2 else None
        if plate is not None:
            yield Shape("plate", _moved(plate, at), body.name)
        else:
            middle = places.mean(axis=0) if len(places) > 2 else places[0]
            for place in places if len(places) > 2 else places[1:]:
                yield Shape("bar", _moved(np.array([middle, place]), at), body.name)

    def _by_inertia(self, body: Body, at: Placed) -> Iterator[Shape]:
        """Disc with the body's mass and largest moment, if the two others are equal; otherwise the uniform box."""
        known = self.inertias.of[body.name]
        a, b, c = known.moments
        axis = next((i for i in range(3) if _is_axial(*np.roll(known.moments, -i))), None)
        if axis is not None and known.mass:
            rim = _ring(axis, *np.full(2, np.sqrt(2 * known.moments[axis] / known.mass)))
            yield Shape("disc", _moved(rim, at), body.name)
            yield Shape("rod", _moved(np.concatenate([ORIGIN, rim[:1]]), at), body.name)
            return
        squares = 6 * np.array([b + c - a, c + a - b, a + b - c]) / known.mass if known.mass else np.zeros(3)
        yield Shape("box", _moved(CORNERS * np.sqrt(np.maximum(squares, 0.0)), at), body.name)

    def _joint(self, joint: SpaceJoint, at: dict[str, Placed]) -> Iterator[Shape]:
        first, second = (self._placed(point, at) for point in (joint.first, joint.second))
        axes = [self._turned(joint, i, at) for i in (0, 1)]
        if isinstance(joint, SpaceRolling):
            yield from self._rolled(joint, (second, axes[1].swapaxes(1, 2)))
            return
        if isinstance(joint, PlaneContact | SphereContact):
            yield from self._touching(joint, first, second, axes)
            return
        if is_on_plane(joint.row) or is_blade(joint.row):
            beside = axes[0][:, 1 if is_on_plane(joint.row) else 0:][:, :2]
            yield Shape("patch", np.concatenate([second[:, None], beside], axis=1), joint.name)
            return
        if holds_distance(joint.row):
            yield Shape("rod", _together(first, second), joint.name)
        elif is_at_point(joint.row) and joint.row.axes:
            yield from (Shape("pin", _together(second, axes[i][:, i]), joint.name) for i in range(joint.row.axes))
        elif joint.row.axes:
            yield Shape("track", _together(first, second), joint.name)
            yield Shape("sleeve", _together(second, axes[0][:, 0]), joint.name)
        else:
            yield Shape("weld" if has_torque(joint.row) else "ball", _together(second), joint.name)
        for side, place in ((joint.first, first), (joint.second, second)):
            if side.body is self.drawing.ground:
                yield Shape("ground", _together(place), joint.name)

    def _touching(self, joint: PlaneContact | SphereContact, first: np.ndarray, second: np.ndarray,
                  axes: list[np.ndarray]) -> Iterator[Shape]:
        """Patch of a plane, three sections of a sphere, and those of the ball, or a dot at the point that touches."""
        balls = [(second, axes[1], joint.radius_with(self.numbers), joint.bodies[1])]
        if isinstance(joint, SphereContact):
            balls.append((first, axes[0], joint.shape.radius, joint.bodies[0]))
        else:
            yield Shape("patch", np.concatenate([first[:, None], axes[0][:, 1:]], axis=1), joint.name)
        for centre, own, radius, body in balls:
            if not radius:
                yield Shape("dot", _together(centre), body.name)
            for i in range(3 if radius else 0):
                yield Shape("ring", _moved(_ring(i, radius, radius), (centre, own.swapaxes(1, 2))), body.name)

    def _rolled(self, joint: SpaceRolling, at: Placed) -> Iterator[Shape]:
        """Rim of a disc with a spoke, or three sections of an ellipsoid, in the axes of the shape."""
        semiaxes = joint.semiaxes_with(self.numbers)
        flat = [i for i in range(3) if semiaxes[i] == 0]
        for i in flat or range(3):
            rim = _ring(i, semiaxes[(i + 1) % 3], semiaxes[(i + 2) % 3])
            yield Shape("disc" if flat else "ring", _moved(rim, at), joint.bodies[1].name)
            if flat:
                yield Shape("rod", _moved(np.concatenate([ORIGIN, rim[:1]]), at), joint.bodies[1].name)

    def _forces(self, at: dict[str, Placed]) -> Iterator[Shape]:
        for element in self.drawing.of((TableForce, Actuator)):
            if not element.first:
                continue
            first, second = self._placed(element.first, at), self._placed(element.second, at)
            if isinstance(element, Actuator) or has(element.row, "distance"):
                yield Shape("rod" if isinstance(element, Actuator) else "spring", _together(first, second), element.name)
                continue
            yield Shape("bushing", _together(second), element.name)
            for side, place in ((element.first, first), (element.second, second)):
                if side.body is self.drawing.ground:
                    yield Shape("ground", _together(place), element.name)

    def _placed(self, point: Point, at: dict[str, Placed]) -> np.ndarray:
        """Positions (moments, 3) of a point."""
        return _moved(self.local(point)[None], at[point.body.name])[:, 0]

    def _turned(self, joint: SpaceJoint, side: int, at: dict[str, Placed]) -> np.ndarray:
        """Rows of a joint's frame on one of its bodies, in the drawing: (moments, axes, 3)."""
        body = joint.bodies[side]
        own = np.array([self.inertias.direction(body, row) for row in joint.frames[side]])
        return own @ at[body.name][1].swapaxes(1, 2)


def _moved(places: np.ndarray, at: Placed) -> np.ndarray:
    """Points (n, 3) of a body at all moments, (moments, n, 3)."""
    return at[0][:, None] + places @ at[1].swapaxes(1, 2)


def _together(*points: np.ndarray) -> np.ndarray:
    """Points (moments, 3) as those of one shape, (moments, n, 3)."""
    return np.stack(points, axis=1)


def _ring(axis: int, one: float, other: float) -> np.ndarray:
    """Ellipse around an axis, (49, 3), whose semiaxes are those that follow it."""
    rim = np.zeros((len(ROUND), 3))
    rim[:, (axis + 1) % 3], rim[:, (axis + 2) % 3] = one * np.cos(ROUND), other * np.sin(ROUND)
    return rim


def _is_axial(own: float, one: float, other: float) -> bool:
    """True if a moment is the largest and the two others are equal, as of a wheel."""
    return abs(one - other) <= ALIKE * own and own > (1 + ALIKE) * one


def _around(places: np.ndarray) -> np.ndarray | None:
    """Points of a plane sorted around their centroid; None if they are not in a plane, or on a line."""
    arms = places - places.mean(axis=0)
    _, sizes, rows = np.linalg.svd(arms)
    if sizes[1] < FLAT * sizes[0] or (len(places) > 3 and sizes[2] > FLAT * sizes[0]):
        return None
    return places[np.argsort(np.arctan2(arms @ rows[1], arms @ rows[0]))]


def space_sketches(drawing: Drawing, numbers: Numbers, moments: Iterable[np.ndarray]) -> list[list[Shape]]:
    """Shapes of a mechanism at each moment, whose mass centres are at poses (bodies, 7)."""
    poses = np.array(list(moments))
    shapes = SpaceSketch(drawing, numbers).shapes(poses) if len(poses) else []
    return [[Shape(kind, points[k], name, number) for kind, points, name, number in shapes] for k in range(len(poses))]
