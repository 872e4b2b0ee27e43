"""The paper's four-bar written in NumPy, term by term: what systems in Python are tested with."""

import numpy as np

import zerodrift as zd
from support import SYSTEMS

ANGLES = ["alpha1", "alpha2", "alpha3"]
GIVEN = {"l0": 1.0, "L": np.array([0.3, 1.0, 0.6]), "m": np.array([1.5, 5.0, 3.0]), "g": 9.81}
AHEAD = np.array([[0.5, 1, 1], [0, 0.5, 1], [0, 0, 0.5]])     # where along link i the weight of link j pulls


def mass(p, L, m):
    """Sum of m_j J_j^T J_j over the link midpoints, with slender links."""
    M = np.diag(m * L**2 / 12)
    for j in range(3):
        arms = AHEAD[:, j] * L
        M = M + m[j] * np.outer(arms, arms) * np.cos(p[:, None] - p)
    return M


def bias(p, v, L, m):
    d = np.zeros(3)
    for j in range(3):
        arms = AHEAD[:, j] * L
        d += m[j] * arms * (np.sin(p[:, None] - p) @ (arms * v**2))
    return d


def force(p, L, m, g):
    return -g * (AHEAD @ m) * L * np.cos(p)


def constraints(p, l0, L):
    return np.array([L @ np.cos(p) - l0, L @ np.sin(p)])


def jacobian(p, L):
    return np.array([-L * np.sin(p), L * np.cos(p)])


def xi(p, v, L):
    return np.array([(L * v**2) @ np.cos(p), (L * v**2) @ np.sin(p)])


def potential(p, L, m, g):
    return g * (AHEAD @ m) * L @ np.sin(p)


def four_bar(**changes):
    bar = SYSTEMS["four_bar"]
    terms = {"mass": mass, "bias": bias, "force": force, "constraints": constraints, "jacobian": jacobian, "xi": xi,
             "potential": potential, "parameters": GIVEN, "p0": bar.p0, "v0": bar.v0}
    return zd.System(ANGLES, **{key: value for key, value in (terms | changes).items() if value is not None})


DERIVED = {"jacobian": None, "xi": None}
