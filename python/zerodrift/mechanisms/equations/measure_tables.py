"""Measures of a mechanism as entries of the core's table, made at first use.

A run without measures needs no such table.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from functools import partial
from typing import Any, NamedTuple

from ..._private import checks
from ..._private.gateway.mechanisms.core import MechanismCore
from ..._private.gateway.mechanisms.element_tables import OutputSpec
from ...errors import WrongValue
from ..elements.bodies import Body, Link, Point
from ..elements.forces import Actuator, Bushing
from ..elements.joints import Joint, holds_angle, is_hinge
from ..elements.space_joints import SpaceJoint, acceleration_of, has_torque, is_at_point, speeds
from ..elements.table_forces import TableForce
from ..loads.group_measures import group_measures
from . import transmission
from .measure_names import has_coordinate
from .space_tables import SpaceTables
from .tables import Tables


class Position(NamedTuple):
    """Measure of positions, its first and second rate if these are measures, and a function that makes its marker quantities."""

    name: str | None        # None if only the rate exists, as for an angular velocity in space
    unit: str
    rate: str | None
    second_rate: str | None
    quantities: Callable[[], tuple[Any, ...]]


def measuring(tables: Tables, only: Collection[str] | None = None) -> MechanismCore:
    """Core system with all measures, or with those of positions and velocities in `only` and their components."""
    core = tables.core(*read(tables, only))
    for name in tables.drawing.reactions() if only is None else ():
        if name not in core.tables.reactions:
            raise WrongValue(f"user functions must depend on scalar measures, and {name!r} is not one; "
                             f"{checks.closest(name, [each.name for each in core.measures])}", "wrong-measure")
    return core


def read(tables: Tables, only: Collection[str] | None = None) -> tuple[list[Any], list[OutputSpec]]:
    """Marker quantities of the tables and of these measures, and the measures."""
    quantities, observed = list(tables.quantities), []
    wanted = None if only is None else {*only, *(name.rpartition(".")[0] for name in only)}
    for position in _positions(tables, wanted):
        if wanted is not None and position.name not in wanted and position.rate not in wanted:
            continue
        reads = position.quantities()
        if position.name:
            observed.append(OutputSpec(position.name, position.unit, "values", len(quantities), len(reads)))
        if position.rate:
            observed.append(OutputSpec(position.rate, f"{position.unit}/s", "rates", len(quantities), len(reads)))
        if position.second_rate and wanted is None:
            observed.append(
                OutputSpec(position.second_rate, f"{position.unit}/s^2", "accelerations", len(quantities), len(reads)))
        quantities += reads
    if wanted is None:
        observed += [*_of_joints(tables), *tables.observed, *group_measures(tables, quantities)]
    return quantities, observed


def _positions(tables: Tables, wanted: Collection[str] | None) -> Iterator[Position]:
    """Measures of positions of bodies, named points, joints and springs.

    Transmission angles are included only if wanted, as each search covers all joints of two bodies.
    """
    if isinstance(tables, SpaceTables):
        yield from _positions_in_space(tables)
        return
    for body in tables.drawing.of(Body):
        if body is tables.drawing.ground:
            continue
        yield _place(tables, body.name, body)
        if body.turns:
            yield Position(f"{body.name}.angle", "rad", f"{body.name}.angular_velocity", f"{body.name}.angular_acceleration",
                           partial(_one, tables.angle_quantity, body))
            for point in (*((body.start, body.end) if isinstance(body, Link) else ()), body.center):
                yield _place(tables, point.name, point)
    for point in tables.drawing.of(Point):
        yield _place(tables, point.name, point)
    for joint in tables.drawing.of(Joint):
        if has_coordinate(joint) and joint.parts:
            unit = "rad" if joint.coordinate == "angle" else "m"
            yield Position(f"{joint.name}.{joint.coordinate}", unit, f"{joint.name}.speed", f"{joint.name}.acceleration",
                           partial(_one, tables.coordinate_quantity, tables.joint_number[joint.name]))
        between = f"{joint.name}.transmission_angle"
        if (wanted is None or between in wanted) and transmission.has_one(joint, tables.joints_by_body):
            yield Position(between, "rad", None, None, partial(_one, tables.transmission_quantity, joint))
        if is_hinge(joint.row):     # without a second rate: its name is that of the angle's acceleration
            yield _place(tables, joint.name, joint.second)._replace(second_rate=None)
    yield from _lengths(tables)


def _positions_in_space(tables: SpaceTables) -> Iterator[Position]:
    """Measures of positions in space, with their rates."""
    for body in tables.drawing.of(Body):
        if body is tables.drawing.ground:
            continue
        yield _place(tables, body.name, body)
        if body.turns:
            yield Position(f"{body.name}.rotation", "", None, None, partial(tables.rotation_quantities, body))
            yield Position(None, "rad", f"{body.name}.angular_velocity", f"{body.name}.angular_acceleration",
                           partial(tables.spin_quantities, body))
            for point in (*((body.start, body.end) if isinstance(body, Link) else ()), body.center):
                yield _place(tables, point.name, point)
    for point in tables.drawing.of(Point):
        yield _place(tables, point.name, point)
    for joint in tables.joints:
        for speed, coordinate in speeds(joint.row).items():
            unit = "m" if dict(joint.row.coordinates)[coordinate] == "along" else "rad"
            yield Position(f"{joint.name}.{coordinate}", unit, f"{joint.name}.{speed}", f"{joint.name}.{acceleration_of(speed)}",
                           partial(_one, tables.coordinate_quantity_of, joint, coordinate))
        if is_at_point(joint.row):
            yield _place(tables, joint.name, joint.second)._replace(second_rate=None)
    yield from _lengths(tables)


def _lengths(tables: Tables) -> Iterator[Position]:
    for each in (*tables.drawing.of(Actuator), *tables.drawing.of(TableForce)):
        if each.coordinate:
            yield Position(f"{each.name}.length", "m", f"{each.name}.speed", None, partial(_one, tables.length_quantity, each))
    for bushing in tables.drawing.of(Bushing):
        name = bushing.name
        for value, unit, rate in (("displacement", "m", "velocity"), ("angle", "rad", ""), ("turn", "rad", "angular_velocity")):
            yield Position(f"{name}.{value}" if value != "turn" else None, unit, f"{name}.{rate}" if rate else None, None,
                           partial(tables.bushing_quantities, bushing, value))


def _one(of: Callable[..., Any], *arguments: Any) -> tuple[Any]:
    return (of(*arguments),)


def _place(tables: Tables, name: str, of: Body | Point) -> Position:
    return Position(f"{name}.position", "m", f"{name}.velocity", f"{name}.acceleration", partial(tables.place_quantities, of))


def _of_joints(tables: Tables) -> Iterator[OutputSpec]:
    """Reactions of joints."""
    for joint in tables.drawing.of(Joint):
        if not joint.parts:
            continue
        i = tables.joint_number[joint.name]
        yield OutputSpec(f"{joint.name}.force", "N", "joint force", i, joint.dimension,
                         term=len(joint.parts) - 1)
        if isinstance(joint, SpaceJoint):
            turns, slides = has_torque(joint.row) or bool(joint.damping), not is_at_point(joint.row)
        else:
            turns = holds_angle(joint.row) or (has_coordinate(joint) and joint.coordinate == "angle")
            slides = joint.coordinate == "displacement"
        size = 2 * joint.dimension - 3
        if turns:
            yield OutputSpec(f"{joint.name}.torque", "N m", "joint torque", i, size)
        if turns and slides:
            yield OutputSpec(f"{joint.name}.first_torque", "N m", "joint torque", i, size, -1.0, 1)
        if joint.row.tension:
            yield OutputSpec(f"{joint.name}.{joint.row.tension}", "N", "joint tension", i)
