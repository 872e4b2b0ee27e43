"""Constraints that switch, as entries of the core's tables: groups of rows of joints, or of relations that are added for them."""

from __future__ import annotations

from typing import Any

from ..._private.gateway.mechanisms.element_tables import Group, OutputSpec, Relation
from ..elements.contacts import Contact, Stop, switching
from ..elements.table_forces import UNITS


def add_switches(tables: Any) -> None:
    """Add the groups of all elements to the tables of a mechanism."""
    for element in switching(tables.drawing.elements.values()):
        for part in getattr(element, "parts", (element,)):
            _add(tables, part)


def _add(tables: Any, element: Any) -> None:
    first, joint, relation = len(tables.groups), tables.joint_number.get(element.name, -1), -1
    bounds = element.bounds(tables.numbers) if isinstance(element, Contact) else None
    for each in element.switches(tables.numbers):
        if each.along and relation < 0:
            relation = _add_row(tables, element, tables._quantity_of(each.along), joint)
        if each.of:
            relation = tables.relation_names.index(each.of)
        owner, number = ("relation", relation) if each.along or each.of else ("joint", joint)
        group = Group(
            each.name, owner, number, each.component, each.rows, each.kind, each.sign, each.is_active,
            first + each.normal if each.normal else 0, each.loads, joint, each.is_largest,
            float("ang" in each.along.rpartition(".")[2] or bool(each.of)), each.value, each.restitution,
            each.friction)
        if bounds and each.kind == "one-sided":
            other = 1 + first + each.other if each.other else 0
            group = group._replace(range=1 + len(tables.relations), other=other, limits=bounds.limits)
        tables.groups.append(group)
    if bounds:      # a row that is never active: its value is the coordinate
        row = tables.joint_rows[joint]
        quantity = tables._quantity(f"{element.name} range", tables.entries.Quantity(
            "along", row.first, row.second, row.point1, row.point2, bounds.axis))
        number = _add_row(tables, element, quantity, -1)
        tables.groups.append(Group(element.name, "relation", number, 0, 1, "absent"))
    if isinstance(element, Stop):
        tables.observed.append(OutputSpec(f"{element.name}.{element.effort}", UNITS[element.effort], "drive", relation))


def _add_row(tables: Any, element: Any, quantity: int, joint: int) -> int:
    tables._relation(element.name, Relation([quantity], [1.0], joint=joint))
    return len(tables.relations) - 1
