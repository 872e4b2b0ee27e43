"""Mechanisms in space: the core's table of joints in space, and the system it makes from tables of numbers."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, Generic, NamedTuple

import numpy as np

from ...core import ffi, lib
from ..base import Card, card_of, doubles, text
from . import element_tables
from .core import MechanismCore
from .element_tables import ZERO, GeneralizedForce, Group, OutputSpec, Relation, Scalar, Triple, three
from .law_owner import Law
from .plane import Coordinate

QUANTITY_KINDS = {"x": lib.ZD_SPACE_X, "y": lib.ZD_SPACE_Y, "z": lib.ZD_SPACE_Z, "along": lib.ZD_SPACE_ALONG,
                  "cosine": lib.ZD_SPACE_COSINE, "angle": lib.ZD_SPACE_ANGLE,
                  "rotation": lib.ZD_SPACE_ROTATION, "distance": lib.ZD_SPACE_DISTANCE,
                  "clearance": lib.ZD_SPACE_CLEARANCE, "slip": lib.ZD_SPACE_SLIP,
                  "glide": lib.ZD_SPACE_GLIDE, "spin": lib.ZD_SPACE_SPIN, "turn": lib.ZD_SPACE_TURN, "shear": lib.ZD_SPACE_SHEAR,
                  "orbit": lib.ZD_SPACE_ORBIT, "orbit across": lib.ZD_SPACE_ORBIT_ACROSS}
NAMES = {value: name for name, value in QUANTITY_KINDS.items()}
ZEROS = {lib.ZD_SPACE_ZERO_NONE: None, lib.ZD_SPACE_ZERO_ALONG: "along", lib.ZD_SPACE_ZERO_LENGTH: "length"}
FREEDOMS = {lib.ZD_SPACE_SLIDES: "slides", lib.ZD_SPACE_TURNS: "turns", lib.ZD_SPACE_ADVANCES: "advances",
            lib.ZD_SPACE_SWINGS: "swings"}
BODY, PARTICLE = (7, 6), (3, 3)     # coordinates and velocities

Vector = Triple[float]
Frame = Triple[Vector]
NONE: Triple[Any] = (0.0, 0.0, 0.0)
AS_DRAWN: Triple[Triple[Any]] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Freedom(NamedTuple):
    """Freedom of a joint: a distance, an angle, or a unit quaternion if `name` is None."""

    kind: str                   # "slides", "turns", "advances", "swings"
    name: str | None
    direction: int = 0          # of the joint's frame
    from_along: bool = False    # True: the coordinate is zero at the distance `along` of the joint


class JointKind(NamedTuple):
    """A kind of joint in space; see `zd_space_joint_kind`. Each constraint is a marker quantity held at zero, with
    the indices of the directions of both bodies' frames.
    """

    number: int
    card: Card
    rows: tuple[tuple[str, int, int], ...]
    coordinates: tuple[tuple[str, str], ...]    # by name, with the kind of the marker quantity
    axes: int
    takes_length: bool
    tension: str | None
    freedoms: tuple[Freedom, ...] | None    # None: it carries no body in a tree


class Body(NamedTuple):
    """A `zd_space_body`; bodies are numbered from 1, 0 is the ground."""

    mass: float
    inertia: Vector = NONE      # about its principal axes, which are those of the core
    is_particle: bool = False
    inboard: int = -1           # the joint of the tree that carries it; -1: it is free


class Joint(NamedTuple):
    """A row of `zd_space_joint`. Points are in the axes of their body and from its mass centre; so are the rows of the frames."""

    kind: int                   # JointKind.number
    first: int
    second: int
    point1: Vector = NONE
    point2: Vector = NONE
    frame1: Frame = AS_DRAWN
    frame2: Frame = AS_DRAWN
    semiaxes: Vector = NONE     # of what rolls, along the rows of the second frame
    along: float = 0.0          # what the distance along the axis is where the joint says zero
    length: float = 0.0         # of a rod; of a screw m for each rad


class Quantity(NamedTuple, Generic[Scalar]):
    """A `zd_space_quantity`; `kind` is a key of QUANTITY_KINDS."""

    kind: str
    first: int
    second: int
    point1: Triple[Scalar] = NONE
    point2: Triple[Scalar] = NONE
    a: Triple[Scalar] = AS_DRAWN[0]     # directions of the first body, and one of the second
    o: Triple[Scalar] = AS_DRAWN[1]
    b: Triple[Scalar] = AS_DRAWN[0]
    # In the second body's axes: an ellipsoid x^T shape^-1 x = 1; of a rotation the first body's axes where it is zero
    shape: Triple[Triple[Scalar]] = (NONE, NONE, NONE)
    zero: Scalar = ZERO
    counted: int = 0            # of an angle that counts turns: 1 + which one it is of all angles of joints


class Tables(NamedTuple):
    """Tables from which the core makes a mechanism in space."""

    bodies: Sequence[Body]
    joints: Sequence[Joint] = ()
    quantities: Sequence[Quantity] = ()
    relations: Sequence[Relation] = ()
    forces: Sequence[GeneralizedForce] = ()
    measures: Sequence[OutputSpec] = ()
    gravity: Vector = NONE
    reactions: Mapping[str, tuple[int, int]] = MappingProxyType({})     # measure and component of those that laws read
    length: float = 1.0         # m: that moments are divided by in the least reactions
    groups: Sequence[Group] = ()


def _joint_kind(number: int) -> JointKind:
    c = lib.zd_space_joint_kind_of(number)
    rows = tuple((NAMES[row.pick.quantity], row.pick.of_first, row.pick.of_second) for row in (c.row[i] for i in range(c.rows)))
    coordinates = tuple((text(each.name), NAMES[each.pick.quantity]) for each in c.coordinate if each.name)
    tension = text(c.tension) if c.tension else None
    freedoms = tuple(Freedom(FREEDOMS[each.kind], text(each.name) if each.name else None, each.direction,
                             each.zero == lib.ZD_SPACE_ZERO_ALONG)
                     for each in (c.freedom[i] for i in range(c.freedoms)))
    return JointKind(number, card_of(c.card), rows, coordinates, c.axes, bool(c.takes_length), tension,
                     freedoms if c.is_inboard else None)


def joint_kinds() -> dict[str, JointKind]:
    """The core's table of joints in space by name."""
    return {kind.card.name: kind for kind in map(_joint_kind, range(lib.zd_space_joint_kinds()))}


