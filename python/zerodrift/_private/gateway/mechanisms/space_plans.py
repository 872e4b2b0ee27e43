"""Plan of a mechanism in space, made by the core: a tree of links, constraints and forces on marker quantities.

As in the plane it has no joints: a tree joint is converted to the freedoms of a link, any other joint to constraints. In absolute
coordinates all links are free.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Generic, NamedTuple

import numpy as np

from ...core import lib
from .element_tables import GeneralizedForce, Relation, Scalar, Triple, three
from .plans import forces_of, rows_of_plan
from .space import AS_DRAWN, NONE, Freedom, Joint, Quantity, SpaceCore, coordinate_quantity, joint_kinds, quantity_of

COORDINATES, VELOCITIES = {"swings": 4}, {"swings": 3}      # of a freedom; of all others one each


class Way(NamedTuple, Generic[Scalar]):
    """A freedom of a link on its way outwards: `direction` is that of the joint's frame, `sign` -1 where the joint is taken
    backwards, and `zero` in m and `length` in m for each rad are 0 where its kind has none.
    """

    kind: str
    direction: int
    sign: int
    zero: Scalar
    length: Scalar
    p: int
    v: int


class Link(NamedTuple, Generic[Scalar]):
    """Link of the tree: a body and its inboard joint, as point and frame in the axes of both bodies; a free body has none."""

    inner: int
    turns: bool
    p: int
    v: int
    mass: Scalar
    inertia: Triple[Scalar]
    ways: tuple[Way[Scalar], ...] | None
    near: Triple[Scalar] = NONE
    far: Triple[Scalar] = NONE
    near_axes: Triple[Triple[Scalar]] = AS_DRAWN
    far_axes: Triple[Triple[Scalar]] = AS_DRAWN


class Angle(NamedTuple, Generic[Scalar]):
    """Angle of a joint: its marker quantity, the axis in the axes of that quantity's first body, and its index in p."""

    quantity: Quantity[Scalar]
    axis: Triple[Scalar]
    place: int


class SpacePlan(NamedTuple, Generic[Scalar]):
    """Plan of a mechanism in space; links are numbered as bodies, from 1, and all marker quantities are used."""

    links: tuple[Link[Scalar], ...]
    quantities: tuple[Quantity[Scalar], ...]
    rows: tuple[Relation[Scalar], ...]  # holonomic ones first; their marker quantities are numbers in `quantities`
    forces: tuple[GeneralizedForce[Scalar], ...]
    angles: tuple[Angle[Scalar], ...]
    followers: int                      # how many of the last entries of p follow the others
    gravity: Triple[Scalar]
    has_rates: bool                     # whether rates of p are more than v


def plan_of(core: Any, measured: Sequence[int] = ()) -> SpacePlan:
    """The plan of a mechanism; marker quantities of measures, by their numbers in the core's table, follow those in use."""
    c, tables = lib.zd_space_planned(core._mechanism), core.tables
    used: dict[int, int] = {}       # by their numbers in the core's table, as measures have marker quantities of their own there
    rows, forces = rows_of_plan(c, core.m, used), forces_of(c, len(tables.forces), used)
    quantities = tuple(quantity_of(c.quantity[i]) for i in (*used, *measured))
    return SpacePlan(_links(core), quantities, rows, forces, _angles(core), core.c.followers, three(tables.gravity),
                     bool(core.provides & lib.ZD_A))


def _links(core: SpaceCore) -> tuple[Link, ...]:
    links, p, v, kinds = [], 0, 0, {kind.number: kind for kind in joint_kinds().values()}
    for number, body in enumerate(core.tables.bodies, 1):
        turns, place = not body.is_particle, (p, v, body.mass, three(body.inertia))
        if body.inboard < 0:
            links.append(Link(0, turns, *place, None))
            p, v = p + (7 if turns else 3), v + (6 if turns else 3)
            continue
        joint = core.tables.joints[body.inboard]
        ways = _ways(joint, [each for each in kinds[joint.kind].freedoms or () if turns or each.kind != "swings"], p, v)
        ends = [(joint.first, joint.point1, joint.frame1), (joint.second, joint.point2, joint.frame2)]
        if joint.second != number:
            ends, ways = ends[::-1], tuple(way._replace(sign=-1) for way in reversed(ways))
        (inner, near, near_axes), (_, far, far_axes) = ends
        links.append(Link(inner, turns, *place, ways, near, far, near_axes, far_axes))
        p, v = p + sum(COORDINATES.get(way.kind, 1) for way in ways), v + sum(VELOCITIES.get(way.kind, 1) for way in ways)
    return tuple(links)


def _ways(joint: Joint, freedoms: list[Freedom], p: int, v: int) -> tuple[Way, ...]:
    """Freedoms of a joint; its coordinates have the order of its table in both directions."""
    ways = []
    for each in freedoms:
        ways.append(Way(each.kind, each.direction, 1, joint.along if each.from_along else 0.0, joint.length, p, v))
        p, v = p + COORDINATES.get(each.kind, 1), v + VELOCITIES.get(each.kind, 1)
    return tuple(ways)


def _angles(core: SpaceCore) -> tuple[Angle, ...]:
    angles: list[Angle] = []
    kinds = {kind.number: kind for kind in joint_kinds().values()}
    for joint in core.tables.joints:
        before = len(angles)
        for i, (_, kind) in enumerate(kinds[joint.kind].coordinates):
            if kind == "angle":
                quantity = coordinate_quantity(joint, i, before)
                is_skew = kinds[joint.kind].axes == 2 and joint.along != 0
                axis = NONE if is_skew else three(np.cross(quantity.a, quantity.o).tolist())
                angles.append(Angle(quantity, axis, int(core._angle_at[len(angles)])))
    return tuple(angles)
