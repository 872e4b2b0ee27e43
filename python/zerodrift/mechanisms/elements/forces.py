"""Drives and forces, as defined."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple, cast

import numpy as np

from ..._private import checks
from ..._private.gateway.mechanisms.element_tables import ElementQuantity
from ...errors import WrongValue
from .bodies import Body, Point
from .immutable import Fixed, amend
from .joints import Joint
from .measures import scalar
from .numbers import AS_GIVEN, Numbers
from .table_forces import UNITS, TableForce, placed
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
    which : str or None
        "angle1" or "angle2" of a universal joint.
    """

    kind = "motor"
    torque = scalar("torque", "The motor's part of the joint's torque, positive where it drives the angle up, in N m.")
    force = scalar("force", "The motor's part of the joint's force, positive where it drives the displacement up, in N.")
    power = scalar("power", "The power that it puts in, in W.")

    def __init__(self, name: str, joint: Joint, drives: str, law: Law, which: str | None = None) -> None:
        self.name, self.joint, self.drives, self.law, self.which = name, joint, drives, law, which

    @property
    def coordinate(self) -> str:
        """Coordinate of the joint that it drives, "angle" or "displacement", or one of two angles."""
        return self.which or self.joint.coordinate or {"torque": "angle", "force": "displacement"}.get(self.drives, self.drives)

    @property
    def prescribes(self) -> bool:
        """True if it prescribes a motion, by a driving constraint; False if it prescribes a torque or force."""
        return self.drives not in ("torque", "force")

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return self.constants

    def __repr__(self) -> str:
        return f"<motor {self.name}: {self.drives} of {placed(self)}>"


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

    def __init__(self, name: str, first: Point, second: Point, drives: str, law: Any) -> None:
        self.name, self.first, self.second, self.drives, self.law = name, first, second, drives, law

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self.first.dimension

    @property
    def prescribes(self) -> bool:
        """True if it prescribes the length, by a driving constraint; False if it prescribes the force."""
        return self.drives == "length"

    @property
    def idle(self) -> Actuator:
        """The same without force."""
        return Actuator(self.name, self.first, self.second, "force", Law("force", 0.0))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return self.constants

    def __repr__(self) -> str:
        return f"<actuator {self.name}: {self.drives} between {self.first.body.name} and {self.second.body.name}>"


class StoredSpring(TableForce):
    """Spring whose parameters are attributes; `stored` has their names by path."""

    stored: ClassVar[dict[str, str]] = {}

    def _keep(self, values: dict[str, float]) -> None:
        for path, name in self.stored.items():
            setattr(self, name, values.get(path))

    @property
    def values(self) -> dict[str, float]:       # type: ignore[override]
        """Parameters by path; ``length`` only if it is given."""
        given = {path: getattr(self, name) for path, name in self.stored.items()}
        return {path: value for path, value in given.items() if value is not None}


class Spring(StoredSpring):
    """A spring with a damper between two points, `Mechanism.spring`."""

    kind, stored = "spring", {"stiffness": "stiffness", "length": "free_length", "damping": "damping"}


class TorsionSpring(StoredSpring):
    """A spring with a damper about a joint, `Mechanism.torsion_spring`."""

    kind, stored = "torsion_spring", {"stiffness": "stiffness", "angle": "angle", "damping": "damping"}


class Bushing(TableForce):
    """A soft joint: springs and dampers along and about directions of the first body, `Mechanism.bushing`."""

    kind = "bushing"


