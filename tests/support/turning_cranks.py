"""Four-bars whose cranks turn all the way around, so that the assembly they are in never changes."""

import numpy as np

LENGTHS = [(1, 0.3, 1, 0.6), (1, 0.4, 0.9, 0.8), (1, 0.2, 1.05, 0.5)]       # cranks turn all the way around: branches never meet


def side(sol):
    """Which assembly each row is: the sign of sin(alpha_3 - alpha_2), which on these mechanisms cannot change."""
    return np.sign(np.sin(sol.p[:, 2] - sol.p[:, 1]))
