"""Docstrings of the methods that `table_joint_verbs` makes, from entries of the core's tables."""

from __future__ import annotations

import textwrap
from typing import Any

from ..elements.joints import Joint, draws_length
from ..elements.space_joints import SpaceJoint, is_at_point, is_blade, speeds

WIDTH = 120     # columns of a docstring
SIDES = {
    "first, second": ("Body, Point or name", "Two points; a body and a point; or two bodies, and `at`.")}
POINTS = {"first, second": ("Point, Particle or name", "")}
POINT = {"point": ("Point, Body or name", "Point of a body; a body alone: its centre of mass.")}
WORDS = {
    "axis": ("array_like {axis_size}", "{only}direction in the drawing; it turns with the {carrier}."),
    "along": ("array_like {axis_size}", "Its direction in the drawing, in which the point slides; it turns with the body."),
    "up": ("array_like (3,), optional",
           "In space a direction in the drawing, made perpendicular to `along`; left out: against gravity, or z without gravity. "
           "The velocity of the point along ``cross(normal, along)`` is zero. This direction turns with the body, also "
           "when it leans. The joint does not keep the point on a plane."),
    "axes": ("tuple of array_like (3,)", "Axis of the first body and axis of the second in the drawing, not parallel. They keep "
             "their angle; if it is not a right angle, the joint is cut."),
    "normal": ("array_like (3,)", "Normal of the plane of the first body, in the drawing."),
    "at": ("array_like {size}", "Position of the joint in the drawing, in m.{origin}"),
    "pitch": ("float", "Advance of the second body along the axis per turn, in m; positive for a right-handed screw."),
    "length": ("float", "In m, above 0{left_out}."),
    "damping": ("float", "Damping of its {coordinate}, in {unit}, at least 0."),
    "cut": ("bool", "True if this joint must close a loop; left out, the joint that closes a loop is chosen."),
    "friction_torque": ("float or (float, float), optional", "Bound of dry friction, or the static and the sliding one, in N m."),
    "friction_force": ("float or (float, float), optional", "Bound of dry friction, or the static and the sliding one, in N."),
    "friction": ("float or (float, float), optional", "Coefficients of friction instead, under the load of the joint, which is "
                 "then constraints, not a coordinate. Axial forces and bending moments of a pin, and torsion of a slide, do not "
                 "count."),
    "radius": ("float, optional", "Radius of the pin in m, on which `friction` acts: its torque is at most ``mu r |F|``, with "
               "the radial force F."),
    "guide": ("float, optional", "Length of the guide in m: friction is at most ``mu (|F/2 + M/l| + |F/2 - M/l|)``."),
    "active": ("bool, optional", "Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, "
               "`Mechanism.latch` and ``Event(then=)``; it is then constraints, not a coordinate.")}
EXAMPLES = {"axis": ("(1, 0)", "(1, 0, 0)"), "along": ("(1, 0)", "(1, 0, 0)"), "axes": ("", "((1, 0, 0), (0, 1, 0))"),
            "normal": ("", "(0, 0, 1)"), "pitch": ("", "0.002"), "length": ("0.5", "0.5")}       # in the plane, in space


def documentation(plane: type[Joint] | None, space: type[SpaceJoint] | None, words: list[str]) -> str:
    """Docstring in the style of the handwritten ones, for a method with these arguments."""
    joint: Any = plane or space
    card = joint.row.card
    lines = [card.summary, "", *wrapped(card.description), "Parameters", "----------"]
    texts = {"name": ("str", ""), **(POINT if "point" in words else SIDES if "at" in words else POINTS)}
    texts |= {word: WORDS["up" if word == "normal" and "along" in words else word] for word in words if word in WORDS}
    values = _values(plane, space)
    for name, (kind, text) in texts.items():
        lines += [f"{name} : {kind.format(**values)}", *wrapped(text.format(**values), "    ")[:-1]]
    lines += ["", "Returns", "-------", ", in space ".join(each.__name__ if each is plane else "SpaceJoint"
                                                          for each in (plane, space) if each)]
    lines += wrapped(_measures(space), "    ")[:-1] if space else []
    lines += ["", "Raises", "------", "ValueError, TypeError"]
    lines += wrapped("If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out "
                     "of range, or a particle would need an orientation.", "    ")
    lines += ["Notes", "-----", *wrapped(f"Source: {card.equations}" + (f"; {card.reference}." if card.reference else "."))]
    return "\n".join([*lines, "Examples", "--------", *_example(joint, plane is not None, words)])


def _values(plane: type[Joint] | None, space: type[SpaceJoint] | None) -> dict[str, str]:
    """Values of the placeholders of the texts."""
    joint: Any = plane or space
    in_plane, in_space = bool(plane and plane.row.takes_axis), bool(space and (space.row.axes == 1 or is_blade(space.row)))
    to_origin = not is_at_point(space.row) if space else joint.row.takes_axis
    return {"carrier": "body" if joint.is_of_one_body else "first body",
            "coordinate": joint.coordinate or "relative angular velocity",
            "unit": "N s/m" if joint.coordinate == "displacement" else "N m s",
            "left_out": "; left out: as drawn" if draws_length(joint.row) else "",
            "size": _size(plane is not None, space is not None), "axis_size": _size(in_plane, in_space),
            "only": "In space: its " if plane and in_space and not in_plane else "Its ",
            "origin": " Left out for two bodies, it is the second's origin." if to_origin else ""}


def _size(in_plane: bool, in_space: bool) -> str:
    return " or ".join(size for size, exists in (("(2,)", in_plane), ("(3,)", in_space)) if exists)


def _measures(space: type[SpaceJoint]) -> str:
    """Sentence on the measures of a joint in space."""
    rates = speeds(space.row)
    if not rates:
        return ""
    names = [f"``{name}``" for name in (*space.coordinates, *rates)]
    turns = "; angles count turns" if space.angles else ""
    return f"With {', '.join(names[:-1])}, {names[-1]} and accelerations{turns}."


def wrapped(text: str, indent: str = "") -> list[str]:
    """Lines of a paragraph and an empty one; [] for an empty text."""
    return [*textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent), ""] if text else []


def _example(joint: type[Joint], in_plane: bool, words: list[str]) -> list[str]:
    at = "(1, 0)" if in_plane else "(1, 0, 0)"
    required = [word for word in words if word in EXAMPLES and EXAMPLES[word][not in_plane]]
    if in_plane:
        required = [word for word in required if word in (*joint.takes, "along")]
    sides = "body" if "point" in words else f"m.ground, body, at={at}" if "at" in words else (
        f"m.ground.point({at[:-2]}1)), body.center")
    arguments = ", ".join([sides, *(f"{word}={EXAMPLES[word][not in_plane]}" for word in required)])
    dimension, inertia = ("", "0.1") if in_plane else (", dimension=3", "(0.1, 0.1, 0.1)")
    return [">>> import zerodrift as zd", f'>>> m = zd.Mechanism("example"{dimension})',
            f'>>> body = m.body("body", 1.0, {inertia}, at={at})', f'>>> m.{joint.kind}("joint", {arguments}).force',
            f"VectorMeasure{'' if in_plane else '3'}('joint.force')"]
