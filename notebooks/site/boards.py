"""Addresses at which the drawing board opens mechanisms: bodies become links and plates, particles become blocks."""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np

import zerodrift as zd
from zerodrift.mechanisms.files.to_json import described

KINDS = {"link", "revolute", "weld", "slot", "prismatic", "motor", "point", "force", "spring"}      # of the board
JOINTS = ("revolute", "weld", "slot", "prismatic")
SIDES = ("first", "second", "point")
DRIVES = ("speed", "torque", "force")
SHORT = 1e-3        # m: length of a block


def address(model: dict[str, Any]) -> str:
    """Address on which the drawing board opens a description."""
    data = json.dumps(model, separators=(",", ":")).encode()
    return "../board.html#m=" + base64.urlsafe_b64encode(data).decode("ascii").rstrip("=")


def boarded(m: zd.Mechanism) -> dict[str, Any] | None:
    """Description of a mechanism for the drawing board, whose links are uniform and which starts as drawn; None if it has parts that
    the board has not.
    """
    if m.dimension == 3:
        return None
    data = described(m._drawing())
    points = {each["name"]: {key: each[key] for key in ("body", "local")} for each in data["elements"] if each["kind"] == "point"}
    points |= {f'{each["name"]}.center': {"body": each["name"], "local": each["com"]} for each in data["elements"] if each["kind"] == "body"}
    elements = [each | {key: points[each[key]] for key in SIDES if isinstance(each.get(key), str) and each[key] in points}
                for each in data["elements"] if each["kind"] != "motor" or _is_plain(each)]
    changed = {each["name"]: _as_link(each, elements) for each in elements if each["kind"] in ("body", "particle")}
    prescribed = [each["drives"] for each in data["elements"] if each["kind"] == "motor" and not _is_plain(each)]
    if any(each is None for each in changed.values()) or set(prescribed) - {"angle"}:       # a crank that swings is left free
        return None
    found = []
    for each in elements:
        if each["kind"] in ("body", "particle"):
            found.append(changed[each["name"]][0])
        elif each["kind"] in KINDS:
            found.append(_moved(each, changed))
        else:
            return None
    return data | {"name": m.name.replace("_", " "), "elements": found, "start": {}, "wish": {}, "parameters": {}}


def _is_plain(motor: dict[str, Any]) -> bool:
    return isinstance(motor["law"], int | float) and motor["drives"] in DRIVES


def _as_link(body: dict[str, Any], elements: list[dict[str, Any]]) -> tuple[dict[str, Any], np.ndarray, float] | None:
    """A body as a link between two of its points, with the origin and the angle of the link in the frame of the body."""
    if body["kind"] == "particle":
        if not isinstance(body["at"], list):
            return None
        start = np.array(body["at"])
        return {"kind": "link", "name": body["name"], "start": [*start], "end": [start[0] + SHORT, start[1]], "mass": body["mass"]}, np.zeros(2), 0.0
    sides = [each[key] for each in elements for key in SIDES if isinstance(each.get(key), dict)] + [each for each in elements if each["kind"] == "point"]
    places = [np.array(side["local"]) for side in sides if side["body"] == body["name"]] + [np.array(body["com"]), np.array([0.1, 0.0])]
    origin = places[0]
    other = max(places[:-1], key=lambda place: float(np.hypot(*(place - origin))))
    along = (other if np.hypot(*(other - origin)) > SHORT else places[-1]) - origin
    c, s = np.cos(body["angle"]), np.sin(body["angle"])
    start, end = (np.array(body["at"]) + np.array([[c, -s], [s, c]]) @ place for place in (origin, origin + along))
    length = float(np.hypot(*along))
    mass = body["mass"] or 3 * body["inertia"] / length**2      # with the inertia about its start
    made = {"kind": "link", "name": body["name"], "start": start.tolist(), "end": end.tolist(), "mass": mass, "length": length}
    return made, origin, float(np.arctan2(along[1], along[0]))


def _moved(element: dict[str, Any], changed: dict[str, Any]) -> dict[str, Any]:
    """An element in the frames of links."""
    found = {key: value for key, value in element.items() if key != "inertia"}
    for key in SIDES:
        side = found.get(key)
        if isinstance(side, dict) and side["body"] in changed:
            found[key] = _named(changed[side["body"]], side["local"])
        elif isinstance(side, str) and side in changed:
            found[key] = f"{side}.start"
    if found["kind"] == "point" and found["body"] in changed:
        found["local"] = _own(changed[found["body"]], found["local"])
    first = element.get("first")
    if "axis" in found and isinstance(first, dict) and first["body"] in changed:
        found["axis"] = _turned(-changed[first["body"]][2], np.array(found["axis"]))
    if found["kind"] == "slot" and isinstance(found["second"], str) and _is_block(found["second"], changed):
        found |= {"kind": "prismatic", "damping": 0.0, "cut": False}       # a particle has no angle that turns
    return found


def _is_block(side: str, changed: dict[str, Any]) -> bool:
    name = side.partition(".")[0]
    return name in changed and "length" not in changed[name][0]


def _turned(angle: float, vector: np.ndarray) -> list[float]:
    c, s = np.cos(angle), np.sin(angle)
    return [float(c * vector[0] - s * vector[1]), float(s * vector[0] + c * vector[1])]


def _own(link: Any, local: list[float]) -> list[float]:
    return _turned(-link[2], np.array(local) - link[1])


def _named(link: Any, local: list[float]) -> Any:
    """A point of a link: one of its ends, or in its frame."""
    name, place = link[0]["name"], _own(link, local)
    length = link[0].get("length", SHORT)
    ends = [f"{name}.{end}" for end, far in (("start", 0.0), ("end", length)) if np.hypot(place[0] - far, place[1]) < 1e-9]
    return ends[0] if ends else {"body": name, "local": place}
