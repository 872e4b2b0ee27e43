"""Time stepping after Moreau in space, with Coulomb's disk, in NumPy alone: independent of the package.

A step solves for momenta p1 = p0 + h f + (G0 + G1)^T P / 2, and moves with the mean of both velocities. The impulses P of a
contact obey 0 <= Pn, complementary to Gn u1 + e min(Gn u0, 0) >= 0, and Coulomb's law, with the slip Gt u1; those of a ball joint
are free. Steps are halved where a contact closes.
"""

import math
from typing import NamedTuple

import numpy as np

GROUND, GRAVITY = -1, np.array([0.0, 0.0, -9.81])
FINEST, STEPS = 2.0**-12, 60000         # part of a step where a contact closes; number of steps after which it gives up
TOUCHES, STILL = 1e-6, 1e-5             # m, m/s


class Body(NamedTuple):
    """Rigid body with principal inertias, or particle with zeros: position, axes, velocity and angular velocity."""

    mass: float
    inertia: np.ndarray
    x: np.ndarray
    R: np.ndarray
    v: np.ndarray
    w: np.ndarray


class Contact(NamedTuple):
    """Ball about a point of a body, and a plane, or a sphere, inside if its size is negative; or a ball joint: no mu."""

    body: int
    point: np.ndarray
    radius: float
    other: int
    at: np.ndarray
    normal: np.ndarray | None = None
    size: float = 0.0
    e: float = 0.0
    mu: float | None = None


def cross(a):
    """Matrix of the vector product with a."""
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def turned(R, angle):
    """Axes R turned by a rotation vector."""
    size, K = math.sqrt(angle @ angle), cross(angle)
    s, c = (math.sin(size) / size, (1 - math.cos(size)) / size**2) if size > 1e-4 else (1 - size**2 / 6, 0.5 - size**2 / 24)
    return R + (s * K + c * K @ K) @ R


def rows(bodies, contacts, x, R):
    """Gaps (m,), and rows (3 m, 6 n) of normal velocities and slips on velocities and angular velocities."""
    G, gaps = np.zeros((3 * len(contacts), 6 * len(bodies))), []
    for i, c in enumerate(contacts):
        at, place = (point if k == GROUND else x[k] + R[k] @ point for k, point in ((c.body, c.point), (c.other, c.at)))
        apart, axes, gap = at - place, np.eye(3), 0.0
        if c.mu is not None:
            n = c.normal if c.normal is None or c.other == GROUND else R[c.other] @ c.normal
            n = apart / math.copysign(math.sqrt(apart @ apart), c.size) if n is None else n
            gap, t = n @ apart - c.size - c.radius, cross(n)[int(np.argmin(np.abs(n)))]
            t = t / math.sqrt(t @ t)
            axes, at = np.array([n, t, cross(n) @ t]), at - c.radius * n
        gaps.append(gap)
        for k, sign in ((c.body, 1), (c.other, -1)):
            if k != GROUND:
                G[3 * i:3 * i + 3, 6 * k:6 * k + 3] = sign * axes
                G[3 * i:3 * i + 3, 6 * k + 3:6 * k + 6] = -sign * axes @ cross(at - x[k])
    return gaps, G


def _allowed(mu, z):
    """Impulses of a contact that are nearest to z, at first the normal one, then the others, and their derivative."""
    if mu is None:
        return z, np.eye(3)
    J, pressed, length = np.zeros((3, 3)), max(0.0, z[0]), math.hypot(z[1], z[2])
    if not pressed:
        return np.zeros(3), J
    if length <= mu * pressed:
        return z, np.eye(3)
    J[0, 0], e = 1.0, z[1:] / length
    J[1:, 0], J[1:, 1:] = mu * e, mu * pressed / length * (np.eye(2) - np.outer(e, e))
    return np.array([pressed, *(mu * pressed * e)]), J


