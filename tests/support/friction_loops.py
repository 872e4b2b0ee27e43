"""Closed loops with friction that reads joint forces, and their motion by a dense index-1 system of free bodies.

A four-bar in the plane, and in space a crank and a rocker on pins with a coupler between two ball joints. The friction torque of
a pin is -c sqrt(F . F + s^2) tanh(w / width). Newton and Euler's equations of the free bodies with multipliers of all joints are
solved with the friction inside, by Newton's method with exact derivatives. The program shares nothing of this.
"""

from typing import NamedTuple

import numpy as np

import zerodrift as zd
from friction_chains import SMOOTHING


class Loop(NamedTuple):
    """Crank, coupler and rocker; vectors in space also for loops in the plane."""

    dimension: int
    points: np.ndarray      # (4, 3) m: joints A, B, C, D
    axes: np.ndarray        # (2, 3): of the pins A and D
    masses: np.ndarray      # (3,)
    inertias: np.ndarray    # (3, 3): diagonals, in the axes of the drawing
    c: np.ndarray           # (4,) or (2,) m: of the friction at pins
    width: float            # rad/s
    speed: float            # rad/s: of the crank at the start
    gravity: np.ndarray     # (3,)

    @property
    def centres(self):
        return 0.5 * (self.points[:-1] + self.points[1:])


def random_loop(seed, dimension):
    chance = np.random.default_rng(seed)
    flat = dimension == 2
    points = np.array([[0, 0, 0], [0.2, 0.5, 0], [1.1, 0.8, 0], [1.3, 0, 0]]) + chance.uniform(-0.12, 0.12, (4, 3))
    points[:, 2] *= not flat
    axes = np.tile([0.0, 0.0, 1.0], (2, 1)) + (0 if flat else chance.uniform(-0.3, 0.3, (2, 3)))
    inertias = chance.uniform(0.05, 0.1, (3, 3))
    inertias[1] = inertias[1, 2]        # so that the coupler's turn about its own line has no effect
    return Loop(dimension, points, axes / np.linalg.norm(axes, axis=1)[:, None], chance.uniform(0.5, 2, 3), inertias,
                chance.uniform(0.1, 1, 4 if flat else 2), chance.uniform(0.5, 1),
                chance.uniform(1, 3) * chance.choice([-1, 1]), np.array([0, -9.81, 0]))


