"""The paper's four-bar from bodies and joints against the built-in one, and against the certified motion of the paper's data."""

import numpy as np
import pytest

import zerodrift as zd
from circles import complex_of, four_bar_by_circles
from support import assert_close


def test_four_bar_is_the_built_in_one():
    sols = [zd.simulate(bar, 4.0, step=0.01, save_every=20, integrator="dop853")
            for bar in (zd.models.four_bar(), zd.systems.four_bar())]
    angles = [[sols[0][f"{link}.angle"] for link in ("crank", "coupler", "rocker")], list(sols[1].p.T)]
    assert_close(np.sin(angles[0]), np.sin(angles[1]), 1e-8)        # the built-in one counts a turn of the rocker otherwise
    assert_close(sols[0].kinetic_energy, sols[1].kinetic_energy, 1e-8)
    C = four_bar_by_circles(sols[0]["crank.angle"], (1.0, 0.3, 1.0, 0.6), 1)[1]
    assert_close(complex_of(sols[0], "rocker.start"), C, 1e-11)


def test_lengths_that_make_no_four_bar():
    with pytest.raises(zd.CorrectionFailed, match="stays open"):
        zd.simulate(zd.models.four_bar(lengths=(4.0, 0.3, 1.0, 0.6)), 1.0, step=0.01)
    with pytest.raises(ValueError, match=r"lengths\[1\] must be greater than 0, not 0"):
        zd.models.four_bar(lengths=(1.0, 0.0, 1.0, 0.6))
