"""Drives and forces, as defined."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ... import _check
from ...errors import WrongValue
from . import columns
from .bodies import Body, Point
from .immutable import Fixed, amend
from .joints import Joint
from .measures import scalar, vector
from .numbers import AS_GIVEN, Numbers
from .user_functions import InputLaw, Law


class Motor(Fixed):
    """A drive of a joint, `Mechanism.motor`.

    Attributes
    ----------
    name : str
    joint : Joint
    drives : str
        "angle", "displacement", "speed", "torque" or "force".
    law : Law
    """

    kind = "motor"
    torque = scalar("torque", "The motor's part of the joint's torque, positive where it drives the angle up, in N m.")
    force = scalar("force", "The motor's part of the joint's force, positive where it drives the displacement up, in N.")
    power = scalar("power", "The power that it puts in, in W.")

    def __init__(self, name: str, joint: Joint, drives: str, law: Law) -> None:
        self.name, self.joint, self.drives, self.law = name, joint, drives, law

    @property
    def coordinate(self) -> str:
        """Coordinate of the joint that it drives, "angle" or "displacement"."""
        return self.joint.coordinate or {"torque": "angle", "force": "displacement"}.get(self.drives, self.drives)

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        return self.name

    @property
    def prescribes(self) -> bool:
        """True if it prescribes a motion, by a driving constraint; False if it prescribes a torque or force."""
        return self.drives not in ("torque", "force")

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        return {} if self.law.constant is None else {self.drives: self.law.constant}

    def __repr__(self) -> str:
        return f"<motor {self.name}: {self.drives} of {self.joint.name}>"


class Actuator(Fixed):
    """A cylinder or a linear drive between two points, `Mechanism.actuator`.

    Attributes
    ----------
    name : str
    first, second : Point
    drives : str
        "length" or "force".
    law : Law
    """

    kind, coordinate = "actuator", "length"
    length = scalar("length", "The distance of its ends, in m.")
    speed = scalar("speed", "The rate of `length`, in m/s.")
    force = scalar("force", "The force with which it pushes its ends apart, in N.")
    power = scalar("power", "The power that it puts in, in W.")

    def __init__(self, name: str, first: Point, second: Point, drives: str, law: Law) -> None:
        self.name, self.first, self.second, self.drives, self.law = name, first, second, drives, law

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self.first.dimension

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        return self.name

    @property
    def prescribes(self) -> bool:
        """True if it prescribes the length, by a driving constraint; False if it prescribes the force."""
        return self.drives == "length"

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        return {} if self.law.constant is None else {self.drives: self.law.constant}

    def __repr__(self) -> str:
        return f"<actuator {self.name}: {self.drives} between {self.first.body.name} and {self.second.body.name}>"


class Spring(Fixed):
    """A spring with a damper between two points, `Mechanism.spring`."""

    kind = "spring"
    force = scalar("force", "Its tension, the damper's included, positive where it pulls, in N.")
    length = scalar("length", "The distance of its ends, in m.")

    def __init__(self, name: str, first: Point, second: Point, stiffness: float, free_length: float | None,
                 damping: float) -> None:
        self.name, self.first, self.second = name, first, second
        self.stiffness, self.free_length, self.damping = stiffness, free_length, damping

    @classmethod
    def from_values(cls, name: str, first: Point, second: Point, axis: None, values: dict[str, float], law: None) -> Spring:
        """A spring from the arguments of elements that the core's table describes."""
        return cls(name, first, second, values["stiffness"], values.get("length"), values["damping"])

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self.first.dimension

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        return self.name

    def free_length_with(self, numbers: Numbers) -> float:
        """Unstressed length; if not given, the distance in the drawing."""
        apart = self.second.drawn_with(numbers) - self.first.drawn_with(numbers)
        drawn = columns.hypot(*apart) if len(apart) == 2 else float(np.linalg.norm(apart))
        return numbers(self, "length", drawn if self.free_length is None else self.free_length)

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        return {"stiffness": self.stiffness, "length": self.free_length_with(now), "damping": self.damping}

    def __repr__(self) -> str:
        return f"<spring {self.name}: {self.first.body.name} - {self.second.body.name}>"


class TorsionSpring(Fixed):
    """A spring with a damper about a joint, `Mechanism.torsion_spring`."""

    kind = "torsion_spring"
    torque = scalar("torque", "What acts on the joint's second body, in N m.")

    def __init__(self, name: str, joint: Joint, stiffness: float, angle: float, damping: float) -> None:
        self.name, self.joint, self.stiffness, self.angle, self.damping = name, joint, stiffness, angle, damping

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        return self.name

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        return {"stiffness": self.stiffness, "angle": self.angle, "damping": self.damping}

    def __repr__(self) -> str:
        return f"<torsion spring {self.name} at {self.joint.name}>"


