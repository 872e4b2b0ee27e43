"""Methods of `Mechanism` that add joints."""

from __future__ import annotations

from typing import Any

from ... import _check
from ...errors import WrongValue
from ..elements.bodies import Body, Particle, Point
from ..elements.joints import KnifeEdge, Rolling, Slot
from .space_joint_verbs import SpaceJointVerbs, checked_cut
from .table_verbs import TableVerbs

Side = Body | Point | str


class JointVerbs(TableVerbs, SpaceJointVerbs):
    """Joints between bodies.

    Where a joint is: `first` and `second` are points, which are joined; or a body and a point, and then the body's point that
    lies there in the drawing is meant; or two bodies, and ``at=`` is a place in the drawing. Names stand for what they name:
    ``"crank"``, ``"crank.end"``, a point's own name.
    """

    gravity: Any

    def slot(self, name: str, first: Body | str, second: Point | Particle | str, *, axis: Any, cut: bool = False) -> Any:
        """Keep a point on a line of a body.

        Parameters
        ----------
        name : str
        first : Body or name
            What the line belongs to; it goes, as drawn, through the point.
        second : Point, Particle or name
            What slides.
        axis : array_like (2,) or (3,)
            The line's direction in the drawing.
        cut : bool
            True if this joint must close a loop; left out, that joint is chosen. In the plane a slot always closes one.

        Returns
        -------
        Slot, in space SpaceJoint

        Raises
        ------
        ValueError, TypeError
            As `revolute`; and for an axis of length zero, or if the line would belong to a particle.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("bead")
        >>> bead = m.particle("bead", 0.1, at=(0, 0))
        >>> m.slot("wire", m.ground, bead, axis=(1, -1)).displacement
        Measure('wire.displacement')
        """
        name = self._new_name(name, "joint")
        axis = self._direction(f"axis of {name!r}", axis)
        first, second = self._body("first", first), self._point("second", second)
        self._turning(name, "the line of", first)
        first, second = self._different(name, first.point(at=second.drawn), second)
        if self.dimension == 3:
            return self._fasten("slot", name, first, second, axis, cut=cut)
        checked_cut(name, cut)
        return self._add(Slot(name, first, second, axis=first.body.pose.local_direction(axis)))

    def rolling(self, name: str, first: Body | str, second: Side, *, radius: float | None = None, at: Any = None,
                normal: Any = None, axle: Any = None, semiaxes: Any = None) -> Any:
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
            raise WrongValue(f"axle and semiaxes of {name!r} are for mechanisms in space")
        name = self._new_name(name, "joint")
        at = (0.0, 0.0) if at is None else at
        radius = _check.number(f"radius of {name!r}", radius, above=0)
        if normal is None:
            normal = -self.gravity if self.gravity.any() else (0.0, 1.0)
        normal = self._direction(f"normal of {name!r}", normal)
        first, at, second = self._body("first", first), self._drawn("at", at), self._named("second", second)
        if isinstance(second, Body) and second.turns:
            second = self._body("second", second).point((0.0, 0.0))
        first, second = self._different(name, first.point(at=at), self._point("second", second))
        self._turning(name, "rolling", first.body, second.body)
        return self._add(Rolling(name, first, second, radius, first.body.pose.local_direction(normal)))

    def knife_edge(self, name: str, point: Side, *, along: Any, normal: Any = None) -> Any:
        """Let a point of a body move along one direction of the body only, as a skate does on ice.

        Parameters
        ----------
        name : str
        point : Point, Body or name
            Of a body without a point, its centre of mass.
        along : array_like (2,) or (3,)
            The direction in the drawing in which it glides; it turns with the body.
        normal : array_like (3,), optional
            In space: a direction in the drawing, made perpendicular to `along`; left out: against gravity, and where there is no
            gravity, z. The velocity of the point along ``cross(normal, along)`` is zero. This direction turns with the body: a
            body that leans takes it along. The joint does not keep the point on a plane.

        Returns
        -------
        KnifeEdge, in space SpaceJoint
            Its first body is the ground.

        Raises
        ------
        ValueError, TypeError
            As `revolute`; and for a direction of length zero, or a particle.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("sleigh")
        >>> sleigh = m.body("sleigh", 1.0, 0.1)
        >>> m.knife_edge("blade", sleigh.point((-0.5, 0)), along=(1, 0))
        <knife_edge blade: ground - sleigh>
        """
        if self.dimension == 3:
            return self._space_knife_edge(name, point, along, normal)
        if normal is not None:
            raise WrongValue(f"normal of {name!r} is for mechanisms in space")
        name = self._new_name(name, "joint")
        along = self._direction(f"along of {name!r}", along)
        point = self._point("point", point, center=True)
        self._turning(name, "knife edge", point.body)
        first, point = self._different(name, self.ground.point(at=point.drawn), point)
        return self._add(KnifeEdge(name, first, point, axis=point.body.pose.local_direction(along)))
