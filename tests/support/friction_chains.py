"""Chains of joints whose friction reads the joint's force, and their motion by Newton and Euler's equations.

The friction torque of a joint is -c sqrt(F . F + s^2) tanh(w / width). The Newton-Euler recursion gives joint forces F
and moments about the axes as affine functions of the angular accelerations; these are solved for with the friction inside, by
Newton's method with exact derivatives. The program shares nothing of this.
"""

from typing import NamedTuple

import numpy as np

import zerodrift as zd

SMOOTHING = 0.5     # N: s


class Chain(NamedTuple):
    """Links drawn along their chain; vectors in space also for chains in the plane."""

    dimension: int
    points: np.ndarray      # (n, 3) m: joints
    axes: np.ndarray        # (n, 3)
    centres: np.ndarray     # (n, 3) m
    masses: np.ndarray      # (n,)
    inertias: np.ndarray    # (n, 3): diagonals, in the axes of the drawing
    speeds: np.ndarray      # (n,) rad/s, at the start
    c: np.ndarray           # (n,) m: of the friction
    width: float            # rad/s
    gravity: np.ndarray     # (3,)


def random_chain(seed, dimension):
    chance = np.random.default_rng(seed)
    n = int(chance.integers(1, 4))
    steps, flat = chance.uniform(0.3, 0.8, (n + 1, 3)) * chance.choice([-1, 1], (n + 1, 3)), dimension == 2
    steps[:, 2] *= not flat
    points = np.cumsum(steps, axis=0)[:-1]
    axes = np.tile([0.0, 0.0, 1.0], (n, 1)) if flat else chance.normal(size=(n, 3))
    return Chain(dimension, points, axes / np.linalg.norm(axes, axis=1)[:, None], points + 0.5 * steps[1:],
                 chance.uniform(0.5, 2, n), chance.uniform(0.05, 0.1, (n, 3)),
                 chance.uniform(1, 3, n) * chance.choice([-1, 1], n),
                 chance.uniform(0.005, 0.03, n),
                 chance.uniform(0.3, 1), np.array([0, -9.81, 0]))


def mechanism(chain):
    d, flat = chain.dimension, chain.dimension == 2
    m = zd.Mechanism("chain", dimension=d, gravity=chain.gravity[:d])
    before, speeds = m.ground, {}
    for i in range(len(chain.masses)):
        inertia = chain.inertias[i, 2] if flat else chain.inertias[i]
        body = m.body(f"link{i}", chain.masses[i], inertia, at=chain.centres[i, :d])
        pin = m.revolute(f"pin{i}", before, body, at=chain.points[i, :d], **({} if flat else {"axis": chain.axes[i]}))

        def plane(w, x, y, c=chain.c[i]):
            return -c * np.sqrt(x * x + y * y + SMOOTHING * SMOOTHING) * np.tanh(w / chain.width)

        def space(w, x, y, z, c=chain.c[i]):
            return -c * np.sqrt(x * x + y * y + z * z + SMOOTHING * SMOOTHING) * np.tanh(w / chain.width)

        forces = {k: f"pin{i}.force.{k}" for k in "xyz"[:d]}
        m.motor(f"friction{i}", pin, torque=plane if flat else space, of={"w": pin.speed} | forces)
        speeds[pin.speed] = chain.speeds[i]
        before = body
    m.start(speeds)
    return m


def turned(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K)


def recursion(chain, q, w, qdd, gravity):
    """Moments about the axes (n,) and joint forces (n, 3) on the outer links, in the axes of the drawing."""
    n, R, x, omega, alpha, a = len(q), np.eye(3), chain.points[0], np.zeros(3), np.zeros(3), -gravity
    links = []
    for i in range(n):
        if i:
            arm = R @ (chain.points[i] - chain.points[i - 1])
            x, a = x + arm, a + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm))
        axis = R @ chain.axes[i]
        alpha = alpha + axis * qdd[i] + np.cross(omega, axis) * w[i]
        omega, R = omega + axis * w[i], R @ turned(chain.axes[i], q[i])
        arm, inertia = R @ (chain.centres[i] - chain.points[i]), R @ np.diag(chain.inertias[i]) @ R.T
        force = chain.masses[i] * (a + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm)))
        links.append((x, axis, arm, force, inertia @ alpha + np.cross(omega, inertia @ omega)))
    F, M, forces, moments, outer = np.zeros(3), np.zeros(3), np.zeros((n, 3)), np.zeros(n), None
    for i in reversed(range(n)):
        x, axis, arm, force, moment = links[i]
        M = M + moment + np.cross(arm, force) + (0 if outer is None else np.cross(outer - x, F))
        F, outer = F + force, x
        forces[i], moments[i] = F, axis @ M
    return moments, forces


