"""Mechanism from JSON, by the methods of `Mechanism`, which check it, with the stored numbers."""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..._private import checks
from ...errors import WrongValue, sentence
from ..building.contact_verbs import with_switches
from ..building.table_force_verbs import NEEDED, sides, words
from ..building.table_joint_verbs import verb
from ..building.table_verbs import FORCES, PLANE
from ..elements.contacts import Compliance
from ..elements.forces import Gravity
from ..elements.frames import Circle, Line, Plane, Sphere
from ..elements.immutable import amend
from ..elements.joints import Joint
from ..elements.table_forces import TableForce, parameters, paths
from .expressions_json import from_json
from .space_from_json import IN_SPACE, frames_from_json, keep_rotations
from .to_json import VERSION, WHAT
from .values_from_json import direction_from_json, law_and_of, place_from_json, point_of_body

MAX_DIGITS = 400       # digits of a whole number in a file, at most: doubles have up to 309


def parsed(text: str, where: str) -> dict[str, Any] | None:
    """JSON of a mechanism, or None if the text is something else."""
    try:
        found = json.loads(text, object_pairs_hook=lambda pairs: _once(pairs, where), parse_constant=_refused(where),
                           parse_int=lambda digits: _whole(digits, where))
    except json.JSONDecodeError:
        return None
    except RecursionError:
        raise WrongValue(f"{where} has lists within lists, deeper than they can be read", "unreadable-file") from None
    return found if isinstance(found, dict) and found.get("zerodrift") == WHAT else None


def _whole(digits: str, where: str) -> int:
    if len(digits) > MAX_DIGITS:
        raise WrongValue(f"{where} has a whole number of {len(digits)} digits; there may be {MAX_DIGITS}", "unreadable-file")
    return int(digits)


