"""What there is to draw of a mechanism in one pose, in m: shapes that `zerodrift.plot` has glyphs for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..systems.shapes import Shape
from .bodies import Particle, Point
from .drawing import Drawing, Inertias
from .forces import Actuator, Bushing, Spring, TorsionSpring
from .joints import Coupling, Joint, holds_angle, is_hinge
from .made_forces import MadeForce
from .numbers import Numbers
from .outline import APART, around
from .plane import Pose, turned


class Sketch:
    """The shapes of a mechanism whose mass centres are at poses (bodies, 3)."""

    def __init__(self, drawing: Drawing, numbers: Numbers, poses: np.ndarray) -> None:
        self.drawing, self.numbers, self.inertias = drawing, numbers, Inertias(drawing, numbers)
        self.pose = {"ground": Pose(np.zeros(2), 0.0)}
        for body, (x, y, angle) in zip(drawing.parts(), poses, strict=True):
            com = self.inertias.of[body.name][2]
            self.pose[body.name] = Pose(np.array([x, y]) - turned(angle, com), angle)
        self.gears = [coupling for coupling in drawing.of(Coupling) if coupling.kind == "gear"]
        sliding = [joint for joint in drawing.of(Joint) if "across" in _gauges(joint)]
        shown = [*sliding, *(joint for gear in self.gears for joint in self._geared(gear))]
        self.has_shape = {joint.second.body.name for joint in shown}      # by what joins it

    def shapes(self) -> list[Shape]:
        """Everything, what is behind first."""
        found = [*self._bodies(), *self._joints(), *self._forces(), *self._gears()]
        return found + [Shape("ground", self._at(point)[None]) for point in self._held_by_ground()]

    def _at(self, point: Point) -> np.ndarray:
        """Where a point is, (2,)."""
        return self.pose[point.body.name].point(point.local_with(self.numbers))

    def _bodies(self) -> Iterator[Shape]:
        for body in self.drawing.parts():
            if isinstance(body, Particle):
                yield Shape("particle", self.pose[body.name].origin[None], body.name)
                continue
            pose = self.pose[body.name]
            places = [point.local_with(self.numbers) for point in around(body, self.drawing, self.numbers)]
            com = self.inertias.of[body.name][2]
            if len(places) == 1 and np.hypot(*(places[0] - com)) > APART:
                places.append(com)      # the mass centre shows which way it hangs
            if len(places) > 1:
                yield Shape("link", np.array([pose.point(place) for place in places]), body.name)
            elif body.name not in self.has_shape:
                place = places[0] if places else com
                yield Shape("disc", np.array([pose.point(place), pose.direction(np.array([1.0, 0.0]))]), body.name)

        for particle in self.drawing.of(Particle):
            if particle.carrier:
                yield Shape("particle", self._at(particle.carrier)[None], particle.name)

    def _joints(self) -> Iterator[Shape]:
        for joint in self.drawing.of(Joint):
            first, second = self._at(joint.first), self._at(joint.second)
            turned_with = self.pose[joint.bodies[0].name]
            if "distance" in _gauges(joint):
                yield Shape("rod", np.array([first, second]), joint.name)
            elif joint.row.at_contact:
                normal, spoke = turned_with.direction(np.array([-joint.axis[1], joint.axis[0]])), self._spoke(joint)
                radius = joint.length_with(self.numbers)
                yield Shape("rail", np.array([first, second - radius * normal, [normal[1], -normal[0]]]), joint.name)
                yield Shape("wheel", np.array([second, spoke]), joint.name, radius)
            elif "across" in _gauges(joint) and joint.axis is not None:
                axis = turned_with.direction(joint.axis)
                rail = "rail" if joint.bodies[0] is self.drawing.ground else "groove"
                yield Shape(rail, np.array([first, first + axis * ((second - first) @ axis), axis]), joint.name)
                yield Shape("slider", np.array([second, axis]), joint.name)
            elif joint.is_of_one_body:
                yield Shape("blade", np.array([second, self.pose[joint.bodies[1].name].direction(joint.axis)]), joint.name)
            if _is_pinned(joint):
                yield Shape("pin", second[None], joint.name)

    def _forces(self) -> Iterator[Shape]:
        for spring in self.drawing.of(Spring):
            yield Shape("spring", np.array([self._at(spring.first), self._at(spring.second)]), spring.name)
        for made in self.drawing.of(MadeForce):
            if made.row.is_spring and made.has("distance"):
                yield Shape("spring", np.array([self._at(made.first), self._at(made.second)]), made.name)
            elif made.row.is_spring:
                yield Shape("bushing", self._at(made.second)[None], made.name)
        for actuator in self.drawing.of(Actuator):
            yield Shape("cylinder", np.array([self._at(actuator.first), self._at(actuator.second)]), actuator.name)
        for spring in self.drawing.of(TorsionSpring):
            angle = self.pose[spring.joint.bodies[1].name].angle - self.pose[spring.joint.bodies[0].name].angle
            yield Shape("spiral", self._at(spring.joint.second)[None], spring.name, angle)
        for bushing in self.drawing.of(Bushing):
            yield Shape("bushing", self._at(bushing.second)[None], bushing.name)

    def _gears(self) -> Iterator[Shape]:
        """Pitch circles of gears, whose sizes follow from the ratio and the distance of the centres."""
        for gear in self.gears:
            joints = self._geared(gear)
            centres = [self._at(joint.second) for joint in joints]
            ratio = self.numbers(gear, "ratio", gear.ratio)
            apart = float(np.hypot(*(centres[1] - centres[0])))
            radii = (apart * abs(ratio / (1 - ratio)), apart * abs(1 / (1 - ratio))) if ratio != 1 else (0.0, 0.0)
            for joint, centre, radius in zip(joints, centres, radii, strict=True):
                yield Shape("gear", np.array([centre, self._spoke(joint)]), gear.name, radius)

    def _geared(self, gear: Coupling) -> list[Joint]:
        return [self.drawing.elements[of.rpartition(".")[0]] for of in gear.of]

    def _spoke(self, joint: Joint) -> np.ndarray:
        """The x axis of a joint's second body."""
        return self.pose[joint.bodies[1].name].direction(np.array([1.0, 0.0]))

    def _held_by_ground(self) -> list[Point]:
        """The points of the ground that a hinge, a rod or a spring holds on to, each place once."""
        ground, places = self.drawing.ground, []
        for element in self.drawing.of((Joint, Spring, Actuator)):
            if isinstance(element, Joint) and not ("distance" in _gauges(element) or is_hinge(element.row)):
                continue
            for side in (element.first, element.second):
                if side.body is ground and all(np.hypot(*(self._at(side) - self._at(other))) > APART for other in places):
                    places.append(side)
        return places


def _gauges(joint: Joint) -> set[str]:
    """What the rows of a joint hold."""
    return {row.gauge for row in joint.row.rows}


def _is_pinned(joint: Joint) -> bool:
    """Whether a joint holds a point about which the second body turns."""
    return bool(_gauges(joint) & {"x", "y", "across"}) and not holds_angle(joint.row) and not joint.row.at_contact


def sketch(drawing: Drawing, numbers: Numbers, poses: np.ndarray) -> list[Shape]:
    """The shapes of a mechanism, with the mass centres at poses (bodies, 3)."""
    return Sketch(drawing, numbers, poses).shapes()
