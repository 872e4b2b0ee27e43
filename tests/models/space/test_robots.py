"""Platforms by their inverse kinematics, the spatial slider-crank by its closed form; and what drives them, by hand."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close, refused


def swung(t, k, amplitude, rate):
    return amplitude * (np.sin(rate * t + k) - np.sin(k))


def test_the_lengths_of_a_stewart_platforms_legs():
    m = zd.models.stewart_platform()
    sol = zd.simulate(m, 1.0, step=5e-3, integrator="dop853", save_every=10)
    R, x, heads = sol["top.rotation"], sol["top.position"], 0.0
    for k in range(6):
        foot, head = m[f"cylinder {k}"].start.drawn, m[f"piston {k}"].end.drawn
        leg = np.linalg.norm(x + R @ (head - (0, 0, 0.8)) - foot, axis=1)
        assert_close(leg, np.linalg.norm(head - foot) + swung(sol.t, k, 0.05, 3.0), 1e-10)
        heads = heads + sol[f"head {k}.force"]
    assert_close(heads, 20.0 * (sol["top.acceleration"] + (0, 0, 9.81)), 1e-8)
    assert np.ptp(x, axis=0).min() > 0.005


def test_a_delta_robot_by_its_inverse_kinematics_and_dynamics():
    """The arms' angles from where the platform is, and the motors' torques from the forces in the forearms."""
    m = zd.models.delta_robot()
    sol = zd.simulate(m, 1.0, step=5e-3, integrator="dop853", save_every=10)
    x, a = sol["platform.position"], sol["platform.acceleration"]
    forearms, angles = np.zeros((len(x), 3, 3)), np.zeros((len(x), 3))
    for k in range(3):
        u = np.array([np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3), 0.0])
        reach = x + (0.05 - 0.2) * u        # from the shoulder to the wrist
        along, down = reach @ u, -reach[:, 2]
        square = (np.einsum("ki,ki->k", reach, reach) + 0.3**2 - 0.8**2) / (2 * 0.3)
        angles[:, k] = np.arctan2(down, along) - np.arccos(square / np.hypot(along, down))
        forearms[:, k] = reach - 0.3 * (np.outer(np.cos(angles[:, k]), u) - np.outer(np.sin(angles[:, k]), (0, 0, 1)))
        assert_close(angles[:, k], 0.6 + swung(sol.t, 2 * np.pi * k / 3, 0.4, 6.0), 1e-9)
    carried = (0.8 + 0.45) * (a + np.array([0, 0, 9.81]))
    held = np.linalg.solve(forearms.transpose(0, 2, 1), carried[:, :, None])[:, :, 0]
    for k in range(3):
        u = np.array([np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3), 0.0])
        turning = -0.3 * (np.outer(np.sin(angles[:, k]), u) + np.outer(np.cos(angles[:, k]), (0, 0, 1)))     # of the elbow
        inertia = 1.0 * 0.3**2 * (1 / 3 + 1 / (16 * 20**2)) + 0.15 * 0.3**2
        rate = -0.4 * 36.0 * np.sin(6.0 * sol.t + 2 * np.pi * k / 3)
        weight = (1.0 * 0.15 + 0.15 * 0.3) * 9.81 * np.cos(angles[:, k])
        load = held[:, k] * np.einsum("ki,ki->k", forearms[:, k], turning)
        assert_close(sol[f"drive {k}.torque"], inertia * rate - weight + load, 1e-7)


def test_the_spatial_slider_crank_by_its_closed_form():
    """Position of the slider, and energy of all bodies from their velocities: together they determine the motion."""
    sol = zd.simulate(zd.models.spatial_slider_crank(), 2.0, step=2e-3, integrator="dop853", save_every=20)
    angle = np.unwrap(sol["hinge.angle"])
    y, z = 0.1 - 0.08 * np.sin(angle), 0.12 + 0.08 * np.cos(angle)
    assert_close(sol["slider.position.x"], np.sqrt(0.09 - y**2 - z**2), 1e-10)
    assert np.ptp(angle) > 2 * np.pi
    energy = 0.0
    for name, mass, J in (("crank", 0.12, (1e-5, 1e-4, 1e-4)), ("rod", 0.5, (4e-4, 4e-3, 4e-3)), ("slider", 2.0, (1e-4,) * 3)):
        own = np.einsum("kij,ki->kj", sol[f"{name}.rotation"], sol[f"{name}.angular_velocity"])
        energy = energy + mass * (0.5 * (sol[f"{name}.center.velocity"]**2).sum(axis=1)
                                  + 9.81 * sol[f"{name}.center.position.z"]) + 0.5 * own**2 @ J
    assert_close(energy, np.full(len(sol.t), energy[0]), 1e-9)


@pytest.mark.parametrize(("model", "wrong", "said"), [
    ("delta_robot", {"forearm_length": 0.3}, "forearm_length must be more than 0.39"),
    ("spatial_slider_crank", {"rod": 0.2}, "rod must be longer than 0.236205 m")])
def test_what_does_not_reach(model, wrong, said):
    with refused("geometry", said):
        getattr(zd.models, model)(**wrong)
