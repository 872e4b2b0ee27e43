"""Hooke's joint, the shaft with two of them, and Bennett's linkage, against what tangents say."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close
from zerodrift.mechanisms.elements.numbers import AS_GIVEN


def test_hookes_joint_by_its_tangents():
    bend = 0.7
    sol = zd.simulate(zd.models.hookes_joint(bend=bend, load=5.0), 1.0, step=1e-3, integrator="dop853", save_every=10)
    a, b = 10.0 * sol.t, sol["bearing out.angle"]
    assert_close(np.sin(b) * np.cos(a), np.sin(a) * np.cos(b) * np.cos(bend), 1e-10, scale=1.0)
    speed = 10.0 * np.cos(bend) / (np.cos(a)**2 + np.cos(bend)**2 * np.sin(a)**2)
    assert_close(sol["bearing out.angle_speed"], speed, 1e-9)
    put_in = sol["drive.torque"] * 10.0
    kinetic = 0.5 * shaft_inertia(zd.models.hookes_joint()) * speed**2
    assert_close(np.gradient(kinetic, sol.t)[1:-1], (put_in - 5.0 * speed)[1:-1], 2e-2)      # of differences


def shaft_inertia(m):
    return m["output"].properties(AS_GIVEN).inertia[0, 0]


@pytest.mark.parametrize("given", [{}, {"bend": 0.4, "last_bend": 0.4}])
def test_two_joints_hand_on_an_even_speed(given):
    sol = zd.simulate(zd.models.double_cardan(**given), 1.0, step=2e-3, integrator="dop853")
    assert_close(sol["bearing out.angle_speed"], np.full(len(sol.t), 10.0), 1e-9)
    assert np.ptp(sol["middle.angular_velocity"], axis=0).max() > 0.5


def test_two_joints_of_different_bends_and_one_with_a_phase():
    sol = zd.simulate(zd.models.double_cardan(bend=0.3, last_bend=0.6), 1.0, step=2e-3, integrator="dop853")
    a, b = 10.0 * sol.t, sol["bearing out.angle"]
    ratio = np.cos(0.3) / np.cos(0.6)       # of the tangents
    assert_close(np.sin(b) * np.cos(a), ratio * np.sin(a) * np.cos(b), 1e-9, scale=1.0)
    sol = zd.simulate(zd.models.double_cardan(phase=np.pi / 2), 1.0, step=2e-3)
    speed = sol["bearing out.angle_speed"]
    assert speed.max() == pytest.approx(10.0 / np.cos(0.5)**2, rel=1e-3)        # unevenness squared


@pytest.mark.parametrize("given", [{}, {"first_twist": 1.2, "second_twist": 0.7, "angle": 2.0}])
def test_bennetts_relation(given):
    """And it is held by rows of which three are redundant."""
    m = zd.models.bennett(**given)
    angle, (alpha, beta) = given.get("angle", 1.0), (given.get("first_twist", 0.5), given.get("second_twist", 1.1))
    assert "3 of 20 constraints are redundant" in str(m)
    sol = zd.simulate(m, 1.0, step=2e-3, integrator="dop853", on_singular="continue")
    constant = np.sin((beta + alpha) / 2) / np.sin((beta - alpha) / 2)
    theta = angle + np.unwrap(sol["B.angle"])
    phi = 2 * np.arctan2(constant, np.tan(angle / 2)) + np.unwrap(sol["A.angle"])
    assert_close(np.sin(theta / 2) * np.sin(phi / 2), constant * np.cos(theta / 2) * np.cos(phi / 2), 1e-9, scale=1.0)
    assert np.ptp(theta) > 0.5
    assert np.abs(sol.energy_violation).max() < 1e-9
