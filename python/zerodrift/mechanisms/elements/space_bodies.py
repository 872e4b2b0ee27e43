"""Bodies of mechanisms in space, as defined."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..._private import checks
from ..._private.rotations import AXES, COMPONENTS, is_order
from ...errors import WrongAttribute, WrongValue
from .bodies import Body, Ground, Link, MassProperties, Particle, Point, _End
from .drawing import Drawing, inertias_of_bodies
from .frames import Pose3
from .measures import Measure, component, vector
from .numbers import AS_GIVEN, Numbers

SLENDER = 1 / 20        # of its length: default diameter of a link
ROUNDING_OF_PRODUCTS = 4 * np.finfo(float).eps     # of the trace of an inertia: products that count as zero
TRIANGLE = 1e-9         # of the largest moment: its excess over the sum of the two others, at most
SYMMETRIC = 1e-9        # of the largest entry: asymmetry, at most
PATHS = tuple(f"{AXES[i]}{AXES[j]}" for i in range(3) for j in range(i, 3))


def tensor(argument: str, value: Any, mass: float) -> np.ndarray:
    """Inertia tensor (3, 3) from a tensor or its diagonal, checked; off-diagonal entries are minus the products of inertia."""
    shape = np.shape(value)
    if shape == () and checks.number(argument, value) == 0:
        return np.zeros((3, 3))
    if shape not in ((3,), (3, 3)):
        raise WrongValue(f"{argument} must be a tensor (3, 3) or its diagonal (3,), in kg m^2, not {checks.shown(value)}",
                         "inertia")
    entries = checks.vector(argument, np.ravel(value), 3 if shape == (3,) else 9)
    J = np.diag(entries) if shape == (3,) else entries.reshape(3, 3)
    check_tensor(argument, J, mass)
    return (J + J.T) / 2


def check_tensor(argument: str, J: np.ndarray, mass: float) -> None:
    """Check that a tensor is the inertia of a body, or without mass that of a rotor, about one axis alone."""
    apart = np.abs(J - J.T)
    if apart.max() > SYMMETRIC * np.abs(J).max():
        i, j = np.unravel_index(int(np.argmax(apart)), (3, 3))
        raise WrongValue(f"{argument} must be symmetric, and [{i}, {j}] is {J[i, j]:g} where [{j}, {i}] is {J[j, i]:g}",
                         "inertia")
    a, b, c = np.linalg.eigvalsh((J + J.T) / 2)
    if a < -TRIANGLE * abs(c):
        raise WrongValue(f"{argument} must have no negative moment, and about one of its axes it has {a:g} kg m^2", "inertia")
    if c - a - b > TRIANGLE * c and (mass or b > TRIANGLE * c):
        raise WrongValue(f"{argument} must be that of a body: its largest moment, {c:g} kg m^2, is more than the sum of the two "
                         f"others, {a:g} and {b:g}; {_remedy(J)}", "inertia")


def _remedy(J: np.ndarray) -> str:
    """Advice for a tensor whose moments are not those of a body."""
    a, b, c = np.linalg.eigvalsh(2 * np.diag(np.diag(J)) - J)
    if a >= 0 and c <= a + b:
        return "with the opposite signs of its products of inertia it is, and tables often give these"
    return "it must be about the centre of mass, with the products of inertia negative, as they are in the matrix"


class RotationMeasure(Measure):
    """Orientation of a body: (k, 3, 3), the columns are its axes in the drawing; `zy` is the z component of its y axis."""

    __slots__ = ()

    xx, xy, xz, yx, yy, yz, zx, zy, zz = (component(each) for each in COMPONENTS[9])

    def euler(self, order: str) -> Measure:
        """Orientation as angles (k, 3) in rad, by rotations about the body's own axes in this order, such as "zyx" or "zxz"."""
        if not is_order(order):
            raise WrongValue(f"order must name three axes, such as 'zyx' or 'zxz', no two neighbours alike, not {order!r}",
                             "unknown-choice")
        return Measure(f"{self.name.removesuffix('.rotation')}.euler.{order}")


