"""Bodies, links, particles and their points, as defined; `Numbers` holds the values that were changed since."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..._private import checks
from ..._private.types import ArrayLike
from ...errors import WrongAttribute, WrongType
from . import columns
from .frames import Pose, Shapes, place
from .immutable import Fixed
from .measures import Measure, scalar, vector
from .numbers import AS_GIVEN, Numbers


class MassProperties(NamedTuple):
    """Mass in kg, moment of inertia about the mass centre in kg m^2, in space (3, 3), and that centre in its frame in m."""

    mass: float
    inertia: Any
    com: np.ndarray


class Point(Fixed):
    """A point that moves with a body; `Body.point` makes it, and a link has a `start` and an `end`.

    Attributes
    ----------
    body : Body
        The body that it belongs to.
    name : str or None
        First part of the names of its measures; a point without a name has none.
    """

    def __init__(self, body: Body, local: np.ndarray, name: str | None = None) -> None:
        self.body, self.name, self._local = body, name, local

    position = vector("position", "Position of the point, in the drawing's axes, in m.")
    velocity = vector("velocity", "Its velocity, in the drawing's axes, in m/s.")
    acceleration = vector("acceleration", "Its acceleration, in the drawing's axes, in m/s^2.")

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self.body.dimension

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        if self.name is None:
            raise WrongAttribute(f"{self!r} has no name, and so no measures: give it one, {self.body.name}.point(..., name=...)")
        return self.name

    @property
    def local(self) -> np.ndarray:
        """Its coordinates in the body's frame, (2,) in m."""
        return self.local_with(AS_GIVEN)

    @property
    def drawn(self) -> np.ndarray:
        """Position in the drawing, (2,) or (3,) in m."""
        return self.drawn_with(AS_GIVEN)

    def local_with(self, numbers: Numbers) -> np.ndarray:
        """Coordinates in the body's frame, (2,) in m, with parameters that may have been changed."""
        return numbers.vector(self.name, "local", self._local)

    def drawn_with(self, numbers: Numbers) -> np.ndarray:
        """Position in the drawing, (2,) or (3,) in m, with parameters that may have been changed."""
        return self.body.pose.point(self.local_with(numbers))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "x" of ``P.x``; none without a name."""
        return {f"local.{axis}": float(value) for axis, value in zip("xyz", self.local_with(now), strict=False)}

    def __repr__(self) -> str:
        return f"<point {self.name or tuple(map(float, self.local))} of {self.body.name}>"


class Body(Fixed, Shapes):
    """A rigid body; `Mechanism.body` makes it.

    Attributes
    ----------
    name : str
    mass : float
        In kg.
    inertia : float
        About the centre of mass, in kg m^2.
    """

    what = "body"
    turns = True        # False for a particle, which has no orientation

    pose: Pose           # in space a Pose3

    def __init__(self, name: str, pose: Any, mass: float, inertia: Any, com: np.ndarray) -> None:
        self.name, self.pose, self.mass, self.inertia, self._com = name, pose, mass, inertia, com
        self._register: Callable[[Point], Point] = _as_it_is       # replaced by the mechanism's own

    position = vector("position", "Position of the origin of its frame, in the drawing's axes, in m.")
    velocity = vector("velocity", "The velocity of that origin, in the drawing's axes, in m/s.")
    angle = scalar("angle", "Its orientation from the drawing's x axis, counter-clockwise, in rad; it counts turns.")
    acceleration = vector("acceleration", "The acceleration of that origin, in the drawing's axes, in m/s^2.")
    angular_velocity = scalar("angular_velocity", "Its angular velocity in rad/s.")
    angular_acceleration = scalar("angular_acceleration", "Its angular acceleration in rad/s^2.")

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return len(self.pose.origin)

    @property
    def center(self) -> Point:
        """Centre of mass as a point, measured as ``body.center.position``; particles attached to the body do not move it."""
        return _Center(self, self._com, f"{self.name}.center")

    def point(self, local: ArrayLike | None = None, *, at: ArrayLike | Point | None = None, name: str | None = None) -> Point:
        """A point of the body.

        Parameters
        ----------
        local : array_like (2,), in space (3,)
            Its coordinates in the body's frame, in m.
        at : array_like (2,) or (3,), or Point
            Its position in the drawing, instead of `local`.
        name : str, optional
            For its measures, ``"name.position"`` and ``"name.velocity"``.

        Returns
        -------
        Point

        Raises
        ------
        TypeError, ValueError
            If there are no coordinates, or the name is taken.
        """
        if (local is None) == (at is None):
            raise WrongType(f"a point of {self.name!r} must have coordinates in its frame, or at=, its position as drawn",
                            "conflicting-arguments")
        size = self.dimension
        local = checks.vector("local", local, size) if at is None else self.pose.local(place("at", at, size))
        return self._register(Point(self, local, name))

    def properties(self, numbers: Numbers) -> MassProperties:
        """Mass, inertia and centre of mass, with parameters that may have been changed."""
        return MassProperties(numbers(self, "mass", self.mass), numbers(self, "inertia", self.inertia),
                              numbers.vector(self.name, "com", self._com))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        mass, inertia, com = self.properties(now)
        return {"mass": mass, "inertia": inertia, "com.x": float(com[0]), "com.y": float(com[1])}

    def __repr__(self) -> str:
        return f"<{self.what} {self.name}>"

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_register": _as_it_is}     # a copy for a system leaves the mechanism behind


class Ground(Body):
    """The ground: it does not move; its frame is the drawing's."""

    what = "ground"
    force = vector("force", "Sum of the forces on the ground, in the drawing's axes, in N.")
    torque = vector("torque", "Their moment about the drawing's origin, in N m; in space a vector in its axes.", Measure)

    def __init__(self) -> None:
        super().__init__("ground", Pose(np.zeros(2), 0.0), 0.0, 0.0, np.zeros(2))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """No parameters: the ground has no mass."""
        return {}


