"""Joints in space: those whose arguments the core's table cannot name, and steps that all methods of joints share."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import checks
from ..._private.gateway.mechanisms.element_tables import three
from ...errors import WrongType, WrongValue
from ..elements.bodies import Body, Point
from ..elements.frames import perpendicular
from ..elements.joints import draws_length
from ..elements.space_joints import BY_KIND, RIGHT_ANGLE, SpaceJoint, has_torque, is_blade, swivels
from .registry import Elements

Side = Body | Point | str
FLAT = 1e-6             # sine of the angle below which directions are parallel
TOUCHING = 0.01         # of the height of the centre: gap of a rough drawing that assembly closes


class SpaceJointVerbs(Elements):
    """Joints in space, whose axes are directions in the drawing."""

    # ---- rolling ----

    gravity: np.ndarray

    def _upwards(self) -> np.ndarray:
        """Direction against gravity; z without gravity."""
        return -self.gravity if self.gravity.any() else np.array([0.0, 0.0, 1.0])

    def _space_rolling(self, name: str, first: Any, second: Any, radius: Any, at: Any, normal: Any, axle: Any,
                       semiaxes: Any) -> SpaceJoint:
        """Ellipsoid on a plane: its shape along the rows of a frame of the second body."""
        name = self._new_name(name, "joint")
        if (radius is None) == (semiaxes is None):
            raise WrongType(f"{name!r} must have radius= for a sphere, with axle= for a disc, or semiaxes= for an ellipsoid",
                            "missing-argument")
        normal = self._direction(f"normal of {name!r}", self._upwards() if normal is None else normal)
        first, second = self._body("first", first), self._named("second", second)
        if isinstance(second, Body) and second.turns:
            second = self._body("second", second).point(np.zeros(3))
        at = np.zeros(3) if at is None else self._drawn("at", at)
        first, second = self._different(name, first.point(at=at), self._point("second", second))
        self._turning(name, "rolling", first.body, second.body)
        frame, shape = self._shape(name, second.body, normal, radius, axle, semiaxes)
        height = float((second.drawn - at) @ normal)
        if not height > 0:
            raise WrongValue(f"normal of {name!r} must point to the side of the plane on which the centre is drawn", "geometry")
        gap = height - float(np.linalg.norm(shape * (frame @ second.body.pose.local_direction(normal))))
        if abs(gap) > TOUCHING * height:
            raise WrongValue(f"{name!r} has no contact as drawn: {second.body.name!r} is {abs(gap):.3g} m "
                             f"{'off' if gap > 0 else 'in'} the plane; draw its centre {height - gap:.6g} m from it", "geometry")
        frames = np.stack([first.body.pose.local_direction(row) for row in _frame(normal, None)]), frame
        return self._add(BY_KIND["rolling"](name, first, second, frames=frames, semiaxes=shape))

    def _shape(self, name: str, body: Body, normal: np.ndarray, radius: Any, axle: Any,
               semiaxes: Any) -> tuple[np.ndarray, tuple[float, float, float]]:
        """Rows (3, 3) of a frame in the body's, and the semiaxes along them."""
        if semiaxes is not None:
            if axle is not None:
                raise WrongType(f"{name!r} must have no axle= with semiaxes=, those of an ellipsoid", "conflicting-arguments")
            given = checks.vector(f"semiaxes of {name!r}", semiaxes, 3)
            return np.eye(3), three(checks.number(f"each of the semiaxes of {name!r}", float(each), above=0) for each in given)
        radius = checks.number(f"radius of {name!r}", radius, above=0)
        if axle is None:
            return np.eye(3), (radius, radius, radius)
        axle = self._direction(f"axle of {name!r}", axle)
        if np.linalg.norm(np.cross(axle, normal)) < FLAT:
            raise WrongValue(f"axle of {name!r} must not be parallel to the normal in the drawing: a disc that lies flat does "
                             "not roll", "geometry")
        return np.stack([body.pose.local_direction(row) for row in _frame(axle, None)]), (0.0, radius, radius)

    # ---- shared ----

    def _at_origin(self, name: str, at: Any, first: Any, second: Any) -> Any:
        """Position of a joint: of two bodies without `at`, the second's origin."""
        first, second = self._named(f"first of {name!r}", first), self._named(f"second of {name!r}", second)
        if at is None and all(isinstance(side, Body) and side.turns for side in (first, second)):
            return second.pose.origin
        return at

    def _join(self, kind: str, name: str, first: Side, second: Side, at: Any, axis: Any = None, normal: Any = None, *,
              length: float | None = None, damping: Any = 0.0, cut: Any = False) -> SpaceJoint:
        """Joint in space between two sides, with the frame of its axis and normal in the drawing."""
        name = self._new_name(name, "joint")
        return self._fasten(kind, name, *self._sides(name, first, second, at), axis, normal, length=length, damping=damping,
                            cut=cut)

    def _fasten(self, kind: str, name: str, first: Point, second: Point, axis: Any = None, normal: Any = None, *,
                length: float | None = None, damping: Any = 0.0, cut: Any = False) -> SpaceJoint:
        """Joint in space between two points, with the frame of its axis and normal in the drawing."""
        joint = BY_KIND[kind]
        if has_torque(joint.row):
            self._turning(name, kind, first.body, second.body)
        elif joint.row.axes:
            self._turning(name, "the axis of", first.body)
        elif is_blade(joint.row):
            self._turning(name, "knife edge", second.body)
        if damping and swivels(joint.row):
            self._turning(name, "damping of", first.body, second.body)
        frame = np.eye(3) if axis is None else _frame(axis, normal)
        frames = tuple(np.stack([side.body.pose.local_direction(row) for row in frame]) for side in (first, second))
        if joint.row.axes == 2 and abs(axis @ normal) > RIGHT_ANGLE:        # the second body has the given normal
            own = np.stack([np.cross(normal, frame[2]), normal, frame[2]])
            frames, cut = (frames[0], np.stack([second.body.pose.local_direction(row) for row in own])), True
        damping = checks.number(f"damping of {name!r}", damping, least=0)
        made = joint(name, first, second, frames=frames, length=length, damping=damping, cut=checked_cut(name, cut))
        if draws_length(joint.row):
            checks.number(f"length of {name!r}, as drawn,", made.numbers()["length"], above=0)
        return self._add(made)


def _frame(axis: np.ndarray, normal: np.ndarray | None) -> np.ndarray:
    """Axis, normal and third direction as rows (3, 3), right-handed."""
    normal = perpendicular(axis, normal)
    return np.stack([axis, normal, np.cross(axis, normal)])


def checked_cut(name: str, value: Any) -> bool:
    """Check that `cut` is True or False."""
    if not isinstance(value, bool):
        raise WrongType(f"cut of {name!r} must be True or False, not {checks.shown(value)}")
    return value
