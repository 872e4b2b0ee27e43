"""Vectors, poses and rotations in the plane and in space, and shapes of bodies that others may touch."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..._private import checks
from ..._private.rotations import quaternion_of, rotation_of, turn
from ...errors import WrongValue


def turned(angle: float | np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Vector (2,), rotated counter-clockwise by an angle in rad."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def turned_back(angle: float, vector: np.ndarray) -> np.ndarray:
    """Vector (2,), rotated clockwise by an angle in rad."""
    return turned(-angle, vector)


class Pose(NamedTuple):
    """Pose of a frame in the plane: origin (2,) in m, and angle of its x axis from the drawing's, in rad."""

    origin: np.ndarray
    angle: float

    def point(self, local: np.ndarray) -> np.ndarray:
        """Position (2,) in the drawing of a point of the frame, in m."""
        return self.origin + turned(self.angle, local)

    def local(self, drawn: np.ndarray) -> np.ndarray:
        """Coordinates (2,) in the frame of a point of the drawing."""
        return turned_back(self.angle, drawn - self.origin)

    def direction(self, local: np.ndarray) -> np.ndarray:
        """Direction (2,) in the drawing, from one in the frame."""
        return turned(self.angle, local)

    def local_direction(self, drawn: np.ndarray) -> np.ndarray:
        """Direction (2,) in the frame, from one in the drawing."""
        return turned_back(self.angle, drawn)


ROTATION = 1e-6         # deviation of a given matrix from a rotation, and of a quaternion's length from 1, at most


class Pose3(NamedTuple):
    """Pose of a frame in space: origin (3,) in m, and its axes in the drawing, the columns of `rotation` (3, 3)."""

    origin: np.ndarray
    rotation: np.ndarray

    def point(self, local: np.ndarray) -> np.ndarray:
        """Position (3,) in the drawing of a point of the frame, in m."""
        return self.origin + self.rotation @ local

    def local(self, drawn: np.ndarray) -> np.ndarray:
        """Coordinates (3,) in the frame of a point of the drawing."""
        return self.rotation.T @ (drawn - self.origin)

    def direction(self, local: np.ndarray) -> np.ndarray:
        """Direction (3,) in the drawing, from one in the frame."""
        return self.rotation @ local

    def local_direction(self, drawn: np.ndarray) -> np.ndarray:
        """Direction (3,) in the frame, from one in the drawing."""
        return self.rotation.T @ drawn


def given_rotation(argument: str, value: Any) -> np.ndarray:
    """Rotation (3, 3) from a matrix whose columns are the axes in the drawing, or from a unit quaternion (w, x, y, z)."""
    if value is None:
        return np.eye(3)
    if np.shape(value) == (4,):
        q = checks.vector(argument, value, 4)
        length = float(np.sqrt(q @ q))
        if abs(length - 1) > ROTATION:
            raise WrongValue(f"{argument} must be a quaternion of length 1, and {tuple(map(float, q))} has length {length:g}",
                             "geometry")
        return rotation_of(q / length)
    if np.shape(value) != (3, 3):
        raise WrongValue(f"{argument} must be a (3, 3) matrix or a quaternion (w, x, y, z), not {checks.shown(value)}", "shape")
    R = checks.vector(argument, np.ravel(value), 9).reshape(3, 3)
    if np.abs(R.T @ R - np.eye(3)).max() > ROTATION or np.linalg.det(R) < 0:
        raise WrongValue(f"{argument} must be a rotation, its columns right-handed, perpendicular and of length 1", "geometry")
    return rotation_of(quaternion_of(R))        # orthogonal to rounding


def about(axis: Any, angle: float) -> np.ndarray:
    """Rotation (3, 3) about an axis (3,) by an angle in rad, right-handed."""
    axis = np.asarray(axis, dtype=float)
    return rotation_of(turn(axis / np.linalg.norm(axis) * angle))


def perpendicular(axis: np.ndarray, wished: np.ndarray | None = None) -> np.ndarray:
    """Unit vector (3,) perpendicular to an axis, from the wished one or from the drawing's axis farthest from it."""
    if wished is None:
        wished = np.eye(3)[int(np.argmin(np.abs(axis)))]
    left = wished - (wished @ axis) * axis
    left = left - (left @ axis) * axis
    return left / np.sqrt(left @ left)


def triple(vector: Any) -> tuple[float, float, float]:
    """Vector as three floats, for the core's tables."""
    x, y, z = vector
    return float(x), float(y), float(z)


# ---- shapes of bodies that others may touch ----


class Line(NamedTuple):
    """Straight line of a body, free to the left of ``a -> b``; `Body.line` and `Body.segment` make it."""

    body: Any
    start: np.ndarray       # (2,) in the body's frame, m
    direction: np.ndarray   # (2,) of length one
    length: float = np.inf  # m: of a segment, which is free on both sides


class Circle(NamedTuple):
    """Circle of a body, or an arc of it; `Body.circle` and `Body.arc` make it."""

    body: Any
    start: np.ndarray       # (2,) its centre in the body's frame, m
    radius: float           # m
    outside: bool           # True: what touches it is outside
    direction: np.ndarray   # (2,) of length one, from the centre to the middle of an arc
    half_angle: float = np.pi       # rad: of an arc, from its middle to either end


class Plane(NamedTuple):
    """Plane of a body in space, free on the side of its normal; `Body.plane` makes it."""

    body: Any
    start: np.ndarray       # (3,) a point of it in the body's frame, m
    direction: np.ndarray   # (3,) its normal, of length one


class Sphere(NamedTuple):
    """Sphere of a body in space; `Body.sphere` makes it."""

    body: Any
    start: np.ndarray       # (3,) its centre in the body's frame, m
    radius: float           # m
    outside: bool           # True: what touches it is outside


