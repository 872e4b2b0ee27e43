"""Sketches: drawings of which the start is meant to differ, as a dimension or a coordinate of a loop is given."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from ..elements.bodies import Link
from ..elements.forces import Actuator, Motor
from ..elements.joints import Coupling, Joint, draws_length
from ..equations.measure_names import is_rate
from ..equations.tables import Tables
from ..equations.tree import ends
from .free_coordinates import bodies_of
from .joint_paths import Reach

DIMENSIONS = "length", "radius", "semiaxes", "local"        # quantities of parameters that change a drawing


class Loop(NamedTuple):
    """Bodies, besides the ground, and joints of all loops that contain a joint; without loops those of the joint itself."""

    bodies: set[str]
    joints: list[Joint]


def loop_of(tables: Tables, joint: int) -> Loop:
    """Loops that contain a joint, by its number."""
    inboard = tables.tree(with_cut=True)
    pairs = [ends(each, tables.number) for each in tables.joints]
    edge = next((body for body, each in enumerate(inboard, 1) if each == joint), -1 - joint)
    edges = {edge, *Reach(inboard, pairs).moving_with((), (edge,), ())}
    numbers = {-1 - each if each < 0 else inboard[each - 1] for each in edges} - {-1}
    joints = [tables.joints[number] for number in sorted(numbers)]
    return Loop({body.name for each in joints for body in each.bodies} - {"ground"}, joints)


def is_sketch(tables: Tables, loop: Loop, also_held: Iterable[str] = ()) -> bool:
    """True if a dimension of the loop is given, or one of its coordinates is held, wished or driven."""
    elements = tables.drawing.elements
    if any(_has_given_dimension(each) for each in (*loop.joints, *(elements[name] for name in loop.bodies))):
        return True
    changed = [elements.get(path.split(".")[0]) for path in tables.numbers.changed if {*path.split(".")[1:]} & {*DIMENSIONS}]
    return any(each in loop.joints or _is_inside(each, loop) for each in (*changed, *_prescribed(tables, also_held)))


def _has_given_dimension(element: Any) -> bool:
    if isinstance(element, Joint):
        has_radius = hasattr(element, "radius") or hasattr(element, "semiaxes")
        return has_radius or (draws_length(element.row) and element.length is not None)
    return isinstance(element, Link) and element.has_given_length


def _prescribed(tables: Tables, also_held: Iterable[str]) -> Iterator[Any]:
    """Elements of which a coordinate is held, wished or driven."""
    drawing = tables.drawing
    names = [*drawing.held, *drawing.wished, *also_held]
    names += [name for each in drawing.of(Coupling) if each.law is not None for name in each.of]
    for name in names:
        if not is_rate(name, drawing.elements):
            yield drawing.elements[name.partition(".")[0]]
    yield from (each.joint for each in drawing.of(Motor) if each.prescribes)
    yield from (each for each in drawing.of(Actuator) if each.prescribes)


def _is_inside(element: Any, loop: Loop) -> bool:
    """True if an element measures bodies of the loop alone."""
    moved = {body.name for body in bodies_of(element)} - {"ground"}
    return bool(moved) and moved <= loop.bodies
