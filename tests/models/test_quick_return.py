"""The quick return against its closed form, of both kinds: a lever that swings, and one that turns round."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused

TURNING = {"ground": 0.01, "crank": 0.025, "lever": 0.03, "rod": 0.09, "height": 0.005, "speed": 15.0}


@pytest.mark.parametrize("sizes", [{}, TURNING], ids=["shaper", "Whitworth"])
def test_the_ram_is_where_the_lever_s_angle_has_it(sizes):
    sol = zd.simulate(zd.models.quick_return(**sizes), 0.42, step=0.001)
    assert known_motions.quick_return(sol, **sizes) < 1e-11
    assert (np.ptp(sol["lever.angle"]) > 2 * np.pi) == bool(sizes)


def test_it_returns_faster_than_it_cuts():
    """The lever's ends are where the crank is at right angles to it, so times are as pi + 2 asin(a / g) to pi - 2 asin(a / g)."""
    turn = 2 * np.pi / 15
    sol = zd.simulate(zd.models.quick_return(), turn, step=turn / 5000)
    share = (sol["lever.angular_velocity"] > 0).mean()
    assert share == pytest.approx(0.5 - np.arcsin(0.4) / np.pi, abs=5e-4)


@pytest.mark.parametrize("wrong", [{"rod": 0.014}, {"crank": 0.025}, {"crank": 0.04}])
def test_a_rod_that_does_not_reach(wrong):
    with refused("geometry", r"rod must be longer than 0\.\d+ m, by which the lever's end moves off"):
        zd.models.quick_return(**wrong)
