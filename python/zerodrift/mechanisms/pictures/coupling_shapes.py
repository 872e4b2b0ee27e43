"""Shapes of gears, racks and cams, with sizes computed from the coupling."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...systems.shapes import Shape
from ..elements.bodies import Body, Particle, Point
from ..elements.frames import turned
from ..elements.joints import Coupling, Joint
from .plane_outline import APART
from .plane_pose import Parts, Posed

ANGLES = 180        # points of a cam's profile
ROOM = 0.7          # of a cam's radius: smallest distance in the picture between roller and guide
BASE = 1.2          # of the lift: smallest radius of a drawn cam


class Wheel(NamedTuple):
    """Body that turns about a hinge as a gear; `sense` is -1 if the hinge measures the other body's rotation."""

    joint: Joint
    body: Body
    sense: int


class Couplings:
    """Shapes of couplings: the parts that do not depend on the pose."""

    def __init__(self, parts: Parts) -> None:
        self.parts = parts
        self.of = {kind: [each for each in parts.drawing.of(Coupling) if each.kind == kind]
                   for kind in ("gear", "rack_pinion", "cam", "coupler")}
        self.cams = [cam for cam in (profile(parts, coupling) for coupling in self.of["cam"]) if cam is not None]
        self.wheels = {wheel.body.name for gear in self.of["gear"] for wheel in _wheels(parts, gear)}
        self.wheels |= {self._joint(rack, 0).bodies[1].name for rack in self.of["rack_pinion"]}
        self.wheels |= {cam.joint.bodies[1].name for cam in self.cams}
        self.lifted = {cam.guide.name: cam.lifted for cam in self.cams}
        for cam in self.cams:
            self._lengthen(cam)

    def _lengthen(self, cam: Cam) -> None:
        """Extend the outline of a follower from its roller to its guide."""
        if isinstance(cam.follower, Particle):
            return
        places = self.parts.outline[cam.follower.name]
        guide = cam.guide.second.local_with(self.parts.numbers)
        axis = cam.follower.pose.local_direction(cam.guide.axis_as_drawn()) if cam.lifted else np.zeros(2)
        for place in (cam.roller, guide + cam.lifted * axis):
            if all(np.hypot(*(place - other)) > APART for other in places):
                places.append(place)

    def _joint(self, coupling: Coupling, which: int) -> Joint:
        return self.parts.drawing.elements[coupling.of[which].rpartition(".")[0]]

    def shapes(self, posed: Posed) -> Iterator[Shape]:
        """All shapes of couplings."""
        drawn: set[tuple[str, int]] = set()
        for gear in self.of["gear"]:
            for body, shape in self._gear(gear, posed):
                key = body.name, round(shape.number / APART)
                if key not in drawn:        # a wheel that meshes with several others is drawn once
                    drawn.add(key)
                    yield shape
        for rack in self.of["rack_pinion"]:
            yield from self._rack(rack, posed)
        for cam in self.cams:
            yield from cam.shapes(posed)
        for coupler in self.of["coupler"]:
            owners = [self.parts.drawing.elements.get(measure.partition(".")[0]) for measure in coupler.of]
            places = [posed.at(owner.second) for owner in owners if isinstance(owner, Joint)]
            if len(places) > 1:
                yield Shape("coupled", np.array(places), coupler.name)

    def _gear(self, gear: Coupling, posed: Posed) -> Iterator[tuple[Body, Shape]]:
        """Pitch circles, with sizes from the ratio and the distance of the centres."""
        wheels = _wheels(self.parts, gear)
        centres = [posed.at(wheel.joint.second) for wheel in wheels]
        apart = float(np.hypot(*(centres[1] - centres[0])))
        ratio = self.parts.numbers(gear, "ratio", gear.ratio) * wheels[0].sense * wheels[1].sense
        if apart <= APART or ratio == 1:
            return
        radii = apart * abs(ratio / (1 - ratio)), apart * abs(1 / (1 - ratio))
        for wheel, centre, radius in zip(wheels, centres, radii, strict=True):
            is_ring = ratio > 0 and radius == max(radii)
            spoke = posed.direction(wheel.body, np.array([1.0, 0.0]))
            yield wheel.body, Shape("ring" if is_ring else "gear", np.array([centre, spoke]), gear.name, radius)

    def _rack(self, rack: Coupling, posed: Posed) -> Iterator[Shape]:
        """Pitch circle, and the rack that touches it where both have the same velocity."""
        pinion, slider = self._joint(rack, 0), self._joint(rack, 1)
        ratio = self.parts.numbers(rack, "ratio", rack.ratio)
        centre, axis = posed.at(pinion.second), posed.axis(slider)
        away = -np.sign(ratio) * np.array([-axis[1], axis[0]])
        moved = posed.displacement(slider) - slider.offset_as_drawn(self.parts.numbers)
        middle, half = centre + abs(ratio) * away + moved * axis, (1.5 * abs(ratio) + abs(moved)) * axis
        yield Shape("rack", np.array([middle - half, middle + half, -away]), rack.name)
        yield Shape("gear", np.array([centre, posed.spoke(pinion)]), rack.name, abs(ratio))


