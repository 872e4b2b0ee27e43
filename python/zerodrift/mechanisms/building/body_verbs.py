"""Methods of `Mechanism` that add bodies."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..._private import checks
from ..._private.types import ArrayLike
from ...errors import WrongValue
from ..elements.bodies import Body, Link, Particle, Point
from ..elements.frames import Pose, Pose3, given_rotation, perpendicular
from ..elements.immutable import Fixed
from ..elements.own_measures import Group
from ..elements.space_bodies import SpaceBody, SpaceLink, SpaceParticle, tensor
from .registry import Elements

PARALLEL = 1e-6     # sine of the angle below which directions are parallel


class BodyVerbs(Elements):
    """Bodies, links and particles."""

    def body(self, name: str, mass: float, inertia: ArrayLike = 0.0, *, at: ArrayLike | Point | None = None, angle: float = 0.0,
             rotation: ArrayLike | None = None, com: ArrayLike | None = None) -> SpaceBody:
        """Add a rigid body.

        Parameters
        ----------
        name : str
            Letters, digits, blanks, ``_`` and ``-``.
        mass : float
            In kg, at least 0.
        inertia : float, in space array_like (3, 3) or (3,)
            About the centre of mass, in kg m^2, at least 0; `zerodrift.inertia` has it for simple shapes. In space the tensor
            in the axes of its frame, or its diagonal; products of inertia with the minus sign of the matrix elements, which
            tables of products often omit.
        at : array_like (2,) or (3,), Point or name
            Position of the origin of its frame in the drawing, in m; left out: the drawing's origin.
        angle : float
            Angle of its frame from the drawing's x axis, counter-clockwise, in rad; in the plane.
        rotation : array_like (3, 3) or (4,)
            In space, its orientation: a matrix whose columns are the body's axes in the drawing, or a unit quaternion (w,
            x, y, z).
        com : array_like (2,) or (3,)
            The centre of mass in its frame, in m; left out: its origin.

        Returns
        -------
        Body

        Raises
        ------
        ValueError, TypeError
            If the name is taken, or a number is out of range.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("wheel", gravity=(0, -9.81))
        >>> m.body("wheel", *zd.inertia.disc(mass=2.0, radius=0.5), at=(0, 0.5))
        <body wheel>
        """
        name = self._new_name(name, "body")
        at = np.zeros(self.dimension) if at is None else self._drawn(f"at of {name!r}", at)
        com = np.zeros(self.dimension) if com is None else checks.vector(f"com of {name!r}", com, self.dimension)
        mass = _amount("mass", name, mass)
        if self.dimension == 3:
            if angle:
                raise WrongValue(f"angle of {name!r} is for the plane: in space take rotation=", "wrong-dimension")
            turned = Pose3(at, given_rotation(f"rotation of {name!r}", rotation))
            return self._add(SpaceBody(name, turned, mass, tensor(f"inertia of {name!r}", inertia, mass), com))
        if rotation is not None:
            raise WrongValue(f"rotation of {name!r} is for mechanisms in space: in the plane take angle=", "wrong-dimension")
        pose = Pose(at, checks.number(f"angle of {name!r}", angle))
        return self._add(Body(name, pose, mass, _amount("inertia", name, inertia), com))

    def link(self, name: str, start: ArrayLike | Point, end: ArrayLike | Point, mass: float = 0.0, *, length: float | None = None,
             inertia: ArrayLike | None = None, thickness: float | None = None, normal: ArrayLike | None = None) -> SpaceLink:
        """Add a link, a uniform slender rod between two points of the drawing; in space a round bar.

        Parameters
        ----------
        name : str
            Letters, digits, blanks, ``_`` and ``-``.
        start, end : array_like (2,) or (3,), Point or name
            In the drawing, in m. The origin of its frame is the start, and its x axis points to the end. In space its z
            axis is the part of the drawing's z perpendicular to x, or of the drawing's y where z and x are parallel.
        mass : float
            In kg, at least 0.
        length : float, optional
            In m, from the start; left out: as drawn. A given length overrides the drawing.
        inertia : float, in space array_like (3, 3) or (3,), optional
            About the middle, in kg m^2; left out: that of a uniform rod.
        thickness : float, optional
            In space, the diameter of the bar in m; left out: a twentieth of its length.
        normal : array_like (3,), optional
            In space: direction in the drawing whose perpendicular part is the z axis.

        Returns
        -------
        Link

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a number is out of range, or start and end are the same point.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> link = m.link("link", (0, 0), (0.3, -0.4), mass=2.0)
        >>> link.length
        0.5
        """
        name = self._new_name(name, "link")
        start, end = self._drawn(f"start of {name!r}", start), self._drawn(f"end of {name!r}", end)
        if not np.linalg.norm(end - start) > 0:
            raise WrongValue(f"start and end of {name!r} must be two places in the drawing, not both {tuple(map(float, start))}",
                             "geometry")
        if length is not None:
            length = checks.number(f"length of {name!r}", length, above=0)
        made = self._made_link(name, start, end, _amount("mass", name, mass), length, inertia, thickness, normal)
        made.has_given_length = length is not None
        return self._add(made)

    def _made_link(self, name: str, start: np.ndarray, end: np.ndarray, mass: float, length: float | None, inertia: Any,
                   thickness: float | None, normal: Any) -> Link:
        if self.dimension == 3:
            return self._space_link(name, start, end, mass, length, inertia, thickness, normal)
        if thickness is not None or normal is not None:
            raise WrongValue(f"thickness and normal of {name!r} are for mechanisms in space", "wrong-dimension")
        if inertia is not None:
            inertia = _amount("inertia", name, inertia)
        return Link(name, start, end, mass, length, inertia)

    def _space_link(self, name: str, start: np.ndarray, end: np.ndarray, mass: float, length: float | None, inertia: Any,
                    thickness: float | None, normal: Any) -> Link:
        along = (end - start) / np.linalg.norm(end - start)
        wished = np.array([0.0, 0.0, 1.0]) if normal is None else self._direction(f"normal of {name!r}", normal)
        if np.linalg.norm(np.cross(wished, along)) < PARALLEL:
            if normal is not None:
                raise WrongValue(f"normal of {name!r} must not be parallel to the link", "geometry")
            wished = np.array([0.0, 1.0, 0.0])
        z = perpendicular(along, wished)
        rotation = np.stack([along, np.cross(z, along), z], axis=1)
        if thickness is not None:
            thickness = checks.number(f"thickness of {name!r}", thickness, above=0)
        inertia = None if inertia is None else tensor(f"inertia of {name!r}", inertia, mass)
        length = float(np.linalg.norm(end - start)) if length is None else length
        return SpaceLink(name, start, end, mass, length, rotation, thickness, inertia)

    def particle(self, name: str, mass: float, at: ArrayLike | Point) -> Particle:
        """Add a point mass.

        Parameters
        ----------
        name : str
            Letters, digits, blanks, ``_`` and ``-``.
        mass : float
            In kg, at least 0.
        at : array_like (2,) or (3,), Point or name
            Position in the drawing, in m, of a separate particle; or a point of a body, to which the mass is then added: the
            particle has measures, but no joint.

        Returns
        -------
        Particle

        Raises
        ------
        ValueError, TypeError
            If the name is taken, or a number is out of range.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> m.particle("bob", 1.0, at=(0.6, -0.8))
        <particle bob>
        """
        name = self._new_name(name, "particle")
        mass, at = _amount("mass", name, mass), self._named(f"at of {name!r}", at)
        made = SpaceParticle if self.dimension == 3 else Particle
        if isinstance(at, Fixed):
            attachment = self._point("at", at)
            return self._add(made(name, attachment.drawn, mass, attachment))
        return self._add(made(name, checks.vector(f"at of {name!r}", at, self.dimension), mass))

    def draw(self, body: Body | str, shape: float | ArrayLike) -> None:
        """Give a body a shape in pictures, films and live pages, in place of lines between its joints. The motion does not
        depend on it.

        Parameters
        ----------
        body : Body or name
            A body or link.
        shape : float or array_like (n, dimension)
            In the body's frame, in m. In the plane the radius of a disc about its origin, or at least three corners. In space
            two opposite corners of a box along its axes, or at least three corners of a plate.

        Raises
        ------
        ValueError, TypeError
            If the body is the ground or a particle, or the shape has too few corners.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("cart")
        >>> cart = m.body("cart", 2.0, 0.1)
        >>> m.draw(cart, [(-0.5, 0), (0.5, 0), (0.4, 0.3), (-0.4, 0.3)])
        """
        body = self._body("body", body)
        if body is self.ground or not body.turns:
            raise WrongValue(f"body must turn to have a shape, and {body.name!r} does not", "wrong-element")
        what = f"shape of {body.name!r}"
        if np.ndim(shape) == 0 and self.dimension == 2:
            self._shapes[body.name] = checks.number(what, shape, above=0)
            return
        given = checks.instance(what, shape, Iterable, "a list of corners, or in the plane a radius")
        corners = np.array([checks.vector(f"each corner of the {what}", each, self.dimension) for each in given])
        if len(corners) < 5 - self.dimension:
            raise WrongValue(f"{what} must have at least {5 - self.dimension} corners, not {len(corners)}", "shape")
        self._shapes[body.name] = corners

    def group(self, name: str, bodies: Iterable[Body | str]) -> Group:
        """Measure bodies as a group.

        Parameters
        ----------
        name : str
            For the measures ``"name.center.position"``, ``"name.center.velocity"``, ``"name.momentum"`` and
            ``"name.angular_momentum"``, which is about the drawing's origin.
        bodies : iterable of Body or name

        Returns
        -------
        Group

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a body does not belong to the mechanism, or the bodies have no mass.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("throw", gravity=(0, -9.81))
        >>> stones = [m.particle(f"stone{i}", 1.0 + i, at=(i, 0)) for i in range(2)]
        >>> both = m.group("both", stones)
        >>> zd.simulate(m, 1.0)[both.center.position][-1].round(9).tolist()
        [0.666666667, -4.905]
        """
        name = self._new_name(name, "group")
        given = [bodies] if isinstance(bodies, Body | str) else checks.instance("bodies", bodies, Iterable, "bodies or names")
        found = tuple(dict.fromkeys(self._body(f"bodies of {name!r}", each) for each in given))
        if self.ground in found or not sum(body.mass for body in found):
            raise WrongValue(f"bodies of group {name!r} must have mass, and be others than the ground", "wrong-element")
        return self._add(Group(name, found))

    def point(self, name: str, body: Body | str, local: ArrayLike | None = None, *, at: ArrayLike | Point | None = None) -> Point:
        """Add a named point to a body, as ``body.point(local, at=at, name=name)`` does.

        Parameters
        ----------
        name : str
            For its measures, ``"name.position"`` and ``"name.velocity"``.
        body : Body or name
        local : array_like (2,) or (3,)
            Its coordinates in the body's frame, in m.
        at : array_like (2,) or (3,), Point or name
            Its position in the drawing, instead of `local`.

        Returns
        -------
        Point

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum")
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> m.point("P", link, (0.5, 0)).position
        VectorMeasure('P.position')
        """
        at = None if at is None else self._drawn("at", at)
        return self._body("body", body).point(local, at=at, name=self._new_name(name, "point"))


def _amount(quantity: str, name: str, value: Any) -> float:
    checks.constant(f"{quantity} of {name!r}", value,
                    "matter that leaves or joins carries momentum. Give the initial mass m0, and in each direction force() whose "
                    "value is (m0 - mass(t)) * a, with a the body's acceleration, and thrust and weight by others")
    return checks.number(f"{quantity} of {name!r}", value, least=0)
