"""Carriers of bodies that drives move: the body through which all joints and drives of a body lead to the ground.

A body that hangs on one other, by whatever elements, is carried by it; one with several ways to the ground is carried by the last
body that all of them contain, at least by the ground. Where drives move a single point of a body, and all else that leads it to
the ground lets it translate with that point, it hangs on the point, as on a particle of its own.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..elements.bodies import Body, Point
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Motor
from ..elements.joints import Coupling, Joint
from ..equations.tables import Tables
from .free_coordinates import bodies_of

SAME = 1e-9         # m: distance of points that are one


class Carrier(NamedTuple):
    """Number of the carrying body, 0 for the ground, and the driven point on which a body hangs.

    The point is given from the mass centre of the body that hangs on it, in the axes of this body.
    """

    body: int
    point: np.ndarray | None = None


class Side(NamedTuple):
    """Number of a body that an element connects, and its point there; None: the element acts on the body as a whole."""

    body: int
    point: np.ndarray | None


class Connection(NamedTuple):
    """Bodies that a joint, a drive, a coupling or a held value of this name connects."""

    name: str
    sides: tuple[Side, ...]
    is_driven: bool
    is_held: bool = False       # a value of the start: it connects what elements connect with the ground already

    @property
    def bodies(self) -> set[int]:
        """Numbers of the bodies."""
        return {side.body for side in self.sides}


def carriers(drawing: Drawing, tables: Tables, held: Iterable[str],
             translates: Callable[[str, int, Carrier], bool]) -> dict[int, Carrier]:
    """Carriers by the number of the body; bodies are left out that the ground carries, or that no drive moves.

    `held` are names of velocities that the start holds or wishes. `translates` is true if an element, by name, lets a body
    translate with a driven point.
    """
    connections = list(_connections(drawing, tables, held))
    fixed = _reached([each for each in connections if not each.is_held])
    behind = {body: fixed - _reached(connections, body) - {body} for body in fixed - {0}}
    found = {}
    for body in sorted(behind.keys() & _with_drives(connections)):
        carrying = min((each for each in behind if body in behind[each]), key=lambda each: len(behind[each]), default=0)
        inward = [each for each in connections if body in each.bodies and each.bodies - behind[body] - {body}]
        found[body] = Carrier(carrying, _driven_point(inward, body, carrying, translates))
    return {body: each for body, each in found.items() if each.body or each.point is not None}


def _reached(connections: Sequence[Connection], without: int = -1, start: Collection[int] = (0,)) -> set[int]:
    """Bodies that are connected with those of the start, such as the ground, by bodies other than `without`."""
    of_body: dict[int, list[int]] = defaultdict(list)
    for i, each in enumerate(connections):
        for body in each.bodies:
            of_body[body].append(i)
    found, left, used = {*start}, [*start], set()
    while left:
        for i in of_body[left.pop()]:
            if i in used:
                continue
            used.add(i)
            new = connections[i].bodies - found - {without}
            found |= new
            left += new
    return found


def _with_drives(connections: Sequence[Connection]) -> set[int]:
    """Bodies that a drive moves, or that other bodies connect with such ones."""
    found: set[int] = set()
    for each in connections:
        if each.is_driven:
            found |= _reached(connections, 0, each.bodies - {0})
    return found


def _driven_point(inward: Sequence[Connection], body: int, carrying: int,
                  translates: Callable[[str, int, Carrier], bool]) -> np.ndarray | None:
    """Single point of a body that drives move, if all `inward` elements, which lead to the ground, let it translate with it."""
    driven = [side.point for each in inward if each.is_driven for side in each.sides if side.body == body]
    if not driven or any(point is None for point in driven) or np.ptp(driven, axis=0).max() > SAME:
        return None
    for each in inward:
        is_there = all(side.point is not None and np.abs(side.point - driven[0]).max() <= SAME for side in each.sides
                       if side.body == body)
        if not is_there and (each.is_held or not translates(each.name, body, Carrier(carrying, driven[0]))):
            return None
    return driven[0]


def _connections(drawing: Drawing, tables: Tables, held: Iterable[str]) -> Iterator[Connection]:
    driven = {motor.joint.name for motor in drawing.of(Motor) if motor.prescribes}
    for joint in drawing.of(Joint):
        yield Connection(joint.name, tuple(_sides(tables, joint)), joint.name in driven)
    for actuator in drawing.of(Actuator):
        if actuator.prescribes:
            yield Connection(actuator.name, tuple(_sides(tables, actuator)), is_driven=True)
    for coupling in drawing.of(Coupling):
        sides = [side for name in coupling.of for side in _sides_of(drawing, tables, name)]
        yield Connection(coupling.name, tuple(sides), coupling.law is not None)
    for name in held:
        yield Connection(name, tuple(_sides_of(drawing, tables, name)), is_driven=False, is_held=True)


def _sides_of(drawing: Drawing, tables: Tables, name: str) -> Iterator[Side]:
    """Sides of the element that a measure belongs to; those of bodies and points are measured from the ground."""
    owner, *rest = name.split(".")
    element = drawing.elements[owner]
    if not isinstance(element, Body):
        yield from _sides(tables, element)
        return
    point = getattr(element, rest[0], None)
    if not isinstance(point, Point):
        point = getattr(element, "carrier", None) or Point(element, np.zeros(drawing.dimension))
    number, is_at_point = tables.number[bodies_of(element)[0].name], bool({"position", "velocity"} & {*rest})
    yield Side(0, None)
    yield Side(number, np.array(tables.place(point)[1]) if is_at_point else None)


def _sides(tables: Tables, element: Any) -> Iterator[Side]:
    for point in (element.first, element.second):
        number, place = tables.place(point)
        yield Side(number, np.array(place, dtype=float))
