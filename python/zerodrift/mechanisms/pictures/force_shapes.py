"""Shapes of springs, dampers, drives and loads."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...systems.shapes import Shape
from ..elements.bodies import Point
from ..elements.forces import Actuator, Force, Motor, Torque
from ..elements.joints import Joint, holds_angle, is_hinge
from ..elements.table_forces import TableForce, has, paths
from ..elements.user_functions import Law
from .plane_outline import APART
from .plane_pose import Parts, Posed


def forces(posed: Posed) -> Iterator[Shape]:
    """All shapes of forces of a mechanism."""
    parts, drawing = posed.parts, posed.parts.drawing
    for element in drawing.of((TableForce, Actuator)):
        if element.first:
            yield from _between(element, posed)
    for spring in (each for each in drawing.of(TableForce) if each.joint):
        angle = posed.pose(spring.joint.bodies[1].name).angle - posed.pose(spring.joint.bodies[0].name).angle
        if parts.numbers(spring, "stiffness", spring.values.get("stiffness", 1.0)) != 0:        # with 0, a damper
            yield Shape("spiral", posed.at(spring.joint.second)[None], spring.name, angle)
    for motor in drawing.of(Motor):
        yield _motor(motor, posed)
    for force in drawing.of(Force):
        if force.law.constant == 0:
            continue
        place, along = posed.at(force.point), posed.direction(force.frame, force.along)
        yield from _to_outside(place, force.point, posed)
        yield Shape("load", np.array([place, _sign(force.law) * along]), force.name)
    for torque in drawing.of(Torque):
        if torque.law.constant != 0:
            yield Shape("moment", posed.at(torque.body.center)[None], torque.name, _sign(torque.law))


def _to_outside(place: np.ndarray, point: Point, posed: Posed) -> Iterator[Shape]:
    """Line from the outline of a body to a point of it farther out."""
    places = posed.outline(point.body.name)
    if not len(places):
        return
    middle = np.mean(places, axis=0)
    if np.hypot(*(place - middle)) > max(np.hypot(*(each - middle)) for each in places) + APART:
        yield Shape("coupled", np.array([min(places, key=lambda each: float(np.hypot(*(each - place)))), place]))


def _between(element: Any, posed: Posed) -> Iterator[Shape]:
    """Shapes of an element between two points."""
    first, second = posed.at(element.first), posed.at(element.second)
    ends = np.array([first, second])
    if isinstance(element, Actuator):
        yield Shape("cylinder", ends, element.name)
    elif element.row.is_spring and has(element.row, "distance"):
        yield from _spring(ends, element.name, *(posed.parts.numbers(element, each, element.values.get(each, 1.0))
                                                 for each in paths(element.row)[0][:2]))
    elif element.row.is_spring:
        yield Shape("bushing", second[None], element.name)
    elif element.axis is None and has(element.row, "angle"):
        yield Shape("moment", second[None], element.name, _sign(element.law))
    else:
        along = ends[1] - ends[0] if element.axis is None else posed.direction(element.first.body, element.axis)
        yield Shape("load", np.array([second, _sign(element.law) * along / max(np.hypot(*along), 1e-300)]), element.name)


def _spring(ends: np.ndarray, name: str, stiffness: float, damping: float) -> list[Shape]:
    """Shapes of a spring, a damper, or both side by side."""
    beside = float(stiffness > 0 and damping > 0)
    found = [Shape("damper", ends, name, -beside)] if damping > 0 else []
    return [Shape("spring", ends, name, beside), *found] if stiffness > 0 or not damping > 0 else found


def _motor(motor: Motor, posed: Posed) -> Shape:
    """Shape of a drive about a hinge, or along an axis."""
    joint, sign = motor.joint, _sign(motor.law)
    place = posed.at(joint.second)
    if joint.coordinate == "angle":
        return Shape("motor", place[None], motor.name, sign)
    axis = posed.axis(joint)
    is_on_ground = joint.bodies[0] is posed.parts.drawing.ground
    side = posed.parts.side(joint) if is_on_ground else np.array([-axis[1], axis[0]])
    return Shape("drive", np.array([place, axis, side]), motor.name, sign)


def _sign(law: Law) -> float:
    """Sign of a constant law; +1 for a law that varies."""
    return -1.0 if law.constant is not None and law.constant < 0 else 1.0


def walls(posed: Posed, held: list[Point]) -> Iterator[Shape]:
    """Marks on the ground where springs, dampers, cylinders and welded bodies are fixed."""
    parts = posed.parts
    for element in (each for each in parts.drawing.of((TableForce, Actuator, Joint)) if each.first):
        if isinstance(element, Joint) and (not holds_angle(element.row) or is_hinge(element.row) or element.axis is not None):
            continue
        for side, other in ((element.first, element.second), (element.second, element.first)):
            if side.body is parts.drawing.ground:
                place = posed.at(side)
                if all(np.hypot(*(place - posed.at(point))) > APART for point in held):
                    yield Shape("wall", np.array([place, _inward(parts, side, other)]))


def _inward(parts: Parts, side: Point, other: Point) -> np.ndarray:
    """Direction (2,) from a fixed point towards the element that is attached there, as drawn."""
    away = other.drawn_with(parts.numbers) - side.drawn_with(parts.numbers)
    if np.hypot(*away) <= APART and other.body.name in parts.outline:
        places = [other.body.pose.point(place) for place in parts.outline[other.body.name]]
        away = np.mean(places, axis=0) - side.drawn_with(parts.numbers)
    length = np.hypot(*away)
    return away / length if length > APART else np.array([0.0, 1.0])
