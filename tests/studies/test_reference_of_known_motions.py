"""Certificates against motions known to thirty digits: a few of those of stress/certificates.py, and whether these are right."""

import numpy as np
import pytest

import taylor
from certain_motions import FAMILIES, compare, draw
from covering import spread
from taylor import mp

QUICK = ["linear", "oscillator", "kepler", "body", "moved_pendulum", "hung_plate", "crank", "sleigh", "knife_edge"]
DIGITS = mp.mpf(10)**-28


@pytest.mark.parametrize("name", spread(QUICK, 5))
def test_no_certificate_is_too_small(name):
    outcome = compare(name, 1)
    for certified, true in zip(outcome.certified, outcome.true, strict=True):
        assert true <= certified <= 1e4 * true


@pytest.mark.parametrize("name", ["pendulum", "sleigh"])
def test_nor_beyond_double_precision(name):
    outcome = compare(name, 1, "double-double")
    assert outcome.precision == "double-double"
    for certified, true in zip(outcome.certified, outcome.true, strict=True):
        assert true <= certified <= 1e-25


@pytest.mark.parametrize("error", [1e-4, 1e-8])
@pytest.mark.parametrize("name", ["linear", "kepler", "wire"])
def test_nor_is_one_that_was_requested(name, error):
    outcome = compare(name, 0, error=error)
    assert outcome.true[0] <= outcome.certified[0] <= error
    assert outcome.true[1] <= outcome.certified[1]


def test_steps_that_are_much_too_long_are_not_taken_for_chaos():
    """With 804 steps of these revolutions, rounding alone happens to change the motion altogether; with more it does not."""
    outcome = compare("kepler", 27)
    assert outcome.true[0] <= outcome.certified[0] < 1e-7


def test_the_quick_ones_are_families():
    assert set(QUICK) <= set(FAMILIES)


# ---- the exact motions themselves ----


def test_series_of_an_oscillator():
    found = taylor.solution(lambda t, x: [x[1], -3 * x[0]], [1, 0], 0, [0, 1, 30])
    assert all(abs(x[0] - mp.cos(mp.sqrt(3) * t)) < DIGITS for t, x in zip((0, 1, 30), found, strict=True))


def test_series_of_a_pendulum_by_elliptic_functions():
    found = taylor.solution(lambda t, x: [x[1], -taylor.sin_cos(x[0])[0]], [0.5, 0], 0, [3])
    k = mp.sin(mp.mpf(0.25))
    assert abs(found[0][0] - 2 * mp.asin(k * mp.ellipfun("cd", 3, m=k * k))) < DIGITS


def test_series_of_exponentials_powers_and_quotients():
    """They are x = exp(exp(t) - 1), y = (1 + t)^(2/3) and z = tan t."""
    def right_side(t, s):
        sine, cosine = taylor.sin_cos(t)
        return [taylor.exp(t) * s[0], (t + 1).power("-1/3") * (mp.mpf(2) / 3), 1 + s[2] * sine / cosine]

    x, y, z = taylor.solution(right_side, [1, 1, 0], 0, [1.25])[0]
    t = mp.mpf(1.25)
    expected = mp.exp(mp.exp(t) - 1), (1 + t)**(mp.mpf(2) / 3), mp.tan(t)
    assert max(abs(a - b) for a, b in zip((x, y, z), expected, strict=True)) < DIGITS


def test_series_do_not_depend_on_their_steps():
    """The double pendulum, cut at other places."""
    motion, _ = draw("double_pendulum", 3)
    ends = np.array([motion.end / 2])
    whole, parts = motion.exact(ends)[-1], motion.exact(np.linspace(0, motion.end / 2, 40))[-1]
    assert max(abs(a - b) for one, other in zip(whole, parts, strict=True) for a, b in zip(one, other, strict=True)) < 1e-24
