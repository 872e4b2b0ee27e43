"""The planetary gear against Willis's equation, power, and the share of each planet."""

import numpy as np
import pytest

import zerodrift as zd


@pytest.mark.parametrize(("given", "teeth"), [
    ({}, (40, 80)), ({"sun": 24, "planet": 36, "planets": 4, "sun_speed": 9.0}, (24, 96))], ids=str)
def test_willis(given, teeth):
    """(w_sun - w_carrier) / (w_ring - w_carrier) = -z_ring / z_sun, and the moments on ring, carrier and sun balance."""
    sol = zd.simulate(zd.models.planetary_gear(**given), 0.5, step=0.01)
    z_sun, z_ring = teeth
    carrier, sun = -200 * np.pi / 30, given.get("sun_speed", -100 * np.pi / 30)
    ring = carrier - (sun - carrier) * z_sun / z_ring
    for name, speed in {"carrier": carrier, "sun": sun, "ring": ring}.items():
        np.testing.assert_allclose(sol[f"{name}.angular_velocity"], speed, rtol=1e-12)
    planets = given.get("planets", 3)
    efforts = np.array([sol[f"planet{i}-ring.torque"] for i in range(planets)])
    np.testing.assert_allclose(efforts, 10.0 / planets, rtol=1e-10)        # each holds its share of the load on the ring
    for i in range(planets):
        angle = 2 * np.pi * i / planets + carrier * sol.t
        arm = 0.0025 * (z_sun + z_ring) / 2
        expected = arm * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        np.testing.assert_allclose(sol[f"planet{i}.position"], expected, atol=1e-12)
    assert "2 of 20 rows follow from others" in str(zd.models.planetary_gear())


def test_the_ring_of_the_textbook_s_gear():
    sol = zd.simulate(zd.models.planetary_gear(), 0.1, step=0.01)
    assert sol["ring.angular_velocity"][-1] * 30 / np.pi == pytest.approx(-250.0, rel=1e-12)


@pytest.mark.parametrize(("wrong", "message"), [
    ({"sun": 0}, "sun must be between 1 and"), ({"planets": 0}, "planets must be between 1 and"),
    ({"module": 0.0}, "module must be greater than 0"), ({"density": -1.0}, "density must be greater than 0")])
def test_wrong_gears(wrong, message):
    with pytest.raises(ValueError, match=message):
        zd.models.planetary_gear(**wrong)
