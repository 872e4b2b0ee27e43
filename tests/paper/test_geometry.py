"""Figures 1-3: what they draw is what the core computes, and has the properties that their titles state."""

import matplotlib
import numpy as np
import pytest

from zerodrift import project
from zerodrift.paper import geometry

matplotlib.use("Agg")

P, V = np.array([0.5, -1.2]), np.array([0.75, -0.05])


def arrows(ax):
    """Start and end of each arrow, (k, 2, 2)."""
    return np.array([(each.xyann, each.xy) for each in ax.texts if getattr(each, "arrow_patch", None)])


def test_numerical_solutions_leave_the_manifold_in_dependent_coordinates_only():
    for ax, violated in zip(geometry.figure_1().axes, (True, False), strict=True):
        numerical = next(line for line in ax.lines if line.get_label() == "numerical solution").get_xydata()
        exact = next(line for line in ax.lines if line.get_label() == "exact motion").get_xydata()
        assert (abs(np.hypot(*numerical.T) - 1).max() > 0.1) == violated
        assert np.hypot(*exact.T) == pytest.approx(np.ones(len(exact)), abs=1e-12)
        assert np.hypot(*(numerical[-1] - exact[-1])) > 0.1


def test_corrections_are_orthogonal():
    before, after = geometry.figure_2(P, V).axes
    start, end = arrows(before)[1]          # Δp
    assert (start == P).all()
    assert np.hypot(*end) == pytest.approx(1, abs=1e-12)
    assert np.cross([*(end - start), 0], [*end, 0])[2] == pytest.approx(0, abs=1e-12)     # along the gradient there
    (at, _), (_, velocity_end), (uncorrected, _) = arrows(after)
    assert at @ (velocity_end - at) == pytest.approx(0, abs=1e-12)                       # in the tangent
    assert (velocity_end - uncorrected) @ (velocity_end - at) == pytest.approx(0, abs=1e-12)


def test_energy_correction_keeps_the_direction_and_takes_the_share_of_the_kinetic_energy():
    (start, end), (_, required) = arrows(geometry.figure_3(P, V, share=0.25).axes[0])
    p, v = project(geometry.PENDULUM, P, V)
    np.testing.assert_allclose(start, p)
    np.testing.assert_allclose(end - start, v, atol=1e-12)
    np.testing.assert_allclose(required - start, v / 2, atol=1e-12)
