"""Joint coordinates that a start does not force: they stay as drawn, and their speeds zero.

Bodies hang on a tree of joints. A value that is held or driven forces the coordinates on the way between the bodies that it
measures, or its own coordinate alone where it is one. A joint that closes a loop, or a coupling, that contains a forced
coordinate forces the others in it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway.mechanisms.element_tables import OutputSpec, three
from ..._private.gateway.mechanisms.space import Quantity
from ..elements.bodies import Body, Point
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Motor
from ..elements.joints import Coupling, Joint
from ..elements.space_joints import SpaceJoint, speeds
from ..equations.measure_names import has_coordinate, is_rate
from ..equations.tables import Tables
from ..equations.tree import ends
from .joint_paths import Reach


class Coordinate(NamedTuple):
    """Joint coordinate, or several of one body: the body that it moves, and the measures of its positions and rates.

    `axis` is "x", "y" or "z" of a place, of which each is a coordinate; None: all components are meant. `joint` is that of a
    spherical joint, whose rotation is measured by cosines between the axes of its bodies.
    """

    body: int
    position: str
    rate: str
    axis: str | None = None
    joint: Joint | None = None


class Forced(NamedTuple):
    """Values that determine coordinates: names of measures, and elements whose whole path is determined."""

    measures: Sequence[str]
    elements: Sequence[Any]


class Unforced(NamedTuple):
    """Coordinates whose positions, whose rates, and whose rates without values of the start nothing determines."""

    positions: Sequence[Coordinate] = ()
    rates: Sequence[Coordinate] = ()
    rates_of_drives: Sequence[Coordinate] = ()


def is_driven(drawing: Drawing) -> bool:
    """True if a motor, an actuator or a user's constraint prescribes a motion."""
    drives = any(each.prescribes for each in drawing.of((Motor, Actuator)))
    return drives or any(each.law is not None for each in drawing.of(Coupling))


def is_forced(drawing: Drawing) -> bool:
    """True if the start depends on anything besides joints: held or wished values, drives, couplings."""
    return bool(drawing.held or drawing.wished or is_driven(drawing) or drawing.of(Coupling))


def unforced(drawing: Drawing, tables: Tables) -> Unforced:
    """Coordinates whose positions and rates held and wished values, drives and constraints do not determine."""
    if not is_forced(drawing):
        return Unforced()
    coordinates = _Coordinates(drawing, tables)
    given = [name for values in (drawing.held, drawing.wished) for name in values]
    rates = [name for name in given if is_rate(name, drawing.elements)]
    positions = [name for name in given if name not in rates]
    of = (positions, rates, ()) if is_driven(drawing) else (positions, rates)
    return Unforced(*(coordinates.unforced(_forced(drawing, each)) for each in of))


def rates_of_tree(drawing: Drawing, tables: Tables) -> dict[str, int]:
    """Measures of the rates of all joint coordinates, of spherical joints the angular velocity of the body; numbers of bodies."""
    return {f"{tables.parts[each.body - 1].name}.angular_velocity" if each.joint else each.rate: each.body
            for each in _Coordinates(drawing, tables).coordinates}


def names_of(coordinates: Iterable[Coordinate]) -> list[str]:
    """Names of the measures of positions and rates."""
    return [name for each in coordinates for name in (each.position, each.rate)]


def _forced(drawing: Drawing, given: Sequence[str]) -> Forced:
    held = [*given, *(f"{motor.joint.name}.{motor.coordinate}" for motor in drawing.of(Motor) if motor.prescribes)]
    moved = [each for each in drawing.of(Actuator) if each.prescribes]
    moved += [each for each in drawing.of(Coupling) if each.kind in ("constraint", "nonholonomic", "cam")]
    return Forced(held, moved)


