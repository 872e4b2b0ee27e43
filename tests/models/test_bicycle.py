"""The bicycle, from bodies and joints and from its energies, against equations by hand."""

import numpy as np
import pytest
import scipy.integrate

import energy_models
import known_motions
import zerodrift as zd
from support import assert_close


def bicycle_by_hand(system, t_eval):
    """Its motion by two equations of balance for the speed u along the frame and the rate of steer, with yaw' = u tan(steer) / w.

    For u: (m + m_f) u' + (m b^2 + J + m_f w^2) k yaw'' + J_f k (yaw'' + steer'') = F, with k = tan(steer) / w.
    For steer: J_f (yaw'' + steer'') = torque.
    """
    q = system.parameters

    def rate(t, y):
        _, _, yaw, steer, u, steer_rate = y
        k, slope = np.tan(steer) / q["wheelbase"], 1 / (np.cos(steer)**2 * q["wheelbase"])
        torque = -q["stiffness"] * (steer - q["amplitude"] * np.sin(q["frequency"] * t)) - q["damping"] * steer_rate
        turning = q["mass"] * q["centre"]**2 + q["inertia"] + q["fork_mass"] * q["wheelbase"]**2
        along = q["mass"] + q["fork_mass"] + turning * k**2
        u_rate = (q["thrust"] - turning * k * u * slope * steer_rate - k * torque) / along
        yaw_rate_rate = u_rate * k + u * slope * steer_rate
        return [u * np.cos(yaw), u * np.sin(yaw), u * k, steer_rate, u_rate, torque / q["fork_inertia"] - yaw_rate_rate]

    start = [*system.p0, system.v0[0], 0.0]
    return scipy.integrate.solve_ivp(rate, (0, t_eval[-1]), start, method="DOP853", rtol=1e-12, atol=1e-12, t_eval=t_eval).y.T


@pytest.mark.parametrize("given", [{}, {"thrust": 60.0, "damping": 0.0, "frequency": 4.0, "speed": 2.0}], ids=str)
def test_bicycle_against_equations_by_hand(given, formulation):
    system = energy_models.bicycle(**given)
    sol = zd.simulate(system, 10.0, step=0.0025, save_every=100, formulation=formulation)
    expected = bicycle_by_hand(system, sol.t)
    assert_close(sol.p, expected[:, :4], 1e-8)
    assert_close(np.hypot(*sol.v[:, :2].T), expected[:, 4], 1e-8)
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-7 * sol.kinetic_energy.max()


@pytest.mark.parametrize("given", [{}, {"thrust": 60.0, "damping": 0.0, "frequency": 4.0, "speed": 2.0}], ids=str)
def test_bodies_and_joints_against_equations_by_hand(given):
    sol = zd.simulate(zd.models.bicycle(**given), 5.0, step=0.02, integrator="dop853", save_every=10)
    expected = bicycle_by_hand(energy_models.bicycle(**given), sol.t)
    found = np.column_stack([sol["frame.position"], sol["frame.angle"], sol["head.angle"]])
    assert_close(found, expected[:, :4], 1e-9)
    assert bool(given) or known_motions.bicycle(sol) < 1e-9
    assert np.abs(sol.velocity_violation).max() <= 1e-12


def test_a_bicycle_whose_handlebar_is_let_go_keeps_its_energy():
    system = energy_models.bicycle(amplitude=0.0, damping=0.0)
    sol = zd.simulate(system, 10.0, [0.0, 0.0, 0.0, 0.3], [3.0, 0.0, 3.0 * np.tan(0.3) / 1.1, 0.0], step=0.002)
    total = sol.kinetic_energy + sol.potential_energy
    assert_close(total, np.full(len(total), total[0]), 1e-7)
    assert np.ptp(sol.potential_energy) > 0.1
