"""A planar mechanism in space: the same bodies, joints, drives and forces, and joints that keep it in its plane."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...errors import WrongValue
from ..elements.bodies import Body, Link, Particle, Point, _Center, kind_of
from ..elements.drawing import Drawing
from ..elements.forces import Bushing, Gravity
from ..elements.frames import about
from ..elements.immutable import amend
from ..elements.joints import Joint
from ..elements.space_joints import BY_KIND
from ..elements.table_forces import TableForce
from ..elements.user_functions import Component, Law
from .coupling_verbs import _Follows, _Profile, _Sum
from .table_verbs import FORCES, PLANE

NORMAL = (0.0, 0.0, 1.0)
HINGED = ("revolute", "prismatic", "weld")      # kinds of joints that keep two bodies in one plane


def lift(drawing: Drawing, m: Any) -> None:
    """Add all elements of a planar drawing to an empty mechanism in space."""
    for element in drawing.elements.values():
        if element is not drawing.ground:
            kind = kind_of(element)
            if kind not in LIFTED:
                raise WrongValue(f"{element.name!r} cannot be lifted: a {kind} has no counterpart in space", "wrong-dimension")
            LIFTED[kind](m, element)
    for name, shape in drawing.shapes.items():
        if np.ndim(shape):
            m.draw(name, np.pad(shape, ((0, 0), (0, 1))))
    for name in _free(drawing):
        _keep(m, m[name])
    m.start(_start(m, drawing, drawing.held), wish=_start(m, drawing, drawing.wished))


def _free(drawing: Drawing) -> list[str]:
    """Bodies that no joint keeps in the plane: of each group that keep each other there the root of its tree, the heaviest."""
    kept, free = {"ground"}, []
    joints = drawing.of(Joint)
    for body in sorted(drawing.parts(), key=lambda body: (body.turns, body.mass), reverse=True):    # bodies may hold particles
        _spread(joints, kept)
        if body.name not in kept:
            free.append(body.name)
            kept.add(body.name)
    return free


def _spread(joints: list[Joint], kept: set[str]) -> None:
    """Add the bodies that joints connect to those kept in the plane."""
    size = 0
    while size < len(kept):
        size = len(kept)
        for joint in joints:
            first, second = joint.bodies
            if joint.kind in HINGED or (joint.kind == "slot" and not second.turns):
                kept.update(other.name for one, other in ((first, second), (second, first)) if one.name in kept and one.turns)


def _keep(m: Any, body: Body) -> None:
    """Add a joint that keeps a body in the plane."""
    if body.turns:
        m.planar(f"{body.name} in its plane", m.ground, body, normal=NORMAL)
    else:
        m.coupler(f"{body.name} in its plane", {f"{body.name}.position.z": 1.0})


# ---- parts of elements ----


def _raised(vector: Any) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), 0.0


def _point(m: Any, point: Point) -> Any:
    """The same point in space; a particle is a point itself."""
    body = m[point.body.name]
    if isinstance(body, Particle):
        return body
    for end in ("start", "end"):
        if getattr(point.body, end, None) is point:
            return getattr(body, end)
    if isinstance(point, _Center):
        return body.center
    return m[point.name] if point.name in m._elements else body.point(_raised(point.local))


def _sides(m: Any, element: Any) -> tuple[Any, Any]:
    return _point(m, element.first), _point(m, element.second)


def _measure(m: Any, name: str) -> str:
    """Name of a measure in space."""
    owner, _, quantity = name.rpartition(".")
    element = m._elements.get(owner)
    if isinstance(element, Body) and quantity == "angle":
        raise WrongValue(f"{name!r} cannot be lifted: {owner!r} has a rotation in space and no angle; take that of a joint",
                         "wrong-dimension")
    is_turned = quantity == "angular_velocity" or (quantity == "angle" and isinstance(element, Bushing))
    return f"{name}.z" if is_turned else name


def _law(m: Any, law: Law | None, word: str = "value") -> dict[str, Any]:
    """Arguments of a user function: its value, as `word`, and `of`."""
    if law is None or law.constant is not None:
        return {} if law is None else {word: law.constant, "of": None}
    bound = {name: _measure(m, measure) for name, measure in law._bound.items()}
    given = {name: measure for name, measure in bound.items() if "." not in name}
    measured = {name: bound[name] for name in bound.keys() - given.keys()}
    is_formula = law.formula and (law._function is None or isinstance(law._function, Component))
    return {word: law.formula.renamed(measured) if is_formula else law._function, "of": given}      # type: ignore[union-attr]


def _start(m: Any, drawing: Drawing, given: Mapping[str, Any]) -> dict[str, Any]:
    """Start in measures of space."""
    said: dict[str, Any] = {}
    for name, value in given.items():
        owner, _, quantity = name.rpartition(".")
        if isinstance(drawing.elements.get(owner), Body) and quantity == "angle":
            said[f"{owner}.rotation"] = about(NORMAL, value)
        elif np.ndim(value):
            said |= {f"{name}.x": float(value[0]), f"{name}.y": float(value[1])}
        else:
            said[_measure(m, name)] = value
    return said


# ---- elements ----


def _plate(inertia: float) -> tuple[float, float, float]:
    """Tensor of a thin round plate with this moment about z; the other moments have no effect in the plane."""
    return inertia / 2, inertia / 2, inertia


def _body(m: Any, body: Body) -> None:
    m.body(body.name, body.mass, _plate(body.inertia), at=_raised(body.pose.origin), rotation=about(NORMAL, body.pose.angle),
           com=_raised(body._com))


def _link(m: Any, link: Link) -> None:
    made = m.link(link.name, _raised(link.pose.origin), _raised(link.drawn_end), link.mass, length=link.length,
                  inertia=_plate(link.inertia))
    amend(made, has_given_length=link.has_given_length)


def _particle(m: Any, particle: Particle) -> None:
    at = _raised(particle.pose.origin) if particle.attachment is None else _point(m, particle.attachment)
    m.particle(particle.name, particle.mass, at=at)


def _named_point(m: Any, point: Point) -> None:
    m.point(point.name, point.body.name, _raised(point.local))


def _revolute(m: Any, joint: Any) -> None:
    sides = _sides(m, joint)
    if all(body.turns for body in joint.bodies):
        m.revolute(joint.name, *sides, axis=NORMAL, damping=joint.damping)
    else:
        m.spherical(joint.name, *sides)     # a particle has no orientation


def _joint(m: Any, joint: Any) -> None:
    given = {word: getattr(joint, word) for word in joint.takes if word != "cut"}
    axis = {"axis": _raised(joint.axis_as_drawn())} if "axis" in given else {}
    getattr(m, joint.kind)(joint.name, *_sides(m, joint), **{**given, **axis})


def _slot(m: Any, joint: Any) -> None:
    m.slot(joint.name, joint.first.body.name, _point(m, joint.second), axis=_raised(joint.axis_as_drawn()))


def _rolling(m: Any, joint: Any) -> None:
    m.rolling(joint.name, joint.first.body.name, _point(m, joint.second), radius=joint.radius, at=_raised(joint.first.drawn),
              normal=_raised(joint.first.body.pose.direction(joint.normal)), axle=NORMAL)


def _knife_edge(m: Any, joint: Any) -> None:
    m.knife_edge(joint.name, _point(m, joint.second), along=_raised(joint.axis_as_drawn()), normal=NORMAL)


def _linear(m: Any, coupling: Any) -> None:
    getattr(m, coupling.kind)(coupling.name, *(measure.rpartition(".")[0] for measure in coupling.of), ratio=coupling.ratio,
                             **(coupling.teeth._asdict() if coupling.teeth else {}))


def _coupling(m: Any, coupling: Any) -> None:
    law = coupling.law
    if isinstance(law._function, _Sum):
        names = (_measure(m, measure) for measure in coupling.of)
        m.coupler(coupling.name, dict(zip(names, law._function.coefficients, strict=True)))
    else:
        getattr(m, coupling.kind)(coupling.name, **_law(m, law))


def _cam(m: Any, coupling: Any) -> None:
    follows: _Follows = coupling.law._function
    profile = follows.profile
    if isinstance(profile, _Profile):
        profile = profile.formula
    m.cam(coupling.name, coupling.of[0].rpartition(".")[0], coupling.of[1], profile=profile)


def _motor(m: Any, motor: Any) -> None:
    m.motor(motor.name, motor.joint.name, **_law(m, motor.law, motor.drives))


def _actuator(m: Any, actuator: Any) -> None:
    m.actuator(actuator.name, *_sides(m, actuator), **_law(m, actuator.law, actuator.drives))


def _table_force(m: Any, force: TableForce) -> None:
    ends = _sides(m, force) if force.joint is None else (force.joint.name,)
    axis = {} if force.axis is None else {"axis": _raised(force.first.body.pose.direction(force.axis))}
    getattr(m, force.kind)(force.name, *ends, **axis, **force.given(), **_law(m, force.law, force.drives))


def _bushing(m: Any, bushing: Any) -> None:
    along, about = {}, {}
    for word in ("stiffness", "damping"):
        along[word] = *(bushing.values[f"{word}.{axis}"] for axis in "xy"), 0.0
    for word in ("torsion", "torsion_damping"):
        about[word] = 0.0, 0.0, bushing.values[word]
    made = m.bushing(bushing.name, *_sides(m, bushing), **along, **about)
    amend(made, laws={path.replace("torque", "torque.z"): m._law(law.what, *_law(m, law).values(), reactions=True)
                      for path, law in bushing.laws.items()})


def _force(m: Any, force: Any) -> None:
    m.force(force.name, _point(m, force.point), along=_raised(force.frame.pose.direction(force.along)),
            frame=m[force.frame.name], **_law(m, force.law),
            against=_point(m, force.against) if isinstance(force.against, Point) else getattr(force.against, "name", None))


def _torque(m: Any, torque: Any) -> None:
    m.torque(torque.name, torque.body.name, against=torque.against.name, axis=NORMAL, **_law(m, torque.law))


def _gravity(m: Any, gravity: Gravity) -> None:
    laws = {axis: m._law(law.what, *_law(m, law).values(), reactions=True) for axis, law in gravity.laws.items()}
    m._add(Gravity({**laws, "z": Law("gravity.z", 0.0)}))


def _own_measure(m: Any, measure: Any) -> None:
    m.measure(measure.name, unit=measure.unit, **_law(m, measure.law))


def _group(m: Any, group: Any) -> None:
    m.group(group.name, [body.name for body in group.bodies])


LIFTED: dict[str, Callable[[Any, Any], None]] = {
    "body": _body, "link": _link, "particle": _particle, "point": _named_point,
    **dict.fromkeys(PLANE.keys() & BY_KIND, _joint), "revolute": _revolute, "slot": _slot, "rolling": _rolling,
    "knife_edge": _knife_edge, "gear": _linear, "rack_pinion": _linear, "coupler": _coupling,
    "constraint": _coupling, "nonholonomic": _coupling, "cam": _cam,
    "motor": _motor, "actuator": _actuator, **{kind: _table_force for kind, force in FORCES.items() if 3 in force.entries},
    "bushing": _bushing, "force": _force, "torque": _torque, "measure": _own_measure,
    "gravity": _gravity, "group": _group}
