"""Methods of `Mechanism` for force elements, made from entries of the core's tables: arguments, checks and documentation."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from ..._private import checks
from ..._private.gateway.mechanisms.element_tables import ElementKind
from ..._private.rotations import AXES
from ...errors import WrongType, WrongValue
from ..elements.bodies import Point
from ..elements.frames import perpendicular
from ..elements.immutable import amend
from ..elements.table_forces import ROTATIONS, TableForce, has, is_between_points, law_words, lengths, parameters, paths
from ..elements.user_functions import Law
from .registry import Elements
from .table_joint_documentation import POINTS, SIDES, wrapped

WORDS = {
    "joint": ("Joint, measure or name", "Joint with one angle, which counts turns; or one of two, such as ``universal.angle1``."),
    "at": ("array_like {vector}", "Position of the element in the drawing, in m."),
    "axis": ("array_like {axis_size}", "{axis}direction in the drawing; it turns with the first body.{own_axes}"),
    "normal": ("array_like (3,), optional", "In space its second direction, which is made perpendicular; the third follows."),
    "length": ("float, optional", "Unstressed length in m, at least 0; left out: as drawn."),
    "angle": ("float, optional", "Angle of the joint at which the spring is slack, in rad; left out: 0, as drawn."),
    "force": ("float, callable or SymPy expression, instead of `stiffness`",
              "Tension in N, negative where it pushes; a function of the same as the torque of `motor`. The spring's own "
              "``length`` and ``speed`` need no `of`: ``force=lambda length, speed: 500 * (length - 0.3)`` restores a length of "
              "0.3 m. Its work is an input of energy; only a number as stiffness has a potential."),
    "torque": ("float, callable or SymPy expression, instead of `stiffness`",
               "Torque on the joint's second body in N m; a function of the same as that of `motor`. The joint's own "
               "``angle`` and ``speed`` need no `of`: ``torque=lambda angle, speed: -5 * angle`` restores the angle 0. Its "
               "work is an input of energy; only a number as stiffness has a potential."),
    "value": ("float, callable or SymPy expression",
              "In {unit}; a function of the same as the torque of `motor`."),
    "of": ("dict of str to measure", "Measures that the callable receives, by argument name.")}
VECTOR = {
    word: (f"callable or array_like of laws, instead of `{stiffness}`",
           f"{what} on the second body along its directions, {unit}, one number for each: "
           f"``{word}=lambda {value}, {rate}: -500 * {value} - 5 * {rate}`` restores. {more}a function of the same as the "
           "torque of `motor`, and an input of energy.")
    for word, stiffness, what, unit, value, rate, more in (
        ("force", "stiffness", "Force", "in N", "displacement", "velocity", "Arrays of its own ``displacement``, ``velocity``, "
         "``angle`` and ``angular_velocity`` need no `of`; the last two are numbers in the plane; "),
        ("torque", "torsion", "Torque", "in N m", "angle", "angular_velocity", "As `force`, "))}
UNITS = {"stiffness": ("N/m", "N m/rad"), "damping": ("N s/m", "N m s/rad"), "torsion": ("", "N m/rad"),
         "torsion_damping": ("", "N m s/rad"), "value": ("N", "N m")}      # along marker quantities in m and in rad
KINDS = {"name": "str", "first": "Side", "second": "Side", "joint": "Joint | Measure | str", "value": "LawLike",
         **dict.fromkeys(("stiffness", "force", "torque"), "LawLike | None"), "of": "Bindings | None"}
BUSHING = {"stiffness": "ArrayLike", **dict.fromkeys(("force", "torque"), "Laws | None")}
NEEDED = inspect.Parameter.empty
SYMMETRIC = 1e-9        # of the largest entry of a matrix: asymmetry, at most
HINT = ("its potential is one of positions alone; give force=, such as lambda t, displacement: -k(t) * displacement, or "
        "torque=, such as lambda t, angle: -k(t) * angle")
VARYING = (" As a function, such as ``lambda t: 500 + 20 * t``, it may depend on the same as the torque of `motor`; "
           "its work is then an input of energy.")
DAMPER = "give force= of a spring, such as lambda speed: 5 * speed**3, or torque= of a torsion spring, with the opposite sign"
FLAT = 1e-6             # sine of the angle below which directions are parallel


def force_verb(force: type[TableForce]) -> Callable[..., Any]:
    """Method of `Mechanism` for one kind of force element."""
    given, kinds = {name: NEEDED for name in sides(force)}, KINDS if _either(force).measure else KINDS | BUSHING
    signature = inspect.Signature(
        [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation=KINDS.get(name, NEEDED))
         for name in ("self", "name", *given)]
        + [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=initial,
                             annotation=kinds.get(name, "ArrayLike" if initial is not None else "ArrayLike | None"))
           for name, initial in _words_of_all(force).items()], return_annotation=force.__name__)

    def make(m: Elements, *given: Any, **named: Any) -> TableForce:
        try:
            bound = signature.bind(m, *given, **named)
        except TypeError as error:
            raise WrongType(f"{force.kind}(): {error}") from None
        bound.apply_defaults()
        values = dict(bound.arguments)
        return _add(values.pop("self"), force, values.pop("name"), values)

    make.__name__, make.__qualname__ = force.kind, f"Mechanism.{force.kind}"
    make.__doc__, vars(make)["__signature__"] = _documentation(force), signature
    return make


def sides(force: type[TableForce]) -> tuple[str, ...]:
    """Arguments of what the element acts on: a joint, or two sides."""
    return ("joint",) if _either(force).at_joint else ("first", "second")


def words(entry: ElementKind) -> dict[str, Any]:
    """Keyword arguments of the method in the plane or in space, with their defaults."""
    axes = {"axis": NEEDED} if entry.axes == 1 else {"axis": None, "normal": None} if entry.axes else {}
    at = {} if entry.at_joint or is_between_points(entry) else {"at": None}
    if not entry.is_spring:
        return {**at, **axes, "value": NEEDED, "of": None}
    return {**at, **{word: None if word in ("length", "angle") or (word == "stiffness" and entry.measure) else 0.0
                     for word in parameters(entry)}, **dict.fromkeys((*law_words(entry), "of")), **axes}


def _either(force: type[TableForce]) -> ElementKind:
    """Entry of the plane, if there is one, otherwise of space."""
    return next(iter(force.entries.values()))


def _words_of_all(force: type[TableForce]) -> dict[str, Any]:
    """Keyword arguments in the plane and in space; those of one of them alone are optional."""
    each = [words(entry) for entry in force.entries.values()]
    return {word: initial if all(word in others for others in each) else None
            for known in each for word, initial in known.items()}


# ---- adding ----


def _add(m: Elements, force: type[TableForce], name: Any, given: dict[str, Any]) -> TableForce:
    entry, what = _entry(m, force, name, given), force.kind.replace("_", " ")
    name = m._new_name(name, what)
    ends = _ends(m, entry, name, given)
    if has(entry, *ROTATIONS) and not entry.at_joint:
        m._turning(name, what, *(end.body for end in ends))
    place = _directions(m, entry, name, given, ends)
    place |= {"which": which} if (which := given.get("which")) else {}
    stiffness: Any = given.get("stiffness")
    drives = "stiffness" if entry.measure and checks.varies(stiffness) else law_words(entry)[0]
    if entry.is_spring and entry.measure:
        _check_one(f"{what} {name!r}", entry.measure, given)
    if np.shape(stiffness) == (6, 6) and entry.axes == 3:
        place |= {"coupled": coupled} if (coupled := _coupled(name, given)).any() else {}
    law = given.pop(drives) if entry.measure else None
    values = {path: value for word in parameters(entry) for path, value in _values(word, name, entry, given.get(word)).items()}
    element = force(name, *ends, values=values, **place)
    if law is not None:
        amend(element, drives=drives, law=m._law(f"{drives} of {what} {name!r}", law, given["of"], reactions=True,
                                                 own=(element.joint or element) if entry.is_spring else None,
                                                 which=element.which))
    if not entry.measure:
        amend(element, laws=_laws(m, element, given))
    return m._add(element)


def _coupled(name: str, given: dict[str, Any]) -> np.ndarray:
    """Stiffness between the directions of a bushing; the diagonal of the given matrix becomes `stiffness` and `torsion`."""
    K = checks.vector(f"stiffness of {name!r}", np.ravel(given["stiffness"]), 36).reshape(6, 6)
    if np.any(given["torsion"]):
        raise WrongType(f"torsion of {name!r} is part of stiffness=, a matrix", "conflicting-arguments")
    if np.abs(K - K.T).max() > SYMMETRIC * np.abs(K).max():
        raise WrongValue(f"stiffness of {name!r} must be symmetric", "shape")
    given["stiffness"], given["torsion"] = np.split(np.diag(K), 2)
    return (K + K.T) / 2 - np.diag(np.diag(K))


def _laws(m: Elements, bushing: TableForce, given: dict[str, Any]) -> dict[str, Law]:
    """User functions of a bushing by path."""
    found, own, what = {}, {}, f"of bushing {bushing.name!r}"
    turns = 2 * m.dimension - 3
    for word, axes in (("displacement", m.dimension), ("velocity", m.dimension), ("angle", turns), ("angular_velocity", turns)):
        name = f"{bushing.name}.{word}"
        own[word] = name if axes == 1 else [f"{name}.{axis}" for axis in AXES[:axes]]
    for word, stiffness in (("force", "stiffness"), ("torque", "torsion")):
        if given[word] is None:
            continue
        if np.any(given[stiffness]) or bushing.coupled is not None:
            raise WrongType(f"{word} {what} must be given without {stiffness}, which it replaces", "conflicting-arguments")
        along = [each[2] for each in paths(bushing.row) if each[2].startswith(word)]
        for path, law in zip(along, m._components(f"{word} {what}", given[word], len(along), own, given["of"]), strict=True):
            found[path] = m._law(f"{path} {what}", law, given["of"], reactions=True, own=bushing)
    if not found and given["of"] is not None:
        raise WrongType(f"of= {what} must be given with force or torque", "conflicting-arguments")
    return found


def _check_one(what: str, law: str, given: dict[str, Any]) -> None:
    """Check that a spring has either a stiffness or a law, and no argument that belongs to the other."""
    has_law = given[law] is not None
    if has_law == (given["stiffness"] is not None):
        raise WrongType(f"{what} must have stiffness or {law}, not {'both' if has_law else 'neither'}", "conflicting-arguments")
    for word in ("length", "angle") if has_law else () if checks.varies(given["stiffness"]) else ("of",):
        if given.get(word) is not None:
            raise WrongType(f"{word}= of {what} must be given with {'stiffness' if has_law else law}", "conflicting-arguments")
    if not has_law and "angle" in given:
        given["angle"] = given["angle"] or 0.0


def _entry(m: Elements, force: type[TableForce], name: Any, given: dict[str, Any]) -> ElementKind:
    """Entry for the plane or for space; arguments of the other must be left out."""
    here, other = ("in the plane", "in space") if m.dimension == 2 else ("in space", "in the plane")
    if m.dimension not in force.entries:
        raise WrongValue(f"{force.kind} is there for mechanisms {other}, not {here}", "wrong-dimension")
    entry = force.entries[m.dimension]
    foreign = [word for word, value in given.items() if word not in (*sides(force), *words(entry)) and value is not None]
    if foreign:
        raise WrongValue(f"{' and '.join(foreign)} of {name!r} {'are' if len(foreign) > 1 else 'is'} for mechanisms {other}",
                         "wrong-dimension")
    return entry


def _ends(m: Elements, entry: ElementKind, name: str, given: dict[str, Any]) -> tuple[Any, ...]:
    """The joint, or the points of both bodies."""
    if entry.at_joint:
        joint, which = m._joint_angle(f"joint of {name!r}", given["joint"], ("angle",))
        given["which"] = which
        return (joint,)
    if is_between_points(entry):
        return m._different(name, *(m._point(side, given[side], center=True) for side in ("first", "second")))
    return m._sides(name, given["first"], given["second"], given["at"])


def _directions(m: Elements, entry: ElementKind, name: str, given: dict[str, Any], ends: tuple[Any, ...]) -> dict[str, Any]:
    """In the plane the axis in the first body's frame; in space the frame of an axis and a normal in those of both bodies."""
    axis, normal = given.get("axis"), given.get("normal")
    if not entry.axes:
        return {}
    if axis is None and entry.axes == 1:
        raise WrongType(f"{name!r} must have axis=, its direction in the drawing", "missing-argument")
    first, second = ends
    m._turning(name, "axis of", first.body)
    axis = None if axis is None else m._direction(f"axis of {name!r}", axis)
    if m.dimension == 2:
        return {"axis": first.body.pose.local_direction(axis)}
    return {"frames": _frames(name, first, second, axis, None if normal is None else m._direction(f"normal of {name!r}", normal))}


