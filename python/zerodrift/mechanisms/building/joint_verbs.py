"""Methods of `Mechanism` that add joints."""

from __future__ import annotations

from typing import Any

from ..._private import checks
from ..._private.types import ArrayLike
from ...errors import WrongValue
from ..elements.bodies import Body, Point
from ..elements.joints import Joint, Rolling
from .space_joint_verbs import SpaceJointVerbs
from .table_verbs import TableVerbs

Side = Body | Point | str


class JointVerbs(TableVerbs, SpaceJointVerbs):
    """Joints between bodies.

    Where a joint is: `first` and `second` are points, which are joined; or a body and a point, and then the body's point that
    lies there in the drawing is meant; or two bodies, and ``at=`` is a place in the drawing. Names stand for what they name:
    ``"crank"``, ``"crank.end"``, a point's own name.
    """

    gravity: Any

    def rolling(self, name: str, first: Body | str, second: Side, *, radius: float | None = None, at: ArrayLike | None = None,
                normal: ArrayLike | None = None, axle: ArrayLike | None = None, semiaxes: ArrayLike | None = None) -> Joint:
        """Let a wheel roll on a line without slipping; in space a disc, a sphere or an ellipsoid on a plane.

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
            In space: axle of a disc in the drawing. It turns with the second body.
        semiaxes : array_like (3,), optional
            In space, instead of the radius: semiaxes of an ellipsoid along the axes of the second body's frame, in m.

        Returns
        -------
        Rolling, in space SpaceJoint
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
