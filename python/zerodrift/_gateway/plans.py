"""Plan of a planar mechanism, made by the core: a tree of links, constraints and forces on marker quantities.

It has no joints, as each is converted to a link or to constraints. So generated equations need only the tree and the marker
quantities.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .._core import ffi, lib
from .element_tables import EFFORTS, Effort, Relation
from .mechanisms import GAUGES, Gauge, MechanismCore

FREE, FREE_POINT, TURNING = lib.ZD_HANGS_FREE, lib.ZD_HANGS_FREE_POINT, lib.ZD_HANGS_TURNING
SLIDING, FIXED, PINNED = lib.ZD_HANGS_SLIDING, lib.ZD_HANGS_FIXED, lib.ZD_HANGS_PINNED
KINDS = {value: name for name, value in GAUGES.items()}
EFFORT_KINDS = {value: name for name, value in EFFORTS.items()}


class Link(NamedTuple):
    """A `zd_plane_link`: connection of a body to its parent. `hang` is FREE, FREE_POINT, TURNING, SLIDING, FIXED or PINNED."""

    hang: int
    inner: int
    coordinate: int
    near: tuple[Any, Any]
    far: tuple[Any, Any]
    axis: tuple[Any, Any]
    along: Any
    angle: Any
    cosine: Any
    sine: Any
    mass: Any
    inertia: Any


class Plan(NamedTuple):
    """A `zd_plane_plan`; bodies have the tree's numbers, the first link is that of body 1, and all gauges are used."""

    links: tuple[Link, ...]
    gauges: tuple[Gauge, ...]
    rows: tuple[Relation, ...]          # holonomic ones first; their gauges are numbers in `gauges`
    efforts: tuple[Effort, ...]
    gravity: tuple[Any, Any]


def plan_of(core: MechanismCore) -> Plan:
    """The plan of a mechanism."""
    c = lib.zd_plane_planned(core._mechanism)
    links = tuple(_link(c.link[i]) for i in range(1, len(core.tables.bodies) + 1))
    used: dict[int, int] = {}       # by their numbers in the core's table, as measures have gauges of their own there
    rows, efforts = rows_of_plan(c, core.m, used), efforts_of(c, len(core.tables.efforts), used)
    return Plan(links, tuple(_gauge(c.gauge[i]) for i in used), rows, efforts, core.tables.gravity)


def _pair(vector: Any) -> tuple[float, float]:
    return vector.x, vector.y


def _link(c: Any) -> Link:
    return Link(int(ffi.cast("int", c.hang)), c.inner, c.coordinate, _pair(c.near), _pair(c.far), _pair(c.axis), c.along, c.angle,
                c.cosine, c.sine, c.mass, c.inertia)


def _gauge(c: Any) -> Gauge:
    return Gauge(KINDS[c.kind], c.first, c.second, tuple(c.point1), tuple(c.point2), tuple(c.axis), c.zero)


def _terms(c: Any, of: Any, used: dict[int, int]) -> tuple[list[int], list[float]]:
    """The gauges of a row or effort, and its coefficients."""
    terms = [c.term[i] for i in range(of.first, of.first + of.terms)]
    return [used.setdefault(term.gauge, len(used)) for term in terms], [term.coefficient for term in terms]


def rows_of_plan(c: Any, count: int, used: dict[int, int]) -> tuple[Relation, ...]:
    """The rows of C; `used` gets the gauges that they have, by the core's numbers."""
    return tuple(_row(c, c.row[i], used) for i in range(count))


def efforts_of(c: Any, count: int, used: dict[int, int]) -> tuple[Effort, ...]:
    """The efforts, likewise."""
    return tuple(_effort(c, c.effort[i], used) for i in range(count))


def _row(c: Any, row: Any, used: dict[int, int]) -> Relation:
    gauges, coefficients = _terms(c, row, used)
    return Relation(gauges, coefficients, row.constant, row.slope, bool(row.nonholonomic), row.law)


def _effort(c: Any, effort: Any, used: dict[int, int]) -> Effort:
    along = used.setdefault(effort.gauge, len(used))
    inputs, _ = _terms(c, effort, used)
    return Effort(EFFORT_KINDS[effort.kind], along, effort.stiffness, effort.damping, effort.value, effort.law, inputs)
