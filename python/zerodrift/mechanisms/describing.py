"""A mechanism as JSON: what it was given, in the frames in which it keeps it, so that no number changes on the way."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np

from .bodies import Body, Particle, Point, _Center
from .drawing import Drawing
from .expressions import to_json
from .joints import JOINTS, Coupling
from .laws import Law
from .made_forces import FORCES_BY_ROW, MadeForce
from .making_couplings import _Expression, _Follows, _Sum
from .splines import PeriodicSpline

WHAT = "mechanism"      # how a file is recognised: its first key says it
VERSION = 1             # of the format


def described(drawing: Drawing) -> dict[str, Any]:
    """Everything of a mechanism; ValueError where a callable is in it, which it names."""
    if drawing.dimension == 3:
        raise ValueError(f"{drawing.name!r} is in space, and a mechanism in space cannot be saved yet")
    elements = [{"kind": _kind(element), "name": element.name, **WRITTEN[_kind(element)](element, drawing)}
                for element in drawing.elements.values() if element is not drawing.ground]
    return {"zerodrift": WHAT, "version": VERSION, "name": drawing.name, "dimension": 2, "gravity": _pair(drawing.gravity),
            "parameters": dict(drawing.parameters), "elements": elements,
            "start": {name: _plain(value) for name, value in drawing.held.items()},
            "wish": {name: _plain(value) for name, value in drawing.wished.items()}}


def text(description: dict[str, Any]) -> str:
    """JSON with each element in a line of its own."""
    lines = []
    for key, value in description.items():
        if key == "elements" and value:
            value = "[\n" + ",\n".join(f"  {json.dumps(element)}" for element in value) + "\n ]"
        else:
            value = json.dumps(value)
        lines.append(f" {json.dumps(key)}: {value}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _kind(element: Any) -> str:
    if isinstance(element, Body):
        return element.what
    return "point" if isinstance(element, Point) else element.kind


def _pair(vector: Any) -> list[float]:
    return [float(vector[0]), float(vector[1])]


def _plain(value: Any) -> Any:
    return value if isinstance(value, float) else _pair(value)


def place(point: Point, drawing: Drawing) -> Any:
    """How a point is told: by a name, such as ``"crank.end"``, or its body and where it is in that body's frame."""
    body = point.body
    if isinstance(body, Particle):
        return body.name
    for end in ("start", "end"):
        if getattr(body, end, None) is point:
            return f"{body.name}.{end}"
    if isinstance(point, _Center):
        return f"{body.name}.center"
    if point.name is not None and drawing.elements.get(point.name) is point:
        return point.name
    return {"body": body.name, "local": _pair(point.local)}


def _sides(element: Any, drawing: Drawing) -> dict[str, Any]:
    return {"first": place(element.first, drawing), "second": place(element.second, drawing)}


# ---- bodies ----


def _body(body: Any, drawing: Drawing) -> dict[str, Any]:
    return {"mass": body.mass, "inertia": body.inertia, "at": _pair(body.pose.origin), "angle": body.pose.angle,
            "com": _pair(body._com)}


def _link(link: Any, drawing: Drawing) -> dict[str, Any]:
    drawn = link.drawn_end - link.pose.origin
    given = {"length": None if link.length == float(np.hypot(*drawn)) else link.length, "inertia": link._inertia}
    return {"start": _pair(link.pose.origin), "end": _pair(link.drawn_end), "mass": link.mass,
            **{key: value for key, value in given.items() if value is not None}}


def _particle(particle: Any, drawing: Drawing) -> dict[str, Any]:
    at = place(particle.carrier, drawing) if particle.carrier else _pair(particle.pose.origin)
    return {"mass": particle.mass, "at": at}


def _point(point: Any, drawing: Drawing) -> dict[str, Any]:
    return {"body": point.body.name, "local": _pair(point.local)}


# ---- joints ----


def _joint(joint: Any, drawing: Drawing) -> dict[str, Any]:
    given = {word: getattr(joint, word) for word in joint.takes}
    return {**_sides(joint, drawing), **{word: _pair(value) if isinstance(value, np.ndarray) else value
                                         for word, value in given.items() if value is not None}}


# ---- couplings, drives and forces ----


