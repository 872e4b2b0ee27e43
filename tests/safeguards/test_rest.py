"""Warnings and advice that fit: of a mechanism at rest, of an implicit method, of energy corrections left out."""

import re
import warnings

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from few_bodies import kicked


@pytest.mark.parametrize("kick", [0.0, 1000.0])
def test_rounding_at_rest_shows_no_frequency(kick):
    """Positions and accelerations at rest differ by rounding only, whose quotient is any number."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", zd.StabilityWarning)
        sol = zd.simulate(kicked(kick, 1.0, 9.81), 2.0, step=1e-3)
    assert sol.stats["too_long"] == 0
    assert sol.stats["omega_h"] < 1         # of 0.03; at the jump itself the quotient is not a frequency


def test_an_instability_that_begins_at_rest_is_reported():
    """The same equilibrium with a step that is too long: omega h = 3.2 grows from rounding until it is seen."""
    with pytest.warns(zd.StabilityWarning, match="longer than 'rk4' is stable"):
        sol = zd.simulate(kicked(0.0, 1.0, 9.81), 30.0, step=0.1, on_failure="return")
    assert sol.stats["too_long"] > 0


def with_sliding_friction():
    m = zd.Mechanism("block", gravity=(0, 0))
    block = m.body("block", 1.0)
    guide = m.prismatic("guide", m.ground, block, axis=(1, 0))
    seen = []       # by which Python calls the function, and steps do not end at its jump
    m.force("friction", block, along=(1, 0), value=lambda v: seen.append(v) or -2.943 * np.sign(v), of={"v": guide.speed})
    m.start({guide.speed: 2.0})
    return m


@pytest.mark.parametrize("method", ["radau", "dop853"])
def test_an_implicit_method_is_not_advised_to_itself(method):
    block = with_sliding_friction()
    sol = zd.simulate(block, 2.0, rtol=1e-6, atol=1e-9, integrator=method, max_steps=70, on_failure="return")
    assert "max_steps = 70" in sol.message      # before the fiftieth that gets nowhere
    assert ("'radau'" in sol.message) == (method != "radau")
    place = [float(each) for each in re.search(r"between t = (\S+) and ([\d.]+)", sol.message).groups()]
    assert np.allclose(place, 2 / 2.943, atol=1e-4)     # where the block comes to rest


def test_corrections_left_out_are_a_part_of_all_of_them():
    """Steps made in parts have more corrections than there are steps."""
    bar = zd.systems.four_bar(crank_rate=12.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        runs = [zd.simulate(bar, 60 * h, step=h, energy=True, on_failure="return") for h in np.linspace(0.05, 0.15, draws(7, 21))]
    found = [re.match(r"(\d+) of (\d+) energy", str(each.message)) for each in caught if each.category is zd.CorrectionWarning]
    assert found
    assert any(sol.stats["energy_skipped"] + sol.stats["energy_corrections"] > sol.stats["steps"] for sol in runs)
    assert all(int(each[1]) <= int(each[2]) for each in found)
