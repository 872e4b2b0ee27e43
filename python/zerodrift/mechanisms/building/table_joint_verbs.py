"""Methods of `Mechanism` for joints, made from entries of the core's tables: arguments, checks and documentation."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from ..._private import checks
from ...errors import WrongType, WrongValue
from ..elements.frames import perpendicular
from ..elements.joints import Joint, draws_length, holds_angle, holds_distance
from ..elements.space_joints import SpaceJoint, advances, is_at_point, is_blade, is_on_plane, swivels
from .contact_verbs import SWITCHED, with_switches
from .registry import Elements
from .space_joint_verbs import FLAT, checked_cut
from .table_joint_documentation import documentation

ORDER = ("axis", "along", "axes", "normal", "pitch", "at", "length", "damping", "cut")
KINDS = {"name": "str", "first": "Side", "second": "Side", "point": "Side", "axes": "tuple[ArrayLike, ArrayLike]",
         "pitch": "float", "damping": "float", "cut": "bool"}
INITIAL = {"at": None, "damping": 0.0, "cut": False}


def verb(plane: type[Joint] | None, space: type[SpaceJoint] | None = None) -> Callable[..., Joint]:
    """Method of `Mechanism` for a kind of joint, from its classes in the plane and in space; None where it does not exist."""
    signature = _signature(plane, space)
    either: Any = plane or space
    parameters = list(signature.parameters.values())[1:]
    initial = {each.name: each.default for each in parameters if each.default is not each.empty and each.name not in SWITCHED}
    names = {each.name for each in parameters} - {*SWITCHED}
    places = [each.name for each in parameters if each.kind is not each.KEYWORD_ONLY]

    def make(m: Elements, *given: Any, **named: Any) -> Joint:
        chosen = dict(zip(places, given, strict=False)) | named
        switched = {word: values for word in SWITCHED if (values := chosen.pop(word, None)) is not None}
        for word in SWITCHED:
            named.pop(word, None)
        values = initial | chosen
        if set(values) != names or len(chosen) != len(given) + len(named):
            try:
                signature.bind(m, *given, **named)
            except TypeError as error:
                raise WrongType(f"{either.kind}(): {error}") from None
        _check_dimension(m, plane, space)
        name = values.pop("name")
        if plane and m.dimension == 2:
            return with_switches(m, _add(m, plane, name, **_taken(m, name, values, plane_words(plane))), switched)
        assert space        # as checked
        return with_switches(m, _add_in_space(m, space, name, **_taken(m, name, values, space_words(space))), switched)

    make.__name__, make.__qualname__ = either.kind, f"Mechanism.{either.kind}"
    make.__doc__ = documentation(plane, space, list(signature.parameters))
    vars(make)["__signature__"] = signature
    return make


# ---- arguments ----


def plane_words(joint: type[Joint]) -> list[str]:
    """Keyword arguments in the plane."""
    if joint.is_of_one_body:
        return ["along" if word == "axis" else word for word in joint.takes]
    return [*([] if holds_distance(joint.row) else ["at"]), *joint.takes]


def space_words(joint: type[SpaceJoint]) -> list[str]:
    """Keyword arguments in space."""
    row = joint.row
    if is_blade(row):
        return ["along", "normal"]
    words = [axis_word(joint)] if row.axes else []
    words += [] if holds_distance(joint.row) else ["at"]
    words += [length_word(joint)] if row.takes_length else []
    words += ["damping"] if swivels(row) or (row.freedoms is not None and len(row.freedoms) == 1 and joint.coordinate) else []
    return words if row.freedoms is None else [*words, "cut"]


def axis_word(joint: type[SpaceJoint]) -> str:
    """Keyword argument for the directions of a joint: "axes" for two; "normal" of the plane that holds the second point;
    "along" for a blade; otherwise "axis".
    """
    if joint.row.axes == 2:
        return "axes"
    if is_blade(joint.row):
        return "along"
    return "normal" if is_on_plane(joint.row) else "axis"


def length_word(joint: type[SpaceJoint]) -> str:
    """Keyword argument for the length of a joint: "pitch" of a screw, otherwise "length"."""
    return "pitch" if advances(joint.row) else "length"


def _signature(plane: type[Joint] | None, space: type[SpaceJoint] | None) -> inspect.Signature:
    in_each = [plane_words(plane)] if plane else []
    in_each += [space_words(space)] if space else []
    initial = {**INITIAL, **({"length": None} if any(draws_length(each.row) for each in (plane, space) if each) else {})}
    initial |= {word: None for word in ORDER if word not in initial and not all(word in each for each in in_each)}
    is_of_one_body = plane.is_of_one_body if plane else space is not None and is_blade(space.row)
    sides = ["point"] if is_of_one_body else ["first", "second"]
    given = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation=KINDS.get(name, inspect.Parameter.empty))
             for name in ("self", "name", *sides)]
    words = [word for word in ORDER if any(word in each for each in in_each)]
    given += [inspect.Parameter(word, inspect.Parameter.KEYWORD_ONLY, annotation=_annotation(word, initial),
                                default=initial.get(word, inspect.Parameter.empty)) for word in words]
    kind = getattr(plane or space, "kind", "")
    given += [inspect.Parameter(word, inspect.Parameter.KEYWORD_ONLY, annotation=annotation, default=None)
              for word, (kinds, annotation) in SWITCHED.items() if not kinds or kind in kinds]
    return inspect.Signature(given, return_annotation=getattr(plane or space, "__name__", ""))


def _annotation(word: str, initial: dict[str, Any]) -> str:
    if word == "length":
        return "float | None" if word in initial else "float"
    return KINDS.get(word, "ArrayLike | None" if word in initial else "ArrayLike")


def _check_dimension(m: Elements, plane: type[Joint] | None, space: type[SpaceJoint] | None) -> None:
    """Check that the kind exists in the plane, or in space."""
    if space is None and plane is not None:
        m._in_the_plane(plane.kind)
    elif plane is None and space is not None and m.dimension == 2:
        instead = "revolute" if is_at_point(space.row) else "a free body" if axis_word(space) == "normal" else "prismatic"
        raise WrongValue(f"{space.kind} is a joint of space, Mechanism(..., dimension=3): in the plane {instead} is meant",
                         "wrong-dimension")


def _taken(m: Elements, name: Any, values: dict[str, Any], words: list[str]) -> dict[str, Any]:
    """Arguments without those of the other dimension, which must be left out; a joint that always closes a loop may be cut."""
    other, taken = "in space" if m.dimension == 2 else "in the plane", {"first", "second", "point", "cut", *words}
    for word in values.keys() - taken:
        if values[word] is not None and not (word == "damping" and values[word] == INITIAL[word]):
            reason = ": in the plane bodies turn about its normal" if (word, m.dimension) == ("axis", 2) else ""
            raise WrongValue(f"{word} of {name!r} is for mechanisms {other}{reason}", "wrong-dimension")
    return {word: value for word, value in values.items() if word in taken}


# ---- adding ----


def _add(m: Elements, joint: type[Joint], name: Any, *, first: Any = None, second: Any = None, point: Any = None, at: Any = None,
         axis: Any = None, along: Any = None, length: Any = None, damping: Any = 0.0, cut: Any = False) -> Joint:
    name = m._new_name(name, "joint")
    word, axis = ("axis", axis) if along is None else ("along", along)
    if axis is not None:
        axis = m._direction(f"{word} of {name!r}", axis)
    first, second = _sides(m, joint, name, first, second, point, at)
    if length is not None:
        length = checks.number(f"length of {name!r}", length, above=0)
    damping = checks.number(f"damping of {name!r}", damping, least=0)
    if needs_angles(joint):
        m._turning(name, joint.kind, first.body, second.body)
    if damping and joint.coordinate == "angle":
        m._turning(name, "damping of", first.body, second.body)
    if axis is not None:
        owner = second.body if joint.is_of_one_body else first.body
        m._turning(name, f"{word} of", owner)
        axis = owner.pose.local_direction(axis)
    made = joint(name, first, second, axis=axis, length=length, damping=damping, cut=checked_cut(name, cut))
    if joint.row.takes_length:
        checks.number(f"length of {name!r}, as drawn,", made.numbers()["length"], above=0)
    return m._add(made)


def _sides(m: Any, joint: type[Joint], name: str, first: Any, second: Any, point: Any, at: Any) -> tuple[Any, Any]:
    """Points of both bodies."""
    if joint.is_of_one_body:
        point = m._point("point", point, center=True)
        return m._different(name, m.ground.point(at=point.drawn), point)
    if holds_distance(joint.row):
        return m._different(name, m._point("first", first), m._point("second", second))
    if joint.row.takes_axis:
        at = m._at_origin(name, at, first, second)
    return m._sides(name, first, second, at)


def needs_angles(joint: type[Joint]) -> bool:
    """True if both bodies must have an orientation."""
    return holds_angle(joint.row) or any(row.rolls for row in joint.row.rows)


def _add_in_space(m: Any, joint: type[SpaceJoint], name: Any, *, first: Any = None, second: Any = None, point: Any = None,
                  at: Any = None, length: Any = None, damping: Any = 0.0, cut: Any = False, **others: Any) -> SpaceJoint:
    if is_blade(joint.row):
        return _add_blade(m, joint, name, point, others.get("along"), others.get("normal"))
    directions = _directions(m, joint, name, others.get(axis_word(joint))) if joint.row.axes else ()
    if length_word(joint) == "pitch":
        length = checks.number(f"pitch of {name!r}", others.get("pitch"))
        if not length:
            raise WrongValue(f"pitch of {name!r} must not be 0: take revolute", "out-of-range")
    if holds_distance(joint.row):
        name = m._new_name(name, "joint")
        sides = m._different(name, m._point("first", first), m._point("second", second))
        length = None if length is None else checks.number(f"length of {name!r}", length, above=0)
        return m._fasten(joint.kind, name, *sides, length=length)
    at = at if is_at_point(joint.row) else m._at_origin(name, at, first, second)
    return m._join(joint.kind, name, first, second, at, *directions, length=length, damping=damping, cut=cut)


def _add_blade(m: Any, joint: type[SpaceJoint], name: Any, point: Any, along: Any, normal: Any) -> SpaceJoint:
    """Blade in space: the axis of its frame points along it, the normal of the frame across."""
    name = m._new_name(name, "joint")
    along = m._direction(f"along of {name!r}", along)
    up = m._direction(f"normal of {name!r}", m._upwards() if normal is None else normal)
    if np.linalg.norm(np.cross(up, along)) < FLAT:
        raise WrongValue(f"along of {name!r} must not be parallel to the normal of the ice", "geometry")
    point = m._point("point", point, center=True)
    sides = m._different(name, m.ground.point(at=point.drawn), point)
    return m._fasten(joint.kind, name, *sides, along, np.cross(perpendicular(along, up), along))


def _directions(m: Elements, joint: type[SpaceJoint], name: Any, given: Any) -> tuple[Any, ...]:
    """Axis of the joint, or two perpendicular axes, in the drawing."""
    word = axis_word(joint)
    if word != "axes":
        if given is None:
            raise WrongType(f"{name!r} must have {word}=, the direction in the drawing about which it turns", "missing-argument")
        return (m._direction(f"{word} of {name!r}", given),)
    if np.ndim(given) == 0 or len(given) != 2:
        raise WrongValue(f"axes of {name!r} must be two directions, one of the first body and one of the second", "shape")
    first, second = (m._direction(f"axes[{i}] of {name!r}", axis) for i, axis in enumerate(given))
    if np.linalg.norm(np.cross(first, second)) < FLAT:
        raise WrongValue(f"axes of {name!r} must not be parallel in the drawing", "geometry")
    return first, second
