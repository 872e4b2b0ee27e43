"""The pantograph against the exact scaling, and its bars against circles."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize("ratio", [2.0, 3.5])
def test_the_pen_draws_the_figure_larger(ratio):
    sol = zd.simulate(zd.models.pantograph(ratio=ratio), 1.0, step=0.01)
    assert known_motions.pantograph(sol, ratio) < 1e-11
    assert np.ptp(sol["P.position"], axis=0) == pytest.approx((0.1 * ratio, 0.05 * ratio), rel=5e-3)


@pytest.mark.parametrize(("wrong", "code", "message"), [
    ({"ratio": 1.0}, "out-of-range", "ratio.*than 1, not 1"),
    ({"size": 0.07}, "geometry", r"size must be from 0 to less than a third of the arm, 0\.066\d*, not 0\.07")])
def test_wrong_pantographs(wrong, code, message):
    with refused(code, message):
        zd.models.pantograph(**wrong)
