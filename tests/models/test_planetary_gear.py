"""The planetary gear against Willis's equation, power, and the share of each planet."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize("given", [{}, {"sun": 24, "planet": 36, "planets": 4, "sun_speed": 9.0}], ids=str)
def test_willis(given):
    """And each planet holds its share of the load on the ring, though which share is not determined."""
    sol = zd.simulate(zd.models.planetary_gear(**given), 0.5, step=0.01)
    assert known_motions.planetary_gear(sol, **given) < 1e-11
    planets = given.get("planets", 3)
    for i in range(planets):
        np.testing.assert_allclose(sol[f"planet{i}-ring.torque"], 10.0 / planets, rtol=1e-10)
    assert "2 of 20 constraints are redundant" in str(zd.models.planetary_gear())


def test_the_ring_of_the_textbook_s_gear():
    sol = zd.simulate(zd.models.planetary_gear(), 0.1, step=0.01)
    assert sol["ring.angular_velocity"][-1] * 30 / np.pi == pytest.approx(-250.0, rel=1e-12)


@pytest.mark.parametrize(("wrong", "message"), [
    ({"sun": 0}, "sun must be between 1 and"), ({"planets": 0}, "planets must be between 1 and"),
    ({"module": 0.0}, "module must be greater than 0"), ({"density": 0.0}, "density must be greater than 0")])
def test_wrong_gears(wrong, message):
    with refused("out-of-range", message):
        zd.models.planetary_gear(**wrong)