def _frames(name: str, first: Point, second: Point, axis: Any, normal: Any) -> tuple[np.ndarray, np.ndarray]:
    """Three directions in the frames of both bodies; by default the axes of the first body."""
    if axis is None and normal is not None:
        raise WrongType(f"normal= of {name!r} must be given with axis=, to which it is made perpendicular", "missing-argument")
    frame = first.body.pose.rotation.T      # type: ignore[attr-defined]
    if axis is not None:
        if normal is not None and np.linalg.norm(np.cross(axis, normal)) < FLAT:
            raise WrongValue(f"normal of {name!r} must not be parallel to its axis", "geometry")
        normal = perpendicular(axis, normal)
        frame = np.stack([axis, normal, np.cross(axis, normal)])
    one, other = (np.stack([side.body.pose.local_direction(row) for row in frame]) for side in (first, second))
    return one, other


def _values(word: str, name: str, entry: ElementKind, given: Any) -> dict[str, float]:
    """Values of a parameter by path, from one number for all of its marker quantities or one for each."""
    if given is None:
        return {}
    checks.constant(f"{word} of {name!r}", given, DAMPER if "damping" in word else HINT)
    paths = parameters(entry)[word]
    each = np.broadcast_to(given, len(paths)) if np.ndim(given) == 0 and len(paths) > 1 else given
    numbers = [each] if np.ndim(each) == 0 else checks.vector(f"{word} of {name!r}", each, len(paths)).tolist()
    return {path: checks.number(f"{path} of {name!r}", number, least=None if word == "angle" else 0)
            for path, number in zip(paths, numbers, strict=True)}