def equations(chain, q, w):
    """Moments A qdd + b (n,), and joint forces e + qdd B (n, 3)."""
    zero = np.zeros(len(q))
    b, e = recursion(chain, q, w, zero, chain.gravity)
    columns = [recursion(chain, q, zero, row, np.zeros(3)) for row in np.eye(len(q))]
    return np.array([each[0] for each in columns]).T, b, np.array([each[1] for each in columns]), e


def slopes(c, speeds, of, qdd):
    """Sizes (n,) of the joint forces, and the derivative (n, n) of all moments, friction included, by qdd"""
    A, _, B, e = of
    F = e + np.einsum("i,ijk->jk", qdd, B)
    size = np.sqrt((F * F).sum(axis=1) + SMOOTHING**2)
    return size, A + (c * speeds / size)[:, None] * np.einsum("jk,ijk->ji", F, B)


def solved(c, speeds, of, qdd):
    """Newton's method from qdd (n,) with the friction c: qdd, and det(I - G du/dr) there; None where it does not converge"""
    A, b = of[:2]
    for _ in range(50):
        size, J = slopes(c, speeds, of, qdd)
        change = np.linalg.solve(J, A @ qdd + b + c * size * speeds)
        qdd = qdd - change
        if np.abs(change).max() < 1e-13 * (1 + np.abs(qdd).max()):
            return qdd, np.linalg.det(J) / np.linalg.det(A)
    return None


def accelerations(chain, q, w):
    """Qdd (n,), and det(I - G du/dr) there; where Newton's method does not converge, friction grows in parts."""
    of, speeds = equations(chain, q, w), np.tanh(w / chain.width)
    qdd = -np.linalg.solve(of[0], of[1])
    found = solved(chain.c, speeds, of, qdd)
    for share in () if found and found[1] > 0 else np.linspace(0.05, 1, 20):
        found = solved(share * chain.c, speeds, of, qdd)
        if found is None:
            raise ValueError("friction has no unique solution")
        qdd = found[0]
    return found


def reference(chain, end):
    """Angles at the end, and the least determinant on the way there"""
    from scipy.integrate import solve_ivp

    n, least = len(chain.masses), [1.0]

    def rate(t, y):
        qdd, determinant = accelerations(chain, y[:n], y[n:])
        least[0] = min(least[0], determinant)
        return np.concatenate([y[n:], qdd])

    found = solve_ivp(rate, (0, end), np.concatenate([np.zeros(n), chain.speeds]), method="DOP853", rtol=1e-12, atol=1e-13)
    return found.y[:n, -1], least[0]


def critical(chain):
    """The chain with Painleve's friction at the start, or None if it is more than 1000 times its own.

    With more, the motion that goes over from that without friction has no continuation, or the determinant is not positive
    between the joint forces of both.
    """
    of, speeds = equations(chain, 0 * chain.speeds, chain.speeds), np.tanh(chain.speeds / chain.width)
    free = qdd = -np.linalg.solve(of[0], of[1])
    factor, ratio = 0.01, 1.3
    while ratio > 1.003:
        c = factor * ratio * chain.c
        found = solved(c, speeds, of, qdd)
        between = [] if found is None else [np.linalg.det(slopes(c, speeds, of, free + part * (found[0] - free))[1])
                                            for part in np.linspace(0, 1, 5)]
        if found is None or min(between) <= 0.02 * np.linalg.det(of[0]):
            ratio = np.sqrt(ratio)
        else:
            qdd, factor = found[0], factor * ratio
        if factor > 1000:
            return None
    return chain._replace(c=factor * chain.c)
