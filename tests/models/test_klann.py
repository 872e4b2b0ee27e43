"""Klann's leg against circles intersected by hand."""

import numpy as np

import known_motions
import zerodrift as zd


def test_every_joint_is_where_circles_meet_over_a_turn():
    sol = zd.simulate(zd.models.klann(scale=1.0, speed=-3.0), 2.1, step=0.01)
    assert np.ptp(sol["crank.angle"]) > 2 * np.pi
    assert known_motions.klann(sol, scale=1.0) < 1e-11
