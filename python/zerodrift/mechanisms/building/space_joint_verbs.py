"""Methods of `Mechanism` that add joints in space, and what its other methods share with them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ... import _check
from ..elements.bodies import Body, Point
from ..elements.frames import perpendicular
from ..elements.space_joints import BY_KIND, SpaceJoint, has_torque
from .registry import Elements

Side = Body | Point | str
RIGHT_ANGLE = 1e-9      # of the cosine: deviation from a right angle, at most
FLAT = 1e-6             # sine of the angle below which directions are parallel
TOUCHING = 0.01         # of the height of the centre: gap of a rough drawing that assembly closes


class SpaceJointVerbs(Elements):
    """Joints that exist in space only. Their axes are directions in the drawing."""

    def spherical(self, name: str, first: Side, second: Side, *, at: Any = None, cut: bool = False) -> SpaceJoint:
        """Join two bodies by a ball.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            As of `revolute`; one of them may be a particle.
        at : array_like (3,)
            Where the joint is in the drawing, in m.
        cut : bool
            As of `revolute`.

        Returns
        -------
        SpaceJoint

        Raises
        ------
        ValueError, TypeError
            As `revolute`; and in the plane, where `revolute` is meant.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", dimension=3, gravity=(0, 0, -9.81))
        >>> link = m.link("link", (0, 0, 0), (1, 0, 0), mass=1.0)
        >>> m.spherical("A", m.ground, link.start).force
        VectorMeasure3('A.force')
        """
        self._in_space("spherical", "revolute")
        return self._join("spherical", name, first, second, at, cut=cut)

    def universal(self, name: str, first: Side, second: Side, *, axes: tuple[Any, Any], at: Any = None,
                  cut: bool = False) -> SpaceJoint:
        """Join two bodies by a cross, as Hooke's or Cardan's joint does.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            As of `revolute`.
        axes : tuple of array_like (3,)
            The arm of the cross that belongs to the first body, and that which belongs to the second: perpendicular.
        at : array_like (3,)
            Where the joint is in the drawing, in m.
        cut : bool
            As of `revolute`.

        Returns
        -------
        SpaceJoint
            ``angle1`` is how far the cross has turned about the first arm, ``angle2`` how far the second body has about the
            other, in rad; they count turns.

        Raises
        ------
        ValueError, TypeError
            As `revolute`; and if the axes are not perpendicular in the drawing, or in the plane.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("shafts", dimension=3)
        >>> one = m.link("one", (0, 0, 0), (1, 0, 0), mass=1.0)
        >>> other = m.link("other", (1, 0, 0), (2, 0.5, 0), mass=1.0)
        >>> m.universal("cross", one.end, other.start, axes=((0, 0, 1), (-0.5, 1, 0))).angle1
        Measure('cross.angle1')
        """
        self._in_space("universal", "revolute")
        if np.ndim(axes) == 0 or len(axes) != 2:
            raise ValueError(f"axes of {name!r} must be two directions, one of the first body and one of the second")
        first_axis, second_axis = (self._direction(f"axes[{i}] of {name!r}", axis) for i, axis in enumerate(axes))
        cosine = float(first_axis @ second_axis)
        if abs(cosine) > RIGHT_ANGLE:
            raise ValueError(f"axes of {name!r} must be perpendicular in the drawing, and are "
                             f"{np.degrees(np.arccos(cosine)):.6g} degrees apart")
        return self._join("universal", name, first, second, at, first_axis, second_axis, cut=cut)

    def cylindrical(self, name: str, first: Side, second: Side, *, axis: Any, at: Any = None, cut: bool = False) -> SpaceJoint:
        """Join two bodies by an axis about which and along which one moves on the other.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            As of `prismatic`.
        axis : array_like (3,)
            Its direction in the drawing.
        at : array_like (3,)
            Where the joint is in the drawing, in m.
        cut : bool
            As of `revolute`.

        Returns
        -------
        SpaceJoint
            With ``angle``, ``displacement`` and their rates, ``angle_speed`` and ``displacement_speed``.

        Raises
        ------
        ValueError, TypeError
            As `prismatic`; and in the plane.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("bolt", dimension=3)
        >>> bolt = m.body("bolt", 1.0, (0.1, 0.2, 0.2))
        >>> m.cylindrical("hole", m.ground, bolt, axis=(1, 0, 0)).displacement
        Measure('hole.displacement')
        """
        self._in_space("cylindrical", "prismatic")
        return self._join("cylindrical", name, first, second, self._at_origin(at, first, second),
                          self._direction(f"axis of {name!r}", axis), cut=cut)

    def screw(self, name: str, first: Side, second: Side, *, axis: Any, pitch: float, at: Any = None,
              cut: bool = False) -> SpaceJoint:
        """Join two bodies by a screw.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            As of `prismatic`.
        axis : array_like (3,)
            Its direction in the drawing.
        pitch : float
            How far the second body advances along the axis for each turn about it, in m; positive of a right-handed screw.
        at : array_like (3,)
            Where the joint is in the drawing, in m.
        cut : bool
            As of `revolute`.

        Returns
        -------
        SpaceJoint
            With ``angle``, ``displacement`` and their rates, ``angle_speed`` and ``displacement_speed``.

        Raises
        ------
        ValueError, TypeError
            As `prismatic`; for a pitch of zero; and in the plane.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("bolt", dimension=3)
        >>> bolt = m.body("bolt", 1.0, (0.1, 0.2, 0.2))
        >>> m.screw("thread", m.ground, bolt, axis=(1, 0, 0), pitch=0.002)
        <screw thread: ground - bolt>
        """
        self._in_space("screw", "prismatic")
        pitch = _check.number(f"pitch of {name!r}", pitch)
        if not pitch:
            raise ValueError(f"pitch of {name!r} must not be 0: take revolute")
        return self._join("screw", name, first, second, self._at_origin(at, first, second),
                          self._direction(f"axis of {name!r}", axis), length=pitch, cut=cut)

    def planar(self, name: str, first: Side, second: Side, *, normal: Any, at: Any = None, cut: bool = False) -> SpaceJoint:
        """Let one body slide on a plane of another, and turn about its normal.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            As of `prismatic`.
        normal : array_like (3,)
            Of the plane, in the drawing.
        at : array_like (3,)
            Where the joint is in the drawing, in m.
        cut : bool
            As of `revolute`.

        Returns
        -------
        SpaceJoint
            With ``angle``, that about the normal.

        Raises
        ------
        ValueError, TypeError
            As `prismatic`; and in the plane.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("puck", dimension=3)
        >>> puck = m.body("puck", 1.0, (0.1, 0.1, 0.2))
        >>> m.planar("ice", m.ground, puck, normal=(0, 0, 1)).angle
        Measure('ice.angle')
        """
        self._in_space("planar", "a free body")
        return self._join("planar", name, first, second, self._at_origin(at, first, second),
                          self._direction(f"normal of {name!r}", normal), cut=cut)

    # ---- rolling and gliding ----

    gravity: np.ndarray

    def _upwards(self) -> np.ndarray:
        """Direction against gravity; z without gravity."""
        return -self.gravity if self.gravity.any() else np.array([0.0, 0.0, 1.0])

    def _space_rolling(self, name: str, first: Any, second: Any, radius: Any, at: Any, normal: Any, axle: Any,
                       semiaxes: Any) -> SpaceJoint:
        """Ellipsoid on a plane: its shape along the rows of a frame of the second body."""
        name = self._new_name(name, "joint")
        if (radius is None) == (semiaxes is None):
            raise TypeError(f"{name!r} needs radius=, of a sphere or with axle= of a disc, or else semiaxes=, of an ellipsoid")
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
            raise ValueError(f"normal of {name!r} must point to the side of the plane on which the centre is drawn")
        gap = height - float(np.linalg.norm(shape * (frame @ second.body.pose.local_direction(normal))))
        if abs(gap) > TOUCHING * height:
            raise ValueError(f"{name!r} has no contact as drawn: {second.body.name!r} is {abs(gap):.3g} m "
                             f"{'off' if gap > 0 else 'in'} the plane; draw its centre {height - gap:.6g} m from it")
        frames = np.stack([first.body.pose.local_direction(row) for row in _frame(normal, None)]), frame
        return self._add(BY_KIND["rolling"](name, first, second, frames=frames, semiaxes=shape))

    def _shape(self, name: str, body: Body, normal: np.ndarray, radius: Any, axle: Any,
               semiaxes: Any) -> tuple[np.ndarray, tuple[float, float, float]]:
        """Rows (3, 3) of a frame in the body's, and the semiaxes along them."""
        if semiaxes is not None:
            if axle is not None:
                raise TypeError(f"{name!r} has semiaxes, of an ellipsoid, and no axle")
            given = _check.vector(f"semiaxes of {name!r}", semiaxes, 3)
            return np.eye(3), tuple(_check.number(f"each of the semiaxes of {name!r}", float(each), above=0) for each in given)
        radius = _check.number(f"radius of {name!r}", radius, above=0)
        if axle is None:
            return np.eye(3), (radius, radius, radius)
        axle = self._direction(f"axle of {name!r}", axle)
        if np.linalg.norm(np.cross(axle, normal)) < FLAT:
            raise ValueError(f"axle of {name!r} must not be parallel to the normal in the drawing: a disc that lies flat does "
                             "not roll")
        return np.stack([body.pose.local_direction(row) for row in _frame(axle, None)]), (0.0, radius, radius)

    def _space_knife_edge(self, name: str, point: Any, along: Any, normal: Any) -> SpaceJoint:
        """Blade: the axis of its frame points along it, the normal of the frame across."""
        name = self._new_name(name, "joint")
        along = self._direction(f"along of {name!r}", along)
        up = self._direction(f"normal of {name!r}", self._upwards() if normal is None else normal)
        if np.linalg.norm(np.cross(up, along)) < FLAT:
            raise ValueError(f"along of {name!r} must not be parallel to the normal of the ice")
        point = self._point("point", point, center=True)
        self._turning(name, "knife edge", point.body)
        first, point = self._different(name, self.ground.point(at=point.drawn), point)
        frame = _frame(along, np.cross(perpendicular(along, up), along))
        frames = tuple(np.stack([side.body.pose.local_direction(row) for row in frame]) for side in (first, point))
        return self._add(BY_KIND["knife_edge"](name, first, point, frames=frames))

    # ---- shared ----

    def _in_space(self, verb: str, instead: str) -> None:
        if self.dimension == 2:
            raise ValueError(f"{verb} is a joint of space, Mechanism(..., dimension=3): in the plane {instead} is meant")

    def _one_axis(self, name: str, axis: Any) -> Any:
        """Axis of a joint that has none in the plane."""
        if self.dimension == 2 and axis is not None:
            raise ValueError(f"axis of {name!r} is for mechanisms in space: in the plane bodies turn about its normal")
        if self.dimension == 3 and axis is None:
            raise TypeError(f"{name!r} needs axis=, the direction in the drawing about which it turns")
        return None if axis is None else self._direction(f"axis of {name!r}", axis)

    def _at_origin(self, at: Any, first: Any, second: Any) -> Any:
        """Position of a joint: of two bodies without `at`, the second's origin."""
        first, second = self._named("first", first), self._named("second", second)
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
        """The same between two points."""
        joint = BY_KIND[kind]
        if has_torque(joint.row):
            self._turning(name, kind, first.body, second.body)
        elif joint.row.axes:
            self._turning(name, "the axis of", first.body)
        frame = np.eye(3) if axis is None else _frame(axis, normal)
        frames = tuple(np.stack([side.body.pose.local_direction(row) for row in frame]) for side in (first, second))
        damping = _check.number(f"damping of {name!r}", damping, least=0)
        made = joint(name, first, second, frames=frames, length=length, damping=damping, cut=checked_cut(name, cut))
        if kind == "rod":
            _check.number(f"length of {name!r}, as drawn,", made.numbers()["length"], above=0)
        return self._add(made)


def _frame(axis: np.ndarray, normal: np.ndarray | None) -> np.ndarray:
    """Axis, normal and third direction as rows (3, 3), right-handed."""
    normal = perpendicular(axis, normal)
    return np.stack([axis, normal, np.cross(axis, normal)])


def checked_cut(name: str, value: Any) -> bool:
    """Check that `cut` is True or False."""
    if not isinstance(value, bool):
        raise TypeError(f"cut of {name!r} must be True or False, not {_check.shown(value)}")
    return value
