"""Shapes of a planar mechanism in its poses, in m, for the glyphs of `zerodrift.plot`.

Joints and force elements are drawn by their entry in the core's table: by the marker quantities that they constrain or act along.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from ...systems.shapes import Shape
from ..elements.bodies import Body, Ground, Particle, Point
from ..elements.contacts import LineContact, RoundContact
from ..elements.drawing import Drawing
from ..elements.joints import Joint, holds_angle
from ..elements.numbers import Numbers
from .coupling_shapes import Couplings
from .force_shapes import forces, walls
from .plane_outline import APART
from .plane_pose import Parts, Posed, at_moments, may_be_apart
from .stop_shapes import stops

ASSUMED = 0.35      # of the distance to the end of its body: length of a groove without a known motion

Ranges = dict[str, tuple[float, float]]


class Sketch:
    """Shapes of a mechanism: the parts that do not depend on the pose."""

    def __init__(self, drawing: Drawing, numbers: Numbers) -> None:
        self.parts = Parts(drawing, numbers)
        self.couplings = Couplings(self.parts)
        self.sliding = [joint for joint in drawing.of(Joint) if slides(joint)]
        self.slotted = {joint.bodies[0].name for joint in self.sliding if has_groove(joint)}
        touching = [joint for joint in drawing.of(Joint) if joint.row.at_contact]
        self.surfaces = [joint for joint in touching if isinstance(joint, LineContact) and joint.is_bounded]
        rolling = [joint for joint in touching if joint not in self.surfaces]
        self.guided = [*self.sliding, *rolling]
        self.switched = [joint for joint in self.guided if may_be_apart(joint)]
        self.lines = list(_by_line(rolling, numbers).values())
        self.has_shape = {joint.bodies[1].name for joint in self.sliding} | self.couplings.wheels
        self.has_shape |= {joint.bodies[1].name for joint in touching if joint.length_with(numbers)}
        self.held = _held_by_ground(self.parts)
        self.kinds = [(joint, _kind(joint), is_pinned(joint)) for joint in drawing.of(Joint)]

    def ranges(self, moments: Iterable[Posed]) -> Ranges:
        """Range of each slider and each wheel over all moments, from the position of its joint on the first body."""
        found: Ranges = {}
        for posed in moments:
            close: dict[int, Joint] = {}      # by point: the groove that it is in, of several in line that with the closest end
            for joint in sorted(self.switched, key=lambda each: -abs(posed.displacement(each))):
                if not posed.is_apart(joint):
                    close[id(joint.second)] = joint
            for joint in self.guided:
                if may_be_apart(joint) and close.get(id(joint.second)) is not joint:
                    found.setdefault(joint.name, (0.0, 0.0))
                    continue
                s = posed.displacement(joint)
                low, high = found.get(joint.name, (s, s))
                found[joint.name] = min(low, s), max(high, s)
        for joint in self.sliding:
            if has_groove(joint) and joint.name in found and np.ptp(found[joint.name]) <= APART:
                found[joint.name] = self._assumed(joint, found[joint.name][0])
        return found

    def _assumed(self, joint: Joint, s: float) -> tuple[float, float]:
        """Ends of a groove without a known motion: towards the ends of its body."""
        start = joint.first.local_with(self.parts.numbers)
        ends = [float((place - start) @ joint.axis) for place in self.parts.outline[joint.bodies[0].name]]
        return s + ASSUMED * min(0.0, min(ends) - s), s + ASSUMED * max(0.0, max(ends) - s)

    def shapes(self, posed: Posed, ranges: Ranges) -> list[Shape]:
        """All shapes."""
        found = [*self._bodies(posed, ranges), *self._joints(posed, ranges), *forces(posed), *self.couplings.shapes(posed)]
        return [*found, *stops(posed), *(Shape("ground", posed.at(point)[None]) for point in self.held), *walls(posed, self.held)]

    def _bodies(self, posed: Posed, ranges: Ranges) -> Iterator[Shape]:
        for body in self.parts.drawing.parts():
            if isinstance(body, Particle):
                if body.name not in self.has_shape:
                    yield Shape("particle", posed.pose(body.name).origin[None], body.name)
                continue
            if body.name in self.parts.drawing.shapes:
                yield _given(body, posed, self.parts.drawing.shapes[body.name])
                continue
            places = posed.outline(body.name)
            if body.name in self.slotted:
                tracks = [posed.track(joint, ranges) for joint in self.sliding if joint.bodies[0] is body]
                places = np.concatenate([places, *tracks])
            if len(places) > 1:
                yield Shape("link", places, body.name, float(body.name in self.slotted))
            elif body.name not in self.has_shape:
                radius = self._radius(body)
                turned = np.array([places[0], posed.direction(body, np.array([1.0, 0.0]))])
                yield Shape("wheel", turned, body.name, radius) if radius else Shape("disc", turned, body.name)
        for particle in self.parts.drawing.of(Particle):
            if particle.attachment:
                yield Shape("particle", posed.at(particle.attachment)[None], particle.name)
        for point in self.parts.free:
            yield Shape("mark", posed.at(point)[None], point.name or "")

    def _radius(self, body: Body) -> float:
        """Radius of a uniform disc with a body's mass and inertia, at most the extent of the drawing; 0 without them."""
        mass, inertia, _ = self.parts.inertias.of[body.name]
        points = [point.drawn_with(self.parts.numbers) for point in self.parts.drawing.joined_points()]
        extent = float(np.ptp(points, axis=0).max()) if len(points) > 1 else 0.0
        if not mass > 0 or not inertia > 0:
            return 0.0
        radius = float(np.sqrt(2 * inertia / mass))
        return min(radius, extent) if extent > APART else radius

    def _joints(self, posed: Posed, ranges: Ranges) -> Iterator[Shape]:
        for joints in self.lines:
            yield Shape("road", posed.line(joints, ranges), joints[0].name)
        for contact in self.surfaces:
            yield Shape("surface", posed.surface(contact), contact.name, float(isinstance(contact, RoundContact)))
        for joint, kind, pinned in self.kinds:
            second = posed.at(joint.second)
            if kind in ("rod", "coupled"):
                length = joint.length_with(self.parts.numbers) if kind == "rod" and may_be_apart(joint) else 0.0
                yield Shape(kind, np.array([posed.at(joint.first), second]), joint.name, length)
            elif kind == "wheel":
                radius = abs(joint.length_with(self.parts.numbers))
                if radius:
                    yield Shape("wheel", np.array([second, posed.spoke(joint)]), joint.name, radius)
            elif kind == "slider":
                yield from _slider(joint, posed, ranges, self.couplings.lifted.get(joint.name, 0.0))
            elif kind == "blade":
                yield Shape("blade", np.array([second, posed.direction(joint.bodies[1], joint.axis)]), joint.name)
            elif kind == "weld":
                yield Shape("weld", np.array([second, posed.spoke(joint)]), joint.name)
            if pinned:
                yield Shape("pin", second[None], joint.name)