class Force(TableForce):
    """A force at a point along a direction, `Mechanism.force`.

    Attributes
    ----------
    point : Point
    along : ndarray (2,) or (3,)
        Its direction in the axes of `frame`.
    frame : Body
    law : Law
    against : Body, Point or None
        On which the opposite acts: on a body at the same place, or at a point; None: the ground.
    """

    kind = "force"

    def __init__(self, name: str, point: Point, along: np.ndarray, frame: Body, law: Law,
                 against: Body | Point | None = None) -> None:
        self.name, self.point, self.along, self.frame, self.law, self.against = name, point, along, frame, law, against

    axis = property(lambda self: self.along, doc="Its direction in the axes of `frame`.")
    frames = property(lambda self: (self.along[None], None), doc="The same as a row.")
    dimension = property(lambda self: self.point.dimension, doc="2 in the plane, 3 in space.")
    axes_of = property(lambda self: self.frame, doc="The body of its direction.")

    @property
    def ends(self) -> tuple[Body, Point]:
        """The body of the direction, or the one that gets the opposite force at the same place, and the point."""
        return self.against if isinstance(self.against, Body) else self.frame, self.point

    @property
    def quantities(self) -> tuple[ElementQuantity, ...]:
        """Marker quantities it acts along."""
        if not isinstance(self.against, Body):
            return self.row.quantities
        return tuple(each._replace(kind="along" if self.frame is self.against else "shear") for each in self.row.quantities)

    @property
    def parts(self) -> tuple[Force, ...]:
        """The force, and the opposite one at a point of another body."""
        point, law = self.against, cast(Law, self.law)
        return (self, Force(self.name, point, -self.along, self.frame, law)) if isinstance(point, Point) else (self,)

    def __repr__(self) -> str:
        return f"<force {self.name} at {self.point.body.name}>"


class Gravity(Fixed):
    """Gravity that user functions give.

    Attributes
    ----------
    laws : dict of str to Law
        Components in m/s^2 in the drawing's axes, by axis.
    """

    kind = name = "gravity"
    laws: Mapping[str, Law] = MappingProxyType({})

    def __init__(self, laws: Mapping[str, Law]) -> None:
        self.laws = laws


class Torque(TableForce):
    """A moment on a body, `Mechanism.torque`; in space about an axis (3,) of `frame`, or of `against` where that is a body."""

    kind = "torque"

    def __init__(self, name: str, body: Body, against: Body, law: Law, *, axis: np.ndarray | None = None,
                 frame: Body | None = None) -> None:
        self.name, self.body, self.against, self.law, self.axis, self.frame = name, body, against, law, axis, frame

    frames = property(lambda self: (self.axis[None], None), doc="Its axis as a row.")
    dimension = property(lambda self: self.body.dimension, doc="2 in the plane, 3 in space.")

    @property
    def ends(self) -> tuple[Body, Body]:
        """The body of the axis, which gets the opposite moment unless it is `frame`, and the body that the moment acts on."""
        return self.frame if self.frame and self._is_alone() else self.against, self.body

    @property
    def quantities(self) -> tuple[ElementQuantity, ...]:
        """Marker quantities it acts along: without a reaction that is the rotation of its body alone."""
        return tuple(each._replace(kind="spin") for each in self.row.quantities) if self._is_alone() else self.row.quantities

    def _is_alone(self) -> bool:
        return self.frame is not None and self.against.name == "ground"

    def __repr__(self) -> str:
        return f"<torque {self.name} on {self.body.name}>"


# ---- inputs ----

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
                             f"{checks.closest(name, known) if known else 'it has no motor, actuator or load'}", "wrong-name")
        element, quantity, path = known[name]
        if element.law.constant is None:
            raise WrongValue(f"input {name!r} must begin with a number: give {element.kind} {element.name!r} one, such as 0.0, "
                             "in the place of its function")
        law = InputLaw(name, float(changed.get(path, element.law.constant)), is_speed=quantity == "speed")
        elements[element.name] = mine = copy.copy(element)
        amend(mine, law=law)
        parameters |= law.numbers
        initial.append(law.initial)
        units.append(UNITS.get(quantity) or ("rad/s" if element.coordinate.startswith("angle") else "m/s"))
    return Driven(drawing._replace(elements=elements, parameters=parameters), initial, units)


def inputs_of(drawing: Any) -> dict[str, tuple[Any, str, str]]:
    """Possible inputs by name: the element, the quantity, and the path of the number."""
    found = {}
    for element in drawing.of((Motor, Actuator)):
        if element.drives in ("torque", "force", "speed"):
            path = f"{element.name}.{element.drives}"
            found[path] = element, element.drives, path
    for element in drawing.of(TableForce):
        if element.law is not None:
            found[f"{element.name}.{element.row.measure}"] = element, element.row.measure, f"{element.name}.{element.drives}"
    return found


def _hint(drawing: Any, name: str) -> str:
    """Reason why a name is not that of an input, if its element exists."""
    element = drawing.elements.get(name.partition(".")[0]) if isinstance(name, str) else None
    if isinstance(element, Motor | Actuator) and element.prescribes:
        return f": {element.kind} {element.name!r} prescribes its {element.drives}, and its force follows from that"
    return ""
