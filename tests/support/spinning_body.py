"""A free body whose attitude is a quaternion: four coordinates, three velocities."""

import numpy as np

import zerodrift as zd

INERTIA = np.array([1.0, 1.0, 0.4])     # kg m^2, about axes that turn with the body
SPIN = np.array([0.3, 0.0, 2.0])        # rad/s


def half_turns(p):
    """A (4, 3): the rate of the quaternion (scalar first) from angular velocity in the body."""
    w, x, y, z = p
    return 0.5 * np.array([[-x, -y, -z], [w, -z, y], [z, w, -x], [-y, x, w]])


def body(**changes):
    terms = {"mass": np.diag(INERTIA), "bias": lambda v: np.cross(v, INERTIA * v), "kinematics": half_turns, "potential": 0.0,
             "p0": [1.0, 0.0, 0.0, 0.0], "v0": SPIN}
    return zd.System(["e0", "e1", "e2", "e3"], **(terms | changes))


def precession(t):
    """Its angular velocity, (k, 3): that of a symmetric body turns about its axis, in the body, at a constant rate."""
    rate = (INERTIA[2] - INERTIA[0]) / INERTIA[0] * SPIN[2]
    return np.stack([SPIN[0] * np.cos(rate * t), SPIN[0] * np.sin(rate * t), np.full_like(t, SPIN[2])], axis=1)


def attitude(t):
    """Its quaternion, (k, 4): the axis goes about the angular momentum at a constant rate, and the body about the axis."""
    momentum = INERTIA * SPIN
    about_axis = (INERTIA[0] - INERTIA[2]) / INERTIA[0] * SPIN[2]
    return product(rotation(momentum, np.linalg.norm(momentum) / INERTIA[0] * t), rotation([0, 0, 1], about_axis * t))


def rotation(axis, angle):
    """The quaternions (k, 4) of turns by angles (k,) about an axis."""
    half = np.asarray(angle)[:, None] / 2
    return np.hstack([np.cos(half), np.sin(half) * np.array(axis) / np.linalg.norm(axis)])


def product(a, b):
    """Product of quaternions (k, 4): the rotation b, then a."""
    scalar = a[:, :1] * b[:, :1] - (a[:, 1:] * b[:, 1:]).sum(axis=1, keepdims=True)
    return np.hstack([scalar, a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])])