class Link(Body):
    """A body between two points, `start` and `end`; `Mechanism.link` makes it.

    The origin of its frame is the start: `position`, `velocity` and `acceleration` are those of the start. Its middle
    is ``link.center.position``.

    Attributes
    ----------
    start, end : Point
    length : float
        Between them, in m.
    """

    what = "link"
    has_given_length = False        # True: the drawing is a sketch
    _inertia: Any                   # as given, or None
    position = vector("position", "Position of its start, in the drawing's axes, in m; its middle is ``link.center.position``.")
    velocity = vector("velocity", "The velocity of its start, in the drawing's axes, in m/s.")
    acceleration = vector("acceleration", "The acceleration of its start, in the drawing's axes, in m/s^2.")

    def __init__(self, name: str, start: np.ndarray, end: np.ndarray, mass: float, length: float | None,
                 inertia: float | None) -> None:
        drawn = end - start
        self.length = float(np.hypot(*drawn)) if length is None else length
        self.drawn_end, self._inertia = end, inertia
        moment = mass * self.length**2 / 12 if inertia is None else inertia
        super().__init__(name, Pose(start, float(np.arctan2(drawn[1], drawn[0]))), mass, moment, np.array([self.length / 2, 0.0]))
        self.start, self.end = Point(self, np.zeros(2), f"{name}.start"), _End(self, np.zeros(2), f"{name}.end")

    def length_with(self, numbers: Numbers) -> float:
        """Length in m, with parameters that may have been changed."""
        return numbers(self, "length", self.length)

    def properties(self, numbers: Numbers) -> MassProperties:
        """As of any body; centre and inertia follow from mass and length, unless they were given."""
        mass, length = numbers(self, "mass", self.mass), self.length_with(numbers)
        inertia = mass * length**2 / 12 if self._inertia is None else self._inertia
        return MassProperties(mass, numbers(self, "inertia", inertia), np.array([length / 2, 0.0]))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        mass, inertia, _ = self.properties(now)
        return {"mass": mass, "length": self.length_with(now), "inertia": inertia}


class _End(Point):
    """End of a link, at the link's length from its start; with the given length its drawn position is exact."""

    body: Link

    def local_with(self, numbers: Numbers) -> np.ndarray:
        return np.array([self.body.length_with(numbers), 0.0])

    def drawn_with(self, numbers: Numbers) -> np.ndarray:
        changed = self.body.length_with(numbers) != self.body.length
        return columns.chosen(changed, self.body.pose.point(self.local_with(numbers)), self.body.drawn_end)


class _Center(Point):
    """Centre of mass, which depends on mass distribution and length."""

    def local_with(self, numbers: Numbers) -> np.ndarray:
        return self.body.properties(numbers).com


class Particle(Body):
    """A point mass, without orientation; `Mechanism.particle` makes it.

    Attributes
    ----------
    attachment : Point or None
        The point of a body to which it is attached; None for a particle with its own coordinates.
    """

    what = "particle"
    turns = False

    def __init__(self, name: str, at: np.ndarray, mass: float, attachment: Point | None = None) -> None:
        super().__init__(name, Pose(at, 0.0), mass, 0.0, np.zeros(2))
        self.attachment = attachment

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        return {"mass": self.properties(now).mass}

    @property
    def angle(self) -> Any:     # type: ignore[override]
        """Not defined: a particle has no orientation."""
        raise WrongAttribute(f"particle {self.name!r} has no orientation: no angle, no angular velocity")

    angular_velocity = angular_acceleration = angle

    @property
    def center(self) -> Point:
        """The particle as a point."""
        return Point(self, np.zeros(2), self.name)


def _as_it_is(point: Point) -> Point:
    return point


def kind_of(element: Any) -> str:
    """Kind of a body, a point or an element between them, as files have it."""
    if isinstance(element, Body):
        return element.what
    return "point" if isinstance(element, Point) else element.kind
