"""Methods of `Mechanism` for force elements, made from entries of the core's table: arguments, checks and documentation."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from ... import _check
from ...errors import WrongType
from ..elements.table_forces import MadeForce
from .registry import Elements
from .table_joint_documentation import POINTS, SIDES, wrapped

TAKEN = {
    "axis": ("array_like {vector}", "Its direction in the drawing; it turns with the first body."),
    "stiffness": ("float{size}", "In N/m{rotary_stiffness}, at least 0{each}.{unstressed}"),
    "damping": ("float{size}", "In N s/m{rotary_damping}, at least 0{each}."),
    "length": ("float, optional", "Unstressed length in m, at least 0; left out: as drawn."),
    "value": ("float, callable or SymPy expression",
              "In N{rotary_value}; of t, parameters and measures of positions and velocities."),
    "of": ("dict of str to measure", "Measures by the names of the callable's arguments.")}
AT = "array_like {vector}", "Position of the element in the drawing, in m."
ROTARY = {"stiffness": "N m/rad", "damping": "N m s/rad", "value": "N m"}
KINDS = {"name": "str", "first": "Side", "second": "Side"}
NEEDED = inspect.Parameter.empty


def force_verb(force: type[MadeForce], build: Callable[..., Any] | None = None) -> Callable[..., Any]:
    """Method of `Mechanism` for one kind of force element; `build` makes it, by default the class `force`."""
    at = {} if force.is_between_points() else {"at": None}
    signature = inspect.Signature(
        [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation=KINDS.get(name, NEEDED))
         for name in ("self", "name", "first", "second")]
        + [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=initial, annotation="Any")
           for name, initial in {**at, **taken(force)}.items()], return_annotation="Any")

    def make(m: Elements, *given: Any, **named: Any) -> MadeForce:
        try:
            bound = signature.bind(m, *given, **named)
        except TypeError as error:
            raise WrongType(f"{force.kind}(): {error}") from None
        bound.apply_defaults()
        values = dict(bound.arguments)
        return _add(values.pop("self"), force, build or force, values.pop("name"), **values)

    make.__name__, make.__qualname__ = force.kind, f"Mechanism.{force.kind}"
    make.__doc__, make.__signature__ = _documentation(force), signature      # type: ignore[attr-defined]
    return make


def taken(force: type[MadeForce]) -> dict[str, Any]:
    """Arguments of the method besides the two sides, with their defaults."""
    axis = {"axis": NEEDED} if force.has("along", "across", "glide", "skid") else {}
    if not force.row.is_spring:
        return {**axis, "value": NEEDED, "of": None}
    length = {"length": None} if any(zero == "length" for _, zero in force.row.quantities) else {}
    return {**axis, "stiffness": NEEDED, "damping": 0.0, **length}


def _add(m: Elements, force: type[MadeForce], build: Callable[..., Any], name: Any, *, first: Any, second: Any, at: Any = None,
         axis: Any = None, stiffness: Any = None, damping: Any = 0.0, length: Any = None, value: Any = None,
         of: Any = None) -> Any:
    if not force.is_in_space():
        m._in_the_plane(force.kind)
    name = m._new_name(name, force.kind)
    if force.is_between_points():
        first, second = m._different(name, m._point("first", first), m._point("second", second))
    else:
        first, second = m._sides(name, first, second, at)
    if force.has("angle"):
        m._turning(name, force.kind, first.body, second.body)
    if axis is not None:
        m._turning(name, "axis of", first.body)
        axis = first.body.pose.local_direction(m._direction(f"axis of {name!r}", axis))
    values, law = {}, None
    if force.row.is_spring:
        values = _each("stiffness", name, force, stiffness) | _each("damping", name, force, damping)
    else:
        law = m._law(f"value of {force.kind} {name!r}", value, of)
    if length is not None:
        values["length"] = _check.number(f"length of {name!r}", length, least=0)
    return m._add(build(name, first, second, axis, values, law))


def _each(quantity: str, name: str, force: type[MadeForce], given: Any) -> dict[str, float]:
    """Values of a quantity for all marker quantities, by path, from one number for all of them or one for each."""
    paths = force.paths(quantity)
    given = np.broadcast_to(given, len(paths)) if np.ndim(given) == 0 else given
    each = zip(paths, _check.vector(f"{quantity} of {name!r}", given, len(paths)), strict=True)
    return {path: _check.number(f"{path} of {name!r}", float(number), least=0) for path, number in each}


def _documentation(force: type[MadeForce]) -> str:
    """Docstring in the style of the handwritten ones."""
    card, several = force.row.card, len(force.row.quantities) > 1
    words = {"vector": "(2,) or (3,)" if force.is_in_space() else "(2,)",
             "unstressed": "" if "length" in taken(force) else " It is unstressed as drawn.",
             **{f"rotary_{name}": f", along angles in {unit}" * force.has("angle") for name, unit in ROTARY.items()},
             "size": f" or array_like ({len(force.row.quantities)},)" if several else "",
             "each": f"; for each of {', '.join(quantity for quantity, _ in force.row.quantities)}" if several else ""}
    lines = [card.summary, "", *wrapped(card.description), "Parameters", "----------"]
    sides = POINTS if force.is_between_points() else {**SIDES, "at": AT}
    for name, (kind, text) in {"name": ("str", ""), **sides, **{word: TAKEN[word] for word in taken(force)}}.items():
        lines += [f"{name} : {kind.format(**words)}", *wrapped(text.format(**words), "    ")[:-1]]
    lines += ["", "Returns", "-------", force.__name__, "", "Notes", "-----", *wrapped(f"Source: {card.equations}.")]
    axis = ", axis=(1, 0)" if "axis" in taken(force) else ""
    given = "m.ground.point((0, 0)), body.center" if force.is_between_points() else "m.ground, body, at=(1, 0)"
    value = "stiffness=2.0" if force.row.is_spring else "value=2.0"
    lines += ["Examples", "--------", ">>> import zerodrift as zd", '>>> m = zd.Mechanism("example")',
              '>>> body = m.body("body", 1.0, 0.1, at=(1, 0))',
              f'>>> m.{force.kind}("element", {given}{axis}, {value})',
              f"<{force.kind} element: ground - body>"]
    return "\n".join(lines)
