"""Elements of a mechanism in space from JSON, where it differs from the plane's."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ..elements.bodies import Point
from ..elements.frames import Pose3, given_rotation
from ..elements.immutable import amend
from ..elements.space_joints import BY_KIND, SpaceJoint, advances
from .values_from_json import direction_from_json, law_and_of, place_from_json, point_of_body

SAME = 1e-9         # difference of a joint's two frames in the drawing, at most


def keep_rotations(m: Any, start: Any, wish: Any) -> None:
    """Set the rotations of a start to the stored ones, bit by bit."""
    for kept, given in ((m._held, start), (m._wished, wish)):
        kept.update({name: np.array(value) for name, value in given.items() if name.endswith(".rotation")})


def _matrix(what: str, given: Any) -> np.ndarray:
    return checks.vector(what, np.ravel(given), 9).reshape(3, 3)


def _rotation(what: str, given: Any) -> np.ndarray:
    """Rotation as stored, checked."""
    given_rotation(what, given)
    return np.array(given, dtype=float)


def _body(m: Any, name: str, *, mass: Any, inertia: Any, at: Any, rotation: Any, com: Any) -> None:
    body = m.body(name, mass, _matrix("inertia", inertia), at=at, rotation=rotation, com=com)
    amend(body, pose=Pose3(body.pose.origin, _rotation("rotation", rotation)))


def _link(m: Any, name: str, *, start: Any, end: Any, rotation: Any, mass: Any, length: Any, thickness: Any = None,
          inertia: Any = None) -> None:
    R = _rotation("rotation", rotation)
    inertia = None if inertia is None else _matrix("inertia", inertia)
    link = m.link(name, start, end, mass, length=length, thickness=thickness, inertia=inertia, normal=R[:, 2])
    if np.abs(link.pose.rotation - R).max() > SAME:
        raise WrongValue("rotation must have the link along its first column", "unreadable-file")
    drawn = np.linalg.norm(link.drawn_end - link.pose.origin)
    amend(link, pose=Pose3(link.pose.origin, R), has_given_length=abs(link.length - drawn) > SAME * drawn)


def frames_from_json(first: Point, second: Point, given: Any, same: slice = slice(3)) -> tuple[np.ndarray, np.ndarray]:
    """Frames (3, 3) of a joint in both bodies, whose directions `same` are checked to be equal in the drawing."""
    if not isinstance(given, list) or len(given) != 2:
        raise WrongValue(f"frames must be two matrices, not {checks.shown(given)}", "unreadable-file")
    frames = _rotation("frames[0]", given[0]), _rotation("frames[1]", given[1])
    one, other = (frame @ side.body.pose.rotation.T       # type: ignore[attr-defined]
                  for frame, side in zip(frames, (first, second), strict=True))
    if np.abs(one - other)[same].max() > SAME:
        raise WrongValue("frames must be the same in the drawing, that of the first body and that of the second",
                         "unreadable-file")
    return frames


def _joint(kind: str) -> Callable[..., None]:
    def make(m: Any, name: str, *, first: Any, second: Any, frames: Any, length: Any = None, damping: Any = 0.0,
             cut: Any = False) -> None:
        one, other = m._different(name, *(m._point("a side", place_from_json(m, side)) for side in (first, second)))
        row = BY_KIND[kind].row
        both = frames_from_json(one, other, frames, slice(2 if row.axes == 2 else 0, 3))
        axis, normal = (frame[i] @ side.body.pose.rotation.T for i, (frame, side) in enumerate(
            zip(both, (one, other), strict=True)))
        if advances(row) and not checks.number("length", length):
            raise WrongValue("length must not be 0: it is the pitch", "unreadable-file")
        made: SpaceJoint = m._fasten(kind, m._new_name(name, "joint"), one, other, axis, normal,
                                     length=None if length is None else checks.number("length", length), damping=damping)
        amend(made, frames=both, cut=checks.instance("cut", cut, bool, "True or False") or made.cut)
    return make


def _rolling(m: Any, name: str, *, first: Any, second: Any, frames: Any, semiaxes: Any) -> None:
    plane, centre = point_of_body(m, first), m._point("second", place_from_json(m, second))
    given = tuple(_rotation(f"frames[{i}]", frame) for i, frame in enumerate(frames))
    a, b, c = (float(each) for each in checks.vector("semiaxes", semiaxes, 3))
    axle = centre.body.pose.direction(given[1][0])
    shape = {"radius": b, "axle": axle} if not a else {"radius": a} if a == b == c else {"semiaxes": (a, b, c)}
    joint = m.rolling(name, plane.body, centre, at=plane.drawn, normal=plane.body.pose.direction(given[0][0]), **shape)
    amend(joint, first=plane, frames=given)


def _torque(m: Any, name: str, *, body: Any, against: Any, axis: Any, frame: Any, value: Any) -> None:
    value, of = law_and_of(value, "value")
    axis, against, frame = direction_from_json("axis", axis, 3), m._body("against", against), m._body("frame", frame)
    turns_with = frame if against is m.ground else against
    torque = m.torque(name, body, value=value, of=of, against=against, axis=turns_with.pose.direction(axis),
                      frame=frame)
    amend(torque, axis=axis)


IN_SPACE: Mapping[str, Callable[..., None]] = {
    **{kind: _joint(kind) for kind in BY_KIND}, "rolling": _rolling, "body": _body, "link": _link,
    "torque": _torque}
