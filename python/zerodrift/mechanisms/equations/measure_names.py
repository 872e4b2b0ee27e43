"""Parser of measure names: element, quantity, and whether the quantity is a rate."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway import Variable
from ..._private.rotations import COMPONENTS
from ...errors import WrongValue
from ..elements.bodies import Body, Link, Point
from ..elements.forces import Bushing
from ..elements.joints import Joint, is_hinge
from ..elements.space_joints import SpaceJoint, is_at_point, speeds
from ..elements.table_forces import paths
from . import transmission

RATES = {"velocity": "position", "angular_velocity": "angle"}      # and "speed" of a joint's coordinate
DYNAMIC = ("force", "torque", "tension", "power", "acceleration")       # last words of reactions and accelerations


class Reading(NamedTuple):
    """Measure of positions, or its rate: `quantities` are the names of its marker quantities, one for each component."""

    quantities: tuple[str, ...]
    is_rate: bool


def reading(name: str, elements: Mapping[str, Any]) -> Reading | None:
    """Element and quantity of a measure of positions or velocities; None for other names."""
    owner, *rest = name.split(".")
    element = elements.get(owner)
    if rest and rest[0] in _points(element):
        element, owner, rest = getattr(element, rest[0]), f"{owner}.{rest[0]}", rest[1:]
    if element is None or not rest:
        return None
    quantity, *component = rest
    if isinstance(element, Bushing):
        return _of_bushing(element, quantity, component)
    if getattr(element, "dimension", 2) == 3:
        return _in_space(owner, element, quantity, component)
    base = getattr(element, "coordinate", None) if quantity == "speed" else RATES.get(quantity, quantity)
    if name == f"{owner}.transmission_angle" and transmission.has_one(element, transmission.joints_by_body(elements)):
        return Reading((name,), False)
    if base not in quantities(element):
        return None
    if base == "position":
        axes = component or ["x", "y"]
        return Reading(tuple(f"{owner}.position.{axis}" for axis in axes), base != quantity) if set(axes) <= {"x", "y"} and (
            len(component) <= 1) else None
    return None if component else Reading((f"{owner}.{base}",), base != quantity)


def _of_bushing(bushing: Bushing, quantity: str, component: list[str]) -> Reading | None:
    """Displacement, angle, and their rates along the directions of a bushing."""
    base = {"velocity": "displacement", "angular_velocity": "angle"}.get(quantity, quantity)
    wanted, word = ".".join((base, *component)), "turn" if quantity == "angular_velocity" else base
    found = [name.replace(base, word) for *_, name in paths(bushing.row) if f"{name}.".startswith(f"{wanted}.")]
    return Reading(tuple(f"{bushing.name}.{name}" for name in found), base != quantity) if found else None


def is_dynamic(name: str, element: Any) -> bool:
    """True for the name of a scalar reaction or acceleration; whether the element has it is checked when a run begins."""
    *_, quantity, last = ("", *name.split("."))
    if last in ("x", "y", "z"):
        return quantity.endswith(DYNAMIC)
    return last.endswith(DYNAMIC) and not (last == "force" and isinstance(element, Joint))


def _in_space(owner: str, element: Any, quantity: str, component: list[str]) -> Reading | None:
    """Element and quantity of a measure in space, where an angular velocity is not the rate of a position; or None."""
    rates = rates_of(element)
    if quantity in quantities(element) and quantity != "position":
        return None if component else Reading((f"{owner}.{quantity}",), False)
    if quantity in rates and rates[quantity] not in ("position", "spin"):
        return None if component else Reading((f"{owner}.{rates[quantity]}",), True)
    if quantity == "rotation" and reading_of_start(f"{owner}.rotation", {owner: element}):
        is_one = len(component) == 1 and component[0] in COMPONENTS[9]
        return Reading((f"{owner}.rotation.{component[0]}",), False) if is_one else None
    axes = component or ["x", "y", "z"]
    if len(component) > 1 or not set(axes) <= {"x", "y", "z"} or (quantity not in rates and quantity not in quantities(element)):
        return None
    base = "angular_velocity" if quantity == "angular_velocity" else "position"
    return Reading(tuple(f"{owner}.{base}.{axis}" for axis in axes), quantity != "position")


def rates_of(element: Any) -> dict[str, str]:
    """Measurable rates of an element in space, with the quantity that each is the rate of."""
    if isinstance(element, SpaceJoint):
        return {**speeds(element.row), **({"velocity": "position"} if is_at_point(element.row) else {})}
    if isinstance(element, Bushing):
        return {"velocity": "displacement", "angular_velocity": "turn"}
    if isinstance(element, Body | Point):
        spin = {"angular_velocity": "spin"} if isinstance(element, Body) and element.turns else {}
        return {"velocity": "position", **spin}
    return {"speed": "length"} if "length" in quantities(element) else {}


def _points(element: Any) -> tuple[str, ...]:
    """Points of an element whose measures exist without a given name."""
    if not isinstance(element, Body) or not element.turns:
        return ()
    return ("start", "end", "center") if isinstance(element, Link) else ("center",)


def reading_of_start(name: str, elements: Mapping[str, Any]) -> Reading | None:
    """Element and quantity of a value of a start, such as the rotation of a body in space; None for other names."""
    owner, _, quantity = name.partition(".")
    body = elements.get(owner)
    if quantity == "rotation" and isinstance(body, Body) and body.turns and body.dimension == 3:
        return Reading((name,) * 9, False)
    return reading(name, elements)


def checked_reading(what: str, name: str, value: Any, elements: Mapping[str, Any]) -> Reading:
    """Element and quantity of a measure that a start holds or wishes; unknown names are an error."""
    read = reading_of_start(name, elements)
    if read is None:
        owner = elements.get(name.partition(".")[0])
        known = readable(owner) if owner is not None else []
        said = f"; of {name.partition('.')[0]!r} these can be given: {_closest_first(name, known)}" if known else ""
        raise WrongValue(f"{what} must name a measure of positions or velocities, not {name!r}{said}", "wrong-name")
    if value is not None and len(read.quantities) != np.size(value):
        raise WrongValue(f"{what}[{name!r}] must have {len(read.quantities)} components, not {np.size(value)}", "shape")
    return read


def is_rate(name: str, elements: Mapping[str, Any]) -> bool:
    """True if a value of a start is a rate."""
    return checked_reading(name, name, None, elements).is_rate


def _closest_first(name: str, known: Sequence[str]) -> str:
    ranked = difflib.get_close_matches(name.lower(), known, n=len(known), cutoff=0.0)
    return ", ".join([*ranked, *(each for each in known if each not in ranked)])


def readable(element: Any) -> list[str]:
    """Names of measures of positions and velocities of an element, vectors as a whole."""
    named = element.measured_name
    if getattr(element, "dimension", 2) == 3:
        own = [f"{named}.{each}" for each in (*quantities(element), *rates_of(element))]
        return own + [f"{named}.{point}.{each}" for point in _points(element) for each in ("position", "velocity")]
    rates = {"position": "velocity", "angle": "angular_velocity", "displacement": "velocity"}
    found = []
    for quantity in quantities(element):
        rate = "speed" if quantity == getattr(element, "coordinate", None) else rates.get(quantity)
        found += [f"{named}.{quantity}", *([f"{named}.{rate}"] if rate else [])]
    found += [f"{named}.{point}.{quantity}" for point in _points(element) for quantity in ("position", "velocity")]
    return found


def quantities(element: Any) -> tuple[str, ...]:
    """Measurable positions of an element, which have rates, too."""
    if isinstance(element, SpaceJoint):
        return (*element.coordinates, *(("position",) if is_at_point(element.row) else ()))
    if isinstance(element, Body):
        return ("position", "angle") if element.turns and element.dimension == 2 else ("position",)
    if isinstance(element, Point):
        return ("position",)
    if isinstance(element, Joint):
        place = ("position",) if is_hinge(element.row) else ()
        return (element.coordinate, *place) if element.coordinate and has_coordinate(element) else place
    if isinstance(element, Bushing):
        return "displacement", "angle"
    return ("length",) if getattr(element, "coordinate", None) == "length" else ()


def has_coordinate(joint: Joint) -> bool:
    """True if the joint has a measurable coordinate; the angle at a particle is not one."""
    return joint.coordinate is not None and (joint.coordinate != "angle" or all(body.turns for body in joint.bodies))


def constraint_names(tables: Any, core: Any) -> tuple[Variable, ...]:
    """Names and units of the constraints: the joint and its marker quantity, or the drive or coupling."""
    named = []
    for row in core.rows:
        if row.owner == "relation":
            named.append(Variable(tables.relation_names[row.number], ""))
            continue
        joint = tables.joints[row.number]
        if isinstance(joint, SpaceJoint):
            named.append(joint.row_named(row.component))
            continue
        rows = joint.row.rows
        quantity = rows[row.component].quantity
        unit = "rad" if quantity == "angle" else "m"
        named.append(Variable(joint.name if len(rows) == 1 else f"{joint.name}.{quantity}", unit))
    return tuple(named)
