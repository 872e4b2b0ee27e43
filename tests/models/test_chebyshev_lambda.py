"""Chebyshev's lambda mechanism against Thales' theorem: B, D and P have the distance 2.5 from C, so B D P is a right angle."""

import numpy as np

import known_motions
import zerodrift as zd


def test_the_path_is_that_of_a_right_angle():
    sol = zd.simulate(zd.models.chebyshev_lambda(crank=0.2), 1.0, step=0.005)
    assert known_motions.chebyshev_lambda(sol, crank=0.2) < 1e-11
    assert np.ptp(sol["crank.angle"]) > 6.2
