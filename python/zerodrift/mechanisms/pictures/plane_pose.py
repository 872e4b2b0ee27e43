"""Planar mechanism in its poses: positions of its points, for `plane_shapes`. Those of all moments are computed together."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..elements.bodies import Body, Particle, Point
from ..elements.contacts import LineContact, RoundContact
from ..elements.drawing import Drawing, Inertias
from ..elements.frames import Pose, turned
from ..elements.joints import Joint, Rolling
from ..elements.numbers import Numbers
from .plane_outline import APART, around, attached

TOUCHES = 1e-5      # of a length: a point that is closer to a line is on it
LEVEL = 1e-12       # slope below which a direction counts as level
SMOOTH = 24         # corners of an arc for each radian of half its angle


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


class Poses:
    """Frames of all bodies at several moments, and positions of points, each computed once for all of them."""

    def __init__(self, parts: Parts, poses: np.ndarray) -> None:
        """Mass centres at poses (moments, bodies, 3)."""
        self.parts, count = parts, len(poses)
        self.frames = {"ground": (np.zeros((count, 2)), np.zeros(count))}       # origins (moments, 2) and angles (moments,)
        for i, body in enumerate(parts.drawing.parts()):
            angle, com = poses[:, i, 2], parts.inertias.of[body.name][2]
            self.frames[body.name] = poses[:, i, :2] - turned(angle, com).T, angle
        self._points: dict[int, tuple[Point, np.ndarray]] = {}       # a point goes on existing while its identity is a key
        self._outlines: dict[str, np.ndarray] = {}

    def _moved(self, name: str, local: np.ndarray) -> np.ndarray:
        origin, angle = self.frames[name]
        return origin + turned(angle, local).T

    def at(self, point: Point) -> np.ndarray:
        """Positions (moments, 2) of a point."""
        if id(point) not in self._points:
            self._points[id(point)] = point, self._moved(point.body.name, point.local_with(self.parts.numbers))
        return self._points[id(point)][1]

    def outline(self, name: str) -> np.ndarray:
        """Points (moments, n, 2) of a body's outline."""
        if name not in self._outlines:
            places = [self._moved(name, place) for place in self.parts.outline.get(name, ())]
            self._outlines[name] = np.stack(places, axis=1) if places else np.zeros((len(self.frames[name][0]), 0, 2))
        return self._outlines[name]


class Posed:
    """Mechanism at one of several moments."""

    def __init__(self, poses: Poses, moment: int) -> None:
        self.parts, self._poses, self._moment = poses.parts, poses, moment

    def pose(self, name: str) -> Pose:
        """Frame of a body in the drawing."""
        origin, angle = self._poses.frames[name]
        return Pose(origin[self._moment], angle[self._moment])

    def at(self, point: Point) -> np.ndarray:
        """Position of a point, (2,)."""
        return self._poses.at(point)[self._moment]

    def outline(self, name: str) -> np.ndarray:
        """Points (n, 2) of a body's outline."""
        return self._poses.outline(name)[self._moment]

    def direction(self, body: Body, local: np.ndarray) -> np.ndarray:
        """Direction (2,) in the drawing, from one in a body's frame."""
        return self.pose(body.name).direction(local)

    def axis(self, joint: Joint) -> np.ndarray:
        """Direction (2,) of the axis of a joint that has one, in its first body."""
        assert joint.axis is not None
        return self.direction(joint.bodies[0], joint.axis)

    def contact(self, joint: Rolling | LineContact) -> np.ndarray:
        """Place (2,) on the line or circle that a body rolls on or may touch, nearest to it."""
        second, start = self.at(joint.second), self.at(joint.first)
        if isinstance(joint, RoundContact):
            apart = second - start
            return start + joint.shape.radius * apart / np.hypot(*apart)
        axis, length = self.axis(joint), joint.shape.length if isinstance(joint, LineContact) else np.inf
        along = float((second - start) @ axis)
        return start + (along if length == np.inf else min(max(along, 0.0), length)) * axis

    def surface(self, contact: LineContact) -> np.ndarray:
        """Places (n, 2) along a bounded shape that a body may touch, which is free on their left."""
        start, axis, shape = self.at(contact.first), self.axis(contact), contact.shape
        if not isinstance(contact, RoundContact):
            return np.array([start, start + shape.length * axis])
        turn = -contact.sign * shape.half_angle
        turned = complex(*axis) * np.exp(1j * np.linspace(-turn, turn, 2 + int(SMOOTH * shape.half_angle)))
        return start + shape.radius * np.column_stack([turned.real, turned.imag])

    def spoke(self, joint: Joint) -> np.ndarray:
        """The x axis of a joint's second body."""
        return self.direction(joint.bodies[1], np.array([1.0, 0.0]))

    def displacement(self, joint: Joint) -> float:
        """Displacement of a joint's second point from its first along the axis."""
        return float((self.at(joint.second) - self.at(joint.first)) @ self.axis(joint))

    def is_apart(self, joint: Joint) -> bool:
        """True if a joint that may be released does not hold its second point on its line."""
        if not may_be_apart(joint):
            return False
        apart = self.at(joint.second) - self.at(joint.first)
        return abs(apart[0] * self.axis(joint)[1] - apart[1] * self.axis(joint)[0]) > TOUCHES * (1 + float(np.hypot(*apart)))

    def track(self, joint: Joint, ranges: dict[str, tuple[float, float]]) -> np.ndarray:
        """Ends (2, 2) of the range of a joint's second point along its axis, through that point if it holds it."""
        axis, now, place = self.axis(joint), self.displacement(joint), self.at(joint.second)
        low, high = ranges[joint.name]
        if self.is_apart(joint):
            now, place = 0.0, self.at(joint.first)
        return np.array([place + (low - now) * axis, place + (high - now) * axis])

    def line(self, joints: Sequence[Joint], ranges: dict[str, tuple[float, float]]) -> np.ndarray:
        """Ends of the line of the first body on which these roll or which they touch, and its direction, (3, 2)."""
        start, axis = self.at(joints[0].first), self.axis(joints[0])
        ends = [(self.at(joint.first) - start) @ axis + end for joint in joints for end in ranges[joint.name]]
        return np.array([start + min(ends) * axis, start + max(ends) * axis, axis])


def may_be_apart(joint: Joint) -> bool:
    """True if a joint can be released and joined."""
    return joint.switched is not None and joint.switched.active is not None


def at_moments(parts: Parts, moments: Iterable[np.ndarray]) -> list[Posed]:
    """Mechanism at each moment, with its mass centres at poses (bodies, 3)."""
    stacked = np.array(list(moments)).reshape(-1, len(parts.drawing.parts()), 3)
    poses = Poses(parts, stacked)
    return [Posed(poses, moment) for moment in range(len(stacked))]
