"""Joints of mechanisms in space, as defined by the core's table of joints in space."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from ..._private.gateway import Variable
from ..._private.gateway.mechanisms.element_tables import three
from ..._private.gateway.mechanisms.space import JointKind, joint_kinds
from ..._private.rotations import AXES
from .bodies import Point
from .joints import FIRST_TORQUE, PLACE, Joint, class_of
from .measures import scalar, vector
from .numbers import AS_GIVEN, Numbers

TABLE = joint_kinds()
JOINTS = {name: kind for name, kind in TABLE.items() if name not in ("bearing", "sphere")}     # with a verb
RIGHT_ANGLE = 1e-9      # cosine of the angle between two axes, at most
DIRECTIONS = ("axis", "normal", "third")


TORQUE = ("The moment that the first body exerts on the second through the joint, about the second's point, in the drawing's "
          "axes, in N m; of the same parts as `force`.")


class SpaceJoint(Joint):
    """Joint between two bodies in space; methods of `Mechanism` make it.

    Attributes
    ----------
    name : str
    first, second : Point
        The points it joins. Its reaction is exerted by the first body on the second, at the second's point.
    frames : tuple of ndarray (3, 3)
        Axis of the joint, a normal of it and the third direction as rows, in the frame of the first body and of the second.
    damping : float
        Damping coefficient of its coordinate, in N m s or N s/m; of spherical and universal joints of the angular velocity of
        the second body relative to the first.
    cut : bool
        True if the joint must close a loop, so that no joint coordinate belongs to it.
    """

    row: ClassVar[JointKind]    # type: ignore[assignment]
    coordinates: tuple[str, ...] = ()
    angles: tuple[str, ...] = ()    # coordinates that are angles and count turns

    def __init_subclass__(cls) -> None:
        """Sets class attributes from the entry of the core's table."""
        cls.row = TABLE[cls.table or cls.kind]
        cls.coordinates = tuple(name for name, _ in cls.row.coordinates)
        cls.angles = tuple(name for name, quantity in cls.row.coordinates if quantity == "angle")
        cls.coordinate = cls.coordinates[0] if len(cls.coordinates) == 1 else None
        for name, doc in _measures(cls.row).items():
            setattr(cls, name, scalar(name, doc))
        vectors = PLACE if is_at_point(cls.row) else {}
        if has_torque(cls.row) or swivels(cls.row):
            vectors = {"torque": TORQUE, **(vectors or {"first_torque": FIRST_TORQUE})}
        for name, doc in vectors.items():
            setattr(cls, name, vector(name, doc))

    def __init__(self, name: str, first: Point, second: Point, *, frames: tuple[np.ndarray, np.ndarray],
                 length: float | None = None, damping: float = 0.0, cut: bool = False) -> None:
        super().__init__(name, first, second, length=length, damping=damping, cut=cut)
        self.frames = frames

    def length_with(self, numbers: Numbers) -> float:
        """Length in m, by default the distance in the drawing; advance per radian of a screw; 0 for kinds without a length."""
        if not self.row.takes_length:
            return 0.0
        if advances(self.row):
            return numbers(self, "pitch", self.length) / (2 * np.pi)
        apart = self.second.drawn_with(numbers) - self.first.drawn_with(numbers)
        return numbers(self, "length", float(np.linalg.norm(apart)) if self.length is None else self.length)

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        if advances(self.row):
            return {"pitch": now(self, "pitch", self.length)}
        return {**super().numbers(now), **({"damping": self.damping} if swivels(self.row) and all(
            body.turns for body in self.bodies) else {})}

    def semiaxes_with(self, numbers: Numbers) -> tuple[float, float, float]:
        """Semiaxes of the rolling body along the rows of the second frame, in m; zero for joints without rolling."""
        return 0.0, 0.0, 0.0

    def offset_as_drawn(self, numbers: Numbers) -> float:
        """Offset of the second point from the first along the axis in the drawing, in m; its displacement counts from there."""
        apart = self.second.drawn_with(numbers) - self.first.drawn_with(numbers)
        return float(apart @ self.axis_as_drawn())

    def along_with(self, numbers: Numbers) -> float:
        """Offset along the axis of the joint's zero position in m; of a universal joint the cosine between its axes."""
        return self.skewness() if self.row.axes == 2 else self.offset_as_drawn(numbers) if self.row.axes else 0.0

    def skewness(self) -> float:
        """Cosine of the angle between the axes of a universal joint; 0 for a right one."""
        (first, second), (one, other) = self.bodies, self.frames
        cosine = float(first.pose.direction(one[0]) @ second.pose.direction(other[1]))
        return cosine if abs(cosine) > RIGHT_ANGLE else 0.0

    def row_named(self, component: int) -> Variable:
        """Name and unit of a constraint of the joint: displacement along an axis of the drawing or joint, or rotation."""
        quantity, first, second = self.row.rows[component]
        if len(self.row.rows) == 1:
            return Variable(self.name, "m")
        if quantity == "cosine":
            return Variable(f"{self.name}.about {DIRECTIONS[3 - first - second]}", "rad")
        return Variable(f"{self.name}.{quantity}" if quantity in AXES else f"{self.name}.along {DIRECTIONS[first]}", "m")

    def axis_as_drawn(self) -> np.ndarray:
        """Axis (3,) in the drawing, of length one."""
        return self.bodies[0].pose.direction(self.frames[0][0])