# ---- documentation ----


def _documentation(force: type[TableForce]) -> str:
    """Docstring in the style of the handwritten ones."""
    cards, known = [entry.card for entry in force.entries.values()], _words_of_all(force)
    texts = {"name": ("str", ""), **({} if "joint" in sides(force) else SIDES if "at" in known else POINTS)}
    of_words = WORDS if _either(force).measure else WORDS | VECTOR
    texts |= {word: of_words.get(word, ("", "")) for word in (*sides(force), *known) if word not in ("first", "second")}
    values = _placeholders(force)
    lines = [cards[0].summary, "", *wrapped(" ".join(dict.fromkeys(card.description for card in cards if card.description))),
             "Parameters", "----------"]
    for word, (kind, text) in texts.items():
        if not kind:
            kind, text = _parameter(force, word)
        lines += [f"{word} : {kind.format(**values)}", *wrapped(text.format(**values), "    ")[:-1]]
    lines += ["", "Returns", "-------", force.__name__, "", "Notes", "-----", *wrapped(f"Source: {cards[0].equations}.")]
    return "\n".join([*lines, "Examples", "--------", *_example(force)])


def _placeholders(force: type[TableForce]) -> dict[str, str]:
    """Values of the placeholders of the texts."""
    in_space = {dimension: entry.axes for dimension, entry in force.entries.items()}
    sizes = {2: "(2,)", 3: "(3,)"}
    return {"vector": " or ".join(sizes[dimension] for dimension in force.entries),
            "axis_size": " or ".join(sizes[dimension] for dimension, axes in in_space.items() if axes)
                         + ", optional" * (in_space.get(3) == 3),
            "axis": "In space its first " if in_space.get(3) == 3 else "Its ",
            "own_axes": " Left out: that body's own axes." if in_space.get(3) == 3 else "",
            "unit": _unit("value", _either(force))}


