"""Constraint rows of mechanisms in space in plain NumPy, exact to rounding: a model that shares no code with the package.

The velocities of a body are those of its mass centre and its angular velocity, both in the drawing's axes; the ground has none.
Vectors carry their row, rate and second derivative at vdot = 0, as those of `plain_mechanics` do in the plane.
"""

import numpy as np

from mechanisms.plain_mechanics import Number
from mechanisms.plain_space import PITCH

RANK = 1e-9     # of the largest singular value: rows of exact numbers have some 1e-15, and the smallest that hold something 1e-6
AXES = np.eye(3)


def skew(r):
    """Matrix of r x."""
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def cross(a, b):
    """As NumPy's, of which much of the time would go to shapes."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


class Bodies:
    """Poses {name: (mass centre, Rotation)} and velocities v (6 n,) at one state."""

    def __init__(self, names, poses, v):
        self.poses, self.v, self.at, self.n = poses, v, {name: 6 * i for i, name in enumerate(names)}, 6 * len(names)
        self.turned = {name: R.as_matrix() for name, (_, R) in poses.items()}

    def fixed(self, value):
        value = np.asarray(value, dtype=float)
        return Number(value, np.zeros((*value.shape, self.n)), 0 * value, 0 * value)

    def direction(self, body, local):
        """A direction (3,) that turns with a body."""
        value = self.turned[body] @ local
        if body not in self.at:
            return self.fixed(value)
        spin, row = self.v[self.at[body] + 3:self.at[body] + 6], np.zeros((3, self.n))
        row[:, self.at[body] + 3:self.at[body] + 6] = -skew(value)
        rate = cross(spin, value)
        return Number(value, row, rate, cross(spin, rate))

    def point(self, body, local):
        """A point at (3,) from a body's mass centre, in the body's axes."""
        point, at = self.direction(body, local), self.at.get(body)
        centre = self.fixed(self.poses[body][0])
        if at is not None:
            centre.row[:, at:at + 3], centre.rate = AXES, self.v[at:at + 3]
        return point + centre


def angle_of(sine, cosine):
    """The angle of two Numbers: (s c' - c s') / (s^2 + c^2), and its derivative."""
    s, c = sine.value, cosine.value
    square, change = s * s + c * c, 2 * (s * sine.rate + c * cosine.rate)
    rate = (c * sine.rate - s * cosine.rate) / square
    return Number(np.arctan2(s, c), (c * sine.row - s * cosine.row) / square, rate,
                  (c * sine.quad - s * cosine.quad - change * rate) / square)


def rows_of(joint, bodies, length):
    """Constraints of a joint of `Plain.held`, each a Number that is zero; `length` is that of a rod."""
    kind, first, second, local1, local2, ((a1, a2), (n1, n2)) = joint
    one, other = (lambda d: bodies.direction(first, d)), (lambda d: bodies.direction(second, d))
    apart = bodies.point(second, local2) - bodies.point(first, local1)
    t1, t2 = cross(a1, n1), cross(a2, n2)
    if kind == "rod":
        return [(apart @ apart).root() + bodies.fixed(-length)]
    together = [apart @ bodies.fixed(axis) for axis in AXES]
    across = [one(n1) @ apart, one(t1) @ apart]
    parallel = [one(a1) @ other(n2), one(a1) @ other(t2)]
    along = one(a1) @ apart
    if kind == "screw":
        turned = angle_of(other(n2) @ one(t1), other(n2) @ one(n1))
        return [*across, *parallel, along - turned * (PITCH / (2 * np.pi))]
    return {"revolute": [*together, *parallel], "prismatic": [*across, *parallel, one(n1) @ other(t2)], "spherical": together,
            "weld": [*together, *parallel, one(n1) @ other(t2)], "cylindrical": [*across, *parallel],
            "universal": [*together, one(a1) @ other(n2)], "planar": [along, *parallel], "slot": across}[kind]


class Dense:
    """Residuals, rank and accelerations of a `Plain` mechanism at any state."""

    def __init__(self, plain):
        self.plain, self.names = plain, plain.names()
        self.lengths = [np.linalg.norm(plain.drawn[name][6] - plain.drawn[name][3]) for name in plain.drawn]

    def rows(self, poses, v):
        bodies = Bodies(self.names, poses, v)
        joints = zip(self.plain.held, self.lengths, strict=True)
        found = [row for joint, length in joints for row in rows_of(joint, bodies, length)]
        return [np.array([getattr(row, part) for row in found]) for part in ("value", "row", "quad")]

    def accelerations(self, poses, v):
        """(6 n,), residuals of positions and velocities, singular values of the rows."""
        value, C, quad = self.rows(poses, v)
        M = np.zeros((len(v), len(v)))
        for i, name in enumerate(self.names):
            mass, inertia, _ = self.plain.mass[name]
            R = poses[name][1].as_matrix()
            M[6 * i:6 * i + 3, 6 * i:6 * i + 3], M[6 * i + 3:6 * i + 6, 6 * i + 3:6 * i + 6] = mass * AXES, R @ inertia @ R.T
        return constrained(M, self.plain.loads(poses, v), C, -quad), np.abs(value).max(), np.abs(C @ v).max(), singular(C)


def singular(C):
    """Singular values of rows (m, n), in descending order."""
    return np.linalg.svd(C, compute_uv=False)


def constrained(M, f, C, right):
    """Accelerations (n,) of M vdot + C^T lambda = f, C vdot = right, by singular vectors: any rows may be redundant."""
    U, s, Vt = np.linalg.svd(C)
    rank = int((s > RANK * s[0]).sum())
    held, free = Vt[:rank].T @ ((U.T @ right)[:rank] / s[:rank]), Vt[rank:].T
    return held + free @ np.linalg.solve(free.T @ M @ free, free.T @ (f - M @ held))