def _given(body: Body, posed: Posed, shape: Any) -> Shape:
    """A disc with its spoke, or corners."""
    pose = posed.pose(body.name)
    if np.ndim(shape):
        return Shape("cam", np.array([pose.point(each) for each in shape]), body.name)
    return Shape("wheel", np.array([pose.origin, pose.direction(np.array([1.0, 0.0]))]), body.name, float(shape))


def _kind(joint: Joint) -> str:
    """Kind of shape of a joint, besides its pin; "" for none."""
    if joint.row.at_contact:
        return "wheel"
    if "distance" in quantities(joint):
        return "rod"
    if slides(joint):
        return "slider"
    if joint.is_of_one_body:
        return "blade"
    if {"x", "y", "angle"} <= quantities(joint):
        return "weld"
    return "" if is_pinned(joint) else "coupled"


def _by_line(joints: Iterable[Joint], numbers: Numbers) -> dict[tuple[Any, ...], list[Joint]]:
    """Wheels and contacts on the same line of a body, by that line."""
    found: dict[tuple[Any, ...], list[Joint]] = {}
    for joint in joints:
        assert joint.axis is not None
        across = joint.first.local_with(numbers) @ np.array([-joint.axis[1], joint.axis[0]])
        found.setdefault((joint.bodies[0].name, *np.round(np.array([*joint.axis, across]) / APART)), []).append(joint)
    return found


def _slider(joint: Joint, posed: Posed, ranges: Ranges, lifted: float) -> Iterator[Shape]:
    """Block on the ground, in a groove of a body if it may turn, otherwise around a rod; shifted if it would cover others."""
    axis = posed.axis(joint)
    second, track = posed.at(joint.second) + lifted * axis, posed.track(joint, ranges) + lifted * axis
    if joint.bodies[0] is posed.parts.drawing.ground:
        yield Shape("rail", np.array([*track, posed.parts.side(joint)]), joint.name)
        yield Shape("slider", np.array([second, axis]), joint.name)
    elif has_groove(joint):
        yield Shape("groove", np.array([*track, axis]), joint.name)
        if not may_be_apart(joint):
            yield Shape("block", np.array([second, axis]), joint.name)
    else:
        yield Shape("guide", np.array([*track, axis]), joint.name)
        yield Shape("slider", np.array([second, axis]), joint.name)


def _held_by_ground(parts: Parts) -> list[Point]:
    """Points of the ground about which a body or a rod turns, each position once."""
    ground, held = parts.drawing.ground, dict[tuple[float, ...], Point]()
    for joint in parts.drawing.of(Joint):
        if may_be_apart(joint):
            continue        # joined anywhere
        if _kind(joint) == "rod" or (is_pinned(joint) and joint.axis is None):
            for side in (joint.first, joint.second):
                if side.body is ground:
                    held.setdefault(tuple(np.round(side.local_with(parts.numbers) / APART)), side)
    return list(held.values())


def quantities(joint: Joint) -> set[str]:
    """Kinds of marker quantities that the joint constrains."""
    return {row.quantity for row in joint.row.rows}


def slides(joint: Joint) -> bool:
    """True if the joint guides a point along a line of its first body."""
    return "across" in quantities(joint) and joint.axis is not None and not joint.row.at_contact


def has_groove(joint: Joint) -> bool:
    """True if that line is a groove in a moving body, in which the point may turn."""
    return not holds_angle(joint.row) and not isinstance(joint.bodies[0], Ground)


def is_pinned(joint: Joint) -> bool:
    """True if the joint holds a point about which the second body turns."""
    return bool(quantities(joint) & {"x", "y", "across"}) and not holds_angle(joint.row) and not joint.row.at_contact


def sketches(drawing: Drawing, numbers: Numbers, moments: Iterable[np.ndarray],
             motion: Iterable[np.ndarray] = ()) -> list[list[Shape]]:
    """Shapes of a mechanism at each moment, whose mass centres are at poses (bodies, 3).

    Rails and grooves are as long as these moments and those of a motion need.
    """
    sketch = Sketch(drawing, numbers)
    drawn = at_moments(sketch.parts, moments)
    others = at_moments(sketch.parts, motion) if sketch.guided else []
    ranges = sketch.ranges([*drawn, *others])
    return [sketch.shapes(each, ranges) for each in drawn]
