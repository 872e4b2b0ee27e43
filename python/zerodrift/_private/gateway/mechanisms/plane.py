"""Mechanisms from bodies and joints: the core's tables of joints and elements, and the system it makes from tables of numbers."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, Generic, NamedTuple

import numpy as np

from ...core import lib
from ..base import Card, card_of, doubles, text
from ..measures import given
from . import element_tables
from .core import MechanismCore
from .element_tables import ZERO, GeneralizedForce, Group, OutputSpec, Relation, Scalar

QUANTITY_KINDS = {"x": lib.ZD_PLANE_X, "y": lib.ZD_PLANE_Y, "angle": lib.ZD_PLANE_ANGLE, "along": lib.ZD_PLANE_ALONG,
                  "across": lib.ZD_PLANE_ACROSS, "distance": lib.ZD_PLANE_DISTANCE, "glide": lib.ZD_PLANE_GLIDE,
                  "skid": lib.ZD_PLANE_SKID, "shear": lib.ZD_PLANE_SHEAR, "orbit": lib.ZD_PLANE_ORBIT}
ONE: Any = 1.0
INBOARD_TYPES = {lib.ZD_NOT_INBOARD: None, lib.ZD_TURNS: "turns", lib.ZD_SLIDES: "slides", lib.ZD_FIXED: "fixed"}
ZEROS = {lib.ZD_ZERO_NONE: None, lib.ZD_ZERO_ALONG: "along", lib.ZD_ZERO_ACROSS: "across", lib.ZD_ZERO_ANGLE: "angle",
         lib.ZD_ZERO_LENGTH: "length"}
COORDINATES = {lib.ZD_COORDINATE_X: "x", lib.ZD_COORDINATE_Y: "y", lib.ZD_COORDINATE_ANGLE: "angle",
               lib.ZD_COORDINATE_DISPLACEMENT: "displacement"}


class JointRow(NamedTuple):
    """Constraint of a kind of joint: a marker quantity that must be zero, and the number of the joint that is its offset."""

    quantity: str
    zero: str | None
    rolls: bool
    nonholonomic: bool


class JointKind(NamedTuple):
    """A kind of joint; see `zd_plane_joint_kind`. `inboard` is None if it cannot be a tree joint."""

    number: int
    card: Card
    inboard: str | None
    rows: tuple[JointRow, ...]
    coordinate: str | None      # "angle" or "displacement"
    quantity: str | None        # the kind of that marker quantity
    zero: str | None
    takes_axis: bool
    takes_length: bool
    at_contact: bool
    tension: str | None


class Body(NamedTuple):
    """A `zd_plane_body`; bodies are numbered from 1, 0 is the ground."""

    mass: float
    inertia: float = 0.0
    is_particle: bool = False
    inboard: int = -1           # the joint of the tree that carries it; -1: it is free


class Joint(NamedTuple):
    """A `zd_plane_joint`. Points are in the axes of their body and from its mass centre; `axis` in the first body's axes."""

    kind: int                   # JointKind.number
    first: int
    second: int
    point1: tuple[float, float] = (0.0, 0.0)
    point2: tuple[float, float] = (0.0, 0.0)
    axis: tuple[float, float] = (1.0, 0.0)
    along: float = 0.0          # what e . (Q - P), n . (Q - P) and the angle are where the joint says zero
    across: float = 0.0
    angle: float = 0.0
    length: float = 0.0         # of a rod; radius of a rolling wheel


class Quantity(NamedTuple, Generic[Scalar]):
    """A `zd_plane_quantity`; `kind` is a key of QUANTITY_KINDS."""

    kind: str
    first: int
    second: int
    point1: tuple[Scalar, Scalar] = (ZERO, ZERO)
    point2: tuple[Scalar, Scalar] = (ZERO, ZERO)
    axis: tuple[Scalar, Scalar] = (ONE, ZERO)
    zero: Scalar = ZERO         # taken from the reading


