"""Watt's linkage against the polar equation of Watt's curve, and circles."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from circles import complex_of
from support import refused


@pytest.mark.parametrize("sizes", [{}, {"rocker": 0.3, "coupler": 0.25, "amplitude": 0.5}])
def test_the_middle_stays_on_watts_curve(sizes):
    """r^2 = b^2 - (a sin(theta) +- sqrt(c^2 / 4 - a^2 cos(theta)^2))^2 from the middle of the hinges, which are 2a apart."""
    sol = zd.simulate(zd.models.watt(**sizes), 1.0, step=0.005)
    b, c, swing = (sizes.get(name, value) for name, value in (("rocker", 0.5), ("coupler", 0.2), ("amplitude", 0.35)))
    D = 2 * b - 1j * c
    assert known_motions.watt(sol, **sizes) < 1e-11
    P = complex_of(sol, "P")
    from_middle, a = (P - D / 2) / D * np.abs(D), np.abs(D) / 2
    from_middle = from_middle[np.abs(from_middle) > 0.01 * b]       # nearer to the middle, the angle is rounded
    r = np.abs(from_middle)
    along, across = a * from_middle.real / r, a * from_middle.imag / r
    q = (c / 2)**2 - along**2
    off = (r**2 - b**2 + across**2 + q)**2 - 4 * across**2 * q        # the curve without its square root
    assert np.abs(off).max() < 1e-12 * b**4
    assert np.ptp(P.imag) > 1.5 * b * swing


def test_a_rocker_that_cannot_follow():
    with refused("geometry", r"amplitude 0\.6 leads the left rocker's end 0\.7\d+ m from the right rocker's hinge, "
                                         r"and coupler and rocker together reach 0\.7 m"):
        zd.models.watt(amplitude=0.6)
