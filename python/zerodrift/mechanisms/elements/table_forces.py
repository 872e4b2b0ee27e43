"""Force elements: the entry of a kind in the core's tables, of the plane and of space, defines its parameters and measures."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from ..._private.gateway.mechanisms import plane, space
from ..._private.gateway.mechanisms.element_tables import ElementKind, ElementQuantity
from ..._private.rotations import AXES
from . import columns
from .bodies import Body, Point
from .immutable import Fixed
from .joints import Joint, class_of
from .measures import Measure, scalar, vector
from .numbers import AS_GIVEN, Numbers
from .user_functions import Law

ELEMENTS, SPACE_ELEMENTS = plane.element_kinds(), space.element_kinds()
WRITTEN = "spring", "torsion_spring", "bushing", "force", "torque"      # kinds with a class in `forces.py`
ROTATIONS = {"angle", "rotation", "spin", "turn"}       # marker quantities in rad or rad/s
UNITS = {"force": "N", "torque": "N m"}

# ---- what an entry defines ----


def has(entry: ElementKind, *kinds: str) -> bool:
    """True if the element acts along a marker quantity of one of these kinds."""
    return any(quantity.kind in kinds for quantity in entry.quantities)


def lengths(entry: ElementKind) -> int:
    """Number of marker quantities in m, which stand before those in rad."""
    return sum(quantity.kind not in ROTATIONS for quantity in entry.quantities)


def is_between_points(entry: ElementKind) -> bool:
    """True if the element acts along the distance of two points, so that its sides are points."""
    return {quantity.kind for quantity in entry.quantities} == {"distance"}


def paths(entry: ElementKind) -> tuple[tuple[str, ...], ...]:
    """Paths of stiffness, damping, law and value for each marker quantity; angles beside lengths have names of their own."""
    along = "stiffness", "damping", "force", "displacement"
    about = ("torsion", "torsion_damping", "torque", "angle") if lengths(entry) else along
    groups = (along, lengths(entry)), (about, len(entry.quantities) - lengths(entry))
    return tuple(tuple(f"{word}.{axis}" if size > 1 else word for word in words)
                 for words, size in groups for axis in AXES[:size])


def parameters(entry: ElementKind) -> dict[str, tuple[str, ...]]:
    """Parameters of a spring, each with its paths: one for each marker quantity that it belongs to."""
    found: dict[str, tuple[str, ...]] = {}
    if not entry.is_spring:
        return found
    for each in paths(entry):
        for path in each[:2]:
            word = path.partition(".")[0]
            found[word] = (*found.get(word, ()), path)
    slack = "angle" if entry.at_joint else "length" if any(each.zero == "length" for each in entry.quantities) else None
    return {"stiffness": found.pop("stiffness"), **({slack: (slack,)} if slack else {}), **found}


def law_words(entry: ElementKind) -> tuple[str, ...]:
    """Arguments that take the law of an element: "force" or "torque" of a spring, both of a bushing, "value" of others."""
    return ((entry.measure,) if entry.measure else ("force", "torque")) if entry.is_spring else ("value",)


LENGTH = {"length": scalar("length", "The distance of its ends, in m."),
          "speed": scalar("speed", "The rate of `length`, in m/s.")}


def _measures(entry: ElementKind) -> dict[str, Any]:
    """Measures of an element."""
    if entry.measure is None:
        found: dict[str, Any] = {
            "force": vector("force", "Force of the first body on the second, at the second's point, in the drawing's axes, "
                            "in N."),
            "torque": vector("torque", "The moment that the first body exerts on the second, about the second's point, in N m; "
                             "in space a vector in the drawing's axes.", Measure),
            "displacement": vector("displacement", "Displacement of the second body's point along its directions, in m."),
            "velocity": vector("velocity", "The rate of `displacement`, in m/s."),
            "angle": vector("angle", "Angle of the second body against the first, in rad; in space the components of the "
                            "rotation vector along its directions.", Measure),
            "angular_velocity": vector("angular_velocity", "Angular velocity of the second body against the first, in rad/s; "
                                       "in space along its directions.", Measure),
            "laws": MappingProxyType({})}       # by path, such as "force.x"
    else:
        where = ("what acts on the joint's second body" if entry.at_joint else "positive where it pulls, its damping included"
                 if entry.sign < 0 else "positive where it drives the marker quantity up")
        found = {entry.measure: scalar(entry.measure, f"Its {entry.measure} in {UNITS[entry.measure]}, {where}.")}
    return {**found, **LENGTH} if has(entry, "distance") else found


# ---- elements ----


class TableForce(Fixed):
    """A force element; methods of `Mechanism` make it.

    Attributes
    ----------
    name : str
    first, second : Point or None
        The points it acts between; None of those on a joint, and of forces and torques on one body.
    joint : Joint or None
        The joint it acts on.
    values : dict of str to float
        Parameters of a spring by path; ``length`` only if it is given.
    law : Law or None
        The force or torque of an element that is not a spring, or of a spring in the place of its stiffness.
    drives : str
        Argument that takes its law: "stiffness" of a spring, or one of `law_words`.
    axis : ndarray (2,) or None
        In the plane, in the first body's frame.
    frames : tuple of ndarray (3, 3), or None
        In space: its directions as rows, in the frame of the first body and of the second.
    which : str or None
        The angle of a joint with several on which it acts.
    coupled : ndarray (6, 6) or None
        Stiffness of a bushing in space between its directions; the diagonal, which is in `values`, is zero.
    """

    kind = ""                                       # name in the core's tables
    entries: ClassVar[dict[int, ElementKind]]       # entries of the tables by dimension
    drives: str
    coordinate: ClassVar[str | None] = None         # "length" of an element between two points
    first: Any = None
    second: Any = None
    joint: Joint | None = None
    law: Law | None = None
    values: Mapping[str, float] = MappingProxyType({})
    axis: np.ndarray | None = None
    frames: Any = None
    which: str | None = None
    coupled: np.ndarray | None = None

    def __init_subclass__(cls) -> None:
        """Sets measures that the class does not define, from the entries of the core's tables."""
        tables = {2: ELEMENTS, 3: SPACE_ELEMENTS}
        cls.entries = {dimension: table[cls.kind] for dimension, table in tables.items() if cls.kind in table}
        for entry in cls.entries.values():
            cls.coordinate, cls.drives = "length" if has(entry, "distance") else None, "stiffness" if entry.is_spring else "value"
            for name, measure in _measures(entry).items():
                setattr(cls, name, measure)

    def __init__(self, name: str, *sides: Any, values: dict[str, float], axis: np.ndarray | None = None,
                 frames: Any = None, which: str | None = None, coupled: np.ndarray | None = None) -> None:
        self.name, self.which, self.coupled = name, which, coupled
        if len(sides) == 1:
            self.joint, = sides
        else:
            self.first, self.second = sides
        self._keep(values)
        self.axis, self.frames = axis, frames

    def _keep(self, values: dict[str, float]) -> None:
        self.values = values

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return (self.first if self.joint is None else self.joint).dimension

    @property
    def row(self) -> ElementKind:
        """Entry in the core's table."""
        return self.entries[self.dimension]

    @property
    def ends(self) -> tuple[Body | Point, Body | Point]:
        """Points or bodies that its marker quantities belong to."""
        return (self.first, self.second) if self.joint is None else self.joint.bodies

    axes_of = property(lambda self: getattr(self.ends[0], "body", self.ends[0]), doc="Body in whose axes its directions are.")
    parts = property(lambda self: (self,), doc="It, and what acts with it by the same law.")

    @property
    def quantities(self) -> tuple[ElementQuantity, ...]:
        """Marker quantities it acts along."""
        return self.row.quantities

    def own(self, acting: str, value: str) -> str:
        """Measure along which a law acts, with the `value` of `paths`; empty for a stiffness, and without a spring."""
        if not self.row.is_spring or acting == "stiffness":
            return ""
        of = self.which or "angle" if self.joint else "length" if self.row.measure else value.replace("angle", "turn")
        return f"{(self.joint or self).name}.{of}"

    def length_with(self, numbers: Numbers) -> float:
        """Unstressed length; if not given, the distance in the drawing."""
        apart = self.second.drawn_with(numbers) - self.first.drawn_with(numbers)
        drawn = columns.hypot(*apart) if len(apart) == 2 else float(np.linalg.norm(apart))
        return numbers(self, "length", self.values.get("length", drawn))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return self.constants | {path: self.length_with(now) if path == "length" else self.values[path]
                      for word, each in parameters(self.row).items() for path in each
                      if path in self.values or (path == "length" and self.drives == "stiffness")}

    def given(self) -> dict[str, Any]:
        """Parameters of a spring as its method takes them: a number, or one for each marker quantity."""
        words = {word: [self.values[path] for path in each if path in self.values] for word, each in parameters(self.row).items()}
        given = {word: values if len(values) > 1 else values[0] for word, values in words.items() if values}
        return given if self.coupled is None else {**given, "coupled": self.coupled.tolist()}

    def zero(self, quantity: ElementQuantity, numbers: Numbers) -> float:
        """Offset of a marker quantity: its value as drawn, or the length or angle at which the element is slack."""
        if self.joint is not None:
            drawn = self.joint.angle_as_drawn() if quantity.zero == "angle" else 0.0
            return drawn + numbers(self, "angle", self.values.get("angle", 0.0))
        if quantity.zero == "length":
            return self.length_with(numbers)
        if quantity.zero == "angle":
            return self.second.body.pose.angle - self.first.body.pose.angle
        if quantity.zero is None:
            return 0.0
        apart = self.first.body.pose.local_direction(self.second.drawn_with(numbers) - self.first.drawn_with(numbers))
        if self.frames is not None:
            return float((self.frames[0] @ apart)[quantity.of_first])
        x, y = (1.0, 0.0) if self.axis is None else self.axis
        return columns.plain(apart[0] * x + apart[1] * y if quantity.zero == "along" else apart[1] * x - apart[0] * y)

    def __repr__(self) -> str:
        where = f": {self.first.body.name} - {self.second.body.name}" if self.joint is None else f" at {placed(self)}"
        return f"<{self.kind.replace('_', ' ')} {self.name}{where}>"


def placed(element: Any) -> str:
    """Name of the joint on which a motor or a spring acts, with that of the angle where it has several."""
    return element.joint.name if element.which is None else f"{element.joint.name}.{element.which}"


def made_force(kind: str) -> type[TableForce]:
    """Class of a kind of force element, from its entries in the core's tables."""
    return class_of(TableForce, kind, (ELEMENTS | SPACE_ELEMENTS)[kind])


# Kinds without a class in `forces.py`, by name. They are attributes of this module for pickle and copy.
FORCES_OF_TABLE = {kind: made_force(kind) for kind in ELEMENTS | SPACE_ELEMENTS if kind not in WRITTEN}
globals().update({force.__name__: force for force in FORCES_OF_TABLE.values()})
