"""Plan of a planar mechanism, made by the core: a tree of links, constraints and forces on marker quantities.

It has no joints, as each is converted to a link or to constraints. So generated equations need only the tree and the marker
quantities.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Generic, NamedTuple

from ...core import ffi, lib
from .core import MechanismCore
from .element_tables import FORCE_KINDS, GeneralizedForce, Relation, Scalar
from .plane import QUANTITY_KINDS, Quantity

FREE, FREE_POINT, TURNING = lib.ZD_HANGS_FREE, lib.ZD_HANGS_FREE_POINT, lib.ZD_HANGS_TURNING
SLIDING, FIXED, PINNED = lib.ZD_HANGS_SLIDING, lib.ZD_HANGS_FIXED, lib.ZD_HANGS_PINNED
NAMES_OF_QUANTITIES = {value: name for name, value in QUANTITY_KINDS.items()}
NAMES_OF_FORCES = {value: name for name, value in FORCE_KINDS.items()}


class Link(NamedTuple, Generic[Scalar]):
    """A `zd_plane_link`: connection of a body to its parent. `hang` is FREE, FREE_POINT, TURNING, SLIDING, FIXED or PINNED."""

    hang: int
    inner: int
    coordinate: int
    near: tuple[Scalar, Scalar]
    far: tuple[Scalar, Scalar]
    axis: tuple[Scalar, Scalar]
    along: Scalar
    angle: Scalar
    cosine: Scalar
    sine: Scalar
    mass: Scalar
    inertia: Scalar


class PlanePlan(NamedTuple, Generic[Scalar]):
    """A `zd_plane_plan`; bodies have the tree's numbers, the first link is that of body 1, and all marker quantities are used."""

    links: tuple[Link[Scalar], ...]
    quantities: tuple[Quantity[Scalar], ...]
    rows: tuple[Relation[Scalar], ...]  # holonomic ones first; their marker quantities are numbers in `quantities`
    forces: tuple[GeneralizedForce[Scalar], ...]
    gravity: tuple[Scalar, Scalar]


def plan_of(core: MechanismCore, measured: Sequence[int] = ()) -> PlanePlan:
    """The plan of a mechanism; marker quantities of measures, by their numbers in the core's table, follow those in use."""
    c = lib.zd_plane_planned(core._mechanism)
    links = tuple(_link(c.link[i]) for i in range(1, len(core.tables.bodies) + 1))
    used: dict[int, int] = {}       # by their numbers in the core's table, as measures have marker quantities of their own there
    rows, forces = rows_of_plan(c, core.m, used), forces_of(c, len(core.tables.forces), used)
    return PlanePlan(links, tuple(_quantity(c.quantity[i]) for i in (*used, *measured)), rows, forces, core.tables.gravity)


def _pair(vector: Any) -> tuple[float, float]:
    return vector.x, vector.y


def _link(c: Any) -> Link:
    return Link(int(ffi.cast("int", c.hang)), c.inner, c.coordinate, _pair(c.near), _pair(c.far), _pair(c.axis), c.along, c.angle,
                c.cosine, c.sine, c.mass, c.inertia)


def _quantity(c: Any) -> Quantity:
    return Quantity(NAMES_OF_QUANTITIES[c.kind], c.first, c.second, tuple(c.point1), tuple(c.point2), tuple(c.axis), c.zero)


def _terms(c: Any, of: Any, used: dict[int, int]) -> tuple[list[int], list[float]]:
    """Marker quantities of a constraint or generalized force, and its coefficients."""
    terms = [c.term[i] for i in range(of.first, of.first + of.terms)]
    return [used.setdefault(term.quantity, len(used)) for term in terms], [term.coefficient for term in terms]


def rows_of_plan(c: Any, count: int, used: dict[int, int]) -> tuple[Relation, ...]:
    """Constraints of the plan; their marker quantities are added to `used` under the core's numbers."""
    return tuple(_row(c, c.row[i], used) for i in range(count))


def forces_of(c: Any, count: int, used: dict[int, int]) -> tuple[GeneralizedForce, ...]:
    """Generalized forces of the plan that act in motions; `used` likewise."""
    return tuple(_generalized_force(c, c.force[i], used) for i in range(count) if c.force[i].kind != lib.ZD_FORCE_SEPARATION)


def _row(c: Any, row: Any, used: dict[int, int]) -> Relation:
    quantities, coefficients = _terms(c, row, used)
    return Relation(quantities, coefficients, row.constant, row.slope, bool(row.nonholonomic), row.law)


def _generalized_force(c: Any, force: Any, used: dict[int, int]) -> GeneralizedForce:
    along = used.setdefault(force.quantity, len(used))
    inputs, _ = _terms(c, force, used)
    return GeneralizedForce(NAMES_OF_FORCES[force.kind], along, force.stiffness, force.damping, force.value, force.law, inputs)
