"""Constraints that switch, as entries of the core's tables: groups of rows of joints, or of relations that are added for them."""

from __future__ import annotations

from typing import Any

from ..._private.gateway.mechanisms.element_tables import GeneralizedForce, Group, OutputSpec, Relation
from ..elements.contacts import Contact, Stop, switching
from ..elements.table_forces import UNITS
from ..elements.user_functions import Law
from .function_calls import ForceLaw


def add_switches(tables: Any) -> None:
    """Add the groups of all elements to the tables of a mechanism, and the forces of compliant ones."""
    for element in tables.drawing.of((Contact, Stop)):
        if element.compliance:
            _add_force(tables, element)
    for element in switching(tables.drawing.elements.values()):
        for part in getattr(element, "parts", (element,)):
            _add(tables, part)


def _add(tables: Any, element: Any) -> None:
    first, joint, relation = len(tables.groups), tables.joint_number.get(element.name, -1), -1
    bounds = element.bounds(tables.numbers) if isinstance(element, Contact) else None
    for each in element.switches(tables.numbers):
        if each.along and relation < 0:
            relation = _add_row(tables, element, tables._quantity_of(each.along), joint)
        if each.coupling:
            relation = tables.relation_names.index(each.coupling)
        owner, number = ("relation", relation) if each.along or each.coupling else ("joint", joint)
        group = Group(
            each.name, owner, number, each.component, each.rows, each.kind, each.sign, each.is_active,
            first + each.normal if each.normal else 0, each.loads, joint, each.is_largest,
            float("ang" in each.along.rpartition(".")[2] or bool(each.coupling)), each.value, each.restitution,
            each.friction)
        if bounds and each.kind == "one-sided":
            opposite = 1 + first + each.opposite if each.opposite else 0
            group = group._replace(range=1 + len(tables.relations), opposite=opposite, limits=bounds.limits)
        tables.groups.append(group)
    if bounds:      # constraint that is never active; its residual is the coordinate along the shape
        row = tables.joint_rows[joint]
        quantity = tables._quantity(f"{element.name} range", tables.entries.Quantity(
            "along", row.first, row.second, row.point1, row.point2, bounds.axis))
        number = _add_row(tables, element, quantity, -1)
        tables.groups.append(Group(element.name, "relation", number, 0, 1, "absent"))
    if isinstance(element, Stop):
        tables.observed.append(OutputSpec(f"{element.name}.{element.effort}", UNITS[element.effort], "drive", relation))


def _add_force(tables: Any, element: Any) -> None:
    """Add the force of a compliant contact along its gap, or of a stop along its measure."""
    push = element.compliance.with_numbers(element, tables.numbers).law()
    if isinstance(element, Stop):
        quantity, (word, size) = tables._quantity_of(element.quantity), ("force value", 1)
        lower, upper = (None if value is None else tables.numbers(element, limit, value)
                        for limit, value in (("lower", element.lower), ("upper", element.upper)))

        def force(x: Any, rate: Any) -> Any:
            below = 0.0 if lower is None else push(x - lower, rate)
            return below if upper is None else below - push(upper - x, -rate)
    else:
        quantity, (word, size) = tables._quantity(f"{element.name} gap", _gap(tables, element)), ("force sum", 1)
        sign = element.sign

        def force(x: Any, rate: Any) -> Any:
            return sign * push(sign * x, sign * rate)
    bound = Law(f"force of {element.kind} {element.name!r}", force, of={"x": f"{element.name}.x", "rate": f"{element.name}.rate"})
    row = tables.laws.add(ForceLaw(bound, [(0, False), (0, True)], tables.parameters))
    effort = element.effort if isinstance(element, Stop) else "force"
    tables.observed.append(OutputSpec(f"{element.name}.{effort}", UNITS[effort], word, len(tables.forces), size))
    tables.forces.append(GeneralizedForce("law", quantity, law=row, inputs=[quantity], what=bound.what))


def _gap(tables: Any, contact: Any) -> Any:
    """Marker quantity of a contact's gap, which is negative inside of a hole."""
    row, kind = tables._joint(contact), tables.entries.Quantity
    if contact.row.takes_axis:
        return kind("across", row.first, row.second, row.point1, row.point2, row.axis, row.length)
    return kind("distance", row.first, row.second, row.point1, row.point2, zero=row.along)


def _add_row(tables: Any, element: Any, quantity: int, joint: int) -> int:
    tables._relation(element.name, Relation([quantity], [1.0], joint=joint))
    return len(tables.relations) - 1