def _law(law: Law) -> Any:
    """A number, or an expression and what its names are bound to."""
    if law.constant is not None:
        return law.constant
    if law.expression is None:
        raise _not_saved(law.what)
    bound = {name: measure for name, measure in law._bound.items() if "." not in name}
    return {"expression": to_json(law.expression, law.what), "of": bound}


def _not_saved(what: str) -> ValueError:
    return ValueError(f"{what} is a callable, which cannot be saved: a SymPy expression in its place can")


def _linear(coupling: Coupling, drawing: Drawing) -> dict[str, Any]:
    first, second = (measure.rpartition(".")[0] for measure in coupling.of)
    return {"first": first, "second": second, "ratio": coupling.ratio}


def _coupling(coupling: Coupling, drawing: Drawing) -> dict[str, Any]:
    law = coupling.law
    if isinstance(law._function, _Sum):
        return {"sum": dict(zip(coupling.of, law._function.coefficients, strict=True))}
    return {"law": _law(law)}


def _cam(coupling: Coupling, drawing: Drawing) -> dict[str, Any]:
    profile = coupling.law._function.profile if isinstance(coupling.law._function, _Follows) else None
    if isinstance(profile, PeriodicSpline):
        written: Any = {"angles": profile.angles.tolist(), "values": profile.values.tolist()}
    elif isinstance(profile, _Expression):
        written = to_json(profile._law.expression, coupling.law.what)
    else:
        raise _not_saved(f"profile of {coupling.name!r}")
    return {"cam": coupling.of[0].rpartition(".")[0], "follower": coupling.of[1], "profile": written}


def _motor(motor: Any, drawing: Drawing) -> dict[str, Any]:
    return {"joint": motor.joint.name, "drives": motor.drives, "law": _law(motor.law)}


def _actuator(actuator: Any, drawing: Drawing) -> dict[str, Any]:
    return {**_sides(actuator, drawing), "drives": actuator.drives, "law": _law(actuator.law)}


def _spring(spring: Any, drawing: Drawing) -> dict[str, Any]:
    length = {} if spring.free_length is None else {"length": spring.free_length}
    return {**_sides(spring, drawing), "stiffness": spring.stiffness, **length, "damping": spring.damping}


def _torsion_spring(spring: Any, drawing: Drawing) -> dict[str, Any]:
    return {"joint": spring.joint.name, "stiffness": spring.stiffness, "angle": spring.angle, "damping": spring.damping}


def _bushing(bushing: Any, drawing: Drawing) -> dict[str, Any]:
    values = bushing.values
    return {**_sides(bushing, drawing), "stiffness": [values["stiffness.x"], values["stiffness.y"]],
            "damping": [values["damping.x"], values["damping.y"]], "torsion": values["torsion"],
            "torsion_damping": values["torsion_damping"]}


def _force(force: Any, drawing: Drawing) -> dict[str, Any]:
    return {"point": place(force.point, drawing), "along": _pair(force.along), "frame": force.frame.name,
            "value": _law(force.law)}


def _torque(torque: Any, drawing: Drawing) -> dict[str, Any]:
    return {"body": torque.body.name, "against": torque.against.name, "value": _law(torque.law)}


def _made_force(made: MadeForce, drawing: Drawing) -> dict[str, Any]:
    axis = {} if made.axis is None else {"axis": _pair(made.axis)}
    if made.law is not None:
        return {**_sides(made, drawing), **axis, "value": _law(made.law)}
    each = {quantity: [made.values[path] for path in made.paths(quantity)] for quantity in ("stiffness", "damping")}
    length = {"length": made.values["length"]} if "length" in made.values else {}
    return {**_sides(made, drawing), **axis, **each, **length}


WRITTEN: dict[str, Callable[[Any, Drawing], dict[str, Any]]] = {
    **dict.fromkeys(JOINTS, _joint), **dict.fromkeys(FORCES_BY_ROW, _made_force),
    "body": _body, "link": _link, "particle": _particle, "point": _point, "gear": _linear,
    "rack_pinion": _linear, "coupler": _coupling, "constraint": _coupling, "nonholonomic": _coupling, "cam": _cam,
    "motor": _motor, "actuator": _actuator, "spring": _spring, "torsion_spring": _torsion_spring, "bushing": _bushing,
    "force": _force, "torque": _torque}