class SpaceBody(Body):
    """A rigid body in space; `Mechanism.body` makes it.

    Attributes
    ----------
    name : str
    mass : float
        In kg.
    inertia : ndarray (3, 3)
        About the centre of mass in the axes of its frame, in kg m^2.
    """

    angular_velocity = vector("angular_velocity", "Its angular velocity in the drawing's axes, in rad/s.")
    angular_acceleration = vector("angular_acceleration", "The rate of `angular_velocity`, in rad/s^2.")

    @property
    def rotation(self) -> RotationMeasure:
        """Its orientation, (k, 3, 3), the columns are its axes in the drawing; ``.euler("zyx")`` is the same as angles."""
        return RotationMeasure(f"{self.measured_name}.rotation")

    @property
    def quaternion(self) -> Measure:
        """Its orientation as unit quaternions (w, x, y, z), (k, 4), which change their sign nowhere."""
        return Measure(f"{self.measured_name}.quaternion")

    @property
    def angle(self) -> Any:     # type: ignore[override]
        """Not defined: a body in space has a rotation."""
        raise WrongAttribute(f"{self.name!r} is a body in space, which has a rotation and no angle")

    def properties(self, numbers: Numbers) -> MassProperties:
        """Mass, inertia tensor and centre of mass, with parameters that may have been changed."""
        return MassProperties(numbers(self, "mass", self.mass), self.tensor_with(numbers, self.inertia),
                              numbers.vector(self.name, "com", self._com))

    def tensor_with(self, numbers: Numbers, given: np.ndarray) -> np.ndarray:
        """Tensor (3, 3), each of whose entries has a path, ``"body.inertia.xx"``."""
        if not numbers.changed:
            return given
        changed = given.copy()
        for path in PATHS:
            i, j = AXES.index(path[0]), AXES.index(path[1])
            changed[i, j] = changed[j, i] = numbers(self, f"inertia.{path}", given[i, j])
        if not np.array_equal(changed, given):
            check_tensor(f"inertia of {self.name!r}", changed, self.mass)
        return changed

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        mass, J, com = self.properties(now)
        entries = {f"inertia.{path}": float(J[AXES.index(path[0]), AXES.index(path[1])]) for path in PATHS}
        return {"mass": mass, **entries, **{f"com.{axis}": float(com[i]) for i, axis in enumerate(AXES)}}


class SpaceGround(Ground):
    """The ground: it does not move; its frame is the drawing's."""

    def __init__(self) -> None:
        Body.__init__(self, "ground", Pose3(np.zeros(3), np.eye(3)), 0.0, 0.0, np.zeros(3))


class SpaceLink(SpaceBody, Link):
    """A body between two points, `start` and `end`; `Mechanism.link` makes it.

    Its frame begins at the start, and its x axis goes to the end. It is a round bar, unless its inertia is given.

    Attributes
    ----------
    start, end : Point
    length, thickness : float
        In m.
    """

    what = "link"
    position, velocity, acceleration = Link.position, Link.velocity, Link.acceleration      # type: ignore[has-type]

    def __init__(self, name: str, start: np.ndarray, end: np.ndarray, mass: float, length: float, rotation: np.ndarray,
                 thickness: float | None, inertia: np.ndarray | None) -> None:
        self.length, self.drawn_end, self._inertia = length, end, inertia
        self.thickness = length * SLENDER if thickness is None else thickness
        self._is_given_thickness = thickness is not None
        moment = _bar(mass, length, self.thickness) if inertia is None else inertia
        Body.__init__(self, name, Pose3(start, rotation), mass, moment, np.array([length / 2, 0.0, 0.0]))
        self.start, self.end = Point(self, np.zeros(3), f"{name}.start"), _SpaceEnd(self, np.zeros(3), f"{name}.end")

    def thickness_with(self, numbers: Numbers) -> float:
        """Diameter, with parameters that may have been changed; by default proportional to the length."""
        given = self.thickness if self._is_given_thickness else self.length_with(numbers) * SLENDER
        return numbers(self, "thickness", given)

    def properties(self, numbers: Numbers) -> MassProperties:
        """As of any body; centre and inertia follow from mass, length and thickness, unless they were given."""
        mass, length = numbers(self, "mass", self.mass), self.length_with(numbers)
        J = _bar(mass, length, self.thickness_with(numbers)) if self._inertia is None else self._inertia
        return MassProperties(mass, self.tensor_with(numbers, J), np.array([length / 2, 0.0, 0.0]))

    def numbers(self, now: Numbers = AS_GIVEN) -> dict[str, float]:
        """Values of its parameters by the last word of their paths: "mass" of ``crank.mass``."""
        found = super().numbers(now)
        return {"mass": found["mass"], "length": self.length_with(now), "thickness": self.thickness_with(now),
                **{path: value for path, value in found.items() if path.startswith("inertia")}}


