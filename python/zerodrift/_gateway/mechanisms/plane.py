"""Mechanisms from bodies and joints: the core's tables of joints and elements, and the system it makes from tables of numbers."""

from __future__ import annotations

import copy
import functools
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ..._core import ffi, lib
from ...errors import WrongValue
from ..base import MESSAGE_SIZE, Card, card_of, doubles, text
from ..measures import given
from ..systems import CoreSystem
from . import element_tables
from .assembly import displaced, displacement
from .element_tables import GeneralizedForce, OutputSpec, Relation, Row, law_sizes, rows_of, written_elements
from .law_owner import Law, LawOwner, calls_python, compiled_table

QUANTITY_KINDS = {"x": lib.ZD_PLANE_X, "y": lib.ZD_PLANE_Y, "angle": lib.ZD_PLANE_ANGLE, "along": lib.ZD_PLANE_ALONG,
                  "across": lib.ZD_PLANE_ACROSS, "distance": lib.ZD_PLANE_DISTANCE, "glide": lib.ZD_PLANE_GLIDE,
                  "skid": lib.ZD_PLANE_SKID}
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
    """A kind of joint; see `zd_plane_joint_kind`. `carrier` is None if it cannot be a tree joint."""

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


class Quantity(NamedTuple):
    """A `zd_plane_quantity`; `kind` is a key of QUANTITY_KINDS."""

    kind: str
    first: int
    second: int
    point1: tuple[float, float] = (0.0, 0.0)
    point2: tuple[float, float] = (0.0, 0.0)
    axis: tuple[float, float] = (1.0, 0.0)
    zero: float = 0.0           # taken from the reading


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


class MechanismCore(CoreSystem):
    """The core's system of a mechanism.

    Parameters
    ----------
    tables : Tables
    law : callable, optional
        ``law(number, t, x, xdot)`` gives, for a generalized force, (1,): its value; for a relation with k marker quantities
        (k + 3,): g, dg/dx_i, dg/dt, and d(dg/dx_i)/dt xdot_i + d(dg/dt)/dt; for a nonholonomic one 0, a_i, a_0, and
        da_i/dt xdot_i + da_0/dt.
    laws_know_time : bool
        True if a law depends on t explicitly, not only through positions and velocities.

    Attributes
    ----------
    measures : tuple of OutputSpec

    Raises
    ------
    ValueError
        If the tables contradict themselves; the sentence says where.
    """

    def __init__(self, tables: Tables, law: Law | None = None, *, laws_know_time: bool = True) -> None:
        self.tables, self._law, self._laws_know_time = tables, law, laws_know_time
        self._owner: LawOwner | None = None
        self._numbers, self._has_written_terms = ffi.NULL, False
        self.written_inputs: Any = None
        self._mechanism, self._words = _create(tables, law is not None, laws_know_time)
        super().__init__(lib.zd_plane_system(self._mechanism), (self._mechanism,))
        self.measures = tuple(tables.measures)

    @functools.cached_property
    def rows(self) -> tuple[Row, ...]:
        """Origin of each constraint, holonomic ones first."""
        return rows_of(lib.zd_plane_rows(self._mechanism), self.m)

    @functools.cached_property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Meaning of each entry of p."""
        coordinates = lib.zd_plane_coordinates(self._mechanism)
        return tuple(Coordinate(coordinates[i].body, COORDINATES[coordinates[i].kind]) for i in range(self.nq))

    @property
    def motions(self) -> tuple[Coordinate, ...]:
        """Coordinate whose rate each entry of v is."""
        return self.coordinates

    @property
    def origin(self) -> np.ndarray:
        """Arbitrary valid positions (nq,)."""
        return np.zeros(self.nq)

    def moved(self, p: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Positions (nq,) after a displacement (nv,)."""
        return displaced(self, p, step)

    def apart(self, p: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Displacement (nv,) from other positions to p."""
        return displacement(self, p, other)

    def for_run(self) -> MechanismCore:
        """The system; with user functions, a copy that stores their exceptions."""
        if self._law is None:
            return self
        sizes = law_sizes(self.tables)
        owner = LawOwner(self._law, sizes)
        # Written terms have the laws in them, and leave them to measures.
        compiled = (ffi.NULL, None) if self._has_written_terms else compiled_table(self._law, sizes)
        mine = self._with_data(ffi.new_handle(owner), self._numbers, compiled)
        mine._owner = owner
        return mine

    def many_bodies(self) -> Any:
        """Components of measures for the assembly of many free bodies."""
        return ffi.new("zd_many_bodies *", (self._mechanism, ffi.addressof(lib, "zd_plane_components"), 3))

    def _with_data(self, handle: Any, numbers: Any, compiled: tuple[Any, Any] = (ffi.NULL, None)) -> MechanismCore:
        mine = copy.copy(self)
        data = ffi.new("char[]", lib.zd_plane_data_size())
        lib.zd_plane_with(self._mechanism, handle, compiled[0], numbers, data)
        mine.c = ffi.new("zd_system *", self.c[0])
        mine.c.data, mine._data, mine._numbers = data, (*self._data, handle, *compiled, numbers, data), numbers
        return mine

    @property
    def lane_numbers(self) -> Any:
        """Numbers that generated closed-form functions read, an array of C, or None without such functions."""
        return self._numbers if self.has_closed_form and self._numbers else None

    @property
    def calls_python(self) -> bool:
        """True if the mechanism has user functions that are not compiled, and terms that call them."""
        return calls_python(self, law_sizes(self.tables))

    @property
    def error(self) -> BaseException | None:
        """Exception raised by a user function, or None."""
        return self._owner.error if self._owner else None

    @property
    def refusal(self) -> BaseException | None:
        """Error for the last values of a user function that were not finite, which shorter steps may have avoided since."""
        return self._owner.refusal if self._owner else None

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


def _create(tables: Tables, has_laws: bool, laws_know_time: bool) -> tuple[Any, Any]:
    """The core's mechanism, and the texts to keep with it."""
    written, words = written_tables(tables, has_laws, laws_know_time)
    c = ffi.new("zd_plane_tables *", written)
    message = ffi.new("char[]", MESSAGE_SIZE)
    mechanism = lib.zd_plane_create(c, message, MESSAGE_SIZE)
    if not mechanism:
        raise WrongValue(text(message))
    return ffi.gc(mechanism, lib.zd_plane_free), words


def written_tables(tables: Tables, has_laws: bool, laws_know_time: bool) -> tuple[dict[str, Any], Any]:
    """Fields of a `zd_plane_tables`, and the words that must live as long as the objects made from it."""
    bodies, joints = ffi.new("zd_plane_body[]", list(tables.bodies)), ffi.new("zd_plane_joint[]", list(tables.joints))
    quantities = ffi.new("zd_plane_quantity[]", [(QUANTITY_KINDS[kind], *others) for kind, *others in tables.quantities])
    elements, words = written_elements(tables, has_laws, laws_know_time)
    return {"gravity": tables.gravity, "bodies": len(bodies), "joints": len(joints), "quantities": len(quantities),
            "body": bodies, "joint": joints, "quantity": quantities, "elements": elements}, words
