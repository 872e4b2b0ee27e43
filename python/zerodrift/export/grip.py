"""Grip of a block: a force on a point of a body, which a page moves from body to body to pull them by the pointer.

Its inputs are ``grip.force.x``, ``grip.force.y`` and in space ``grip.force.z``, in N. Its parameters are the body's number
``grip.body``, and the point relative to the mass centre in the body's axes, ``grip.x`` and so on. Its measure
``grip.acceleration`` is that of the point, from which follows how heavy it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from .._private.gateway.mechanisms import blocks, plane, space
from .._private.gateway.mechanisms.element_tables import GeneralizedForce, OutputSpec
from .._private.rotations import AXES

BODY, POINT = 2, {2: 5, 3: 6}       # places in a marker quantity: the second body, and its point
FAR = 1e9                           # m: limit of the point's coordinates


class Grip(NamedTuple):
    """Grip of a mechanism whose tables have these numbers of marker quantities and forces without it."""

    dimension: int
    quantities: int
    forces: int
    bodies: int

    @property
    def axes(self) -> str:
        return AXES[:self.dimension]

    def added(self, packed: Any) -> Any:
        """Tables with the grip's marker quantities and forces."""
        make = (space if self.dimension == 3 else plane).Quantity
        forces = [GeneralizedForce("constant", self.quantities + i) for i in range(self.dimension)]
        return packed._replace(quantities=[*packed.quantities, *(make(axis, 0, 1) for axis in self.axes)],
                               forces=[*packed.forces, *forces])

    @property
    def measure(self) -> OutputSpec:
        return OutputSpec("grip.acceleration", "m/s^2", "accelerations", self.quantities, self.dimension)

    def inputs(self, texts: blocks.Texts) -> list[float]:
        """Entries of the section of inputs."""
        return [number for i, axis in enumerate(self.axes) for number in
                (texts.offset(f"grip.force.{axis}"), texts.offset("N"), blocks.INPUTS["force"], self.forces + i, 0.0)]

    def parameters(self, texts: blocks.Texts) -> list[float]:
        """Entries of the section of parameters."""
        body = [texts.offset("grip.body"), texts.offset(""), 1.0, 1.0, float(self.bodies)]
        return [*body, *(number for axis in self.axes for number in
                         (texts.offset(f"grip.{axis}"), texts.offset("m"), 0.0, -FAR, FAR))]

    def effects(self, begin: int, width: int, first: int, product: int) -> tuple[list[float], list[float]]:
        """Sections of effects and products.

        Parameters
        ----------
        begin, width : int
            Place of the first marker quantity in the block, and words of each.
        first, product : int
            Numbers of the grip's first parameter and product.
        """
        found: list[float] = []
        for i in range(self.dimension):
            own = begin + (self.quantities + i) * width
            places: Sequence[int] = (BODY, *range(POINT[self.dimension], POINT[self.dimension] + self.dimension))
            found += [number for k, place in enumerate(places) for number in (own + place, product + k, 1)]
        return found, [number for k in range(1 + self.dimension) for number in (1.0, first + k, 1, 0, 0, 0, 0)]