def _element_quantities(c: Any) -> tuple[element_tables.ElementQuantity, ...]:
    return tuple(element_tables.ElementQuantity(NAMES[pick.quantity], ZEROS[pick.zero], pick.of_first, pick.of_second)
                 for pick in (c.pick[i] for i in range(c.quantities)))


def element_kinds() -> dict[str, element_tables.ElementKind]:
    """The core's table of force elements in space by name."""
    return element_tables.element_kinds(lib.zd_space_element_kinds(), lib.zd_space_element_kind_of, _element_quantities)


def coordinate_quantity(joint: Joint, coordinate: int, angles: int) -> Quantity:
    """Marker quantity of a coordinate of a joint; `angles` is the number of angles of the joints before it."""
    return quantity_of(lib.zd_space_coordinate_quantity(ffi.new("zd_space_joint *", joint), coordinate, angles))


def quantity_of(c: Any) -> Quantity:
    """Marker quantity of the core's struct."""
    point1, point2, a, o, b = map(three, (c.point1, c.point2, c.a, c.o, c.b))
    return Quantity(NAMES[c.kind], c.first, c.second, point1, point2, a, o, b, three(map(three, c.shape)), c.zero, c.counted)


class SpaceCore(MechanismCore):
    """The core's system of a mechanism in space, in absolute coordinates."""

    dimension, quantity_kinds, velocities, made_by = "space", QUANTITY_KINDS, 6, lib.zd_space_create

    def __init__(self, tables: Tables, law: Law | None = None, *, laws_know_time: bool = True) -> None:
        super().__init__(tables, law, laws_know_time=laws_know_time)
        sizes = np.array([PARTICLE if body.is_particle else BODY for body in tables.bodies])
        self._at_p, self._at_v = (np.concatenate([[0], np.cumsum(column)[:-1]]) for column in sizes.T)
        self._turning = np.array([not body.is_particle for body in tables.bodies])
        places = np.zeros(lib.zd_space_angles(self._mechanism, ffi.NULL), dtype=np.int32)
        lib.zd_space_angles(self._mechanism, ffi.from_buffer("int[]", places, require_writable=True))
        self._angle_at = places         # in p

    @functools.cached_property
    def motions(self) -> tuple[Coordinate, ...]:
        """Quantity whose rate each entry of v is: a coordinate of the mass centre, or an angle about an axis of a body."""
        return tuple(Coordinate(i, kind) for i, turns in enumerate(self._turning, 1)
                     for kind in ("x", "y", "z", *(("angle",) * 3 if turns else ()))[:6])

    # ---- between the state and bodies ----

    def poses(self, p: np.ndarray, v: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray | None]:
        """Poses (bodies, 7) of the mass centres, place and unit quaternion, and their rates (bodies, 6) where v is given."""
        poses = np.zeros((len(self._at_p), 7))
        poses[:, :3] = np.asarray(p)[self._at_p[:, None] + np.arange(3)]
        poses[:, 3] = 1.0
        poses[self._turning, 3:] = np.asarray(p)[self._at_p[self._turning, None] + np.arange(3, 7)]
        return poses, None if v is None else self._rates(np.asarray(v))

    def _rates(self, v: np.ndarray) -> np.ndarray:
        rates = np.zeros((len(self._at_v), 6))
        rates[:, :3] = v[self._at_v[:, None] + np.arange(3)]
        rates[self._turning, 3:] = v[self._at_v[self._turning, None] + np.arange(3, 6)]
        return rates

    @property
    def origin(self) -> np.ndarray:
        """Positions (nq,) in which all bodies are at the drawing's origin, with its axes."""
        return self.state(np.tile([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (len(self._at_p), 1)))[0]

    def angles(self, p: np.ndarray) -> np.ndarray:
        """The angles of joints, (k,) in rad with their turns."""
        return np.asarray(p)[self._angle_at]

    def state(self, poses: np.ndarray, rates: np.ndarray | None = None,
              angles: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """(p, v) from poses and rates as `poses` returns them, with the joint angles nearest to `angles` (default zero)."""
        p = np.concatenate([*(pose if turns else pose[:3] for pose, turns in zip(poses, self._turning, strict=True)),
                            np.zeros(len(self._angle_at)) if angles is None else angles])
        if len(self._angle_at):
            self.c.follow(self.c.data, doubles(p, self.nq, writable=True))
        if rates is None:
            return p, np.zeros(self.nv)
        return p, np.concatenate([rate if turns else rate[:3] for rate, turns in zip(rates, self._turning, strict=True)])
