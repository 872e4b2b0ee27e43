"""Rows of four-bars against one pendulum, which all uprights turn as, and the reference of the benchmark library."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd


def test_two_four_bars_for_ten_seconds():
    """Through ten flat poses, in each of which they could part."""
    sol = zd.simulate(zd.models.four_bars(2), 10.0, step=0.0025, on_singular="continue", t_eval=[0.0, 1.0, 4.0, 10.0])
    assert known_motions.four_bars(sol) < 1e-8


@pytest.mark.parametrize("loops", [1, 5])
def test_each_upright_turns_by_the_energy_of_one_pendulum(loops):
    """Half of k2 psi'^2 less g cos(psi), with k2 of the library's closed form, stays what it was; psi is from the bottom."""
    L, v = 0.5, 1.5
    sol = zd.simulate(zd.models.four_bars(loops, length=L, speed=v), 0.34, step=0.002)
    angle, rate = sol["crank0.angle"] - np.pi / 2, sol["crank0.angular_velocity"]
    k2 = 9.81 / L * ((loops + 1) / 2 + loops) / ((loops + 1) / 3 + loops)
    energy = rate**2 / 2 + k2 * np.cos(angle)
    np.testing.assert_allclose(energy, (v / L)**2 / 2 + k2, rtol=1e-9)
    assert np.ptp(angle) > 1.0
    for i in range(loops + 1):
        np.testing.assert_allclose(sol[f"crank{i}.angle"], sol["crank0.angle"], atol=1e-11)
