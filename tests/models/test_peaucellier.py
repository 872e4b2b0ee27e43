"""Peaucellier's cell against inversion in a circle."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize("sizes", [{}, {"arm": 0.3, "side": 0.5, "crank": 0.2, "amplitude": 1.5, "rate": 4.0}])
def test_the_far_corner_is_the_inverse_of_the_near_one(sizes):
    """In the second the arms are shorter than the sides: inversion is negative, and the line is on the other side."""
    sol = zd.simulate(zd.models.peaucellier(**sizes), 1.0, step=0.002)
    assert known_motions.peaucellier(sol, **sizes) < 1e-11
    x, y = sol["P.position"].T
    assert np.ptp(x) < 1e-12
    assert np.ptp(y) > 0.3


def test_a_cell_whose_arms_cannot_follow():
    with refused("geometry", r"amplitude 2 leads Q from 0\.2 to 0\.10\d+ m from O, and arms of 0\.25 m with sides "
                                         r"of 0\.12 m reach from 0\.13 to 0\.37 m"):
        zd.models.peaucellier(amplitude=2.0)
    with refused("geometry", "amplitude 1"):
        zd.models.peaucellier(crank=0.2, amplitude=1.0)
