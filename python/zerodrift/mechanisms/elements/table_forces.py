"""Force elements without a class of their own: the entry of their kind in the core's table defines them."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from ..._gateway.mechanisms.plane import ElementKind, element_kinds
from . import columns
from .bodies import Point
from .immutable import Fixed
from .measures import scalar
from .numbers import AS_GIVEN, Numbers
from .user_functions import Law

ELEMENTS = element_kinds()
WRITTEN = "spring", "torsion_spring", "bushing", "force", "torque"      # kinds with a class in `forces.py`
IN_BOTH = {"distance", "along", "glide"}       # marker quantities that the plane and space have, with one axis
EFFORTS = {"force": "The force along its marker quantity, in N", "torque": "The moment along its marker quantity, in N m"}


class MadeForce(Fixed):
    """A force element between two points; verbs of `Mechanism` make it.

    Attributes
    ----------
    name : str
    first, second : Point
    values : dict of str to float
        Of springs: stiffness and damping of each marker quantity; ``length``, where it is given.
    law : Law or None
        The value of others.
    """

    kind = ""                           # name in the core's table
    row: ClassVar[ElementKind]          # entry in the core's table

    def __init_subclass__(cls) -> None:
        cls.row = ELEMENTS[cls.kind]
        if cls.row.measure:
            sign = "positive where it pulls" if cls.row.sign < 0 else "positive where it drives the marker quantity up"
            setattr(cls, cls.row.measure, scalar(cls.row.measure, f"{EFFORTS[cls.row.measure]}, {sign}."))

    def __init__(self, name: str, first: Point, second: Point, axis: np.ndarray | None, values: dict[str, float],
                 law: Law | None) -> None:
        self.name, self.first, self.second = name, first, second
        self.axis = axis        # (2,) or (3,), in the first body's frame
        self.values, self.law = values, law

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        return self.name

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self.first.dimension

    @classmethod
    def is_in_space(cls) -> bool:
        """True if the element exists in space, too: its marker quantities need no second direction."""
        return {quantity for quantity, _ in cls.row.quantities} <= IN_BOTH

    @classmethod
    def is_between_points(cls) -> bool:
        """True if the element acts along the distance of two points, so that its sides are points."""
        return {quantity for quantity, _ in cls.row.quantities} == {"distance"}

    @classmethod
    def has(cls, *quantities: str) -> bool:
        """True if the element has a marker quantity of one of these kinds."""
        return any(quantity in quantities for quantity, _ in cls.row.quantities)

    @classmethod
    def paths(cls, parameter: str) -> tuple[str, ...]:
        """Path of a parameter for each marker quantity, with its name if there are several."""
        several = len(cls.row.quantities) > 1
        return tuple(f"{parameter}.{quantity}" if several else parameter for quantity, _ in cls.row.quantities)

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        if self.law is None:
            return dict(self.values)
        return {} if self.law.constant is None else {"value": self.law.constant}

    def zero(self, which: str | None, numbers: Numbers) -> float:
        """Offset of a marker quantity: its value as drawn, or the given length."""
        apart = self.second.drawn_with(numbers) - self.first.drawn_with(numbers)
        if which == "along" and self.dimension == 3:
            return float(self.first.body.pose.local_direction(apart) @ self.axis)
        if which in ("along", "across"):
            (x, y), axis = self.first.body.pose.local_direction(apart), self.axis if which == "along" else _turned(self.axis)
            return columns.plain(x * axis[0] + y * axis[1])
        if which == "length":
            drawn = columns.hypot(*apart) if len(apart) == 2 else float(np.linalg.norm(apart))
            return numbers(self, "length", self.values.get("length", drawn))
        return self.second.body.pose.angle - self.first.body.pose.angle if which == "angle" else 0.0

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name}: {self.first.body.name} - {self.second.body.name}>"


def _turned(axis: np.ndarray) -> np.ndarray:
    """Vector, rotated counter-clockwise by a right angle."""
    return np.array([-axis[1], axis[0]])


def made_force(kind: str) -> type[MadeForce]:
    """Class of a kind of force element, from its entry in the core's table."""
    name = "".join(word.capitalize() for word in kind.split("_"))
    doc = f"{ELEMENTS[kind].card.summary} `Mechanism.{kind}`."
    return type(name, (MadeForce,), {"kind": kind, "__doc__": doc, "__module__": __name__})


# Kinds without a class in `forces.py`, by name. They are attributes of this module for pickle and copy.
FORCES_BY_ROW = {kind: made_force(kind) for kind in ELEMENTS if kind not in WRITTEN}
globals().update({force.__name__: force for force in FORCES_BY_ROW.values()})