def _bar(mass: float, length: float, thickness: float) -> np.ndarray:
    """Inertia of a uniform round bar along x."""
    about, across = mass * thickness**2 / 8, mass * (length**2 / 12 + thickness**2 / 16)
    return np.diag([about, across, across])


class _SpaceEnd(_End):
    def local_with(self, numbers: Numbers) -> np.ndarray:
        return np.array([self.body.length_with(numbers), 0.0, 0.0])


class SpaceParticle(Particle):
    """A mass in a point, without orientation; `Mechanism.particle` makes it."""

    def __init__(self, name: str, at: np.ndarray, mass: float, attachment: Point | None = None) -> None:
        Body.__init__(self, name, Pose3(at, np.eye(3)), mass, 0.0, np.zeros(3))
        self.attachment = attachment

    @property
    def center(self) -> Point:
        """The particle as a point."""
        return Point(self, np.zeros(3), self.name)


class SpaceMass(NamedTuple):
    """Mass, principal moments (3,), centre of mass (3,) in the frame, and principal axes there, columns of (3, 3)."""

    mass: float
    moments: np.ndarray
    com: np.ndarray
    axes: np.ndarray


class SpaceInertias:
    """Mass and principal moments of each body together with the particles attached to it."""

    def __init__(self, drawing: Drawing, numbers: Numbers) -> None:
        self.of: dict[str, SpaceMass] = inertias_of_bodies(drawing, numbers, _principal)

    def local(self, point: Point, numbers: Numbers) -> np.ndarray:
        """Point relative to its body's mass centre, in the body's principal axes; on the ground relative to the origin."""
        place, known = point.local_with(numbers), self.of.get(point.body.name)
        return place if known is None else known.axes.T @ (place - known.com)

    def direction(self, body: Body, local: np.ndarray) -> np.ndarray:
        """Direction in a body's principal axes, from one in its frame."""
        known = self.of.get(body.name)
        return local if known is None else known.axes.T @ local

    def is_massive(self, body: Body) -> bool:
        """True if every motion of a body has inertia."""
        known = self.of[body.name]
        return bool(known.mass > 0 and (not body.turns or known.moments.min() > 0))


def _principal(mass: float, J: Any, com: np.ndarray, others: list[tuple[float, np.ndarray]]) -> SpaceMass:
    """Mass, principal moments and axes of a body together with point masses fixed to it."""
    J, total = np.zeros((3, 3)) if np.ndim(J) == 0 else J, mass + sum(other for other, _ in others)
    if others and total:
        centre = (mass * com + sum(other * place for other, place in others)) / total
        for part, place in [(mass, com), *others]:
            arm = place - centre
            J = J + part * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
        com = centre
    if np.abs(J - np.diag(np.diagonal(J))).max() <= ROUNDING_OF_PRODUCTS * np.trace(J):
        return SpaceMass(total, np.diagonal(J).copy(), com, np.eye(3))
    moments, axes = np.linalg.eigh(J)
    if np.linalg.det(axes) < 0:
        axes[:, 0] *= -1
    return SpaceMass(total, np.maximum(moments, 0.0), com, axes)
