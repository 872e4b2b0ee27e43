"""Contacts, stops and other constraints that switch, as defined."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .bodies import Point
from .immutable import Fixed
from .joints import Rolling
from .measures import Measure, scalar
from .numbers import AS_GIVEN, Numbers
from .switches import Switch, friction_with, of_friction


class Contact(Rolling):
    """Contact of a point or a round body with a line, `Mechanism.contact`.

    Attributes
    ----------
    name : str
    first, second : Point
        A point of the line, and the point or the centre of the round body.
    radius : float
        In m; 0: a point.
    restitution : float
        Coefficient of restitution.
    friction : tuple of float
        Coefficients of static and of sliding friction.
    """

    unswitched, switched = None, None
    kind, table = "contact", "rolling"
    takes = ("radius", "normal", "restitution", "friction")    # type: ignore[assignment]

    def __init__(self, name: str, first: Point, second: Point, radius: float, normal: np.ndarray, restitution: float,
                 friction: tuple[float, float]) -> None:
        super().__init__(name, first, second, radius, normal)
        self.restitution, self.friction = restitution, friction

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return {"radius": self.radius, "restitution": self.restitution, **of_friction("friction", self.friction)}

    def switches(self, numbers: Numbers) -> Iterator[Switch]:
        """Its switched constraints: the gap, and the slip."""
        yield Switch(self.name, "one-sided", restitution=numbers(self, "restitution", self.restitution))
        yield Switch(self.name, "friction" if any(self.friction) else "absent", component=1, normal=1,
                     friction=friction_with(numbers, self, "friction", self.friction))


class Stop(Fixed):
    """Limits of a measure, `Mechanism.stop`.

    Attributes
    ----------
    name : str
    of : str
        Name of the measure.
    lower, upper : float or None
    restitution : float
    """

    kind, unswitched = "stop", None
    force = scalar("force", "Force in N on its measure, a length, positive upward.")
    torque = scalar("torque", "Torque in N m on its measure, an angle, positive upward.")

    def __init__(self, name: str, of: str, lower: float | None, upper: float | None, restitution: float, effort: str) -> None:
        self.name, self.of, self.lower, self.upper, self.restitution, self.effort = name, of, lower, upper, restitution, effort

    @property
    def limits(self) -> dict[str, float]:
        """Limits by name."""
        return {word: value for word, value in (("lower", self.lower), ("upper", self.upper)) if value is not None}

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return {**self.limits, "restitution": self.restitution}

    def switches(self, numbers: Numbers) -> Iterator[Switch]:
        """A switched constraint for each limit, of one row."""
        restitution = numbers(self, "restitution", self.restitution)
        for word, value in self.limits.items():
            name = self.name if len(self.limits) == 1 else f"{self.name} {word}"
            yield Switch(name, "one-sided", along=self.of, sign=1 if word == "lower" else -1, value=numbers(self, word, value),
                         restitution=restitution)

    @property
    def measure(self) -> Measure:
        """Its force or torque."""
        return Measure(f"{self.name}.{self.effort}")

    def __repr__(self) -> str:
        return f"<stop {self.name}: {self.of}>"


class Latch(Fixed):
    """Events at which a joint is joined and released, `Mechanism.latch`.

    Attributes
    ----------
    name : str
    joint : str
        Name of the joint.
    when, until : str, Event or SymPy expression; None
        Quantities that pass through zero upward when it is joined, and when it is released.
    """

    kind = "latch"

    def __init__(self, name: str, joint: str, when: Any, until: Any) -> None:
        self.name, self.joint, self.when, self.until = name, joint, when, until

    def __repr__(self) -> str:
        return f"<latch {self.name}: {self.joint}>"


def switching(elements: Any) -> list[Any]:
    """Elements whose constraints are not all active at all times."""
    return [element for element in elements if isinstance(element, Contact | Stop) or getattr(element, "switched", None)]
