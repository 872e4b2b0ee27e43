"""The heavy top against its reference, and the gyroscope in gimbals against an equation for its incline by hand."""

import numpy as np
import pytest
import scipy.integrate

import zerodrift as zd
from reference_files import table
from support import assert_close, refused

EXACT = {"integrator": "dop853", "step": None, "rtol": 1e-12, "atol": 1e-12}


def test_the_heavy_top_of_its_reference():
    reference = {name: column[:21] for name, column in table("heavy_top").items()}
    sol = zd.simulate(zd.models.heavy_top(), reference["t"][-1], t_eval=reference["t"], **EXACT)
    for axis in "xyz":
        assert_close(sol[f"top.center.position.{axis}"], reference[axis], 1e-10, scale=1.0)


def gimbals_by_hand(theta, rate, spin, precession, t_eval):
    """Incline and precession by Lagrange's equation for the incline, and by both angular momenta that stay."""
    C, A, B, outer, weight, arm = 2e-3, 1.2e-3, 4e-4, 1e-3, 0.2, 0.15
    across = A + B + weight * arm**2

    def inertia(theta):     # about the vertical, without the rotor's axial part
        return outer + B * np.cos(theta)**2 + across * np.sin(theta)**2

    axial = C * (spin + precession * np.cos(theta))
    vertical = inertia(theta) * precession + axial * np.cos(theta)

    def turning(theta):
        return (vertical - axial * np.cos(theta)) / inertia(theta)

    def change(t, y):
        theta, rate = y
        w = turning(theta)
        moment = (across - B) * np.sin(theta) * np.cos(theta) * w**2 - axial * w * np.sin(theta)
        return [rate, (moment + weight * 9.81 * arm * np.sin(theta)) / across]

    y = scipy.integrate.solve_ivp(change, (0, t_eval[-1]), [theta, rate], method="DOP853", rtol=1e-12, atol=1e-12,
                                  t_eval=t_eval).y
    return y[0], turning(y[0])


@pytest.mark.parametrize("rate", [0.0, 3.0])
def test_the_gyroscope_in_its_gimbals(rate):
    """In steady precession, and where it nods."""
    m = zd.models.gyroscope()
    m.start({"trunnion.speed": -rate})      # the incline grows the other way
    sol = zd.simulate(m, 0.5, t_eval=np.linspace(0, 0.5, 21), **EXACT)
    theta, turning = gimbals_by_hand(1.0, rate, 200.0, sol["pivot.speed"][0], sol.t)
    assert_close(1.0 - sol["trunnion.angle"], theta, 1e-9)
    assert_close(sol["pivot.speed"], turning, 1e-8)
    assert (np.ptp(turning) < 1e-9) == (rate == 0)


def test_a_rotor_that_is_too_slow():
    with refused("out-of-range", "^spin must"):
        zd.models.gyroscope(incline=0.1, spin=1.0)
