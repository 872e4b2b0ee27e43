"""Contacts, stops and other constraints that switch, as defined."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from .bodies import Point
from .frames import Circle, perpendicular
from .immutable import Fixed
from .joints import Joint
from .measures import Measure, VectorMeasure, scalar
from .numbers import AS_GIVEN, Numbers
from .space_joints import SpaceJoint
from .switches import Switch, friction_with, of_friction


class Compliance(NamedTuple):
    """Law of Hunt and Crossley: stiffness d^exponent (1 + damping d'), at least 0, for a depth d above 0."""

    stiffness: float        # N/m^exponent, N m/rad^exponent
    damping: float          # s/m, s/rad
    exponent: float

    def law(self) -> Callable[[Any, Any], Any]:
        """Force, from a gap and its rate."""
        stiffness, damping, exponent = self

        def push(gap: Any, rate: Any) -> Any:
            return stiffness * max(0.0, -gap)**exponent * max(0.0, 1.0 - damping * rate)
        return push

    def numbers(self) -> dict[str, float]:
        """Values by the last word of their paths."""
        return self._asdict()

    def with_numbers(self, element: Any, numbers: Numbers) -> Compliance:
        """The same with parameters that may have been changed."""
        return Compliance(*(numbers(element, word, value) for word, value in self._asdict().items()))


class Bounds(NamedTuple):
    """Coordinate along a bounded shape, from its first point along an axis of its body, and the limits of it in m."""

    axis: tuple[float, float]
    limits: tuple[float, float]


class Contact:
    """Contact of a point or a round body with a shape of another body, `Mechanism.contact`.

    Attributes
    ----------
    name : str
    first, second : Point
        The start of the shape, and the point or the centre of the round body.
    radius : float
        In m; 0: a point.
    shape : Line, Circle, Plane or Sphere
    restitution : float
        Coefficient of restitution.
    friction : tuple of float
        Coefficients of static and of sliding friction.
    compliance : Compliance or None
        Law of its force; None: it is rigid.
    """

    unswitched: Any = None
    switched: Any = None
    kind = "contact"
    takes: tuple[str, ...] = ("radius", "shape", "restitution", "friction")
    name: str
    force: VectorMeasure
    dimension: int
    opposite = 0        # index of the first switch of the part on the opposite side, relative to its own
    owner = property(lambda self: vars(self).get("_owner", self), lambda self, owner: vars(self).update(_owner=owner),
                     doc="The contact of which it is a part, or itself.")

    def __init__(self, name: str, first: Point, second: Point, radius: float, shape: Any, restitution: float,
                 friction: tuple[float, float], compliance: Compliance | None = None) -> None:
        super().__init__(name, first, second, **self._geometry(shape))      # type: ignore[call-arg]
        self.radius, self.shape, self.restitution, self.friction = radius, shape, restitution, friction
        self.compliance = compliance

    @staticmethod
    def _geometry(shape: Any) -> dict[str, Any]:
        """Axis or frames of the joint, as arguments."""
        return {"axis": shape.direction}

    @property
    def parts(self) -> tuple[Any, ...]:
        """Entries of the core's table of joints, each as a contact: itself; of a compliant one none."""
        return () if self.compliance else (self,)

    def bounds(self, numbers: Numbers) -> Bounds | None:
        """Range of the shape; None if it is unbounded."""
        return None

    @property
    def sign(self) -> int:
        """Sign of its gap: -1 inside of a circle or a sphere."""
        return 1 if getattr(self.shape, "outside", True) else -1

    def radius_with(self, numbers: Numbers) -> float:
        """Radius of the round body in m."""
        return numbers(self.owner, "radius", self.radius)

    def length_with(self, numbers: Numbers) -> float:
        """Radius of the round body in m, negative inside of a circle or a sphere."""
        return self.sign * self.radius_with(numbers)

    def distance_with(self, numbers: Numbers) -> float:
        """Distance of the centres of two round bodies that touch, in m."""
        return self.shape.radius + self.length_with(numbers)

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        rigid = {"restitution": self.restitution, **of_friction("friction", self.friction)}
        return {"radius": self.radius, **(self.compliance.numbers() if self.compliance else rigid)}

    def switches(self, numbers: Numbers) -> Iterator[Switch]:
        """Its switched constraints: the gap, and the slip."""
        yield Switch(self.name, "one-sided", restitution=numbers(self.owner, "restitution", self.restitution), sign=self.sign,
                     opposite=self.opposite)
        yield Switch(self.name, "friction" if any(self.friction) else "absent", component=1, rows=self.dimension - 1, normal=1,
                     friction=friction_with(numbers, self.owner, "friction", self.friction))


class LineContact(Contact, Joint):      # type: ignore[misc]
    """Contact with a line or a segment, `Mechanism.contact`; its attributes are those of `Contact`."""

    kind, table = "contact", "rolling"

    @property
    def parts(self) -> tuple[Joint, ...]:
        """Itself; of a segment its left and right side, and for a round body its ends."""
        line = self.shape
        if self.compliance:
            return ()
        if line.length == np.inf:
            return (self,)
        back = line._replace(start=self.ends[1], direction=-line.direction)
        sides = [self._part(LineContact, f"{self.name} {word}", each) for word, each in (("left", line), ("right", back))]
        count = len(list(sides[0].switches(AS_GIVEN))) + 1      # and that of its range
        sides[0].opposite, sides[1].opposite = count, -count
        return (*sides, *self.end_parts())

    @property
    def ends(self) -> list[np.ndarray]:
        """Ends (2,) of a bounded shape in the frame of its body."""
        return [np.asarray(self.shape.start + s * self.shape.direction) for s in (0.0, self.shape.length)]

    def _part(self, kind: type[LineContact], name: str, shape: Any) -> Any:
        part = kind(name, Point(shape.body, shape.start), self.second, self.radius, shape, self.restitution, self.friction)
        part.owner = self
        return part

    def end_parts(self) -> list[Any]:
        """Parts that a round body touches beside a bounded shape."""
        return [self._part(RoundContact, f"{self.name} {word}", Circle(self.shape.body, at, 0.0, True, np.array([1.0, 0.0])))
                for word, at in zip(("start", "end"), self.ends, strict=True) if self.radius]

    def bounds(self, numbers: Numbers) -> Bounds | None:
        """Range of the shape; None if it is unbounded."""
        axis, length = self.shape.direction, self.shape.length
        return None if length == np.inf else Bounds((float(axis[0]), float(axis[1])), (0.0, length))

    @property
    def is_bounded(self) -> bool:
        """True for all shapes but unbounded lines."""
        return isinstance(self.shape, Circle) or self.shape.length < np.inf


class RoundContact(LineContact):
    """Contact of a point or a round body with a circle, or with an arc of it, `Mechanism.contact`.

    Its attributes are those of `Contact`; `shape` is a Circle, and `first` its centre.
    """

    kind, table = "contact", "circle"

    @property
    def parts(self) -> tuple[Joint, ...]:
        """Itself, and of an arc its ends, if a round body touches it."""
        circle = self.shape
        if self.compliance:
            return ()
        return (self,) if circle.half_angle == np.pi else (self, *self.end_parts())

    @property
    def ends(self) -> list[np.ndarray]:
        """Ends (2,) of an arc in the frame of its body."""
        towards = complex(*self.shape.direction) * self.shape.radius
        turned = (towards * np.exp(1j * angle) for angle in (-self.shape.half_angle, self.shape.half_angle))
        return [self.shape.start + np.array([at.real, at.imag]) for at in turned]

    def offset_as_drawn(self, numbers: Numbers) -> float:
        """Distance of the centres where they touch, in m."""
        return self.distance_with(numbers)

    def bounds(self, numbers: Numbers) -> Bounds | None:
        """Range of an arc, from the chord between its ends outward; None of a circle."""
        half_angle, axis = self.shape.half_angle, self.shape.direction
        if half_angle == np.pi:
            return None
        return Bounds((float(axis[0]), float(axis[1])), (self.offset_as_drawn(numbers) * float(np.cos(half_angle)), np.inf))


class PlaneContact(Contact, SpaceJoint):        # type: ignore[misc]
    """Contact of a point or a ball with a plane, `Mechanism.contact`; its attributes are those of `Contact`."""

    kind, table = "contact", "rolling"

    @staticmethod
    def _geometry(shape: Any) -> dict[str, Any]:
        across = perpendicular(shape.direction)
        return {"frames": (np.stack([shape.direction, across, np.cross(shape.direction, across)]), np.eye(3))}

    def semiaxes_with(self, numbers: Numbers) -> tuple[float, float, float]:
        """Radius of the ball in m, three times."""
        return (self.radius_with(numbers),) * 3


class SphereContact(Contact, SpaceJoint):      # type: ignore[misc]
    """Contact of a point or a ball with a sphere, `Mechanism.contact`; its attributes are those of `Contact`."""

    kind, table = "contact", "sphere"

    @staticmethod
    def _geometry(shape: Any) -> dict[str, Any]:
        return {"frames": (np.eye(3), np.eye(3))}

    def along_with(self, numbers: Numbers) -> float:
        """Distance of the centres where they touch, in m."""
        return self.distance_with(numbers)


class Stop(Fixed):
    """Limits of a measure, `Mechanism.stop`.

    Attributes
    ----------
    name : str
    of : str
        Name of the measure.
    lower, upper : float or None
    restitution : float
    compliance : Compliance or None
        Law of its effort; None: it is rigid.
    """

    kind, unswitched = "stop", None
    force = scalar("force", "Force in N on its measure, a length, positive upward.")
    torque = scalar("torque", "Torque in N m on its measure, an angle, positive upward.")

    def __init__(self, name: str, of: str, lower: float | None, upper: float | None, restitution: float, effort: str,
                 quantity: str, is_rate: bool, compliance: Compliance | None) -> None:
        self.name, self.of, self.lower, self.upper, self.restitution, self.effort = name, of, lower, upper, restitution, effort
        self.quantity, self.is_rate = quantity, is_rate     # the measure of positions; True: its rate is limited
        self.compliance = compliance

    @property
    def limits(self) -> dict[str, float]:
        """Limits by name."""
        return {word: value for word, value in (("lower", self.lower), ("upper", self.upper)) if value is not None}

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return {**self.limits, **(self.compliance.numbers() if self.compliance else {"restitution": self.restitution})}

    def switches(self, numbers: Numbers) -> Iterator[Switch]:
        """A switched constraint for each limit, of one row."""
        restitution = numbers(self, "restitution", self.restitution)
        for word, value in self.limits.items():
            name = self.name if len(self.limits) == 1 else f"{self.name} {word}"
            yield Switch(name, "one-way" if self.is_rate else "one-sided", along=self.quantity,
                         sign=1 if word == "lower" else -1, value=numbers(self, word, value), restitution=restitution)

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
    return [element for element in elements
            if (isinstance(element, Contact | Stop) and not element.compliance) or getattr(element, "switched", None)
            or getattr(element, "backlash", 0.0)]
