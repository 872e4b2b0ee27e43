"""The snakeboard against the balance of its nonholonomic momentum by hand."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize("wheel_rate", [1.0, 2.0])
def test_it_goes_as_its_momentum_has_it(wheel_rate):
    sol = zd.simulate(zd.models.snakeboard(wheel_rate=wheel_rate), 6.0, step=0.05, integrator="dop853")
    assert known_motions.snakeboard(sol, wheel_rate) < 1e-10
    assert np.abs(sol.velocity_violation).max() < 1e-12


def test_axles_across_the_board():
    with refused("out-of-range", r"wheel_swing.*between -1\.5.*and 1\.5.*not 1\.6"):
        zd.models.snakeboard(wheel_swing=1.6)
