"""Constraints that switch, as entries of the core's tables: groups of rows of joints, or of relations that are added for them."""

from __future__ import annotations

from typing import Any

from ..._private.gateway.mechanisms.element_tables import Group, OutputSpec, Relation
from ..elements.contacts import Stop, switching
from ..elements.table_forces import UNITS


def add_switches(tables: Any) -> None:
    """Add the groups of all elements to the tables of a mechanism."""
    for element in switching(tables.drawing.elements.values()):
        _add(tables, element)


def _add(tables: Any, element: Any) -> None:
    first, joint, relation = len(tables.groups), tables.joint_number.get(element.name, -1), -1
    for each in element.switches(tables.numbers):
        if each.along and relation < 0:
            relation = len(tables.relations)
            tables._relation(element.name, Relation([tables._quantity_of(each.along)], [1.0], joint=joint))
        owner, number = ("relation", relation) if each.along else ("joint", joint)
        tables.groups.append(Group(
            each.name, owner, number, each.component, each.rows, each.kind, each.sign, each.is_active,
            first + each.normal if each.normal else 0, each.loads, joint, each.is_largest,
            float("ang" in each.along.rpartition(".")[2]), each.value, each.restitution,
            each.friction))
    if isinstance(element, Stop):
        tables.observed.append(OutputSpec(f"{element.name}.{element.effort}", UNITS[element.effort], "drive", relation))
