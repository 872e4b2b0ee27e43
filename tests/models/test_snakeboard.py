"""The snakeboard against the balance of its nonholonomic momentum by hand."""

import numpy as np
import pytest
import scipy.integrate

import zerodrift as zd


def by_hand(t_eval, wheel_rate):
    """Board's x, y, yaw and speed u along itself.

    With the axles at s and -s, the middle goes along the board and yaw' = u tan(s) / l. Along that motion,
    m u' + tan(s) / l (J yaw'' + J_r r'') = 0, where J is of all together and r the rotor's angle: the axles' moments cancel.
    """
    half, total, rotor = 0.2, 0.016 + 0.072 + 2 * 0.0013, 0.072

    def rate(t, y):
        _, _, yaw, u = y
        s, s_rate = 0.3 * np.sin(wheel_rate * t), 0.3 * wheel_rate * np.cos(wheel_rate * t)
        k, k_rate = np.tan(s) / half, s_rate / (half * np.cos(s)**2)
        u_rate = -k * (total * u * k_rate - rotor * 0.7 * np.sin(t)) / (6.0 + total * k**2)
        return [u * np.cos(yaw), u * np.sin(yaw), u * k, u_rate]

    return scipy.integrate.solve_ivp(rate, (0, t_eval[-1]), [0.0] * 4, method="DOP853", rtol=1e-12, atol=1e-14, t_eval=t_eval).y


@pytest.mark.parametrize("wheel_rate", [1.0, 2.0])
def test_it_goes_as_its_momentum_has_it(wheel_rate):
    sol = zd.simulate(zd.models.snakeboard(wheel_rate=wheel_rate), 6.0, step=0.05, integrator="dop853")
    x, y, yaw, u = by_hand(sol.t, wheel_rate)
    np.testing.assert_allclose(sol["board.position"], np.stack([x, y], axis=1), atol=1e-10)
    np.testing.assert_allclose(sol["board.angle"], yaw, atol=1e-10)
    np.testing.assert_allclose(np.hypot(*sol["board.velocity"].T), np.abs(u), atol=1e-10)
    assert np.abs(sol.velocity_violation).max() < 1e-12


def test_axles_across_the_board():
    with pytest.raises(ValueError, match=r"wheel_swing must be between -1\.5 and 1\.5, .*, not 1\.6"):
        zd.models.snakeboard(wheel_swing=1.6)