class Shapes:
    """Methods of a body that make its shapes."""

    pose: Pose

    def _in(self, dimension: int, shape: str) -> None:
        """Check that the mechanism of the body has this dimension."""
        if len(self.pose.origin) != dimension:
            own, where, verbs = (("in the plane", "in space", "plane() or sphere()") if dimension == 2 else
                                 ("in space", "in the plane", "line(), segment(), circle() or arc()"))
            raise WrongValue(f"a shape {where} must be {verbs} of the body, not a {shape}, which is {own}", "wrong-dimension")

    def line(self, start: Any, end: Any) -> Line:
        """The unbounded line through two places of the drawing, that moves with the body, for `Mechanism.contact`.

        Parameters
        ----------
        start, end : array_like (2,) or Point
            In m; what touches the line is on the left of ``start -> end``.

        Returns
        -------
        Line

        Raises
        ------
        ValueError
            If both are the same place.
        """
        self._in(2, "line")
        start, end = place("start", start, 2), place("end", end, 2)
        length = np.hypot(*(end - start))
        if not length > 0:
            raise WrongValue("start and end of a line must be two places, not the same one", "geometry")
        return Line(self, self.pose.local(start), self.pose.local_direction((end - start) / length))

    def segment(self, start: Any, end: Any) -> Line:
        """The line from one place of the drawing to another, that moves with the body, for `Mechanism.contact`.

        It has two sides and two ends: a round body rolls over them, a point passes beside them.

        Parameters
        ----------
        start, end : array_like (2,) or Point
            In m.

        Returns
        -------
        Line

        Raises
        ------
        ValueError
            If both are the same place.
        """
        line = self.line(start, end)
        return line._replace(length=float(np.hypot(*(place("end", end, 2) - place("start", start, 2)))))

    def circle(self, center: Any, radius: float, *, outside: bool = True) -> Circle:
        """A circle that moves with the body, for `Mechanism.contact`.

        Parameters
        ----------
        center : array_like (2,) or Point
            In the drawing, in m.
        radius : float
            In m; 0: a point.
        outside : bool
            True: bodies touch it from outside, as a disc; False: from inside, as a hole.

        Returns
        -------
        Circle

        Raises
        ------
        ValueError
            For a radius below zero.
        """
        return Circle(*self._round("circle", 2, center, radius, outside), np.array([1.0, 0.0]))

    def arc(self, center: Any, start: Any, end: Any, *, outside: bool = True) -> Circle:
        """An arc that moves with the body, counter-clockwise from one place of the drawing to another, for `Mechanism.contact`.

        It has one side; a round body rolls over its ends, a point passes beside them.

        Parameters
        ----------
        center, start, end : array_like (2,) or Point
            In m; the radius is the distance of `start` from the centre, and `end` lies in the direction of its other end.
        outside : bool
            True: bodies touch it from outside, as a cam; False: from inside, as a bowl.

        Returns
        -------
        Circle

        Raises
        ------
        ValueError
            If a place is the centre, or both are in the same direction.
        """
        self._in(2, "circular arc")
        middle, *ends = (place(name, at, 2) for name, at in (("center", center), ("start", start), ("end", end)))
        (first, last) = (complex(*(each - middle)) for each in ends)
        if not first or not last or not (angle := float(np.angle(last / first)) % (2 * np.pi)):
            raise WrongValue("start and end of an arc must be in two directions from its centre", "geometry")
        towards = first / abs(first) * np.exp(0.5j * angle)
        return Circle(self, self.pose.local(middle), abs(first), bool(outside),
                      self.pose.local_direction(np.array([towards.real, towards.imag])), angle / 2)


    def plane(self, point: Any, normal: Any) -> Plane:
        """A plane in space that moves with the body, for `Mechanism.contact`.

        Parameters
        ----------
        point : array_like (3,) or Point
            A point of it in the drawing, in m.
        normal : array_like (3,)
            Its normal in the drawing, towards what touches it.

        Returns
        -------
        Plane

        Raises
        ------
        ValueError
            For a normal of length zero.
        """
        self._in(3, "plane")
        normal = checks.vector("normal", normal, 3)
        length = float(np.linalg.norm(normal))
        if not length > 0:
            raise WrongValue("normal of a plane must not be zero", "geometry")
        return Plane(self, self.pose.local(place("point", point, 3)), self.pose.local_direction(normal / length))

    def sphere(self, center: Any, radius: float, *, outside: bool = True) -> Sphere:
        """A sphere in space that moves with the body, for `Mechanism.contact`.

        Parameters
        ----------
        center : array_like (3,) or Point
            In the drawing, in m.
        radius : float
            In m; 0: a point.
        outside : bool
            True: bodies touch it from outside, as a ball; False: from inside, as a bowl.

        Returns
        -------
        Sphere

        Raises
        ------
        ValueError
            For a radius below zero.
        """
        return Sphere(*self._round("sphere", 3, center, radius, outside))

    def _round(self, shape: str, dimension: int, center: Any, radius: Any, outside: Any) -> tuple[Any, np.ndarray, float, bool]:
        """Body, centre in its frame, radius and side of a circle or a sphere, checked."""
        self._in(dimension, shape)
        return (self, self.pose.local(place("center", center, dimension)), checks.number(f"radius of a {shape}", radius, least=0),
                checks.instance(f"outside of a {shape}", outside, bool, "True or False"))


def place(argument: str, value: Any, dimension: int = 2) -> np.ndarray:
    """Position in the drawing, (dimension,): coordinates, or the drawn position of a point."""
    return value.drawn if hasattr(value, "drawn") else checks.vector(argument, value, dimension)
