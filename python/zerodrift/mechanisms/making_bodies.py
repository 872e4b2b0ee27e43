"""The verbs of a mechanism that make bodies."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _check
from .bodies import Body, Link, Particle, Point
from .elements import Elements
from .plane import Pose


class BodyVerbs(Elements):
    """Bodies, links and particles."""

    def body(self, name: str, mass: float, inertia: float = 0.0, *, at: Any = (0.0, 0.0), angle: float = 0.0,
             com: Any = (0.0, 0.0)) -> Body:
        """Add a rigid body.

        Parameters
        ----------
        name : str
            Letters, digits, blanks, ``_`` and ``-``.
        mass : float
            In kg, at least 0.
        inertia : float
            About the centre of mass, in kg m^2, at least 0; `zerodrift.inertia` has it for plain shapes.
        at : array_like (2,), Point or name
            Where the origin of its frame is in the drawing, in m.
        angle : float
            Of its frame, from the drawing's x axis, counter-clockwise, in rad.
        com : array_like (2,)
            The centre of mass in its frame, in m.

        Returns
        -------
        Body

        Raises
        ------
        ValueError, TypeError
            If the name is taken, or a number is none that there can be.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("wheel", gravity=(0, -9.81))
        >>> m.body("wheel", *zd.inertia.disc(mass=2.0, radius=0.5), at=(0, 0.5))
        <body wheel>
        """
        name = self._new_name(name, "body")
        pose = Pose(self._drawn(f"at of {name!r}", at), _check.number(f"angle of {name!r}", angle))
        return self._add(Body(name, pose, _amount("mass", name, mass), _amount("inertia", name, inertia),
                              _check.vector(f"com of {name!r}", com, 2)))

    def link(self, name: str, start: Any, end: Any, mass: float = 0.0, *, length: float | None = None,
             inertia: float | None = None) -> Link:
        """Add a link, a uniform slender rod between two points of the drawing.

        Parameters
        ----------
        name : str
            Letters, digits, blanks, ``_`` and ``-``.
        start, end : array_like (2,), Point or name
            In the drawing, in m. Its frame begins at the start, and its x axis goes to the end.
        mass : float
            In kg, at least 0.
        length : float, optional
            In m, from the start; left out: as drawn. The drawing may be a sketch: lengths count.
        inertia : float, optional
            About the middle, in kg m^2; left out: that of a uniform rod.

        Returns
        -------
        Link

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a number is none that there can be, or start and end are the same point.

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
        if not np.hypot(*(end - start)) > 0:
            raise ValueError(f"start and end of {name!r} must be two places in the drawing, not both {tuple(map(float, start))}")
        if length is not None:
            length = _check.number(f"length of {name!r}", length, above=0)
        if inertia is not None:
            inertia = _amount("inertia", name, inertia)
        return self._add(Link(name, start, end, _amount("mass", name, mass), length, inertia))

    def particle(self, name: str, mass: float, at: Any) -> Particle:
        """Add a mass in a point.

        Parameters
        ----------
        name : str
            Letters, digits, blanks, ``_`` and ``-``.
        mass : float
            In kg, at least 0.
        at : array_like (2,), Point or name
            Where it is in the drawing, in m: then it is a part of its own. Or a point of a body: then its mass belongs to that
            body, and it has measures, but no joint.

        Returns
        -------
        Particle

        Raises
        ------
        ValueError, TypeError
            If the name is taken, or a number is none that there can be.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> m.particle("bob", 1.0, at=(0.6, -0.8))
        <particle bob>
        """
        name = self._new_name(name, "particle")
        mass, at = _amount("mass", name, mass), self._named(f"at of {name!r}", at)
        if isinstance(at, Point | Particle):
            carrier = self._point("at", at)
            return self._add(Particle(name, carrier.drawn, mass, carrier))
        return self._add(Particle(name, _check.vector(f"at of {name!r}", at, 2), mass))

    def point(self, name: str, body: Body | str, local: Any = None, *, at: Any = None) -> Point:
        """Add a named point to a body, as ``body.point(local, at=at, name=name)`` does.

        Parameters
        ----------
        name : str
            For its measures, ``"name.position"`` and ``"name.velocity"``.
        body : Body or name
        local : array_like (2,)
            Its coordinates in the body's frame, in m.
        at : array_like (2,), Point or name
            Instead: where it is in the drawing.

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
    return _check.number(f"{quantity} of {name!r}", value, least=0)
