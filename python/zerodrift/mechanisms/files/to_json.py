"""Mechanism as JSON: its numbers in the frames in which they are stored, so that none is rounded."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np

from ...errors import WrongValue
from ...laws.table import Table
from ..building.coupling_verbs import _Follows, _Profile, _Sum
from ..building.table_verbs import FORCES
from ..elements.bodies import Body, kind_of
from ..elements.drawing import Drawing
from ..elements.frames import Circle, Line, Plane
from ..elements.joints import JOINTS, Coupling
from ..elements.table_forces import ELEMENTS, TableForce, placed
from .expressions_json import to_json
from .space_to_json import IN_SPACE
from .values_to_json import formula_to_json, law_to_json, numbers, place, sides

WHAT = "mechanism"      # first key of a file, by which it is recognized
VERSION = 1             # version of the format


def described(drawing: Drawing) -> dict[str, Any]:
    """Description of a mechanism as dicts and lists; ValueError names a callable, which cannot be saved."""
    written = WRITTEN_IN_SPACE if drawing.dimension == 3 else WRITTEN
    elements = [{"kind": kind_of(element), "name": element.name, **written[kind_of(element)](element, drawing),
                 **_switched(element)} for element in drawing.elements.values() if element is not drawing.ground]
    return {"zerodrift": WHAT, "version": VERSION, "name": drawing.name, "dimension": drawing.dimension,
            "gravity": numbers(drawing.gravity), "parameters": dict(drawing.parameters), "elements": elements,
            "start": {name: _plain(value) for name, value in drawing.held.items()},
            "wish": {name: _plain(value) for name, value in drawing.wished.items()},
            **({"equilibrium": True} if drawing.is_balanced else {}),
            **({"shapes": {name: np.asarray(each).tolist() for name, each in drawing.shapes.items()}} if drawing.shapes else {})}


def text(description: dict[str, Any]) -> str:
    """JSON with one element per line."""
    lines = []
    for key, value in description.items():
        if key == "elements" and value:
            value = "[\n" + ",\n".join(f"  {json.dumps(element)}" for element in value) + "\n ]"
        else:
            value = json.dumps(value)
        lines.append(f" {json.dumps(key)}: {value}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _plain(value: Any) -> Any:
    return value if isinstance(value, float) else numbers(value)


# ---- bodies ----


def _body(body: Any, drawing: Drawing) -> dict[str, Any]:
    return {"mass": body.mass, "inertia": body.inertia, "at": numbers(body.pose.origin), "angle": body.pose.angle,
            "com": numbers(body._com)}


def _link(link: Any, drawing: Drawing) -> dict[str, Any]:
    drawn = link.drawn_end - link.pose.origin
    given = {"length": None if link.length == float(np.hypot(*drawn)) else link.length, "inertia": link._inertia}
    return {"start": numbers(link.pose.origin), "end": numbers(link.drawn_end), "mass": link.mass,
            **{key: value for key, value in given.items() if value is not None}}


def _particle(particle: Any, drawing: Drawing) -> dict[str, Any]:
    at = place(particle.attachment, drawing) if particle.attachment else numbers(particle.pose.origin)
    return {"mass": particle.mass, "at": at}


def _point(point: Any, drawing: Drawing) -> dict[str, Any]:
    return {"body": point.body.name, "local": numbers(point.local)}


# ---- joints ----


def _joint(joint: Any, drawing: Drawing) -> dict[str, Any]:
    given = {word: getattr(joint, word) for word in joint.takes}
    return {**sides(joint, drawing), **{word: numbers(value) if isinstance(value, np.ndarray) else value
                                         for word, value in given.items() if value is not None}}


def _switched(element: Any) -> dict[str, Any]:
    """Dry friction of a joint, and whether it is joined, if it has any of them."""
    switched = getattr(element, "switched", None)
    return {"switched": switched.given(element)} if switched else {}


def _contact(contact: Any, drawing: Drawing) -> dict[str, Any]:
    shape = contact.shape
    if isinstance(shape, Line):
        given = {"direction": numbers(shape.direction), **({"length": shape.length} if shape.length < np.inf else {})}
    elif isinstance(shape, Plane):
        given = {"direction": numbers(shape.direction)}
    else:
        arc = {"direction": numbers(shape.direction), "half_angle": shape.half_angle} if isinstance(
            shape, Circle) and shape.half_angle < np.pi else {}
        given = {"ring": shape.radius, "outside": shape.outside, **arc}
    return {**sides(contact, drawing), "shape": given, "radius": contact.radius, "restitution": contact.restitution,
            "friction": list(contact.friction), **_compliance(contact)}


def _compliance(element: Any) -> dict[str, Any]:
    return {"compliance": list(element.compliance)} if element.compliance else {}


def _stop(stop: Any, drawing: Drawing) -> dict[str, Any]:
    return {"measure": stop.of, **stop.limits, "restitution": stop.restitution, **_compliance(stop)}


def _latch(latch: Any, drawing: Drawing) -> dict[str, Any]:
    given = {word: value for word, value in (("when", latch.when), ("until", latch.until)) if value is not None}
    for word, value in given.items():
        if not isinstance(value, str):
            raise WrongValue(f"{word} of latch {latch.name!r} must be a measure or text to be saved, not {value!r}",
                             "not-portable")
    return {"joint": latch.joint, **given}


# ---- couplings, drives and forces ----


def _linear(coupling: Coupling, drawing: Drawing) -> dict[str, Any]:
    first, second = (measure.rpartition(".")[0] for measure in coupling.of)
    more = coupling.teeth._asdict() if coupling.teeth else {}
    play = {"backlash": coupling.backlash, "restitution": coupling.restitution} if coupling.backlash else {}
    return {"first": first, "second": second, "ratio": coupling.ratio, **more, **play}


def _coupling(coupling: Any, drawing: Drawing) -> dict[str, Any]:
    law = coupling.law
    if isinstance(law._function, _Sum):
        return {"sum": dict(zip(coupling.of, law._function.coefficients, strict=True))}
    return {"law": law_to_json(law)}


def _cam(coupling: Any, drawing: Drawing) -> dict[str, Any]:
    profile = coupling.law._function.profile if isinstance(coupling.law._function, _Follows) else None
    if isinstance(profile, Table):
        written: Any = profile.written_as or {"table": profile.to_json()}
    elif isinstance(profile, _Profile):
        written = to_json(profile.formula, coupling.law.what)
    else:       # the constraint is that of the follower, less the profile
        written = ["*", -1, formula_to_json(coupling.law, {"follower": 0})]
    return {"cam": coupling.of[0].rpartition(".")[0], "follower": coupling.of[1], "profile": written}


def _motor(motor: Any, drawing: Drawing) -> dict[str, Any]:
    return {"joint": placed(motor), "drives": motor.drives, "law": law_to_json(motor.law)}


def _actuator(actuator: Any, drawing: Drawing) -> dict[str, Any]:
    return {**sides(actuator, drawing), "drives": actuator.drives, "law": law_to_json(actuator.law)}


def _force(force: Any, drawing: Drawing) -> dict[str, Any]:
    return {"point": place(force.point, drawing), "along": numbers(force.along), "frame": force.frame.name,
            "value": law_to_json(force.law), **({} if force.against is None else {"against": force.against.name if isinstance(
                force.against, Body) else place(force.against, drawing)})}


def _torque(torque: Any, drawing: Drawing) -> dict[str, Any]:
    return {"body": torque.body.name, "against": torque.against.name, "value": law_to_json(torque.law)}


def _measure(measure: Any, drawing: Drawing) -> dict[str, Any]:
    return {"law": law_to_json(measure.law), "unit": measure.unit}


def _group(group: Any, drawing: Drawing) -> dict[str, Any]:
    return {"bodies": [body.name for body in group.bodies]}


def _gravity(gravity: Any, drawing: Drawing) -> dict[str, Any]:
    return {"laws": {axis: law_to_json(law) for axis, law in gravity.laws.items()}}


def _table_force(force: TableForce, drawing: Drawing) -> dict[str, Any]:
    place: dict[str, Any] = sides(force, drawing) if force.joint is None else {"joint": placed(force)}
    if force.axis is not None:
        place["axis"] = numbers(force.axis)
    if force.frames is not None:
        place["frames"] = [numbers(frame) for frame in force.frames]
    laws = {path: law_to_json(law) for path, law in force.laws.items()}
    return {**place, **force.given(), **(laws if force.row.measure else {"laws": laws} if laws else {})}


WRITTEN: dict[str, Callable[[Any, Drawing], dict[str, Any]]] = {
    **dict.fromkeys(JOINTS, _joint), **dict.fromkeys((kind for kind in FORCES if kind in ELEMENTS), _table_force),      # type: ignore[has-type]
    "body": _body, "contact": _contact, "stop": _stop, "latch": _latch, "link": _link, "particle": _particle, "point": _point,
    "gear": _linear,
    "rack_pinion": _linear, "coupler": _coupling, "constraint": _coupling, "nonholonomic": _coupling, "cam": _cam,
    "motor": _motor, "actuator": _actuator, "force": _force, "torque": _torque, "measure": _measure, "gravity": _gravity,
    "group": _group}
WRITTEN_IN_SPACE = WRITTEN | dict.fromkeys(FORCES, _table_force) | IN_SPACE
