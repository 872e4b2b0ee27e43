"""The pantograph against the exact scaling, and its bars against circles."""

import numpy as np
import pytest

import zerodrift as zd
from circles import complex_of, crossing


@pytest.mark.parametrize("ratio", [2.0, 3.5])
def test_the_pen_draws_the_figure_larger(ratio):
    sol = zd.simulate(zd.models.pantograph(ratio=ratio), 1.0, step=0.01)
    Q = 0.2 + 0.05 * np.sin(2 * np.pi * sol.t) + 1j * (0.12 + 0.025 * np.sin(4 * np.pi * sol.t))
    A = crossing(0, Q, 0.2, 0.2, 1)
    for name, expected in {"Q": Q, "A": A, "B": ratio * A, "C": Q + (ratio - 1) * A, "P": ratio * Q}.items():
        assert np.abs(complex_of(sol, name) - expected).max() < 1e-12, name


@pytest.mark.parametrize(("wrong", "message"), [
    ({"ratio": 1.0}, "ratio must be greater than 1, not 1"),
    ({"size": 0.07}, r"size must be from 0 to less than a third of the arm, 0\.066\d*, not 0\.07")])
def test_wrong_pantographs(wrong, message):
    with pytest.raises(ValueError, match=message):
        zd.models.pantograph(**wrong)
