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