def _unit(word: str, entry: ElementKind) -> str:
    return UNITS[word][word.startswith("torsion") or not lengths(entry)]


def _parameter(force: type[TableForce], word: str) -> tuple[str, str]:
    """Kind and text of a stiffness or a damping."""
    sizes = {len(parameters(entry)[word]) for entry in force.entries.values()}
    vectors = " or ".join(f"({size},)" for size in sorted(sizes - {1}))
    kind = f"float{', in space' * (1 in sizes)} or array_like {vectors}" if vectors else "float"
    where = " about its directions" if word.startswith("torsion") else " along its directions" if vectors else ""
    text = f"In {_unit(word, _either(force))}{where}, at least 0."
    if word == "stiffness" and not vectors:
        return f"{kind}, callable or SymPy expression", text + VARYING
    return kind, text + " It is unstressed as drawn." * (word == "stiffness")


def _example(force: type[TableForce]) -> list[str]:
    entry, in_plane = _either(force), 2 in force.entries
    (x, y), dimension, inertia = (("(1, 0)", "(0, 0)"), "", "0.1") if in_plane else (
        ("(1, 0, 0)", "(0, 0, 0)"), ", dimension=3", "(0.1, 0.1, 0.1)")
    hinge = ", axis=(0, 0, 1)" * (not in_plane)
    given = (f'm.revolute("hinge", m.ground, body, at={y}{hinge})' if entry.at_joint else
             f"m.ground.point({y}), body.center" if is_between_points(entry) else f"m.ground, body, at={x}")
    axis = f", axis={x}" * (entry.axes == 1)
    where = " at hinge" if entry.at_joint else ": ground - body"
    return [">>> import zerodrift as zd", f'>>> m = zd.Mechanism("example"{dimension})',
            f'>>> body = m.body("body", 1.0, {inertia}, at={x})',
            f'>>> m.{force.kind}("element", {given}{axis}, {"stiffness" if entry.is_spring else "value"}=2.0)',
            f"<{force.kind.replace('_', ' ')} element{where}>"]
