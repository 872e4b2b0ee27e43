"""Joints in the plane, as defined: the points of two bodies that they join, and an axis of the first body.

The core's table defines each kind of joint: coordinate, arguments, measures. A kind without a class of its own gets one from its
entry in the table.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..._private.gateway.mechanisms.plane import JointKind, joint_kinds
from ...errors import WrongAttribute
from . import columns
from .bodies import Point
from .immutable import Fixed
from .measures import Measure, scalar, vector
from .numbers import AS_GIVEN, Numbers
from .switches import Switch, Switched
from .user_functions import Law

TABLE = joint_kinds()
JOINTS = {name: kind for name, kind in TABLE.items() if name != "circle"}     # with a verb; the others are of contacts alone


class Joint(Fixed):
    """Joint between two bodies; methods of `Mechanism` make it.

    Attributes
    ----------
    name : str
    first, second : Point
        The points it joins. Its reaction is exerted by the first body on the second, at the second's point.
    damping : float
        Damping coefficient of its coordinate, in N m s or N s/m.
    cut : bool
        True if the joint must close a loop, so that no joint coordinate belongs to it.
    """

    kind = ""                           # name of the verb
    table = ""                          # name in the core's table, if that is another one
    row: ClassVar[JointKind]            # entry in the core's table
    coordinate: str | None = None       # coordinate of motors and dampers: "angle" or "displacement"
    is_of_one_body = False              # True if all constraints concern the second body, whose frame has the axis
    takes: tuple[str, ...] = ()         # arguments of its method besides the sides

    def __init_subclass__(cls) -> None:
        """Sets class attributes from the entry of the core's table, except those that the class defines."""
        if not cls.kind:        # joints in space have a table of their own
            return
        cls.row = TABLE[cls.table or cls.kind]
        cls.coordinate = cls.row.coordinate
        cls.is_of_one_body = all(each.quantity in ("glide", "skid") for each in cls.row.rows)
        said = {"takes": _taken(cls.row), **{name: scalar(name, doc) for name, doc in _measures(cls.row).items()},
                **({name: vector(name, doc) for name, doc in PLACE.items()} if is_hinge(cls.row) else {}),
                **({"transmission_angle": scalar("transmission_angle", TRANSMISSION)} if is_hinge(cls.row) else {})}
        for name, value in said.items():
            if name not in vars(cls):
                setattr(cls, name, value)

    def __init__(self, name: str, first: Point, second: Point, *, axis: np.ndarray | None = None, length: float | None = None,
                 damping: float = 0.0, cut: bool = False) -> None:
        self.name, self.first, self.second, self.axis = name, first, second, axis       # the axis (2,) in the first body's frame
        self.length, self.damping, self.cut = length, damping, cut
        self._switched: Switched | None = None

    force = vector("force", "Force of the first body on the second through the joint, in the drawing's axes, in N: its "
                   "reaction, with its motors, damping and torsion springs. Springs, actuators, gears and couplers, which act "
                   "between points or joints, have their own measures and are not included.")

    switched = property(lambda self: self._switched, doc="Dry friction, and whether it is joined; None: neither.")

    @property
    def unswitched(self) -> Joint | None:
        """The joint with which a start is assembled, without what switches; None if it is not joined at the start."""
        if self._switched and self._switched.active is False:
            return None
        joint = copy.copy(self)
        joint._switched = None
        return joint

    def switches(self, numbers: Numbers) -> Iterator[Switch]:
        """Its constraints that switch."""
        return self._switched.switches(self, numbers) if self._switched else iter(())

    @property
    def parts(self) -> tuple[Joint, ...]:
        """Entries of the core's table of joints, each as a joint; a contact may have several."""
        return (self,)

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self.first.dimension

    @property
    def bodies(self) -> tuple[Any, Any]:
        """The two bodies."""
        return self.first.body, self.second.body

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Coordinates along which motors and dampers may act."""
        return () if self.coordinate is None else (self.coordinate,)

    def length_with(self, numbers: Numbers) -> float:
        """Length in m; if not given, the distance in the drawing; 0 for kinds without a length."""
        if not self.row.takes_length:
            return 0.0
        drawn = columns.hypot(*(self.second.drawn_with(numbers) - self.first.drawn_with(numbers)))
        return numbers(self, "length", drawn if self.length is None else self.length)

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        length = {"length": self.length_with(now)} if self.row.takes_length else {}
        friction = self._switched.numbers(self) if self._switched else {}
        return {**length, **friction} if self.coordinate is None else {**length, "damping": self.damping, **friction}

    def angle_as_drawn(self) -> float:
        """Relative angle of the bodies in the drawing, where the joint's angle is zero."""
        return self.second.body.pose.angle - self.first.body.pose.angle

    def offset_as_drawn(self, numbers: Numbers) -> float:
        """Offset of the second point from the first along the axis in the drawing, in m; its displacement counts from there."""
        if self.axis is None:
            return 0.0
        apart = self.second.drawn_with(numbers) - self.first.drawn_with(numbers)
        axis = self.axis_as_drawn()
        return columns.plain(apart[0] * axis[0] + apart[1] * axis[1])

    def axis_as_drawn(self) -> np.ndarray:
        """Axis (2,) in the drawing, of length one."""
        return self.bodies[1 if self.is_of_one_body else 0].pose.direction(self.axis)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name}: {self.first.body.name} - {self.second.body.name}>"


