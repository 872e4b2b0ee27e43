"""The cam's follower against its polynomial, and the force between them against Newton's law."""

import numpy as np
import pytest

import known_motions
import zerodrift as zd
from support import refused


@pytest.mark.parametrize("angles", [{}, {"rise": 1.2, "dwell": 0.9, "fall": 2.0}], ids=str)
def test_lift_and_force(angles):
    rise, dwell, fall = (angles.get(name, np.pi / 2) for name in ("rise", "dwell", "fall"))
    sol = zd.simulate(zd.models.cam_follower(**angles), 1.0, step=0.005)
    assert known_motions.cam_follower(sol, **angles) < 1e-11
    lift, bend = known_motions.cam_lift(2 * np.pi * sol.t, 0.0254, rise, dwell, fall)
    force = 0.5 * (9.81 + (2 * np.pi)**2 * bend) + 20.0 + 500.0 * lift
    np.testing.assert_allclose(sol["contact.force"], force, rtol=1e-8)
    assert lift.max() == pytest.approx(0.0254, rel=1e-12)


@pytest.mark.parametrize("wrong", [{"rise": 4.0}, {"fall": 3.2}])
def test_a_cam_of_more_than_a_turn(wrong):
    with refused("out-of-range", r"6\.28319"):
        zd.models.cam_follower(**wrong)
