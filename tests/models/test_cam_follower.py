"""The cam's follower against its polynomial, and the force between them against Newton's law."""

import numpy as np
import pytest

import zerodrift as zd


def by_polynomial(angle, lift, rise, dwell, fall):
    """Lift and its second derivative at angles within a turn, by NumPy's polynomials."""
    up = np.polynomial.Polynomial([0, 0, 0, 0, 35, -84, 70, -20])
    begin = (2 * np.pi - rise - dwell - fall) / 2
    x, y = (angle - begin) / rise, (begin + rise + dwell + fall - angle) / fall
    where = [(x > 0) & (x < 1), (x >= 1) & (y >= 1), (y > 0) & (y < 1)]
    values = [np.select(where, parts) for parts in (
        [up(x), np.ones_like(x), up(y)], [up.deriv(2)(x) / rise**2, np.zeros_like(x), up.deriv(2)(y) / fall**2])]
    return lift * values[0], lift * values[1]


@pytest.mark.parametrize("angles", [{}, {"rise": 1.2, "dwell": 0.9, "fall": 2.0}], ids=str)
def test_lift_and_force(angles):
    rise, dwell, fall = (angles.get(name, np.pi / 2) for name in ("rise", "dwell", "fall"))
    sol = zd.simulate(zd.models.cam_follower(**angles), 1.0, step=0.005)
    lift, bend = by_polynomial(2 * np.pi * sol.t, 0.0254, rise, dwell, fall)
    np.testing.assert_allclose(sol["guide.displacement"], lift, atol=1e-12)
    force = 0.5 * (9.81 + (2 * np.pi)**2 * bend) + 20.0 + 500.0 * lift
    np.testing.assert_allclose(sol["contact.force"], force, rtol=1e-8)
    assert lift.max() == pytest.approx(0.0254, rel=1e-12)


@pytest.mark.parametrize("wrong", [{"rise": 4.0}, {"fall": 3.2}])
def test_a_cam_of_more_than_a_turn(wrong):
    with pytest.raises(ValueError, match=r"rise, dwell and fall must be less than a turn together, 6\.28319, not"):
        zd.models.cam_follower(**wrong)
