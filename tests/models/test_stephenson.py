"""The six-bar of Stephenson's kind against circles intersected by hand."""

import numpy as np

import zerodrift as zd
from circles import complex_of, crossing, four_bar_by_circles


def test_every_joint_is_where_circles_meet_over_a_turn():
    sol = zd.simulate(zd.models.stephenson(), 1.05, step=0.005)
    B, C = four_bar_by_circles(sol["crank.angle"], (0.135, 0.080, 0.105, 0.120), 1)
    E = B + 0.225 * np.exp(1j * np.radians(20)) * (C - B) / 0.105
    G = crossing(E, 0.195 * np.exp(-1j * np.radians(20)), 0.180, 0.180, 1)
    assert np.ptp(sol["crank.angle"]) > 2 * np.pi
    for name, expected in {"B": B, "C": C, "E": E, "G": G}.items():
        assert np.abs(complex_of(sol, name) - expected).max() < 1e-12, name
