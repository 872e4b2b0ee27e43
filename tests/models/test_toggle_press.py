"""The toggle press against the law of cosines, and its crank's moment against virtual work."""

import numpy as np
import pytest

import zerodrift as zd
from circles import complex_of, crossing


def ram_by_cosines(crank):
    """Knee and height of the ram at crank angles (k,)."""
    B = 0.352 + 0.3j + 0.05 * np.exp(1j * crank)
    knee = crossing(0.6j, B, 0.3, 0.3, -1)
    between = np.pi - 2 * np.arcsin(knee.real / 0.3)        # of the two links at the knee
    return knee, 0.6 - np.sqrt(2 * 0.3**2 * (1 - np.cos(between)))


def test_the_ram_is_where_the_law_of_cosines_has_it():
    sol = zd.simulate(zd.models.toggle_press(), 1.0, step=0.002)
    knee, height = ram_by_cosines(sol["crank.angle"])
    assert np.abs(complex_of(sol, "K") - knee).max() < 1e-12
    assert np.abs(sol["ram.position.y"] - height).max() < 1e-12


def test_the_crank_s_moment_presses_the_load():
    """Without masses: moment d(angle) + load d(height) = 0, with the derivative by differences."""
    sol = zd.simulate(zd.models.toggle_press(mass=0.0, ram_mass=0.0, load=700.0), 1.0, step=0.01, formulation="augmented")
    h = 1e-3
    crank = sol["crank.angle"]
    slope = sum(weight * ram_by_cosines(crank + k * h)[1] for k, weight in ((-2, 1), (-1, -8), (1, 8), (2, -1))) / (12 * h)
    np.testing.assert_allclose(sol["drive.torque"], -700.0 * slope, atol=1e-6)


@pytest.mark.parametrize("distance", [0.35, 0.47])
def test_a_knee_that_would_be_pushed_through_or_not_reached(distance):
    with pytest.raises(ValueError, match=r"distance must be above crank and rod together, 0\.35 m, .* and below 0\.4\d+ m"):
        zd.models.toggle_press(distance=distance)
