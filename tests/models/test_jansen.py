"""Jansen's leg of `zd.models` against circles intersected by hand."""

import numpy as np

import zerodrift as zd
from circles import complex_of, jansen_by_circles


def test_every_point_is_where_circles_meet_over_a_turn():
    sol = zd.simulate(zd.models.jansen(scale=0.01, speed=3.0), 2.1, step=0.01)
    assert np.ptp(sol["crank.angle"]) > 2 * np.pi
    for name, expected in jansen_by_circles(sol["crank.angle"]).items():
        assert np.abs(complex_of(sol, name) - expected).max() < 1e-11, name      # with corrections to 1e-12