def mechanism(loop):
    d, flat = loop.dimension, loop.dimension == 2
    m = zd.Mechanism("loop", dimension=d, gravity=loop.gravity[:d])
    crank, coupler, rocker = (m.body(name, loop.masses[i], loop.inertias[i, 2] if flat else loop.inertias[i],
                                     at=loop.centres[i, :d]) for i, name in enumerate(("crank", "coupler", "rocker")))
    pairs = [(m.ground, crank), (crank, coupler), (coupler, rocker), (m.ground, rocker)]
    pins = []
    for i, (name, pair) in enumerate(zip("ABCD", pairs, strict=True)):
        if not flat and name in "BC":
            m.spherical(name, *pair, at=loop.points[i])
            continue
        axis = {} if flat else {"axis": loop.axes[i // 3]}
        pins.append(m.revolute(name, *pair, at=loop.points[i, :d], **axis))
    for pin, c in zip(pins, loop.c, strict=True):
        def plane(w, x, y, c=c):
            return -c * np.sqrt(x * x + y * y + SMOOTHING * SMOOTHING) * np.tanh(w / loop.width)

        def space(w, x, y, z, c=c):
            return -c * np.sqrt(x * x + y * y + z * z + SMOOTHING * SMOOTHING) * np.tanh(w / loop.width)

        of = {"w": pin.speed} | {k: f"{pin.name}.force.{k}" for k in "xyz"[:d]}
        m.motor(f"friction{pin.name}", pin, torque=plane if flat else space, of=of)
    m.start({pins[0].speed: loop.speed})
    return m


def cross(v):
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


class Equations:
    """Unknowns: accelerations (18,) of the bodies, linear and angular; forces and moments of the joints on the later bodies."""

    JOINTS = ((-1, 0), (0, 1), (1, 2), (-1, 2))

    def __init__(self, loop):
        self.loop, self.flat = loop, loop.dimension == 2
        self.pins = (0, 1, 2, 3) if self.flat else (0, 3)
        self.arms = [[None if b < 0 else loop.points[j] - loop.centres[b] for b in self.JOINTS[j]] for j in range(4)]

    def axis_of(self, j):
        return self.loop.axes[0 if j in (0, 1, 2) else 1]

    def rows(self, R):
        """Constraint rows on twists: (m, 18), with the range of the force rows of each joint, in global axes."""
        rows, at, kept = [], [], 2 if self.flat else 3
        for j, pair in enumerate(self.JOINTS):
            block = np.zeros((3, 18))
            for b, sign, arm in zip(pair, (-1, 1), self.arms[j], strict=True):
                if b >= 0:
                    block[:, 6 * b:6 * b + 3] += sign * np.eye(3)
                    block[:, 6 * b + 3:6 * b + 6] -= sign * cross(R[b] @ arm)
            at.append(range(len(rows), len(rows) + kept))
            rows += list(block[:kept])
            if not self.flat and j in self.pins:
                across = np.linalg.svd(self.axis_of(j)[None])[2][1:]       # ground pins: fixed directions
                for e in across:
                    row = np.zeros(18)
                    row[6 * pair[1] + 3:6 * pair[1] + 6] = e
                    rows.append(row)
        if self.flat:
            for b in range(3):
                for k in (2, 3, 4):
                    row = np.zeros(18)
                    row[6 * b + k] = 1
                    rows.append(row)
        return np.array(rows), at

    def biases(self, R, omega, count):
        """Rates of the rows times the twists."""
        bias, k, kept = np.zeros(count), 0, 2 if self.flat else 3
        for j, pair in enumerate(self.JOINTS):
            rate = np.zeros(3)
            for b, sign, arm in zip(pair, (-1, 1), self.arms[j], strict=True):
                if b >= 0:
                    rate += sign * np.cross(omega[b], np.cross(omega[b], R[b] @ arm))
            bias[k:k + kept] = rate[:kept]
            k += kept + (0 if self.flat or j not in self.pins else 2)
        return bias

    def matrices(self, R, omega):
        n, loop = 18, self.loop
        M, f = np.zeros((n, n)), np.zeros(n)
        for b in range(3):
            inertia = R[b] @ np.diag(loop.inertias[b]) @ R[b].T
            M[6 * b:6 * b + 3, 6 * b:6 * b + 3] = loop.masses[b] * np.eye(3)
            M[6 * b + 3:6 * b + 6, 6 * b + 3:6 * b + 6] = inertia
            f[6 * b:6 * b + 3] = loop.masses[b] * loop.gravity
            f[6 * b + 3:6 * b + 6] = -np.cross(omega[b], inertia @ omega[b])
        C, at = self.rows(R)
        torques = np.zeros((n, len(self.pins)))
        for i, j in enumerate(self.pins):
            for b, sign in zip(self.JOINTS[j], (-1, 1), strict=True):
                if b >= 0:
                    torques[6 * b + 3:6 * b + 6, i] = sign * self.axis_of(j)
        return M, f, C, self.biases(R, omega, len(C)), at, torques

    def speeds(self, omega):
        return np.array([self.axis_of(j) @ ((omega[b] if b >= 0 else 0) - (omega[a] if a >= 0 else 0))
                         for j, (a, b) in ((j, self.JOINTS[j]) for j in self.pins)])

    def solve(self, R, omega, c, u0=0):
        """Accelerations (18,), det(I - G du/dr) there and least between there and the torques u0, and the torques"""
        M, f, C, bias, at, torques = self.matrices(R, omega)
        K = np.block([[M, C.T], [C, np.zeros((len(C), len(C)))]])
        zero = np.linalg.solve(K, np.concatenate([f, -bias]))
        each = np.linalg.solve(K, np.vstack([torques, np.zeros((len(C), torques.shape[1]))]))
        F0 = [-zero[18:][list(at[j])] for j in self.pins]
        G = [-each[18:][list(at[j])] for j in self.pins]
        sign = c * np.tanh(self.speeds(omega) / self.loop.width)

        def residual(u):
            forces = [F0[i] + G[i] @ u for i in range(len(c))]
            size = np.array([np.sqrt(F @ F + SMOOTHING**2) for F in forces])
            return u + sign * size, np.eye(len(c)) + np.array([sign[i] / size[i] * (forces[i] @ G[i]) for i in range(len(c))])

        u = start = u0 + np.zeros(len(c))
        for _ in range(50):
            left, J = residual(u)
            change = np.linalg.solve(J, left)
            u = u - change
            if np.abs(change).max() < 1e-13 * (1 + np.abs(u).max()):
                break
        determinants = [np.linalg.det(residual(start + part * (u - start))[1]) for part in np.linspace(0, 1, 9)]
        return zero[:18] + each[:18] @ u, determinants[-1], min(determinants), u

    def start(self):
        """Twists (18,) at the drawn start, by the crank's speed; the coupler does not turn about its own line."""
        C = self.rows([np.eye(3)] * 3)[0]
        wanted = [np.concatenate([np.zeros(3), self.loop.axes[0], np.zeros(12)])]
        if not self.flat:
            wanted.append(np.concatenate([np.zeros(9), self.loop.points[2] - self.loop.points[1], np.zeros(6)]))
        values = np.concatenate([np.zeros(len(C)), [self.loop.speed], np.zeros(len(wanted) - 1)])
        return np.linalg.lstsq(np.vstack([C, *wanted]), values, rcond=None)[0]


def critical(loop):
    """The loop with the friction with which its motion at the start, followed from less friction, ends; None: not found"""
    equations = Equations(loop)
    omega = equations.start().reshape(3, 6)[:, 3:]
    u = 0
    for factor in np.geomspace(0.05, 1e3, 400):
        *_, least, u = equations.solve([np.eye(3)] * 3, omega, factor * loop.c, u)
        if least <= 0:
            return loop._replace(c=loop.c * factor)
    return None


def reference(loop, end):
    """Angle of the crank at the end, and the least determinant on the way"""
    from scipy.integrate import solve_ivp

    equations, least = Equations(loop), [1.0]

    def rate(t, y):
        R, twists = y[9:36].reshape(3, 3, 3), y[36:].reshape(3, 6)
        vdot, _, smallest, _ = equations.solve(R, twists[:, 3:], loop.c)
        least[0] = min(least[0], smallest)
        spun = [cross(twists[b, 3:]) @ R[b] for b in range(3)]
        return np.concatenate([twists[:, :3].ravel(), np.ravel(spun), vdot])

    y = np.concatenate([loop.centres.ravel(), np.tile(np.eye(3).ravel(), 3), equations.start()])
    found = solve_ivp(rate, (0, end), y, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    R = found[9:18].reshape(3, 3)
    first = np.linalg.svd(loop.axes[0][None])[2][1]
    return np.arctan2(loop.axes[0] @ np.cross(first, R @ first), first @ R @ first), least[0]
