"""Text of `print(mechanism)`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...errors import sentence
from ..elements.bodies import Point
from ..elements.contacts import Contact, Stop, switching
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Force, Gravity, Motor
from ..elements.joints import Joint
from ..elements.numbers import AS_GIVEN
from ..elements.table_forces import TableForce, placed
from ..equations.space_tables import tables_of
from . import cost
from .counting import Count, count

MAX_NAMED = 40         # constraints or loops in a list, at most


def headline(drawing: Drawing) -> str:
    """First line: the number of elements of each kind."""
    touching = drawing.of((Contact, Stop))
    bodies, joints = len(drawing.parts()), len([joint for joint in drawing.of(Joint) if joint not in touching])
    tabled = sorted(drawing.of(TableForce), key=lambda force: force.row.number)
    known = [*touching, *tabled, *drawing.of(Motor), *drawing.of(Actuator)]
    forces = [_several(count, kind.replace("_", " ")) for kind, count in Counter(each.kind for each in known).items()]
    gravity = f"gravity ({', '.join(f'{each:g}' for each in drawing.gravity)})" if drawing.gravity.any() else (
        "varying gravity" if drawing.of(Gravity) else "no gravity")
    said = f"{', '.join(forces)}, {gravity}" if forces else "no forces" if gravity == "no gravity" else f"no forces but {gravity}"
    where = "space" if drawing.dimension == 3 else "plane"
    return f"<Mechanism {drawing.name}: {where}, {_several(bodies, 'body', 'bodies')}, {_several(joints, 'joint')}; {said}>"


def report(drawing: Drawing) -> str:
    """Elements, degrees of freedom, redundant constraints, drives, and the coordinates that a simulation uses."""
    switched, heading, drawing = switching(drawing.elements.values()), headline(drawing), drawing.free
    if not drawing.parts():
        return f"{heading}\n nothing moves yet"
    try:
        counted = count(drawing)
    except Exception as error:      # also of the user's functions
        return f"{heading}\n it cannot start: {'; '.join([sentence(error), *getattr(error, '__notes__', ())])}"
    lines = [heading, f" {_freedom(drawing, counted)}; {_rows(counted)}"]
    if counted.is_of_many and counted.redundant:
        lines.append(" undetermined reactions are not listed for so many constraints")
    if counted.undetermined:
        lines.append(f" reactions not determined: {', '.join(counted.undetermined)}")
    lines += [f" {note}" for note in counted.notes]
    driven = [f"{placed(motor)} by {motor.name} ({motor.drives})" for motor in drawing.of(Motor)]
    driven += [f"{actuator.name} ({actuator.drives})" for actuator in drawing.of(Actuator)]
    if switched:
        lines.append(f" switched: {_listed([f'{each.name} ({each.kind})' for each in switched])}")
    if driven:
        lines.append(f" driven: {', '.join(driven)}")
    lines += [f" force {force.name} is a pair at two points, with a free moment: value times {_arm(force):.3g} m as drawn"
              for force in drawing.of(Force) if isinstance(force.against, Point)]
    if drawing.parameters:
        lines.append(f" parameters: {_listed([f'{name} = {value:g}' for name, value in drawing.parameters.items()])}")
    laws = [f"{law.what} ({law.kind})" for each in drawing.elements.values() for law in each.laws.values() if law.kind]
    if laws:
        lines.append(f" laws: {_listed(laws)}")
    found = cost.cost(tables_of(drawing, AS_GIVEN, in_tree=True), exact=True)
    lines.append(f" a simulation takes {found.taken} coordinates: {found.in_words}")
    return "\n".join(lines)


def _arm(force: Force) -> float:
    """Distance in m between the lines along which a force and its opposite act, as drawn."""
    against: Any = force.against
    apart, along = force.point.drawn - against.drawn, force.frame.pose.direction(force.along)
    return float(np.linalg.norm(apart - apart @ along * along))


def _freedom(drawing: Drawing, counted: Count) -> str:
    """Degrees of freedom, and numbers of coordinates and constraints in both layouts."""
    tables = tables_of(drawing, AS_GIVEN, in_tree=True)
    core = tables.core()
    inboard_joints = {joint for joint in tables.inboard if joint >= 0}
    cuts = [joint.name for i, joint in enumerate(tables.joints) if i not in inboard_joints and not joint.is_of_one_body]
    loops = f" closing {_several(len(cuts), 'loop')} at {_listed(cuts)}" if cuts else ""
    return (f"freedom {counted.freedom} (Gruebler {counted.gruebler}); "
            f"joint coordinates {core.nv}, {_several(core.m, 'constraint')}{loops}; "
            f"absolute {counted.velocities}, {_several(counted.rows, 'constraint')}")


def _rows(counted: Count) -> str:
    if not counted.redundant:
        return "no redundant constraints"
    are = "is" if len(counted.redundant) == 1 else "are"
    return f"{len(counted.redundant)} of {_several(counted.rows, 'constraint')} {are} redundant: {_listed(counted.redundant)}"


def _listed(names: Sequence[str]) -> str:
    """List of names, shortened after the first few."""
    if len(names) <= MAX_NAMED:
        return ", ".join(names)
    return f"{', '.join(names[:MAX_NAMED])} and {len(names) - MAX_NAMED} others"


def _several(number: int, word: str, plural: str = "") -> str:
    return f"{number} {word if number == 1 else plural or word + 's'}"