class _Coordinates:
    """Joint coordinates of a mechanism, and the groups that move together."""

    def __init__(self, drawing: Drawing, tables: Tables) -> None:
        self.drawing, self.tables, self.inboard = drawing, tables, tables.tree(with_cut=True)
        self.reach = Reach(*self._edges())
        self.coordinates = list(self._all())

    def unforced(self, forced: Forced) -> list[Coordinate]:
        ways: set[int] = set()
        numbers = self._numbers()
        alone: set[int] = set()             # numbers of held or driven coordinates
        for name in forced.measures:
            own = numbers.get(name, ())
            alone |= set(own)
            ways |= set() if own else self._way_of(name)
        for element in forced.elements:
            ways |= self._way_of_element(element)
        moving = self.reach.moving_with(ways, {self.coordinates[i].body for i in alone}, self._couplings(numbers))
        return [each for i, each in enumerate(self.coordinates) if i not in alone and each.body not in moving]

    def _edges(self) -> tuple[list[int], list[tuple[int, int]]]:
        """Inboard joints and ends of joints, in which bodies are free that the ground guides in a plane."""
        pairs = [ends(joint, self.tables.number) for joint in self.tables.joints]
        guides = {i for i, joint in enumerate(self.tables.joints) if joint.kind == "planar" and 0 in pairs[i]}
        return ([-1 if joint in guides else joint for joint in self.inboard],
                [(max(each), max(each)) if i in guides else each for i, each in enumerate(pairs)])

    def _numbers(self) -> dict[str, list[int]]:
        """Numbers of the coordinates by the measures that are theirs or their rates."""
        numbers: dict[str, list[int]] = {}
        for i, each in enumerate(self.coordinates):
            for name in (each.position, each.rate):
                for measure in (name, f"{name}.{each.axis}"):
                    numbers.setdefault(measure, []).append(i)
        return numbers

    def _couplings(self, numbers: Collection[str]) -> Iterator[set[int]]:
        """Edges of couplings, of which one that fixes a coordinate alone has none, and of driven actuators."""
        for each in (*self.drawing.of(Coupling), *(each for each in self.drawing.of(Actuator) if each.prescribes)):
            is_alone = isinstance(each, Coupling) and len(each.of) == 1 and {*each.of} <= {*numbers}
            yield set() if is_alone else self._way_of_element(each)

    def _way_of_element(self, element: Any) -> set[int]:
        if isinstance(element, Coupling):
            return set().union(*(self._way_of(name) for name in element.of))
        numbers = [self.tables.number[body.name] for body in bodies_of(element)]
        return self.reach.between(*numbers) if len(numbers) == 2 else self.reach.between(0, numbers[0])

    def _way_of(self, name: str) -> set[int]:
        return self._way_of_element(self.drawing.elements[name.partition(".")[0]])

    def _all(self) -> Iterator[Coordinate]:
        for number, (body, inboard) in enumerate(zip(self.tables.parts, self.inboard, strict=True), 1):
            if inboard < 0:
                yield from _of_free(number, body, self.drawing.dimension)
            else:
                yield from _of_joint(number, body, self.tables.joints[inboard])
                if number in self.reach.free:
                    yield from _translations(number, body, self.drawing.dimension)


def _of_free(number: int, body: Body, dimension: int) -> Iterator[Coordinate]:
    yield from _translations(number, body, dimension)
    if body.turns:
        yield Coordinate(number, f"{body.name}.{'angle' if dimension == 2 else 'rotation'}", f"{body.name}.angular_velocity")


def _translations(number: int, body: Body, dimension: int) -> Iterator[Coordinate]:
    for axis in "xyz"[:dimension]:
        yield Coordinate(number, f"{body.name}.position", f"{body.name}.velocity", axis)


def _of_joint(number: int, body: Body, joint: Joint) -> Iterator[Coordinate]:
    if not isinstance(joint, SpaceJoint):
        if has_coordinate(joint):
            yield Coordinate(number, f"{joint.name}.{joint.coordinate}", f"{joint.name}.speed")
        return
    for speed, coordinate in speeds(joint.row).items():
        yield Coordinate(number, f"{joint.name}.{coordinate}", f"{joint.name}.{speed}")
    if body.turns and any(each.kind == "swings" for each in joint.row.freedoms or ()):
        yield Coordinate(number, f"{joint.name} swings", f"{joint.name} swings at", joint=joint)


def bodies_of(element: Any) -> tuple[Body, ...]:
    """Bodies that an element is, belongs to, or joins."""
    if isinstance(element, Body):
        attachment = getattr(element, "attachment", None)     # the point of a body of which a particle is part
        return (element if attachment is None else attachment.body,)
    if isinstance(element, Point):
        return (element.body,)
    return element.bodies if isinstance(element, Joint) else (element.first.body, element.second.body)


def swings(tables: Tables, coordinates: Iterable[Coordinate], first: int) -> tuple[list[Quantity], list[OutputSpec]]:
    """Marker quantities, numbered from `first`, and measures of the rotations of spherical joints."""
    quantities: list[Quantity] = []
    observed: list[OutputSpec] = []
    for each in coordinates:
        if each.joint is None:
            continue
        first_body, second_body = ends(each.joint, tables.number)
        cosines = [Quantity("cosine", first_body, second_body, a=three(a), b=three(b)) for a in np.eye(3) for b in np.eye(3)]
        for name, unit, quantity in ((each.position, "", "values"), (each.rate, "1/s", "rates")):
            observed.append(OutputSpec(name, unit, quantity, first + len(quantities), len(cosines)))
        quantities += cosines
    return quantities, observed
