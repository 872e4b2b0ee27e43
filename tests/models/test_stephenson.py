"""The six-bar of Stephenson's kind against circles intersected by hand."""

import numpy as np

import known_motions
import zerodrift as zd


def test_every_joint_is_where_circles_meet_over_a_turn():
    sol = zd.simulate(zd.models.stephenson(), 1.05, step=0.005)
    assert np.ptp(sol["crank.angle"]) > 2 * np.pi
    assert known_motions.stephenson(sol) < 1e-11
