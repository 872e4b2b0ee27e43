"""JSON of elements that differ in space: frames of bodies and joints, as stored."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..elements.drawing import Drawing
from ..elements.space_joints import BY_KIND
from .values_to_json import law_to_json, numbers, sides


def _body(body: Any, drawing: Drawing) -> dict[str, Any]:
    return {"mass": body.mass, "inertia": numbers(body.inertia), "at": numbers(body.pose.origin),
            "rotation": numbers(body.pose.rotation), "com": numbers(body._com)}


def _link(link: Any, drawing: Drawing) -> dict[str, Any]:
    given = {"thickness": link.thickness if link._is_given_thickness else None,
             "inertia": None if link._inertia is None else numbers(link._inertia)}
    return {"start": numbers(link.pose.origin), "end": numbers(link.drawn_end), "rotation": numbers(link.pose.rotation),
            "mass": link.mass, "length": link.length, **{key: value for key, value in given.items() if value is not None}}


def _joint(joint: Any, drawing: Drawing) -> dict[str, Any]:
    given = {"length": joint.length, "damping": joint.damping or None, "cut": joint.cut or None}
    return {**sides(joint, drawing), "frames": [numbers(frame) for frame in joint.frames],
            **{key: value for key, value in given.items() if value is not None}}


def _rolling(joint: Any, drawing: Drawing) -> dict[str, Any]:
    return {**sides(joint, drawing), "frames": [numbers(frame) for frame in joint.frames], "semiaxes": numbers(joint.semiaxes)}


def _torque(torque: Any, drawing: Drawing) -> dict[str, Any]:
    return {"body": torque.body.name, "against": torque.against.name, "axis": numbers(torque.axis), "frame": torque.frame.name,
            "value": law_to_json(torque.law)}


IN_SPACE: dict[str, Callable[[Any, Drawing], dict[str, Any]]] = {
    **dict.fromkeys(BY_KIND, _joint), "rolling": _rolling, "body": _body, "link": _link, "torque": _torque}      # type: ignore[has-type]
