"""Constraints, forces and measures along marker quantities, in the plane and in space, as tables for the core."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from .._core import ffi, lib

EFFORTS = {"spring": lib.ZD_EFFORT_SPRING, "constant": lib.ZD_EFFORT_CONSTANT, "law": lib.ZD_EFFORT_LAW}
QUANTITIES = {
    "values": lib.ZD_VALUES, "rates": lib.ZD_RATES, "accelerations": lib.ZD_ACCELERATIONS, "joint force": lib.ZD_JOINT_FORCE,
    "joint torque": lib.ZD_JOINT_TORQUE, "joint tension": lib.ZD_JOINT_TENSION, "effort": lib.ZD_EFFORT_VALUE,
    "effort power": lib.ZD_EFFORT_POWER, "drive": lib.ZD_DRIVE_VALUE, "drive power": lib.ZD_DRIVE_POWER,
    "effort force": lib.ZD_EFFORT_FORCE, "effort torque": lib.ZD_EFFORT_TORQUE}


class Relation(NamedTuple):
    """A row of `zd_relation`: sum of coefficients times gauges - constant - slope t = 0, or by a law."""

    gauges: Sequence[int]
    coefficients: Sequence[float] = ()      # without a law
    constant: float = 0.0
    slope: float = 0.0
    nonholonomic: bool = False
    law: int = -1
    joint: int = -1             # to whose force and torque it contributes as its drive


class Effort(NamedTuple):
    """A row of `zd_effort`; `kind` is a key of EFFORTS."""

    kind: str
    gauge: int
    stiffness: float = 0.0
    damping: float = 0.0
    value: float = 0.0
    law: int = -1
    inputs: Sequence[int] = ()  # gauges that the law depends on
    joint: int = -1             # to whose force and torque it contributes


class Observed(NamedTuple):
    """A row of `zd_output_spec`: a measure by its name; `quantity` is a key of QUANTITIES."""

    name: str
    unit: str
    quantity: str
    index: int                  # of the first gauge, the joint, effort or relation
    size: int = 1               # of values, rates, accelerations; of an effort force, of how many efforts
    scale: float = 1.0
    term: int = 0               # of drives: along which of the relation's gauges


class Row(NamedTuple):
    """Origin of a constraint: a joint (component: index among its constraints), or a relation."""

    owner: str                  # "joint" or "relation"
    index: int
    component: int


def rows_of(rows: Any, m: int) -> tuple[Row, ...]:
    """Origin of each constraint, from a `zd_row_owner *`."""
    return tuple(Row("joint" if rows[i].owner == lib.ZD_OF_JOINT else "relation", rows[i].index, rows[i].component)
                 for i in range(m))


def law_sizes(tables: Any) -> dict[int, tuple[int, int]]:
    """Number of marker quantities that each user function takes, and number of values that it returns, by its index."""
    sizes = {effort.law: (len(effort.inputs), 1) for effort in tables.efforts if effort.law >= 0}
    return sizes | {row.law: (len(row.gauges), len(row.gauges) + 3) for row in tables.relations if row.law >= 0}


def written_elements(tables: Any, has_laws: bool, laws_know_time: bool) -> tuple[dict[str, Any], Any]:
    """Fields of a `zd_elements`, and the words that must live as long as the objects made from it."""
    terms: list[tuple[int, float]] = []
    relations, efforts = [], []
    for row in tables.relations:
        relations.append((len(terms), len(row.gauges), row.nonholonomic, row.law, row.constant, row.slope, row.joint))
        terms += zip(row.gauges, row.coefficients or [1.0] * len(row.gauges), strict=True)
    for effort in tables.efforts:
        efforts.append((EFFORTS[effort.kind], effort.gauge, effort.stiffness, effort.damping, effort.value, effort.law,
                        len(terms), len(effort.inputs), effort.joint))
        terms += ((gauge, 1.0) for gauge in effort.inputs)
    units = {unit: ffi.new("char[]", unit.encode()) for unit in {row.unit for row in tables.measures}}
    names = [ffi.new("char[]", row.name.encode()) for row in tables.measures]
    measures = [(name, units[row.unit], QUANTITIES[row.quantity], *row[3:])
                for name, row in zip(names, tables.measures, strict=True)]
    elements = {
        "terms": len(terms), "relations": len(relations), "efforts": len(efforts), "measures": len(measures),
        "term": ffi.new("zd_gauge_term[]", terms), "relation": ffi.new("zd_relation[]", relations),
        "effort": ffi.new("zd_effort[]", efforts), "measure": ffi.new("zd_output_spec[]", measures),
        "law": lib.zd_law_in_python if has_laws else ffi.NULL, "laws_know_time": has_laws and laws_know_time}
    return elements, (names, units)
