"""Joints, as they were given: which points of which bodies they join, and along which axis of the first."""

from __future__ import annotations

from typing import Any

import numpy as np

from .bodies import Point
from .laws import Law
from .measures import Measure, scalar, vector
from .numbers import AS_GIVEN, Numbers


class Joint:
    """What joins two bodies; verbs of `Mechanism` make it.

    Attributes
    ----------
    name : str
    first, second : Point
        What it joins; its reaction is what the first body does to the second, at the second's point.
    damping : float
        Of its coordinate, in N m s or N s/m.
    cut : bool
        Whether it shall close a loop, and own no coordinate.
    """

    kind = ""           # as the core's table calls it
    own = 0             # coordinates that it may own where bodies hang on it
    coordinate = None   # what motors and dampers act along: "angle" or "displacement"

    def __init__(self, name: str, first: Point, second: Point, *, axis: np.ndarray | None = None, damping: float = 0.0,
                 cut: bool = False) -> None:
        self.name, self.first, self.second, self.axis = name, first, second, axis       # the axis (2,) in the first's frame
        self.damping, self.cut = damping, cut

    force = vector("force", "What the first body does to the second through the joint, in the drawing's axes, in N: what holds "
                   "the joint, its motors and its damping. Springs, and couplings such as gears, are elements of their own: what "
                   "they do along the joint's coordinate is in their measures, and not in this one.")

    @property
    def measured_name(self) -> str:
        """What its measures are called by."""
        return self.name

    @property
    def bodies(self) -> tuple[Any, Any]:
        """The two bodies."""
        return self.first.body, self.second.body

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """What can be addressed by path."""
        return {} if self.coordinate is None else {"damping": self.damping}

    def angle_as_drawn(self) -> float:
        """The second body's angle less the first's in the drawing, where the joint's angle is zero."""
        return self.second.body.pose.angle - self.first.body.pose.angle

    def offset_as_drawn(self, numbers: Numbers) -> float:
        """How far the second's point is along the axis from the first's in the drawing, where the displacement is zero."""
        apart = self.second.drawn_with(numbers) - self.first.drawn_with(numbers)
        return float(apart @ self.axis_as_drawn())

    def axis_as_drawn(self) -> np.ndarray:
        """The axis (2,) in the drawing, of length one."""
        return self.first.body.pose.direction(self.axis)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name}: {self.first.body.name} - {self.second.body.name}>"


class Revolute(Joint):
    """A hinge, `Mechanism.revolute`."""

    kind, own, coordinate = "revolute", 1, "angle"
    position = vector("position", "Where the joint is, by the second's point, in the drawing's axes, in m.")
    velocity = vector("velocity", "The velocity of that point, in the drawing's axes, in m/s.")
    angle = scalar("angle", "How far the second body has turned against the first since the drawing, in rad; it counts turns.")
    speed = scalar("speed", "The rate of `angle`, in rad/s.")
    acceleration = scalar("acceleration", "The rate of `speed`, in rad/s^2.")
    torque = scalar("torque", "The moment that the first body exerts on the second through the joint, in N m; as with `force`, "
                    "without springs and couplings.")


class Prismatic(Joint):
    """A slider, `Mechanism.prismatic`."""

    kind, own, coordinate = "prismatic", 1, "displacement"
    displacement = scalar("displacement", "How far the second's point has moved along the axis since the drawing, in m.")
    speed = scalar("speed", "The rate of `displacement`, in m/s.")
    acceleration = scalar("acceleration", "The rate of `speed`, in m/s^2.")
    torque = scalar("torque", "The moment that the first body exerts on the second, about the second's point, in N m.")


class Weld(Joint):
    """Two bodies that are one, `Mechanism.weld`."""

    kind = "weld"
    torque = scalar("torque", "The moment that the first body exerts on the second, about the second's point, in N m.")


