"""The scissor lift against its height by the sine, and the roller's force by virtual work."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize("stages", [1, 4])
def test_height_and_force(stages):
    """Arms without mass; the roller's force is n m (g + y'') / tan(angle), inwards."""
    lift = zd.models.scissor_lift(stages, arm=1.2, mass=0.0)
    sol = zd.simulate(lift, 2.0, step=0.01, formulation="augmented")
    assert known_motions.scissor_lift(sol, stages, arm=1.2) < 1e-10
    angle = np.arccos((1.2 * np.cos(0.6) + 0.1 * np.sin(np.pi * sol.t)) / 1.2)
    foot_rate, foot_acceleration = 0.1 * np.pi * np.cos(np.pi * sol.t), -0.1 * np.pi**2 * np.sin(np.pi * sol.t)
    rate = -foot_rate / (1.2 * np.sin(angle))
    acceleration = (-foot_acceleration - 1.2 * np.cos(angle) * rate**2) / (1.2 * np.sin(angle))
    rise = 1.2 * stages * (np.cos(angle) * acceleration - np.sin(angle) * rate**2)
    np.testing.assert_allclose(sol["drive.force"], -stages * 110.0 * (9.81 + rise) / np.tan(angle), rtol=1e-9)


@pytest.mark.parametrize("wrong", [{"angle": 0.0}, {"angle": 1.6}, {"amplitude": 0.2}, {"amplitude": -0.2}])
def test_a_roller_that_would_go_too_far(wrong):
    with refused("geometry", r"amplitude must be less than 0(\.\d+)? m with arms of 1 m at an angle of"):
        zd.models.scissor_lift(**wrong)
