"""Chebyshev's lambda mechanism against Thales' theorem: B, D and P have the distance 2.5 from C, so B D P is a right angle."""

import numpy as np

import zerodrift as zd
from circles import complex_of


def test_the_path_is_that_of_a_right_angle():
    sol = zd.simulate(zd.models.chebyshev_lambda(crank=0.1), 1.0, step=0.005)
    to_crank = 0.1 * np.exp(1j * sol["crank.angle"]) - 0.2
    expected = 0.2 - 1j * to_crank / np.abs(to_crank) * np.sqrt(0.25 - np.abs(to_crank)**2)
    assert np.abs(complex_of(sol, "P") - expected).max() < 1e-12
    assert np.ptp(sol["crank.angle"]) > 6.2