def solve(A, b, mus, P):
    """Impulses P by their laws: Newton's method on P = allowed part of P - (A P + b) / r, and sweeps of it where that fails."""
    parts = [slice(3 * i, 3 * i + 3) for i in range(len(mus))]
    r, fine = np.repeat([np.trace(A[s, s]) for s in parts], 3), 1e-11 * max(1e-9, np.abs(b).max())
    D = np.eye(len(b)) - A / r[:, None]
    for sweeps in (100, 400, 1600, 6400):
        start = P
        for _ in range(25):
            z = P - (A @ P + b) / r
            found = [_allowed(mu, z[s]) for mu, s in zip(mus, parts, strict=True)]
            F = np.concatenate([each for each, _ in found])
            if np.abs((F - P) * r).max() < fine:
                return F
            slope = np.vstack([J @ D[s] for (_, J), s in zip(found, parts, strict=True)])
            P = P - np.linalg.lstsq(np.eye(len(b)) - slope, P - F, rcond=1e-10)[0]
        P = start.copy()
        for _ in range(sweeps):
            old = P.copy()
            for mu, s in zip(mus, parts, strict=True):
                P[s] = _allowed(mu, P[s] - (A[s] @ P + b[s]) / r[s])[0]
            if np.abs((P - old) * r).max() < fine:
                return P
    return P


def _inverse_masses(bodies, R):
    W = np.zeros((6 * len(bodies),) * 2)
    for i, (body, axes) in enumerate(zip(bodies, R, strict=True)):
        W[range(6 * i, 6 * i + 3), range(6 * i, 6 * i + 3)] = 1 / body.mass
        if body.inertia[0]:
            W[6 * i + 3:6 * i + 6, 6 * i + 3:6 * i + 6] = axes / body.inertia @ axes.T
    return W


def _step(bodies, contacts, state, h, pressed, known):
    """State after a step of size h, what is pressed there, and True if a contact closes."""
    x, R, p = state
    u, (gaps0, G0) = _inverse_masses(bodies, R) @ p, rows(bodies, contacts, x, R)
    p1 = free = p + h * np.concatenate([[*(body.mass * GRAVITY), 0, 0, 0] for body in bodies])
    middle = [turned(axes, h / 2 * u[6 * k + 3:6 * k + 6]) for k, axes in enumerate(R)]
    first = 1 + any(c.mu is None for c in contacts)
    for sweep in range(9):
        rates = (_inverse_masses(bodies, middle) @ (p + p1) / 2).reshape(-1, 6)
        middle, R1 = ([turned(axes, part * h * rate[3:]) for axes, rate in zip(R, rates, strict=True)] for part in (0.5, 1))
        x1 = x + h * rates[:, :3]
        gaps, G1 = rows(bodies, contacts, x1, R1)
        if sweep in (0, first):
            taking = [k for k, c in enumerate(contacts) if c.mu is None or
                      (sweep and (gaps[k] < 0 or (pressed[k] and gaps0[k] < TOUCHES)))]
        last, p1 = p1, free
        if taking:
            some = [3 * k + i for k in taking for i in range(3)]
            W, B = _inverse_masses(bodies, R1), (G0 + G1)[some].T / 2
            b = G1[some] @ W @ free
            b[::3] += [contacts[k].e * min(0.0, G0[3 * k] @ u) for k in taking]
            known[some] = solve(G1[some] @ W @ B, b, [contacts[k].mu for k in taking], known[some])
            p1 = free + B @ known[some]
        if sweep > first and np.abs(p1 - last).max() < 1e-8 * np.abs(free - p).max():
            break
    now = [contacts[k].mu is not None and k in taking and known[3 * k] > 0 for k in range(len(contacts))]
    return (x1, R1, p1), now, any(on and G0[3 * k] @ u < -STILL for k, on in enumerate(now))


def simulate(bodies, contacts, t_eval, h):
    """Positions and axes (samples, 12 bodies) at these times, from 0 on; NaN after too many steps. h is the largest step in s."""
    p = np.concatenate([[*(b.mass * b.v), *(b.R @ (b.inertia * (b.R.T @ b.w)))] for b in bodies])
    state, pressed, known = (np.array([b.x for b in bodies]), [b.R for b in bodies], p), [False] * len(contacts), np.zeros(
        3 * len(contacts))
    out, t, size, steps = np.full((len(t_eval), 12 * len(bodies)), np.nan), 0.0, h, 0
    for i, end in enumerate(t_eval):
        while t < end - 1e-14:
            rest = end - t
            step, closes = rest if size >= rest else size if 2 * size <= rest else rest / 2, True
            while closes:
                steps += 1
                following, now, closes = _step(bodies, contacts, state, step, pressed, known)
                closes &= step > h * FINEST
                step = step / 2 if closes else step
            if steps > STEPS:
                return out
            size = min(h, 2 * step) if step < rest else size
            t, state, pressed = end if step == rest else t + step, following, now
        out[i] = np.concatenate([[*state[0][k], *np.ravel(state[1][k])] for k in range(len(bodies))])
    return out
