"""Transmission angle at a hinge: between the lines along which its two links transmit forces.

The line of a link goes from the hinge to the other joint of that link; where that joint is a slider, it is the normal of the
slide, which the push should not follow. In a four-bar, at the hinge of coupler and rocker, that is the angle of textbooks, and in
a slider-crank, at the wrist, the angle between the rod and the normal of the slide.

J. J. Uicker, G. R. Pennock, J. E. Shigley, Theory of Machines and Mechanisms, Oxford University Press, section 1.10.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway.mechanisms.plane import Quantity
from ...errors import WrongValue
from ..elements import columns
from ..elements.bodies import Body, Point
from ..elements.joints import Joint, is_hinge
from ..elements.numbers import AS_GIVEN, Numbers

SAME = 1e-9             # m or rad: largest distance of joints that coincide


class Line(NamedTuple):
    """Line that turns with a body: its angle in the body's frame, in rad."""

    body: Body
    angle: float


class NoTransmissionAngle(WrongValue):
    """The transmission angle is undefined, for the reason in the message."""

    code = "wrong-element"


def joints_by_body(elements: Mapping[str, Any]) -> dict[str, list[Joint]]:
    """Joints of each body, by its name."""
    found: dict[str, list[Joint]] = {}
    for joint in elements.values():
        if isinstance(joint, Joint):
            for body in dict.fromkeys(body.name for body in joint.bodies):
                found.setdefault(body, []).append(joint)
    return found


def lines(joint: Joint, joints: Mapping[str, list[Joint]], numbers: Numbers = AS_GIVEN) -> tuple[Line, Line]:
    """Lines of a hinge's two links, ordered so that the angle from the first to the second is positive as drawn."""
    if not is_hinge(joint.row):
        raise NoTransmissionAngle(f"{joint.name!r} is not a hinge; a transmission angle is measured at a hinge between two links")
    if any(body.name == "ground" for body in joint.bodies):
        raise NoTransmissionAngle(f"{joint.name!r} is fixed to the ground, and a transmission angle is that at a hinge of two "
                                  "moving links")
    first, second = (_line(joint, side, joints[side.body.name], numbers) for side in (joint.first, joint.second))
    return (first, second) if _turned(first, second) >= 0 else (second, first)


def has_one(joint: Any, joints: Mapping[str, list[Joint]]) -> bool:
    """True if the element is a joint with a transmission angle."""
    if not isinstance(joint, Joint):
        return False
    try:
        lines(joint, joints)
    except NoTransmissionAngle:
        return False
    return True


def quantity(joint: Joint, joints: Mapping[str, list[Joint]], numbers: Numbers, number: Mapping[str, int]) -> Quantity:
    """Marker quantity of the angle: between 0 and pi in the drawing, and smooth from there."""
    first, second = lines(joint, joints, numbers)
    drawn = (second.body.pose.angle if second.body.turns else 0.0) - first.body.pose.angle
    return Quantity("angle", number[first.body.name], number[second.body.name], zero=drawn - _turned(first, second))


def _turned(first: Line, second: Line) -> float:
    """Angle from the first line to the second as drawn, in (-pi, pi]."""
    angle = second.body.pose.angle + second.angle - first.body.pose.angle - first.angle
    return columns.plain(np.pi - (np.pi - angle) % (2 * np.pi))


def _line(joint: Joint, point: Point, others: Iterable[Joint], numbers: Numbers) -> Line:
    """Line of one link, from a hinge at that point of it."""
    here, found = point.local_with(numbers), []
    for other in others:
        if other is joint:
            continue
        for side, opposite in ((other.first, other.second), (other.second, other.first)):
            if side.body is point.body and other.axis is not None and other.row.takes_axis:
                body = point.body if other.row.coordinate and point.body.turns else other.bodies[0]
                normal = other.axis_as_drawn()
                found.append((other, opposite.body, Line(body, _direction(body, np.array([-normal[1], normal[0]])))))
            elif side.body is point.body and columns.hypot(*(apart := side.local_with(numbers) - here)) > SAME:
                found.append((other, opposite.body, Line(point.body, columns.arctan2(apart[1], apart[0]))))
    return _only(joint, point.body, found)


def _direction(body: Body, drawn: np.ndarray) -> float:
    local = body.pose.local_direction(drawn)
    return float(np.arctan2(local[1], local[0]))


def _is_same(first: Line, second: Line) -> bool:
    """True if two lines coincide, as those to two joints at one point."""
    return first.body is second.body and abs(first.angle - second.angle) < SAME


def _only(joint: Joint, body: Body, found: list[tuple[Joint, Body, Line]]) -> Line:
    """Line to the only other joint, or among several to the one on the ground."""
    grounded = [each for each in found if each[1].name == "ground"]
    for chosen in (found, grounded):
        if chosen and all(_is_same(line, chosen[0][2]) for _, _, line in chosen):
            return chosen[0][2]
    if not found:
        raise NoTransmissionAngle(f"there is no transmission angle at {joint.name!r}: {body.name!r} has no other joint")
    others = ", ".join(repr(other.name) for other, _, _ in found)
    raise NoTransmissionAngle(f"there is no one transmission angle at {joint.name!r}: {body.name!r} has the other joints "
                    f"{others}, {len(grounded) or 'none'} of them on the ground; take the difference of two angles of bodies")
