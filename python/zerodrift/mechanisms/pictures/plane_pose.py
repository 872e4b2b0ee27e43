"""Planar mechanism in a pose: positions of its points, for `plane_shapes`."""

from __future__ import annotations

import numpy as np

from ..elements.bodies import Body, Particle, Point
from ..elements.drawing import Drawing, Inertias
from ..elements.frames import Pose, turned
from ..elements.joints import Joint
from ..elements.numbers import Numbers
from .plane_outline import APART, around, attached

LEVEL = 1e-12       # slope below which a direction counts as level


class Parts:
    """Quantities that do not depend on the pose.

    Attributes
    ----------
    outline : dict of str to list of ndarray (2,)
        Points of each body's outline in its frame: joints, named points, and the mass centre where there is nothing else, or
        only one point that does not show its angle.
    free : list of Point
        Named points that belong to no joint or force element.
    """

    def __init__(self, drawing: Drawing, numbers: Numbers) -> None:
        self.drawing, self.numbers, self.inertias = drawing, numbers, Inertias(drawing, numbers)
        self.attached = attached(drawing, numbers)
        self.outline = {body.name: self._outline(body) for body in drawing.parts()}
        held = {id(point) for point in drawing.joined_points()}     # each position once, joints first
        self.free = [point for body in drawing.parts() for point in self.attached[body.name]
                     if point.name in drawing.elements and id(point) not in held]

    def _outline(self, body: Body) -> list[np.ndarray]:
        places = [point.local_with(self.numbers) for point in around(self.attached[body.name], self.numbers)]
        com = self.inertias.of[body.name][2]
        if len(places) < 2 and (not places or np.hypot(*(places[0] - com)) > APART):
            places.append(com)
        return places

    def side(self, joint: Joint) -> np.ndarray:
        """Side (2,) of a joint's axis on which its second body is in the drawing; by default above or to the left."""
        axis, place = joint.axis_as_drawn(), joint.second.drawn_with(self.numbers)
        normal = np.array([-axis[1], axis[0]])
        body = joint.bodies[1]
        pose = body.pose
        places = [] if isinstance(body, Particle) else [pose.point(each) for each in self.outline[body.name]]
        beside = sum(float((each - place) @ normal) for each in places)
        if abs(beside) > APART:
            return normal if beside > 0 else -normal
        points_up = normal[1] > LEVEL or (abs(normal[1]) <= LEVEL and normal[0] < 0)
        return normal if points_up else -normal


class Posed:
    """Mechanism with its mass centres at poses (bodies, 3)."""

    def __init__(self, parts: Parts, poses: np.ndarray) -> None:
        self.parts = parts
        self.pose = {"ground": Pose(np.zeros(2), 0.0)}
        for body, (x, y, angle) in zip(parts.drawing.parts(), poses, strict=True):
            com = parts.inertias.of[body.name][2]
            self.pose[body.name] = Pose(np.array([x, y]) - turned(angle, com), angle)

    def at(self, point: Point) -> np.ndarray:
        """Position of a point, (2,)."""
        return self.pose[point.body.name].point(point.local_with(self.parts.numbers))

    def direction(self, body: Body, local: np.ndarray) -> np.ndarray:
        """Direction (2,) in the drawing, from one in a body's frame."""
        return self.pose[body.name].direction(local)

    def contact(self, joint: Joint) -> np.ndarray:
        """Contact point of a wheel with its line, (2,)."""
        down = np.array([joint.axis[1], -joint.axis[0]])
        return self.at(joint.second) + joint.length_with(self.parts.numbers) * self.direction(joint.bodies[0], down)

    def spoke(self, joint: Joint) -> np.ndarray:
        """The x axis of a joint's second body."""
        return self.direction(joint.bodies[1], np.array([1.0, 0.0]))

    def displacement(self, joint: Joint) -> float:
        """Displacement of a joint's second point from its first along the axis."""
        return float((self.at(joint.second) - self.at(joint.first)) @ self.direction(joint.bodies[0], joint.axis))

    def track(self, joint: Joint, ranges: dict[str, tuple[float, float]]) -> np.ndarray:
        """Ends (2, 2) of the range of a joint's second point along its axis; the line passes through that point."""
        axis, now, place = self.direction(joint.bodies[0], joint.axis), self.displacement(joint), self.at(joint.second)
        low, high = ranges[joint.name]
        return np.array([place + (low - now) * axis, place + (high - now) * axis])
