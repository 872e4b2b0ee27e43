"""Linkages by hand: circles that meet, in complex numbers, as the package has none."""

import numpy as np


def crossing(a, b, from_a, from_b, side):
    """Intersection of circles about a and b; side 1 is left of the direction from a to b."""
    apart = abs(b - a)
    x = (apart**2 + from_a**2 - from_b**2) / (2 * apart)
    return a + (x + side * 1j * np.sqrt(from_a**2 - x**2)) * (b - a) / apart


def jansen_by_circles(crank):
    """All points of the leg in m at crank angles (k,)."""
    Y, X = -0.38 - 0.078j, 0.15 * np.exp(1j * crank)
    V, U = crossing(Y, X, 0.415, 0.5, 1), crossing(Y, X, 0.393, 0.619, -1)
    W = crossing(Y, V, 0.401, 0.558, 1)
    T = crossing(W, U, 0.394, 0.367, -1)
    return {"X": X, "V": V, "U": U, "W": W, "T": T, "F": crossing(U, T, 0.49, 0.657, 1)}


def four_bar_by_circles(crank, lengths, side):
    """The joints B and C of a four-bar at crank angles (k,), of ground (along x), crank, coupler and rocker lengths."""
    ground, a, b, c = lengths
    B = a * np.exp(1j * crank)
    return B, crossing(B, ground, b, c, side)


def complex_of(sol, name):
    """Positions of a point in a motion as complex numbers, (k,) m."""
    x, y = sol[f"{name}.position"].T
    return x + 1j * y
