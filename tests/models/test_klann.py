"""Klann's leg against circles intersected by hand."""

import numpy as np

import zerodrift as zd
from circles import complex_of, crossing


def klann_by_circles(crank):
    """All joints in the patent's unit at crank angles (k,)."""
    O, A, B = 1.599 + 0.750j, 1.366 + 1.366j, 1.009 + 0.574j        # noqa: E741 - as the model calls it
    M = O + 0.268 * np.exp(1j * crank)
    C = crossing(M, B, 0.590, 0.321, -1)
    D = crossing(M, C, 1.105, 0.522, -1)
    E = crossing(D, A, 0.897, 0.518, 1)
    return {"M": M, "C": C, "D": D, "E": E, "F": crossing(D, E, 0.897, 1.732, -1)}


def test_every_joint_is_where_circles_meet_over_a_turn():
    sol = zd.simulate(zd.models.klann(scale=1.0, speed=-3.0), 2.1, step=0.01)
    assert np.ptp(sol["crank.angle"]) > 2 * np.pi
    for name, expected in klann_by_circles(sol["crank.angle"]).items():
        assert np.abs(complex_of(sol, name) - expected).max() < 1e-11, name