def _taken(row: JointKind) -> tuple[str, ...]:
    """Arguments of the method that adds such a joint, besides the two sides."""
    words = {"axis": row.takes_axis, "length": row.takes_length, "damping": row.coordinate,
             "cut": row.inboard is not None}
    return tuple(word for word, is_taken in words.items() if is_taken)


def _measures(row: JointKind) -> dict[str, str]:
    """Scalar measures of a joint, and their documentation."""
    found, unit = {}, "rad" if row.coordinate == "angle" else "m"
    if row.coordinate == "angle":
        found["angle"] = "Angle of the second body relative to the first, zero as drawn, in rad; it counts turns."
    elif row.coordinate:
        found["displacement"] = "Displacement of the second's point along the axis, zero as drawn, in m."
    if row.coordinate:
        found["speed"] = f"The rate of `{row.coordinate}`, in {unit}/s."
        found["acceleration"] = f"The rate of `speed`, in {unit}/s^2."
    if holds_angle(row) or row.coordinate == "angle":
        found["torque"] = ("The moment that the first body exerts on the second through the joint, about the second's point, in "
                           "N m; of the same parts as `force`.")
    if holds_angle(row) and row.coordinate:
        found["first_torque"] = FIRST_TORQUE
    if row.tension:
        found[row.tension] = "Force that pulls the two points together, negative where it pushes, in N."
    return found


FIRST_TORQUE = ("The moment on the first body through the joint, about the first's point, in N m; `torque` is about the "
                "second's point, which slides.")
PLACE = {"position": "Position of the joint, that of the second's point, in the drawing's axes, in m.",
         "velocity": "The velocity of that point, in the drawing's axes, in m/s."}
TRANSMISSION = "The angle between the lines of its two links, in rad, where there is one: `zerodrift.transmission_angle`."


def is_hinge(row: JointKind) -> bool:
    """True if the joint holds one point of both bodies together and leaves their rotation free."""
    return {each.quantity for each in row.rows} == {"x", "y"}


def holds_angle(row: JointKind) -> bool:
    """True if the joint constrains the relative angle."""
    return any(each.quantity == "angle" for each in row.rows)


def holds_distance(row: Any) -> bool:
    """True if the joint, in the plane or in space, constrains the distance of two points and nothing else."""
    return {each[0] for each in row.rows} <= {"distance"}


def draws_length(row: Any) -> bool:
    """True if the length of the joint, in the plane or in space, defaults to the drawn distance."""
    return row.takes_length and any(quantity == "distance" for quantity, *_ in row.rows)


class Revolute(Joint):
    """A hinge, `Mechanism.revolute`."""

    kind = "revolute"


class Prismatic(Joint):
    """A slider, `Mechanism.prismatic`."""

    kind = "prismatic"


class Weld(Joint):
    """Rigid connection of two bodies, `Mechanism.weld`."""

    kind = "weld"


class Rod(Joint):
    """A massless rod between two points, `Mechanism.rod`."""

    kind = "rod"


class Slot(Joint):
    """Point guided on a line of a body, `Mechanism.slot`."""

    kind, takes = "slot", ("axis",)


class KnifeEdge(Joint):
    """A blade, `Mechanism.knife_edge`: its point moves along its axis only. The axis turns with the second body."""

    kind = "knife_edge"


class Rolling(Joint):
    """A wheel on a line, `Mechanism.rolling`."""

    kind, takes = "rolling", ("radius", "normal")
    axis: np.ndarray

    def __init__(self, name: str, first: Point, second: Point, radius: float, normal: np.ndarray) -> None:
        super().__init__(name, first, second, axis=np.array([normal[1], -normal[0]]))
        self.radius = radius

    @property
    def normal(self) -> np.ndarray:
        """Normal of the line (2,) in the first body's frame, towards the wheel."""
        return np.array([-self.axis[1], self.axis[0]])

    def length_with(self, numbers: Numbers) -> float:
        """Radius in m."""
        return numbers(self, "radius", self.radius)

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return {"radius": self.radius}