def _wheels(parts: Parts, gear: Coupling) -> list[Wheel]:
    """The two meshing gears, relative to the body of both axles."""
    joints = [parts.drawing.elements[of.rpartition(".")[0]] for of in gear.of]
    carriers = [body for body in joints[0].bodies if any(body is other for other in joints[1].bodies)]
    if not carriers:
        return [Wheel(joint, joint.bodies[1], 1) for joint in joints]
    carried = [int(joint.bodies[0] is carriers[0]) for joint in joints]
    return [Wheel(joint, joint.bodies[side], 1 if side else -1) for joint, side in zip(joints, carried, strict=True)]


class Cam(NamedTuple):
    """Path of a follower's roller around a cam: `path` (n, 2) in the frame of the cam's body, with the cam's centre as origin."""

    name: str
    joint: Joint
    path: np.ndarray
    guide: Joint
    follower: Body
    roller: np.ndarray      # (2,) in the follower's frame
    lifted: float           # shift of the drawn guide along its axis, which uncovers the roller

    def shapes(self, posed: Posed) -> Iterator[Shape]:
        """Shapes of the cam and the roller."""
        centre, angle = posed.at(self.joint.second), posed.pose(self.joint.bodies[1].name).angle
        yield Shape("cam", np.array([centre + turned(angle, place) for place in self.path]), self.name, 1.0)
        yield Shape("roller", posed.pose(self.follower.name).point(self.roller)[None], self.name)


def profile(parts: Parts, coupling: Coupling) -> Cam | None:
    """Cam of a coupling whose follower is a joint of the body that supports the cam; None for other followers."""
    elements, numbers = parts.drawing.elements, parts.numbers
    joint, follower = (elements.get(measure.rpartition(".")[0]) for measure in coupling.of)
    law = coupling.law
    if law is None or not isinstance(joint, Joint) or not isinstance(follower, Joint):
        return None
    if joint.bodies[0] is not follower.bodies[0]:
        return None
    roller = _roller(parts, follower, joint.second.drawn_with(numbers))
    if roller is None:
        return None
    angles = np.linspace(0, 2 * np.pi, ANGLES, endpoint=False)
    known = {name: numbers.changed.get(name, value) for name, value in parts.drawing.parameters.items()}
    moves = np.array([-float(law.value(0.0, (angle, 0.0), known)) for angle in angles])
    centre, start = joint.first.drawn_with(numbers), roller.drawn_with(numbers)
    if follower.coordinate == "angle":
        pivot = follower.first.drawn_with(numbers)
        path = np.array([pivot + turned(move, start - pivot) for move in moves]) - centre
        stem = np.zeros(2)
    else:
        axis = follower.axis_as_drawn()
        path = start + moves[:, None] * axis - centre
        stem = _lengthened(path, axis)
        path = path + stem
    zero = joint.bodies[1].pose.angle
    path = np.array([turned(-zero - angle, place) for angle, place in zip(angles, path, strict=True)])
    lifted = 0.0 if follower.coordinate == "angle" else _room(path, start + stem, follower.second.drawn_with(numbers), axis)
    return Cam(coupling.name, joint, path, follower, roller.body, roller.body.pose.local(start + stem), lifted)


def _room(path: np.ndarray, roller: np.ndarray, guide: np.ndarray, axis: np.ndarray) -> float:
    """Distance along its axis by which a guide is moved in the picture to clear the cam and the roller."""
    radius = float(np.hypot(*path.T).max())
    return max(0.0, ROOM * radius - float((guide - roller) @ axis))


def _lengthened(path: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Displacement (2,) along its axis of a follower's path, so that a cam of reasonable size fits under it."""
    along = path @ axis
    least = BASE * float(np.ptp(along))
    nearest = float(np.hypot(*path.T).min())
    return np.zeros(2) if nearest >= least else (least - float(along.min())) * axis


def _roller(parts: Parts, follower: Joint, centre: np.ndarray) -> Point | None:
    """Point of a follower that is nearest to its cam."""
    body = follower.bodies[1]
    if isinstance(body, Particle):
        return follower.second
    points = [*parts.attached[body.name], body.center]
    if follower.coordinate == "angle":
        pivot = follower.second.drawn_with(parts.numbers)
        points = [point for point in points if np.hypot(*(point.drawn_with(parts.numbers) - pivot)) > APART]
    apart = [float(np.hypot(*(point.drawn_with(parts.numbers) - centre))) for point in points]
    return points[int(np.argmin(apart))] if points else None