class Rod(Joint):
    """A massless rod between two points, `Mechanism.rod`."""

    kind = "rod"
    tension = scalar("tension", "The force in the rod, positive where it pulls, in N.")

    def __init__(self, name: str, first: Point, second: Point, length: float | None) -> None:
        super().__init__(name, first, second)
        self.length = length

    def length_with(self, numbers: Numbers) -> float:
        """Its length; where none was given, the distance in the drawing."""
        drawn = float(np.hypot(*(self.second.drawn_with(numbers) - self.first.drawn_with(numbers))))
        return numbers(self, "length", drawn if self.length is None else self.length)

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """What can be addressed by path."""
        return {"length": self.length_with(now)}


class Slot(Joint):
    """A point on a line of a body, `Mechanism.slot`."""

    kind, coordinate = "slot", "displacement"
    displacement = scalar("displacement", "How far the point has moved along the line since the drawing, in m.")
    speed = scalar("speed", "The rate of `displacement`, in m/s.")
    acceleration = scalar("acceleration", "The rate of `speed`, in m/s^2.")


class KnifeEdge(Joint):
    """A blade, `Mechanism.knife_edge`: its point moves along its axis only. The axis turns with the second body."""

    kind = "knife_edge"

    def axis_as_drawn(self) -> np.ndarray:
        return self.second.body.pose.direction(self.axis)


class Rolling(Joint):
    """A wheel on a line, `Mechanism.rolling`."""

    kind = "rolling"

    def __init__(self, name: str, first: Point, second: Point, radius: float, normal: np.ndarray) -> None:
        super().__init__(name, first, second)
        self.radius, self.normal = radius, normal       # the normal (2,) in the first's frame, towards the wheel

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """What can be addressed by path."""
        return {"radius": self.radius}


class Coupling:
    """One row between measures: gears, a rack and its pinion, couplers, cams and users' own constraints.

    Attributes
    ----------
    name : str
    kind : str
    of : tuple of str
        The measures it couples: of gears and racks (first, second), where ``second = ratio * first``; of cams (cam, follower).
    ratio : float or None
    law : Law or None
        What has to be zero, of the others.

    Notes
    -----
    A coupling acts along the measures that it couples: along the coordinate of a joint between the two bodies of that joint,
    with opposite signs. It is an element of its own, as a spring is: `force` and `torque` of joints leave it out, and its effort
    is its own measure, `force` or `torque` by the unit of the second of these measures, positive where it drives that one up.
    For every body, joints, springs, forces and couplings together are mass times acceleration. The force between teeth
    across these coordinates (the load with which gears push their shafts apart and aside) is not modelled.
    """

    def __init__(self, name: str, kind: str, of: tuple[str, ...], *, ratio: float | None = None, law: Law | None = None) -> None:
        self.name, self.kind, self.of, self.ratio, self.law = name, kind, of, ratio, law

    @property
    def efforts(self) -> dict[str, int]:
        """What is measured of its effort, and along which of the measures in `of`."""
        if self.kind in ("constraint", "nonholonomic"):
            return {}
        last = min(1, len(self.of) - 1)
        effort = {_effort_along(self.of[last]): last}
        return {**effort, "cam_torque": 0} if self.kind == "cam" else effort

    @property
    def force(self) -> Measure:
        """The force along the second measure, positive where it drives it up, in N; where that measure is in m."""
        return self._effort("force")

    @property
    def torque(self) -> Measure:
        """The torque along the second measure, positive where it drives it up, in N m; where that measure is in rad."""
        return self._effort("torque")

    @property
    def cam_torque(self) -> Measure:
        """The torque on a cam, positive where it drives the cam's angle up, in N m."""
        return self._effort("cam_torque")

    def _effort(self, effort: str) -> Measure:
        if effort not in self.efforts:
            known = ", ".join(self.efforts) or "no measure but its multiplier"
            raise AttributeError(f"{self.kind} {self.name!r} of {', '.join(self.of)} has no {effort}; it has {known}")
        return Measure(f"{self.name}.{effort}")

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """What can be addressed by path."""
        return {} if self.ratio is None else {"ratio": self.ratio}

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name}: {', '.join(self.of)}>"


def _effort_along(measure: str) -> str:
    """What acts along a measure: a torque along an angle, a force along a length."""
    return "torque" if measure.endswith(".angle") else "force"
