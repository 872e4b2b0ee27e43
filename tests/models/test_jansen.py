"""Jansen's leg of `zd.models` against circles intersected by hand."""

import numpy as np

import known_motions
import zerodrift as zd


def test_every_point_is_where_circles_meet_over_a_turn():
    sol = zd.simulate(zd.models.jansen(scale=0.01, speed=3.0), 2.1, step=0.01)
    assert np.ptp(sol["crank.angle"]) > 2 * np.pi
    assert known_motions.jansen(sol) < 1e-11        # with corrections to 1e-12
