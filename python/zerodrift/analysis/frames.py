"""The frame in which a motion is linearized: rates of bodies in fixed axes, carried along by a steady rotation.

Displacements are compared as eta = J delta, changes of the places and rotation vectors of all bodies in the drawing's axes, and
their rates as nu, the changes of the rates w = J v. Rotation vectors of fixed axes do not spin with a wheel; they obey

    eta' = nu + omega x eta      (rotations; omega the body's angular velocity)
    eta' = nu                    (places)

In a steady motion all of them turn with one angular velocity Omega about the direction of gravity (about any axis without
gravity), and vdot satisfies acc = Omega x w. Systems without bodies have their coordinates for places, and their unit
quaternions for rotations.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .._private.gateway.mechanisms.core import MechanismCore
from ..systems.base import BaseSystem, core_of
from . import differences
from .quantities import rates_of
from .state import State, scales, state

STEADY = 1e-7       # of the accelerations' size: what counts as a steady motion


def cross(a: np.ndarray) -> np.ndarray:
    """The matrix (3, 3) of the product a x b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


class Frame:
    """Rates of a system's bodies in fixed axes.

    `turning` has the first rows of angular velocities in space, `vectors` those of all vectors that a rotation of the system
    turns.
    """

    turning: list[int]
    vectors: list[int]
    dimension = 3
    gravity: np.ndarray | None = None       # None: it is not known whether the system may be rotated

    @property
    def weight(self) -> float:
        """The acceleration of gravity in m/s^2, before constraints take part of it; zero where it is not known."""
        return 0.0 if self.gravity is None else float(np.linalg.norm(self.gravity))

    def rows(self, at: State) -> np.ndarray:
        """J (n, nv)."""
        raise NotImplementedError

    def bias(self, at: State) -> np.ndarray:
        """The derivative of J v with respect to time at frozen v, (n,)."""
        raise NotImplementedError

    def each(self, system: BaseSystem, t: np.ndarray, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """J (k, n, nv) and the bias (k, n) at many states t (k,), p (k, nq), v (k, nv)."""
        there = [state(system, float(of_t), of_p, of_v) for of_t, of_p, of_v in zip(t, p, v, strict=True)]
        return np.array([self.rows(at) for at in there]), np.array([self.bias(at) for at in there])

    def rates(self, at: State) -> np.ndarray:
        """W = J v, (n,)."""
        return self.rows(at) @ at.v

    def commutator(self, w: np.ndarray) -> np.ndarray:
        """The matrix (n, n) of omega x eta."""
        return self._blocks(w.size, {first: cross(w[first:first + 3]) for first in self.turning})

    def angular_velocities(self, at: State, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Angular velocities (k, 3) of bodies, and (j, 3) of the places of their mass centres about the origin."""
        return np.zeros((0, 3)), np.zeros((0, 3))

    def rotation(self, Omega: np.ndarray, n: int) -> np.ndarray:
        """The matrix (n, n) of Omega x eta, of all vectors."""
        size = self.dimension
        return self._blocks(n, {first: cross(Omega)[:size, :size] for first in self.vectors})

    @staticmethod
    def _blocks(n: int, blocks: dict[int, np.ndarray]) -> np.ndarray:
        matrix = np.zeros((n, n))
        for first, block in blocks.items():
            matrix[first:first + len(block), first:first + len(block)] = block
        return matrix

    def steady_rotation(self, w: np.ndarray, acc: np.ndarray) -> np.ndarray:
        """Omega (3,), with which acc = Omega x w for rows of both (j, n) as nearly as can be, about axes that keep gravity."""
        axes, (j, n) = self.axes, w.shape
        columns = np.array([w @ self.rotation(axis, n).T for axis in axes]).reshape(len(axes), j * n).T
        if not columns.size or np.abs(columns).max() <= STEADY * np.abs(w).max(initial=0.0):
            return np.zeros(3)
        return axes.T @ np.linalg.lstsq(columns, acc.ravel(), rcond=STEADY)[0]

    @property
    def axes(self) -> np.ndarray:
        """Axes (a, 3) about which a rotation keeps gravity."""
        if self.gravity is None:
            return np.zeros((0, 3))
        size = float(np.linalg.norm(self.gravity))
        if self.dimension == 2:
            return np.zeros((0, 3)) if size else np.array([[0.0, 0.0, 1.0]])
        return self.gravity[None] / size if size else np.eye(3)


def mechanism_core_of(system: BaseSystem) -> MechanismCore:
    """The core's system of a mechanism."""
    core = core_of(system)
    assert isinstance(core, MechanismCore)
    return core


class BodyFrame(Frame):
    """The frame of a mechanism: velocities of mass centres, and angular velocities."""

    def __init__(self, system: Any) -> None:
        drawing = system._drawing
        self.dimension, self.gravity = drawing.dimension, np.asarray(drawing.gravity, dtype=float)
        names, self.turning, self.vectors, at = [], [], [], 0
        known = set(system._names_of_measures())
        for body in drawing.parts():
            centre, spin = f"{body.name}.center.velocity", f"{body.name}.angular_velocity"
            names.append(centre if centre in known else f"{body.name}.velocity")
            self.vectors.append(at)
            at += self.dimension
            if spin in known:
                names.append(spin)
                if self.dimension == 3:
                    self.turning.append(at)
                    self.vectors.append(at)
                at += 3 if self.dimension == 3 else 1
        self.names = tuple(names)

    def each(self, system: BaseSystem, t: np.ndarray, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = rates_of(system, self.names, "frame", t, p, v)
        return found["row"], found["bias"]

    def _at(self, at: State) -> tuple[np.ndarray, np.ndarray]:
        rows, bias = self.each(at.system, np.array([at.t]), at.p[None], at.v[None])
        return rows[0], bias[0]

    def angular_velocities(self, at: State, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        places = [first for first in self.vectors if first not in self.turning]
        is_spin = np.ones(w.size, dtype=bool)
        is_spin[[first + i for first in self.vectors for i in range(self.dimension)]] = False
        spins = [w[first:first + 3] for first in self.turning] + [np.array([0.0, 0.0, each]) for each in w[is_spin]]
        centres = mechanism_core_of(at.system).poses(at.p)[0][:, :self.dimension]
        space = np.zeros((2, len(places), 3))
        space[:, :, :self.dimension] = centres, [w[first:first + self.dimension] for first in places]
        about = np.cross(*space) / np.maximum((space[0]**2).sum(axis=1), 1e-300)[:, None]
        return np.array(spins).reshape(-1, 3), about

    def rows(self, at: State) -> np.ndarray:
        return self._at(at)[0]

    def bias(self, at: State) -> np.ndarray:
        return self._at(at)[1]


class CoordinateFrame(Frame):
    """The frame of a system without bodies: rates of coordinates, and of unit quaternions their rotation vectors."""

    def __init__(self, system: Any) -> None:
        quaternions = {first + i for first in system.quaternions for i in range(4)}
        self.places = [i for i in range(system.nq) if i not in quaternions]
        self.turning = [len(self.places) + 3 * i for i in range(len(system.quaternions))]
        self.vectors = []

    def rows(self, at: State) -> np.ndarray:
        parts = [at.A[self.places]]
        for first in at.system.quaternions:
            w, vector = at.p[first], at.p[first + 1:first + 4]
            parts.append(2 * np.column_stack([-vector, w * np.eye(3) + cross(vector)]) @ at.A[first:first + 4])
        return np.vstack(parts)

    def bias(self, at: State) -> np.ndarray:
        pdot = at.A @ at.v
        size = float(np.abs(pdot / scales(at.system, at.p).p).max(initial=0.0))
        return differences.along(lambda h: self.rates(state(at.system, at.t, at.p + h * pdot, at.v)), size)


def frame_of(system: Any) -> Frame:
    """Frame of a system: of its bodies if it is a mechanism, otherwise of its coordinates."""
    return BodyFrame(system) if hasattr(system, "_drawing") else CoordinateFrame(system)
