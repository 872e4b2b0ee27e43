"""The quarter car against eigenvalues of its matrices and their transfer function."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize("given", [
    {}, {"body_mass": 300.0, "wheel_mass": 40.0, "stiffness": 2e4, "damping": 1200.0, "rate": 40.0}], ids=str)
def test_free_and_forced_motion(given):
    sol = zd.simulate(zd.models.quarter_car(**given), 1.0, step=0.0025, integrator="dop853")
    assert known_motions.quarter_car(sol, **given) < 1e-9


def test_it_stands_still_on_a_road_that_does():
    sol = zd.simulate(zd.models.quarter_car(amplitude=0.0), 1.0, step=0.01)
    assert np.abs(sol["body guide.displacement"]).max() < 1e-12
    np.testing.assert_allclose(sol["tyre.force"], -2820.0 * 9.81, rtol=1e-10)


def test_a_car_without_springs():
    with refused("out-of-range", "stiffness.*than 0, not 0"):
        zd.models.quarter_car(stiffness=0.0)
