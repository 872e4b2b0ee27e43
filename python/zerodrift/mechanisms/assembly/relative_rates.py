"""Start velocities of least kinetic energy relative to the motions of carriers.

Velocities that constraints and given values leave undetermined are those of least kinetic energy, in which each body counts with
its velocity relative to its carrier: to the rigid motion of the body on which it hangs, or to the translation of its driven
point. The energy depends on what connects the bodies, not on coordinates or on the kind of the elements.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..._gateway.mechanisms.plane import MechanismCore
from ..._rotations import AXES, rotation_of
from .carriers import Carrier

GROUND = Carrier(0)
LEAST_RATE = 1e-9       # of the largest: rate of a constraint that is not violated
LEAST_GAIN = 1e-12      # of the energy: gain below which velocities are left as they are


class Rates(NamedTuple):
    """Velocities (nv,), a basis (nv, k) of what conditions leave undetermined, and whether carriers take part in that."""

    v: np.ndarray
    free: np.ndarray
    is_relative: bool = False


class Motions(NamedTuple):
    """Places (bodies, 3) of mass centres and axes (bodies, 3, 3), the ground's first.

    Velocities and spins (bodies, 3, nv) by those of the coordinates; directions (nv, 3) of these, and their bodies and kinds.
    """

    place: np.ndarray
    axes: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray
    direction: np.ndarray
    coordinates: Sequence[Any]

    def at(self, body: int, place: np.ndarray) -> np.ndarray:
        """Velocity (3, nv) of a place (3,) that moves with a body."""
        return self.velocity[body] + np.cross(self.spin[body].T, place - self.place[body]).T

    def of_point(self, body: int, carrier: Carrier) -> np.ndarray:
        """Velocity (3, nv) of the driven point of a body relative to its carrier."""
        place = self.place[body] + self.axes[body][:, :len(carrier.point)] @ carrier.point
        return self.at(body, place) - self.at(carrier.body, place)


def least_relative(of: Motions, v: np.ndarray, free: np.ndarray, roots: np.ndarray,
                   carriers: Mapping[int, Carrier]) -> np.ndarray:
    """Velocities (nv,) of least kinetic energy relative to the carriers.

    Parameters
    ----------
    of : Motions
    v : ndarray (nv,)
        Velocities that satisfy all conditions.
    free : ndarray (nv, k)
        Basis of what these leave undetermined.
    roots : ndarray (nv,)
        Square roots of masses and moments of inertia.
    carriers : dict of int to Carrier
    """
    rows = np.array(list(_relative(of, roots, carriers)))
    change = free @ np.linalg.lstsq(rows @ free, -rows @ v, rcond=None)[0]
    before, after = (float(np.sum((rows @ each)**2)) for each in (v, v + change))
    return v + change if before - after > LEAST_GAIN * before else v


def translates(of: Motions, rows: Mapping[str, np.ndarray], v: np.ndarray, name: str, body: int, carrier: Carrier) -> bool:
    """True if an element lets a body translate with its driven point; `rows` (k, nv) of elements by name."""
    step = of.of_point(body, carrier) @ v
    moved = np.array([each == body and kind != "angle" for each, kind in of.coordinates]) * (of.direction @ step)
    size = np.abs(rows[name]).max(initial=0.0) * np.abs(step).max()
    return bool(np.abs(rows[name] @ moved).max(initial=0.0) <= LEAST_RATE * size)


def motions(core: MechanismCore, p: np.ndarray) -> Motions:
    """Velocities of bodies by those of coordinates, at p (nq,)."""
    place, axes = _poses(core, p)
    velocity, spin = np.zeros((2, len(place), 3, core.nv))
    direction, about = np.zeros((core.nv, 3)), [_axes_of_turns(core)] * len(place)
    for i, (body, kind) in enumerate(core.motions):
        if kind == "angle":
            direction[i], about[body] = axes[body][:, about[body][0]], about[body][1:]
        else:
            direction[i, AXES.index(kind)] = 1.0
        (spin if kind == "angle" else velocity)[body, :, i] = direction[i]
    return Motions(place, axes, velocity, spin, direction, core.motions)


def _axes_of_turns(core: MechanismCore) -> tuple[int, ...]:
    """Axes about which coordinates turn a body, in their order: z in the plane."""
    return (0, 1, 2) if any(kind == "z" for _, kind in core.motions) else (2,)


def _poses(core: MechanismCore, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places of mass centres and axes, with those of the ground."""
    poses, _ = core.poses(p)
    place, axes = np.zeros((len(poses) + 1, 3)), np.repeat(np.eye(3)[None], len(poses) + 1, axis=0)
    if poses.shape[1] == 7:
        place[1:], axes[1:] = poses[:, :3], rotation_of(poses[:, 3:])
        return place, axes
    place[1:, :2], (cos, sin) = poses[:, :2], (function(poses[:, 2]) for function in (np.cos, np.sin))
    axes[1:, :2, :2] = np.moveaxis(np.array([[cos, -sin], [sin, cos]]), 2, 0)
    return place, axes


def _relative(of: Motions, roots: np.ndarray, carriers: Mapping[int, Carrier]) -> Iterator[np.ndarray]:
    """Rows (nv,) of velocities relative to carriers and to driven points, and of these points, times the roots of masses."""
    for (body, kind), root, direction in zip(of.coordinates, roots, of.direction, strict=True):
        carrier = carriers.get(body, GROUND)
        if kind == "angle":
            yield root * direction @ (of.spin[body] - of.spin[carrier.body])
        elif carrier.point is None:
            yield root * direction @ (of.velocity[body] - of.at(carrier.body, of.place[body]))
        else:
            by_point = of.of_point(body, carrier)
            by_body = of.velocity[body] - of.at(carrier.body, of.place[body])
            yield root * direction @ (by_body - by_point)
            yield root * direction @ by_point
