"""The toggle press against the law of cosines, and its crank's moment against virtual work."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


def test_the_ram_is_where_the_law_of_cosines_has_it():
    sol = zd.simulate(zd.models.toggle_press(), 1.0, step=0.002)
    assert known_motions.toggle_press(sol) < 1e-11
    assert sol["K.position"][:, 0].min() < 0.003      # the knee comes near to being straight


def test_the_crank_s_moment_presses_the_load():
    """Without masses: moment d(angle) + load d(height) = 0, with the derivative by differences."""
    sol = zd.simulate(zd.models.toggle_press(mass=0.0, ram_mass=0.0, load=700.0), 1.0, step=0.01, formulation="augmented")
    h = 1e-3
    crank = sol["crank.angle"]
    heights = {k: known_motions.ram_by_cosines(crank + k * h)[1] for k in (-2, -1, 1, 2)}
    slope = (8 * (heights[1] - heights[-1]) - (heights[2] - heights[-2])) / (12 * h)
    np.testing.assert_allclose(sol["drive.torque"], -700.0 * slope, atol=1e-6)


@pytest.mark.parametrize("distance", [0.35, 0.47])
def test_a_knee_that_would_be_pushed_through_or_not_reached(distance):
    with refused("geometry", r"distance must be above crank and rod together, 0\.35 m, .* and below 0\.4\d+ m"):
        zd.models.toggle_press(distance=distance)