class Bushing(Fixed):
    """A soft joint: springs and dampers along and about a frame of the first body, `Mechanism.bushing`."""

    kind = "bushing"
    force = vector("force", "What the first body does to the second, at the second's point, in the drawing's axes, in N.")
    torque = scalar("torque", "The moment that the first body exerts on the second, about the second's point, in N m.")

    def __init__(self, name: str, first: Point, second: Point, values: dict[str, float]) -> None:
        self.name, self.first, self.second, self.values = name, first, second, values

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        return self.name

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        return dict(self.values)

    def __repr__(self) -> str:
        return f"<bushing {self.name}: {self.first.body.name} - {self.second.body.name}>"


class SpaceBushing(Bushing):
    """A soft joint in space: springs and dampers along and about three directions of the first body, `Mechanism.bushing`.

    Attributes
    ----------
    frames : tuple of ndarray (3, 3)
        The rows are these directions, in the frame of the first body and of the second.
    """

    torque = vector("torque", "The moment that the first body exerts on the second, about the second's point, in the drawing's "
                    "axes, in N m.")

    def __init__(self, name: str, first: Point, second: Point, values: dict[str, float],
                 frames: tuple[np.ndarray, np.ndarray]) -> None:
        super().__init__(name, first, second, values)
        self.frames = frames


class Force(Fixed):
    """A force at a point along a direction, `Mechanism.force`."""

    kind = "force"

    def __init__(self, name: str, point: Point, along: np.ndarray, frame: Body, law: Law) -> None:
        self.name, self.point, self.along, self.frame, self.law = name, point, along, frame, law

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        return {} if self.law.constant is None else {"value": self.law.constant}

    def __repr__(self) -> str:
        return f"<force {self.name} at {self.point.body.name}>"


class Torque(Fixed):
    """A moment on a body, `Mechanism.torque`; in space about an axis (3,) of `frame`, or of `against` where that is a body."""

    kind = "torque"

    def __init__(self, name: str, body: Body, against: Body, law: Law, *, axis: np.ndarray | None = None,
                 frame: Body | None = None) -> None:
        self.name, self.body, self.against, self.law, self.axis, self.frame = name, body, against, law, axis, frame

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters, by the quantity in their paths ``name.quantity``."""
        return {} if self.law.constant is None else {"value": self.law.constant}

    def __repr__(self) -> str:
        return f"<torque {self.name} on {self.body.name}>"


# ---- inputs ----

UNITS = {"torque": "N m", "force": "N"}


class Driven(NamedTuple):
    """A drawing with inputs, their initial values and their units."""

    drawing: Any
    initial: list[float]
    units: list[str]


def driven(drawing: Any, names: Sequence[str], changed: Mapping[str, float]) -> Driven:
    """The drawing whose user functions of these names are inputs; `changed` are parameters with other values."""
    elements, parameters, initial, units = dict(drawing.elements), dict(drawing.parameters), [], []
    known = inputs_of(drawing)
    for name in names:
        if name not in known:
            raise WrongValue(f"inputs must name a torque, force or speed of {drawing.name}, not {name!r}{_hint(drawing, name)}; "
                             f"{_check.closest(name, known) if known else 'it has no motor, actuator or load'}")
        element, quantity, path = known[name]
        if element.law.constant is None:
            raise WrongValue(f"input {name!r} must begin with a number: give {element.kind} {element.name!r} one, such as 0.0, "
                             "in the place of its function")
        law = InputLaw(name, float(changed.get(path, element.law.constant)), is_speed=quantity == "speed")
        elements[element.name] = mine = copy.copy(element)
        amend(mine, law=law)
        parameters |= law.numbers
        initial.append(law.initial)
        units.append(UNITS.get(quantity) or ("rad/s" if element.coordinate == "angle" else "m/s"))
    return Driven(drawing._replace(elements=elements, parameters=parameters), initial, units)


def inputs_of(drawing: Any) -> dict[str, tuple[Any, str, str]]:
    """Possible inputs by name: the element, the quantity, and the path of the number."""
    found = {}
    for element in drawing.of((Motor, Actuator)):
        if element.drives in ("torque", "force", "speed"):
            path = f"{element.name}.{element.drives}"
            found[path] = element, element.drives, path
    for kind, quantity in ((Force, "force"), (Torque, "torque")):
        for element in drawing.of(kind):
            found[f"{element.name}.{quantity}"] = element, quantity, f"{element.name}.value"
    return found


def _hint(drawing: Any, name: str) -> str:
    """Reason why a name is not that of an input, if its element exists."""
    element = drawing.elements.get(name.partition(".")[0]) if isinstance(name, str) else None
    if isinstance(element, Motor | Actuator) and element.prescribes:
        return f": {element.kind} {element.name!r} prescribes its {element.drives}, and its force follows from that"
    return ""
