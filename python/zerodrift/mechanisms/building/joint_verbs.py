"""Methods of `Mechanism` that add joints."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import checks
from ..._private.types import ArrayLike
from ...errors import WrongType, WrongValue
from ..elements.bodies import Body, Point
from ..elements.joints import Joint, Rolling
from .space_joint_verbs import TOUCHING, SpaceJointVerbs
from .table_verbs import TableVerbs

Side = Body | Point | str


class JointVerbs(TableVerbs, SpaceJointVerbs):
    """Joints between bodies.

    Position of a joint: `first` and `second` are two points; or a body and a point, at whose position in the drawing the body
    is joined; or two bodies, with the position ``at=`` in the drawing. Names may replace objects: ``"crank"``,
    ``"crank.end"``, a point's own name.
    """

    gravity: Any

    def rolling(self, name: str, first: Body | str, second: Side, *, radius: float | None = None, at: ArrayLike | None = None,
                normal: ArrayLike | None = None, axle: ArrayLike | None = None, semiaxes: ArrayLike | None = None,
                ring: float | None = None) -> Joint:
        """Let a wheel roll on a line or a ring without slipping; in space a disc, a sphere or an ellipsoid on a plane.

        Parameters
        ----------
        name : str
        first : Body or name
            Body of the line or plane.
        second : Body, Point or name
            The wheel, with its centre at its origin, or the point that is its centre.
        radius : float
            In m; in space that of a sphere, or with `axle` that of a disc.
        at : array_like (2,) or (3,)
            A point of the line or plane in the drawing; left out: the drawing's origin.
        normal : array_like (2,) or (3,), optional
            Normal of the line or plane in the drawing, towards the wheel; left out: against gravity, and without gravity y, in
            space z.
        axle : array_like (3,), optional
            In space: axle of a disc in the drawing. It turns with the second body; with `ring` it is the ring's axis, too.
        semiaxes : array_like (3,), optional
            In space, instead of the radius: semiaxes of an ellipsoid along the axes of the second body's frame, in m.
        ring : float, optional
            Radius in m of a ring that is fixed to the first body, with its centre at `at`; the wheel rolls in it or around it, as
            drawn. A body without mass, ``"name arm"``, turns about the centre on ``"name hub"`` and carries the wheel, which
            ``"name gear"`` turns; all constraints are holonomic.

        Returns
        -------
        Rolling, in space SpaceJoint; with `ring` the hinge of the wheel on the arm
            Its force acts at the contact point. In space it has one holonomic and two nonholonomic constraints.

        Raises
        ------
        ValueError, TypeError
            As `revolute`; and for a normal of length zero, a radius that is not positive, or a particle.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("wheel", gravity=(0, -9.81))
        >>> wheel = m.body("wheel", *zd.inertia.disc(mass=1.0, radius=0.5), at=(0, 0.5))
        >>> m.rolling("contact", m.ground, wheel, radius=0.5).force
        VectorMeasure('contact.force')
        """
        if ring is not None:
            if normal is not None or semiaxes is not None or (axle is None) != (self.dimension == 2):
                raise WrongType(f"ring= of {name!r} must be given with radius=, at= and in space axle=", "conflicting-arguments")
            return self._on_ring(name, first, second, radius, ring, at, {} if axle is None else {"axis": axle})
        if self.dimension == 3:
            return self._space_rolling(name, first, second, radius, at, normal, axle, semiaxes)
        if axle is not None or semiaxes is not None:
            raise WrongValue(f"axle and semiaxes of {name!r} are for mechanisms in space", "wrong-dimension")
        name = self._new_name(name, "joint")
        at = (0.0, 0.0) if at is None else at
        radius = checks.number(f"radius of {name!r}", radius, above=0)
        if normal is None:
            normal = -self.gravity if self.gravity.any() else (0.0, 1.0)
        normal = self._direction(f"normal of {name!r}", normal)
        first, at, second = self._body("first", first), self._drawn("at", at), self._named("second", second)
        if isinstance(second, Body) and second.turns:
            second = self._body("second", second).point((0.0, 0.0))
        one, other = self._different(name, first.point(at=at), self._point("second", second))
        self._turning(name, "rolling", one.body, other.body)
        return self._add(Rolling(name, one, other, radius, one.body.pose.local_direction(normal)))

    def _on_ring(self: Any, name: str, first: Any, second: Any, radius: Any, ring: Any, at: Any, axis: dict[str, Any]) -> Joint:
        """Wheel on an arm without mass that turns about the centre of a ring, geared to the arm."""
        name, radius = self._new_name(name, "joint"), checks.number(f"radius of {name!r}", radius, above=0)
        ring = checks.number(f"ring of {name!r}", ring, above=0)
        first, second = self._body("first", first), self._named("second", second)
        origin = np.zeros(self.dimension)
        wheel = second.point(origin) if isinstance(second, Body) and second.turns else self._point("second", second)
        at = self._drawn("at", origin if at is None else at)
        distance = float(np.linalg.norm(wheel.drawn - at))
        length = min(abs(ring - radius), ring + radius, key=lambda each: abs(each - distance))
        if abs(length - distance) >= TOUCHING * length:
            raise WrongValue(f"{name!r} has no contact as drawn: the centre of {wheel.body.name!r} must be "
                             f"{abs(ring - radius):.6g} or {ring + radius:.6g} m from that of the ring, not {distance:.6g} m",
                             "geometry")
        arm = self.body(f"{name} arm", 0.0, at=at)
        hub = self.revolute(f"{name} hub", first, arm, at=at, **axis)
        joint = self.revolute(name, arm.point(at=at + length / distance * (wheel.drawn - at)), wheel, **axis)
        self.gear(f"{name} gear", hub, joint, ratio=(ring if length == ring + radius else -ring) / radius)
        return joint