def speeds(row: JointKind) -> dict[str, str]:
    """Names of the rates of a joint's coordinates, with the coordinates."""
    names = [name for name, _ in row.coordinates]
    return {"speed": names[0]} if len(names) == 1 else {f"{name}_speed": name for name in names}


def acceleration_of(speed: str) -> str:
    """Name of the rate of a speed."""
    return f"{speed.removesuffix('speed')}acceleration"


def _measures(row: JointKind) -> dict[str, str]:
    """Scalar measures of a joint, and their documentation."""
    found = {}
    for name, quantity in row.coordinates:
        found[name] = ("Displacement of the second's point along the axis, zero as drawn, in m." if quantity == "along" else
                       "Angle of the second body relative to the first, zero as drawn, in rad; it counts turns.")
    for speed, name in speeds(row).items():
        unit = "m" if dict(row.coordinates)[name] == "along" else "rad"
        found[speed] = f"The rate of `{name}`, in {unit}/s."
        found[acceleration_of(speed)] = f"The rate of `{speed}`, in {unit}/s^2."
    if row.tension:
        found[row.tension] = "Force that pulls the two points together, negative where it pushes, in N."
    return found


def has_torque(row: JointKind) -> bool:
    """True if the joint transmits a moment, by its constraints or by a motor or damper."""
    return any(quantity == "cosine" for quantity, _, _ in row.rows)


def swivels(row: JointKind) -> bool:
    """True if the joint leaves rotations about two or three axes free, and nothing else: its damping is of their sum."""
    kinds = [freedom.kind for freedom in row.freedoms or ()]
    return kinds in (["swings"], ["turns", "turns"])


def is_at_point(row: JointKind) -> bool:
    """True if the joint holds one point of both bodies together."""
    return {"x", "y", "z"} <= {quantity for quantity, _, _ in row.rows}


def is_on_plane(row: JointKind) -> bool:
    """True if the joint holds the second point on a plane of the first body, whose normal is the joint's axis."""
    return {direction for quantity, direction, _ in row.rows if quantity == "along"} == {DIRECTIONS.index("axis")}


def is_blade(row: JointKind) -> bool:
    """True if the joint keeps a velocity across a direction of the second body zero, as the blade of a skate does."""
    return any(quantity == "glide" for quantity, _, _ in row.rows)


def advances(row: JointKind) -> bool:
    """True if the bodies advance along the axis in proportion to their rotation, as on a screw, whose length is the pitch."""
    return any(freedom.kind == "advances" for freedom in row.freedoms or ())


# Kinds by name. They are attributes of this module for pickle and copy.
BY_KIND = {kind: class_of(SpaceJoint, kind, JOINTS[kind], "Space") for kind in sorted(JOINTS)}
globals().update({joint.__name__: joint for joint in BY_KIND.values()})


class SpaceRolling(BY_KIND["rolling"]):      # type: ignore[name-defined,valid-type,misc]
    """A disc, a sphere or an ellipsoid on a plane of the first body, `Mechanism.rolling`.

    Attributes
    ----------
    semiaxes : tuple of float
        In m, along the rows of the second body's frame: of a disc the first is 0, and the others are its radius.
    """

    kind = "rolling"

    def __init__(self, name: str, first: Point, second: Point, *, frames: tuple[np.ndarray, np.ndarray],
                 semiaxes: tuple[float, float, float]) -> None:
        super().__init__(name, first, second, frames=frames)
        self.semiaxes = semiaxes

    def semiaxes_with(self, numbers: Numbers) -> tuple[float, float, float]:
        """Semiaxes in m, along the rows of the second body's frame."""
        if len({*self.semiaxes} - {0.0}) == 1:
            radius = numbers(self, "radius", max(self.semiaxes))
            return three(radius if each else 0.0 for each in self.semiaxes)
        return three(numbers(self, f"semiaxes.{axis}", each) for axis, each in zip(AXES, self.semiaxes, strict=True))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        found = self.semiaxes_with(now)
        return {"radius": max(found)} if len({*found} - {0.0}) == 1 else {
            f"semiaxes.{axis}": each for axis, each in zip(AXES, found, strict=True)}


BY_KIND["rolling"] = SpaceRolling
