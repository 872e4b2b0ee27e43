"""Constraints that switch, as entries of the core's table of groups; dry friction of joints, and whether they are joined."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from .numbers import Numbers


class Switch(NamedTuple):
    """Constraints of an element that are switched together: an entry of the core's table of groups."""

    name: str
    kind: str                   # "one-sided", "friction" or "two-sided"; "absent": rows that are never active
    along: str = ""             # measure of whose value they are a row
    coupling: str = ""          # name of the coupling that they are a row of; "" as well: they are rows of the joint
    component: int = 0
    rows: int = 1
    sign: int = 1
    value: float = 0.0
    is_active: bool = False
    normal: int = 0             # 1 + index of the one-sided switch of the element that bounds the friction
    loads: tuple[float, ...] = ()       # factors of the multipliers of the joint's first rows, whose norm bounds it otherwise
    at_ends: bool = False       # True: of their halves F and M, |F + M| + |F - M| does
    restitution: float = 0.0
    friction: tuple[float, float] = (0.0, 0.0)
    opposite: int = 0           # index of the switch of the opposite side of the shape, relative to this one; 0: none


def of_friction(word: str, values: tuple[float, float]) -> dict[str, float]:
    """Friction as parameters: one number, or a static one besides."""
    static, sliding = values
    return {word: sliding} if static == sliding else {f"static_{word}": static, word: sliding}


def friction_with(numbers: Numbers, element: Any, word: str, values: tuple[float, float]) -> tuple[float, float]:
    """Static and sliding friction, with parameters that may have been changed."""
    sliding = numbers(element, word, values[1])
    return sliding if values[0] == values[1] else numbers(element, f"static_{word}", values[0]), sliding


class Switched(NamedTuple):
    """Switched parts of a joint: the joint itself, and dry friction along its coordinate."""

    active: bool | None = None              # True or False: it is joined at the start; it can be released and joined
    bounds: tuple[float, float] | None = None       # static and sliding friction in N or N m
    friction: tuple[float, float] | None = None     # coefficients of the load
    radius: float = 0.0                     # m: of a pin
    guide: float | None = None              # m: length of the guide of a slider

    @property
    def needs_rows(self) -> bool:
        """True if the joint must be constraints, not coordinates."""
        return self.active is not None or self.friction is not None

    def of_bounds(self, joint: Any) -> str:
        """Argument of the joint's verb for its bounds."""
        return "friction_torque" if joint.coordinate == "angle" else "friction_force"

    def given(self, joint: Any) -> dict[str, Any]:
        """Arguments of the joint's verb."""
        words = {"active": self.active, self.of_bounds(joint): self.bounds, "friction": self.friction,
                 "radius": self.radius or None, "guide": self.guide}
        return {word: value for word, value in words.items() if value is not None}

    def numbers(self, joint: Any) -> dict[str, float]:
        """Friction as parameters."""
        bounds = of_friction(self.of_bounds(joint), self.bounds) if self.bounds else {}
        return {**bounds, **(of_friction("friction", self.friction) if self.friction else {})}

    def switches(self, joint: Any, numbers: Numbers) -> Iterator[Switch]:
        """Switched constraints of the joint."""
        if self.active is not None:
            yield Switch(joint.name, "two-sided", rows=len(joint.row.rows), is_active=self.active)
        along = f"{joint.name}.{joint.coordinate}"
        if self.bounds:
            bounds = friction_with(numbers, joint, self.of_bounds(joint), self.bounds)
            yield Switch(joint.name, "friction", along, friction=bounds)
        friction = friction_with(numbers, joint, "friction", self.friction) if self.friction else (0.0, 0.0)
        if self.friction and joint.coordinate == "angle":       # of the radial force, by the multipliers of the pin
            yield Switch(joint.name, "friction", along, friction=friction, loads=(self.radius, self.radius))
        elif self.friction:             # |F|, or at the ends of a guide |F/2 + M/l| + |F/2 - M/l|
            across = joint.dimension - 1        # directions
            loads = (1.0,) * across if self.guide is None else (0.5,) * across + (1 / self.guide,) * across
            yield Switch(joint.name, "friction", along, friction=friction, loads=loads, at_ends=self.guide is not None)