class Tables(NamedTuple):
    """Tables from which the core makes a mechanism."""

    bodies: Sequence[Body]
    joints: Sequence[Joint] = ()
    quantities: Sequence[Quantity] = ()
    relations: Sequence[Relation] = ()
    forces: Sequence[GeneralizedForce] = ()
    measures: Sequence[OutputSpec] = ()
    gravity: tuple[float, float] = (0.0, 0.0)
    reactions: Mapping[str, tuple[int, int]] = MappingProxyType({})     # measure and component of those that laws read
    length: float = 1.0         # m: that moments are divided by in the least reactions
    groups: Sequence[Group] = ()


class Coordinate(NamedTuple):
    """Meaning of an entry of p and of v: "x", "y" or "angle" of a body, or "displacement" of its inboard joint."""

    body: int
    kind: str


def _joint_kind(number: int) -> JointKind:
    c = lib.zd_plane_joint_kind_of(number)
    names = {value: name for name, value in QUANTITY_KINDS.items()}
    rows = tuple(JointRow(names[row.quantity], ZEROS[row.zero], bool(row.rolls), bool(row.nonholonomic))
                 for row in (c.row[i] for i in range(c.rows)))
    coordinate = text(c.coordinate) if c.coordinate else None
    return JointKind(number, card_of(c.card), INBOARD_TYPES[c.inboard], rows, coordinate,
                     names[c.quantity] if coordinate else None, ZEROS[c.zero] if coordinate else None,
                     bool(c.takes_axis), bool(c.takes_length), bool(c.at_contact), text(c.tension) if c.tension else None)


def _element_quantities(c: Any) -> tuple[element_tables.ElementQuantity, ...]:
    names = {value: name for name, value in QUANTITY_KINDS.items()}
    return tuple(element_tables.ElementQuantity(names[c.quantity[i]], ZEROS[c.zero[i]]) for i in range(c.quantities))


def joint_kinds() -> dict[str, JointKind]:
    """The core's table of joints by name."""
    return {kind.card.name: kind for kind in map(_joint_kind, range(lib.zd_plane_joint_kinds()))}


def element_kinds() -> dict[str, element_tables.ElementKind]:
    """The core's table of force elements by name."""
    return element_tables.element_kinds(lib.zd_plane_element_kinds(), lib.zd_plane_element_kind_of, _element_quantities)


class PlaneCore(MechanismCore):
    """The core's system of a planar mechanism."""

    dimension, quantity_kinds, velocities, made_by = "plane", QUANTITY_KINDS, 3, lib.zd_plane_create

    @functools.cached_property
    def motions(self) -> tuple[Coordinate, ...]:
        """Coordinate whose rate each entry of v is."""
        coordinates = lib.zd_plane_coordinates(self._mechanism)
        return tuple(Coordinate(coordinates[i].body, COORDINATES[coordinates[i].kind]) for i in range(self.nq))

    @property
    def origin(self) -> np.ndarray:
        """Arbitrary valid positions (nq,)."""
        return np.zeros(self.nq)

    def poses(self, p: np.ndarray, v: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray | None]:
        """Poses (bodies, 3) of the mass centres, x, y, angle, and their rates where v is given; without the ground."""
        scratch, shape = np.zeros(max(1, lib.zd_plane_system(self._mechanism).scratch)), (len(self.tables.bodies), 3)
        poses, rates = np.zeros(shape), None if v is None else np.zeros(shape)
        lib.zd_plane_poses(self._mechanism, doubles(p, self.nq), given(v, self.nv), given(poses, poses.size),
                               given(rates, poses.size), doubles(scratch, scratch.size, writable=True))
        return poses, rates

    def state(self, poses: np.ndarray, rates: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """(p, v) from poses and rates as `poses` returns them; components that tree joints do not allow are ignored."""
        size = 3 * len(self.tables.bodies)
        p, v = np.zeros(self.nq), np.zeros(self.nv)
        lib.zd_plane_state(self._mechanism, doubles(poses, size), given(rates, size), doubles(p, p.size, writable=True),
                               doubles(v, v.size, writable=True))
        return p, v