def class_of(base: Any, kind: str, row: Any, prefix: str = "") -> Any:
    """Class of a kind of joint or force, from its entry in the core's table."""
    name = prefix + "".join(word.capitalize() for word in kind.split("_"))
    doc = f"{row.card.summary} `Mechanism.{kind}`."
    return type(name, (base,), {"kind": kind, "__doc__": doc, "__module__": base.__module__})


def made(kind: str) -> type[Joint]:
    """Class of a kind of joint in the plane."""
    return class_of(Joint, kind, JOINTS[kind])


# Kinds without a class above, by name. They are attributes of this module for pickle and copy.
BY_ROW = {kind: made(kind) for kind in sorted(JOINTS.keys() - {written.kind for written in Joint.__subclasses__()})}
globals().update({joint.__name__: joint for joint in BY_ROW.values()})


class Teeth(NamedTuple):
    """Pressure angle and helix angle of teeth in rad, and the pitch radius of the second wheel in m; None: from the distance."""

    pressure_angle: float
    helix_angle: float
    radius: float | None


class Coupling(Fixed):
    """One constraint between measures: gears, a rack and its pinion, couplers, cams and users' own constraints.

    Attributes
    ----------
    name : str
    kind : str
    of : tuple of str
        The measures it couples: of gears and racks (first, second), where ``second = ratio * first``; of cams (cam, follower).
    ratio : float or None
    law : Law or None
        Function that is constrained to zero, of couplings other than gears, racks and cams.
    teeth : Teeth or None
        Geometry of the teeth of a gear whose tooth forces act on its bodies.
    backlash, restitution : float
        Free play of a gear, in rad of its second angle, and the coefficient of restitution of its flanks.

    Notes
    -----
    A coupling acts along the measures that it couples: along the coordinate of a joint between the two bodies of that joint,
    with opposite signs. It is an element of its own, as a spring is: `force` and `torque` of joints leave it out, and its effort
    is its own measure: `torque` in N m if all of these measures are angles or their rates, else `force` in N, for a value in m or
    m/s. It is positive where it drives the value that is constrained up, and acts on each measure times the derivative of the
    value with respect to that; the value of gears, racks and cams is the second measure less what prescribes it.
    For every body, joints, springs, forces and couplings together are mass times acceleration. The force between teeth
    across these coordinates (the load with which gears push their shafts apart and aside) is modelled of gears with `teeth`.
    """

    def __init__(self, name: str, kind: str, of: tuple[str, ...], effort: str, *, ratio: float | None = None,
                 law: Law | None = None, teeth: Teeth | None = None, backlash: float = 0.0, restitution: float = 0.0) -> None:
        self.name, self.kind, self.of, self.ratio, self.law, self.teeth = name, kind, of, ratio, law, teeth
        self.backlash, self.restitution = backlash, restitution
        self._along_value = effort      # "torque" or "force"

    @property
    def efforts(self) -> tuple[str, ...]:
        """Measures of its generalized force: that along the value, and of a cam that along its angle."""
        more = "cam_torque" if self.kind == "cam" else "tooth_force" if self.teeth else None
        return (self._along_value, more) if more else (self._along_value,)

    @property
    def force(self) -> Measure:
        """Force in N along the value that is constrained, a length or a velocity; positive if it increases the value."""
        return self._effort("force")

    @property
    def torque(self) -> Measure:
        """Torque in N m along the value that is constrained, an angle or its rate; positive if it increases the value."""
        return self._effort("torque")

    @property
    def tooth_force(self) -> Measure:
        """Tangential force between the teeth of a gear in N, with the sign of `torque`."""
        return self._effort("tooth_force")

    @property
    def cam_torque(self) -> Measure:
        """Torque on a cam in N m, positive if it increases the cam's angle."""
        return self._effort("cam_torque")

    def _effort(self, effort: str) -> Measure:
        if effort not in self.efforts:
            raise WrongAttribute(f"{self.kind} {self.name!r} of {', '.join(self.of)} has no {effort}; it has "
                                 f"{', '.join(self.efforts)}")
        return Measure(f"{self.name}.{effort}")

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        play = {"backlash": self.backlash, "restitution": self.restitution} if self.backlash else {}
        return {} if self.ratio is None else {"ratio": self.ratio, **play}

    unswitched = None       # a gear with backlash is open as a start is assembled

    def switches(self, numbers: Numbers) -> Iterator[Switch]:
        """Both flanks of the teeth."""
        play, restitution = numbers(self, "backlash", self.backlash), numbers(self, "restitution", self.restitution)
        for word, sign in (("lower", 1), ("upper", -1)):
            yield Switch(f"{self.name} {word}", "one-sided", coupling=self.name, sign=sign, value=-sign * play / 2,
                         restitution=restitution)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name}: {', '.join(self.of)}>"