def _once(pairs: list[tuple[str, Any]], where: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise WrongValue(f"{where} has the key {key!r} twice in one place", "unreadable-file")
        found[key] = value
    return found


def _refused(where: str) -> Callable[[str], Any]:
    def refuse(number: str) -> Any:
        raise WrongValue(f"{where} has {number} where a finite number is needed", "unreadable-file")
    return refuse


def mechanism(make: Callable[..., Any], description: Any, where: str) -> Any:
    """Mechanism, of the class `make`, from a description by `to_json.described`; errors name `where` and the place in it."""
    version = description.get("version", VERSION)       # first, as other versions may have other keys
    if type(version) is not int or version != VERSION:
        raise WrongValue(f"{where} is a mechanism of version {version!r}, and version {VERSION} is known here", "unreadable-file")
    fields = {key: value for key, value in description.items() if key != "shapes"}
    m = _parts(make, where, **_fields(_parts, fields, where, skip=("zerodrift", "version")))
    for body, shape in _at(where, checks.instance, "shapes", description.get("shapes", {}), dict, "a dict of bodies").items():
        _at(f"{where}, shapes", m.draw, body, shape)
    return m


def _parts(make: Callable[..., Any], where: str, *, zerodrift: str = WHAT, version: int = VERSION, name: Any, dimension: Any,
           gravity: Any, parameters: Any, elements: Any, start: Any, wish: Any, equilibrium: Any = False) -> Any:
    m = _at(where, make, name, dimension=dimension, gravity=gravity, parameters=parameters)
    for i, element in enumerate(_at(where, checks.instance, "elements", elements, list, "a list")):
        _element(m, element, f"{where}, element {i}")
    _at(f"{where}, start", m.start, start, wish=wish, equilibrium=equilibrium)
    keep_rotations(m, start, wish)
    return m


def _element(m: Any, description: Any, where: str) -> None:
    _at(where, checks.instance, "an element", description, dict, "a dict with kind and name")
    kind, name = description.get("kind"), description.get("name")
    made = MADE_IN_SPACE if m.dimension == 3 else MADE
    if not isinstance(kind, str) or kind not in made:
        raise WrongValue(f"{where} is of kind {kind!r}, which is not known; there are {', '.join(made)}", "unreadable-file")
    where = f"{where} ({kind} {name!r})"
    description, switched = dict(description), description.get("switched")
    if description.pop("switched", None) is not None:
        _at(where, checks.instance, "switched", switched, dict, "a dict of arguments")
    given = _fields(made[kind], description, where, skip=("kind", "name"))
    _at(where, made[kind], m, name, **given)
    if switched:
        joint = _at(where, checks.instance, "an element that switches", m[name], Joint, "a joint")
        _at(where, with_switches, m, joint, switched)


def _fields(function: Callable[..., Any], description: Any, where: str, skip: tuple[str, ...]) -> dict[str, Any]:
    """Values of a description by the function's argument names: all that it requires, and no others."""
    wanted = {name: parameter for name, parameter in inspect.signature(function).parameters.items()
              if parameter.kind is parameter.KEYWORD_ONLY}
    known = [*skip, *(name for name in wanted if name not in skip)]
    for key in description:
        if key not in known:
            raise WrongValue(f"{where} has the key {key!r}, which is not known; there are {', '.join(known)}", "unreadable-file")
    needed = [*skip, *(name for name, parameter in wanted.items() if parameter.default is parameter.empty)]
    for key in needed:
        if key not in description:
            raise WrongValue(f"{where} lacks the key {key!r}", "unreadable-file")
    return {key: value for key, value in description.items() if key not in skip}


def _at(where: str, function: Callable[..., Any], *given: Any, **named: Any) -> Any:
    """Call a function; its errors name the place in the file."""
    try:
        return function(*given, **named)
    except (ValueError, TypeError) as error:
        raise WrongValue(f"{where}: {sentence(error)}", "unreadable-file") from error


# ---- elements ----


def _body(m: Any, name: str, *, mass: Any, inertia: Any, at: Any, angle: Any, com: Any) -> None:
    m.body(name, mass, inertia, at=at, angle=angle, com=com)


def _link(m: Any, name: str, *, start: Any, end: Any, mass: Any, length: Any = None, inertia: Any = None) -> None:
    m.link(name, start, end, mass, length=length, inertia=inertia)


def _particle(m: Any, name: str, *, mass: Any, at: Any) -> None:
    m.particle(name, mass, at=at if isinstance(at, list) else place_from_json(m, at))


def _point(m: Any, name: str, *, body: Any, local: Any) -> None:
    m.point(name, body, local)


def _rolling(m: Any, name: str, *, first: Any, second: Any, radius: Any, normal: Any) -> None:
    normal, line = direction_from_json("normal", normal), point_of_body(m, first)
    joint = m.rolling(name, line.body, place_from_json(m, second), radius=radius, at=line.drawn,
                      normal=line.body.pose.direction(normal))
    amend(joint, first=line, axis=np.array([normal[1], -normal[0]]))


def _contact(m: Any, name: str, *, first: Any, second: Any, shape: Any, radius: Any, restitution: Any, friction: Any,
             compliance: Any = None) -> None:
    given = checks.instance("shape", shape, dict, "an object")
    made = _shape(point_of_body(m, first), **_fields(_shape, given, f"shape of {name!r}", skip=()))
    m.contact(name, place_from_json(m, second), made, radius=radius, restitution=restitution,
              friction=tuple(checks.vector("friction", friction, 2).tolist()), **_compliance(compliance))


def _shape(start: Any, *, direction: Any = None, length: Any = None, ring: Any = None, outside: Any = True,
           half_angle: Any = np.pi) -> Line | Circle | Plane | Sphere:
    dimension = start.dimension
    axis = np.eye(dimension)[0] if direction is None else direction_from_json("direction", direction, dimension)
    if ring is None and dimension == 3:
        return Plane(start.body, start.local, axis)
    if ring is None:
        return Line(start.body, start.local, axis, np.inf if length is None else checks.number("length", length, above=0))
    outside = checks.instance("outside", outside, bool, "True or False")
    if dimension == 3:
        return Sphere(start.body, start.local, checks.number("ring", ring, least=0), outside)
    return Circle(start.body, start.local, checks.number("ring", ring, least=0), outside, axis,
                  checks.number("half_angle", half_angle, above=0))


def _compliance(given: Any) -> dict[str, Any]:
    """Law of a compliant contact, as arguments."""
    return {} if given is None else dict(zip(Compliance._fields, checks.vector("compliance", given, 3).tolist(), strict=True))


def _stop(m: Any, name: str, *, measure: Any, lower: Any = None, upper: Any = None, restitution: Any,
          compliance: Any = None) -> None:
    m.stop(name, measure, lower=lower, upper=upper, restitution=restitution, **_compliance(compliance))


def _latch(m: Any, name: str, *, joint: Any, when: Any = None, until: Any = None) -> None:
    m.latch(name, joint, when=when, until=until)


def _by_row(joint: type[Joint]) -> Callable[..., None]:
    """Reader of a kind of joint whose method is made from the core's table."""
    ends = ("second",) if joint.is_of_one_body else ("first", "second")

    def make(m: Any, name: str, **given: Any) -> None:
        places = {side: given.pop(side) for side in ("first", "second")}
        if axis := given.pop("axis", None):
            axis, word = direction_from_json("axis", axis), "along" if joint.is_of_one_body else "axis"
            given[word] = point_of_body(m, places[ends[0]]).body.pose.direction(axis)
        made = getattr(m, joint.kind)(name, *(place_from_json(m, places[end]) for end in ends), **given)
        amend(made, axis=axis)
        if joint.is_of_one_body:
            amend(made, first=point_of_body(m, places["first"]))

    words, needed = inspect.signature(verb(joint)).parameters, inspect.Parameter.empty
    optional = {word: words[word].default for word in joint.takes
                if word in words and (words[word].default is None or word == "cut")}
    vars(make)["__signature__"] = inspect.Signature([
        inspect.Parameter(word, inspect.Parameter.KEYWORD_ONLY, default=optional.get(word, needed))
        for word in ("first", "second", *joint.takes)])
    return make


def _gear(m: Any, name: str, *, first: Any, second: Any, ratio: Any, pressure_angle: Any = None, helix_angle: Any = 0.0,
          radius: Any = None, backlash: Any = 0.0, restitution: Any = 0.0) -> None:
    m.gear(name, first, second, ratio=ratio, pressure_angle=pressure_angle, helix_angle=helix_angle, radius=radius,
           backlash=backlash, restitution=restitution)


def _rack_pinion(m: Any, name: str, *, first: Any, second: Any, ratio: Any) -> None:
    m.rack_pinion(name, first, second, ratio=ratio)


def _coupler(m: Any, name: str, *, law: Any = None, sum: Any = None) -> None:
    if (law is None) == (sum is None):
        raise WrongValue("it must have law or sum", "unreadable-file")
    value, of = (sum, None) if law is None else law_and_of(law, "law")
    m.coupler(name, value, of=of)


def _cam(m: Any, name: str, *, cam: Any, follower: Any, profile: Any) -> None:
    if isinstance(profile, Mapping) and set(profile) == {"angles", "values"}:
        given: Any = profile["angles"], profile["values"]
    elif isinstance(profile, Mapping):
        given, _ = law_and_of({**profile, "of": None}, "profile")
    else:
        given = from_json(profile, "profile")
    m.cam(name, cam, follower, profile=given)


def _constraint(m: Any, name: str, *, law: Any) -> None:
    value, of = law_and_of(law, "law")
    m.constraint(name, value, of=of)


def _nonholonomic(m: Any, name: str, *, law: Any) -> None:
    value, of = law_and_of(law, "law")
    m.nonholonomic(name, value, of=of)


def _motor(m: Any, name: str, *, joint: Any, drives: Any, law: Any) -> None:
    value, of = law_and_of(law, "law")
    checks.choice("drives", drives, ("angle", "displacement", "speed", "torque", "force"))
    m.motor(name, joint, of=of, **{drives: value})


def _actuator(m: Any, name: str, *, first: Any, second: Any, drives: Any, law: Any) -> None:
    value, of = law_and_of(law, "law")
    checks.choice("drives", drives, ("length", "force"))
    m.actuator(name, place_from_json(m, first), place_from_json(m, second), of=of, **{drives: value})


def _force(m: Any, name: str, *, point: Any, along: Any, frame: Any, value: Any, against: Any = None) -> None:
    along, frame = direction_from_json("along", along, m.dimension), m._body("frame", frame)
    value, of = law_and_of(value, "value")
    force = m.force(name, place_from_json(m, point), along=frame.pose.direction(along), value=value, of=of, frame=frame,
                    against=None if against is None else place_from_json(m, against))
    amend(force, along=along)


def _torque(m: Any, name: str, *, body: Any, against: Any, value: Any) -> None:
    value, of = law_and_of(value, "value")
    m.torque(name, body, value=value, of=of, against=against)


def _measure(m: Any, name: str, *, law: Any, unit: Any) -> None:
    value, of = law_and_of(law, "law")
    m.measure(name, value, of=of, unit=unit)


def _group(m: Any, name: str, *, bodies: Any) -> None:
    m.group(name, checks.instance("bodies", bodies, list, "a list of names"))


def _gravity(m: Any, name: str, *, laws: Any) -> None:
    checks.choice("the name of gravity", name, (Gravity.name,))
    if [*laws] != [*"xyz"[:m.dimension]]:
        raise WrongValue(f"laws of gravity must be of {m.dimension} axes, not {checks.shown(laws)}", "unreadable-file")
    m._add(Gravity({axis: m._law(f"gravity.{axis}", *law_and_of(law, axis), reactions=True) for axis, law in laws.items()}))


def _table_force(force: type[TableForce], dimension: int) -> Callable[..., None]:
    """Reader of a kind of force element whose method is made from the core's tables."""
    entry = force.entries[dimension]
    law, known = entry.measure or "" if entry.is_spring else "value", words(entry)

    def make(m: Any, name: str, **given: Any) -> None:
        ends = [given.pop(side) for side in sides(force)]
        places = ends if entry.at_joint else [place_from_json(m, end) for end in ends]
        stored: dict[str, Any] = {}
        if "axis" in given:
            stored["axis"] = direction_from_json("axis", given["axis"])
            given["axis"] = point_of_body(m, ends[0]).body.pose.direction(stored["axis"])
        if "frames" in given:
            first, second = (m._point("a side", place) for place in places)
            stored["frames"] = frames_from_json(first, second, given.pop("frames"))
            given["axis"] = first.body.pose.direction(stored["frames"][0][0])
        if coupled := given.pop("coupled", None):
            given["stiffness"] = np.array(coupled, dtype=float) + np.diag([*given["stiffness"], *given.pop("torsion")])
        for word in (law, "stiffness"):
            if isinstance(given.get(word), Mapping):
                given[word], given["of"] = law_and_of(given[word], word)
        laws = given.pop("laws", {})
        made = getattr(m, force.kind)(name, *places, **given)
        for path, each in laws.items():
            checks.choice("a path of laws", path, [acting for *_, acting, _ in paths(entry)])
            stored.setdefault("laws", {})[path] = m._law(f"{path} of bushing {name!r}", *law_and_of(each, path), reactions=True)
        amend(made, **stored)

    place = ("frames" if dimension == 3 else "axis",) if entry.axes else ()
    wanted = (*sides(force), *place, *parameters(entry), *([law] if law else ()))
    vars(make)["__signature__"] = inspect.Signature([
        inspect.Parameter(word, inspect.Parameter.KEYWORD_ONLY, default=NEEDED if known.get(word, 0.0) is not None else None)
        for word in wanted] + [inspect.Parameter("coupled", inspect.Parameter.KEYWORD_ONLY, default=None)] * (entry.axes == 3)
        + [inspect.Parameter("laws", inspect.Parameter.KEYWORD_ONLY, default={})] * (not law))
    return make


def _table_forces(dimension: int) -> dict[str, Callable[..., None]]:
    return {kind: _table_force(force, dimension) for kind, force in FORCES.items() if dimension in force.entries}


MADE: dict[str, Callable[..., None]] = {
    "body": _body, "contact": _contact, "stop": _stop, "latch": _latch, "link": _link, "particle": _particle, "point": _point,
    "rolling": _rolling,
    "gear": _gear, "rack_pinion": _rack_pinion, "coupler": _coupler,
    "constraint": _constraint, "nonholonomic": _nonholonomic, "cam": _cam,
    "motor": _motor, "actuator": _actuator, "force": _force, "torque": _torque,
    "measure": _measure, "gravity": _gravity, "group": _group,
    **_table_forces(2), **{kind: _by_row(joint) for kind, joint in PLANE.items()}}
MADE_IN_SPACE = {**MADE, **IN_SPACE, **_table_forces(3)}
