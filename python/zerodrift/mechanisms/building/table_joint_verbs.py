"""Methods of `Mechanism` for joints, made from entries of the core's table: arguments, checks and documentation."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import Any

from ... import _check
from ..elements.joints import Joint, holds_angle
from .registry import Elements

WIDTH = 120     # columns of a docstring
SIDES = {
    "first, second": ("Body, Point or name", "Two points; a body and a point; or two bodies, and `at`."),
    "at": ("array_like (2,)", "Where the joint is in the drawing, in m.")}
POINT = {"point": ("Point, Body or name", "Of a body without a point, its centre of mass.")}
TAKEN = {
    "axis": ("array_like (2,)", "Its direction in the drawing; it turns with the {carrier}."),
    "length": ("float", "In m, above 0{left_out}."),
    "damping": ("float", "Of its {coordinate}, in {unit}, at least 0."),
    "cut": ("bool", "Whether this joint shall close a loop; left out, loops are cut where it is best.")}


def verb(joint: type[Joint]) -> Callable[..., Joint]:
    """Method of `Mechanism` for one kind of joint."""
    signature = _signature(joint)

    def make(m: Elements, *given: Any, **named: Any) -> Joint:
        try:
            taken = signature.bind(m, *given, **named)
        except TypeError as error:
            raise TypeError(f"{joint.kind}(): {error}") from None
        taken.apply_defaults()
        values = dict(taken.arguments)
        return _add(values.pop("self"), joint, values.pop("name"), **values)

    make.__name__, make.__qualname__ = joint.kind, f"Mechanism.{joint.kind}"
    make.__doc__, make.__signature__ = _documentation(joint), signature      # type: ignore[attr-defined]
    return make


def _draws_length(joint: type[Joint]) -> bool:
    """True if its length defaults to the drawn distance."""
    return any(row.gauge == "distance" and row.zero == "length" for row in joint.row.rows)


def _signature(joint: type[Joint]) -> inspect.Signature:
    initial = {"at": None, "damping": 0.0, "cut": False, **({"length": None} if _draws_length(joint) else {})}
    sides = ["point"] if joint.is_of_one_body else ["first", "second"]
    named = [*([] if joint.is_of_one_body else ["at"]), *joint.takes]
    given = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD) for name in ["self", "name", *sides]]
    given += [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=initial.get(name, inspect.Parameter.empty))
              for name in named]
    return inspect.Signature(given)


def _add(m: Elements, joint: type[Joint], name: Any, *, first: Any = None, second: Any = None, point: Any = None, at: Any = None,
         axis: Any = None, length: Any = None, damping: Any = 0.0, cut: Any = False) -> Joint:
    m._in_the_plane(joint.kind)
    name = m._new_name(name, "joint")
    if joint.is_of_one_body:
        point = m._point("point", point, center=True)
        first, second = m._different(name, m.ground.point(at=point.drawn), point)
    else:
        first, second = m._sides(name, first, second, at)
    if length is not None:
        length = _check.number(f"length of {name!r}", length, above=0)
    damping = _check.number(f"damping of {name!r}", damping, least=0)
    _check.instance(f"cut of {name!r}", cut, bool, "True or False")
    if axis is not None:
        carrier = second.body if joint.is_of_one_body else first.body
        m._turning(name, "axis of", carrier)
        axis = carrier.pose.local_direction(m._direction(f"axis of {name!r}", axis))
    if needs_angles(joint) or (damping and joint.coordinate == "angle"):
        m._turning(name, joint.kind, first.body, second.body)
    made = joint(name, first, second, axis=axis, length=length, damping=damping, cut=cut)
    if joint.row.takes_length:
        _check.number(f"length of {name!r}, as drawn,", made.numbers()["length"], above=0)
    return m._add(made)


def needs_angles(joint: type[Joint]) -> bool:
    """True if both bodies must have an orientation."""
    return holds_angle(joint.row) or any(row.rolls for row in joint.row.rows)


def _documentation(joint: type[Joint]) -> str:
    """Docstring in the style of the handwritten ones."""
    words = {"carrier": "body" if joint.is_of_one_body else "first body", "coordinate": joint.coordinate,
             "unit": "N m s" if joint.coordinate == "angle" else "N s/m",
             "left_out": "; left out: as drawn" if _draws_length(joint) else ""}
    sides = POINT if joint.is_of_one_body else SIDES
    parameters = {"name": ("str", ""), **sides, **{word: TAKEN[word] for word in joint.takes}}
    lines = [joint.row.card.summary, "", *wrapped(joint.row.card.description), "Parameters", "----------"]
    for name, (kind, text) in parameters.items():
        lines += [f"{name} : {kind}", *wrapped(text.format(**words), "    ")[:-1]]
    lines += ["", "Returns", "-------", joint.__name__, "", "Raises", "------", "ValueError, TypeError"]
    lines += wrapped("If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not "
                      "what it may be, or a particle would need an orientation.", "    ")
    lines += ["Notes", "-----", *wrapped(f"Source: {joint.row.card.equations}" + _reference(joint))]
    return "\n".join([*lines, "Examples", "--------", *_example(joint)])


def wrapped(text: str, indent: str = "") -> list[str]:
    """Lines of a paragraph and an empty one; [] for an empty text."""
    return [*textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent), ""] if text else []


def _reference(joint: type[Joint]) -> str:
    return f"; {joint.row.card.reference}." if joint.row.card.reference else "."


def _example(joint: type[Joint]) -> list[str]:
    sides = "body" if joint.is_of_one_body else "m.ground, body, at=(1, 0)"
    given = {word: text for word, text in (("axis", "(1, 0)"), ("length", "0.5")) if word in joint.takes}
    arguments = ", ".join([sides, *(f"{word}={text}" for word, text in given.items())])
    return [">>> import zerodrift as zd", '>>> m = zd.Mechanism("example")', '>>> body = m.body("body", 1.0, 0.1, at=(1, 0))',
            f'>>> m.{joint.kind}("joint", {arguments}).force', "VectorMeasure('joint.force')"]
