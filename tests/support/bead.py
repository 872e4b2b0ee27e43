"""A mass on a circle, written in Python with everything that callables can be handed."""

import numpy as np

import zerodrift as zd

MASKED = np.ma.array([1.0, 0.0], mask=[False, True])


def bead(**changes):
    """A mass on a circle, with everything that callables can be handed; its constraints are differentiated."""
    given = {
        "mass": lambda p, m: m * np.eye(2), "force": lambda t, p, v, m, pull: m * pull, "bias": lambda v: np.zeros(2),
        "constraints": lambda p: np.array([p @ p - 1.0]) / 2, "kinematics": lambda p: np.eye(2),
        "potential": lambda p, m, pull: -m * (pull @ p), "power": lambda v: 0.0,
        "parameters": {"m": 2.0, "pull": np.array([0.0, -9.81])}, "p0": [1.0, 0.0]}
    return zd.System(["x", "y"], **{key: value for key, value in (given | changes).items() if value is not None})
