"""Constraints that switch, as entries of the core's tables: groups of rows of joints, or of relations that are added for them."""

from __future__ import annotations

import math
from typing import Any

from ..._private.gateway.mechanisms.element_tables import GeneralizedForce, Group, OutputSpec, Relation
from ..elements.contacts import Contact, LineContact, PlaneContact, RoundContact, SphereContact, Stop, switching
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
            first + each.normal if each.normal else 0, each.loads, joint, each.at_ends,
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
    """Add the force of a compliant contact along the gap of each part, or of a stop along its measure."""
    push = element.compliance.with_numbers(element, tables.numbers).law()
    first, effort = len(tables.forces), "force"
    if isinstance(element, Stop):
        effort, quantity = element.effort, tables._quantity_of(element.quantity)
        lower, upper = (None if value is None else tables.numbers(element, limit, value)
                        for limit, value in (("lower", element.lower), ("upper", element.upper)))

        def force(x: Any, rate: Any) -> Any:
            below = 0.0 if lower is None else push(x - lower, rate)
            return below if upper is None else below - push(upper - x, -rate)
        _add_law(tables, element, force, [quantity])
    else:
        for part, law in _laws(element, push, tables.numbers):
            inputs = [tables._quantity(f"{part.name} gap", _gap(tables, part))]
            if bounds := element.bounds(tables.numbers):
                row = tables._joint(element)
                inputs += [tables._quantity(f"{element.name} {word}", tables.entries.Quantity(
                    "along", row.first, row.second, row.point1, row.point2, axis))
                    for word, axis in (("along", bounds.axis), ("across", (-bounds.axis[1], bounds.axis[0])))]
            _add_law(tables, element, law, inputs)
    word, size = ("force value", 1) if isinstance(element, Stop) else ("force sum", len(tables.forces) - first)
    tables.observed.append(OutputSpec(f"{element.name}.{effort}", UNITS[effort], word, first, size))


def _laws(contact: Contact, push: Any, numbers: Any) -> list[tuple[Contact, Any]]:
    """Parts of a compliant contact and their forces: functions of the gap, its rate, and coordinates along and across a bounded
    shape, whose nearest point pushes.
    """
    sign, bounds = contact.sign, contact.bounds(numbers)
    if not bounds or not isinstance(contact, LineContact):
        return [(contact, lambda x, rate: sign * push(sign * x, sign * rate))]
    is_arc, length, radius = isinstance(contact, RoundContact), bounds.limits[1], contact.length_with(numbers)
    cosine = math.cos(contact.shape.half_angle) if is_arc else 0.0

    def beside(along: Any, across: Any) -> Any:
        """Number of the end that is nearest; 0: none is."""
        if is_arc:
            return 0 if along >= cosine * math.sqrt(along * along + across * across) else 1 if across < 0 else 2
        return 1 if along < 0 else 2 if along > length else 0

    def between(x: Any, rate: Any, along: Any, across: Any) -> Any:
        if beside(along, across) != 0:
            return 0.0
        apart = x + radius
        return push(apart - abs(radius), rate) if apart > 0 else -push(-apart - abs(radius), -rate)

    def at_start(x: Any, rate: Any, along: Any, across: Any) -> Any:
        return push(x, rate) if beside(along, across) == 1 else 0.0

    def at_end(x: Any, rate: Any, along: Any, across: Any) -> Any:
        return push(x, rate) if beside(along, across) == 2 else 0.0
    return list(zip((contact, *contact.end_parts()), (between, at_start, at_end), strict=True))


def _add_law(tables: Any, element: Any, force: Any, inputs: list[int]) -> None:
    """Add a force along the first of some quantities, as a function of it, its rate, and the others."""
    bound = Law(f"force of {element.kind} {element.name!r}", force,
                of={word: f"{element.name}.{word}" for word in ("x", "rate", "along", "across")[:len(inputs) + 1]})
    read = [(0, False), (0, True), *((i, False) for i in range(1, len(inputs)))]
    row = tables.laws.add(ForceLaw(bound, read, tables.parameters))
    tables.forces.append(GeneralizedForce("law", inputs[0], law=row, inputs=inputs, what=bound.what))


def _gap(tables: Any, contact: Any) -> Any:
    """Marker quantity of a contact's gap, which is negative inside of a hole."""
    row, kind = tables._joint(contact), tables.entries.Quantity
    if isinstance(contact, PlaneContact):
        square = row.semiaxes[0]**2
        return kind("clearance", row.first, row.second, row.point1, row.point2, o=row.frame1[0],
                    shape=((square, 0.0, 0.0), (0.0, square, 0.0), (0.0, 0.0, square)))
    if not isinstance(contact, RoundContact | SphereContact):
        return kind("across", row.first, row.second, row.point1, row.point2, row.axis, row.length)
    return kind("distance", row.first, row.second, row.point1, row.point2, zero=row.along)


def _add_row(tables: Any, element: Any, quantity: int, joint: int) -> int:
    tables._relation(element.name, Relation([quantity], [1.0], joint=joint))
    return len(tables.relations) - 1
