"""Shapes of stops: blocks against which a slider, a link or a point comes to rest; walls at limits of coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...systems.shapes import Shape
from ..elements.bodies import Point
from ..elements.contacts import Stop
from ..elements.frames import turned
from ..elements.joints import Joint
from .plane_outline import APART
from .plane_pose import Posed

ALONG = 0.6         # of a link's length: distance of its stop from the joint


def stops(posed: Posed) -> Iterator[Shape]:
    """Blocks of all stops of displacements, angles and lengths, and walls of those of coordinates of points; stops of other
    measures have no shape.
    """
    for stop in posed.parts.drawing.of(Stop):
        name, _, quantity = stop.of.rpartition(".")
        element: Any = posed.parts.drawing.elements.get(name)
        for word, value in stop.limits.items():
            limit, outward = posed.parts.numbers(stop, word, value), 1.0 if word == "upper" else -1.0
            if isinstance(element, Joint) and quantity == "displacement":
                axis = posed.axis(element)
                place = posed.at(element.second) + (limit - posed.displacement(element)) * axis
                yield Shape("stop", np.array([place, outward * axis]), stop.name, 1.0)
            elif isinstance(element, Joint) and quantity == "angle":
                yield from _beside_link(element, limit, outward, stop.name, posed)
            elif quantity == "length" and getattr(element, "second", None) is not None:
                start = posed.at(element.first)
                along = posed.at(element.second) - start
                along /= max(float(np.hypot(*along)), APART)
                yield Shape("stop", np.array([start + limit * along, outward * along]), stop.name)
            elif quantity in ("x", "y") and name.endswith(".position"):
                yield _wall(name.removesuffix(".position"), "xy".index(quantity), limit, outward, stop.name, posed)


def _wall(owner: str, axis: int, limit: float, outward: float, name: str, posed: Posed) -> Shape:
    """Wall at a limit of a coordinate, beside the point as drawn."""
    of = posed.parts.drawing.measured_at(owner)
    place, inward = np.array(of.drawn_with(posed.parts.numbers) if isinstance(of, Point) else of.pose.origin), np.zeros(2)
    place[axis], inward[axis] = limit, -outward
    return Shape("wall", np.array([place, inward]), name)


def _beside_link(joint: Joint, limit: float, outward: float, name: str, posed: Posed) -> Iterator[Shape]:
    """Block that the second body of a joint touches at an angle, if it has an extent."""
    first, second = (posed.pose(body.name).angle for body in joint.bodies)
    place = posed.at(joint.second)
    farthest = max((point - place for point in posed.outline(joint.bodies[1].name)), key=lambda each: float(np.hypot(*each)),
                   default=np.zeros(2))
    if np.hypot(*farthest) > APART:
        link = turned(limit + joint.angle_as_drawn() - (second - first), farthest)
        yield Shape("stop", np.array([place + ALONG * link, outward * np.array([-link[1], link[0]]) / np.hypot(*link)]), name)
