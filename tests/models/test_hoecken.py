"""Hoecken's linkage against the right angle at its rocker's foot, and the numbers that Norton tables."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize(("ground", "coupler"), [(2.5, 3.25), (2.2, 2.8)])
def test_the_path_is_that_of_a_right_angle(ground, coupler):
    sol = zd.simulate(zd.models.hoecken(ground=ground, coupler=coupler), 1.0, step=0.005)
    assert known_motions.hoecken(sol, ground=ground, coupler=coupler) < 1e-11
    assert np.ptp(sol["crank.angle"]) > 6.2


@pytest.mark.parametrize(("ground", "coupler", "degrees", "length", "percent"), [
    (2.500, 3.250, 140, 3.623, 0.023), (2.200, 2.800, 180, 4.181, 0.096)])
def test_it_is_as_straight_as_tabled(ground, coupler, degrees, length, percent):
    """Norton's table: over so many degrees P moves so many crank lengths along x, straight to so many percent of that."""
    sol = zd.simulate(zd.models.hoecken(crank=1.0, ground=ground, coupler=coupler, speed=2 * np.pi), 1.0, step=1 / 720)
    x, y = sol["P.position"][360 - degrees:361 + degrees].T
    assert np.ptp(x) == pytest.approx(length, abs=6e-4)
    assert 100 * np.ptp(y) / np.ptp(x) == pytest.approx(percent, abs=6e-4)


def test_a_crank_that_cannot_turn_round():
    with refused("geometry", r"coupler.*1\.75.*not 1\.5"):
        zd.models.hoecken(coupler=1.5)
    with refused("out-of-range", "ground.*than 1, not 1"):
        zd.models.hoecken(ground=1.0)
