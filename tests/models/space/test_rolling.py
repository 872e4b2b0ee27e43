"""Discs against their steady motions, and the rattleback against Newton's and Euler's equations by hand."""

import numpy as np
import pytest
import scipy.integrate

import zerodrift as zd
from support import assert_close, refused
from zerodrift.mechanisms.elements.frames import about

EXACT = {"integrator": "dop853", "step": None, "rtol": 1e-11, "atol": 1e-12}


@pytest.mark.parametrize(("lean", "turning"), [(0.4, 2.0), (-0.7, 3.0), (0.3, -4.0)])
def test_the_steady_motion_of_a_disc(lean, turning):
    """Its centre goes round a circle; what holds it there is its contact's force."""
    sol = zd.simulate(zd.models.rolling_disc(lean=lean, turning=turning), 2.0, t_eval=np.linspace(0, 2, 21), **EXACT)
    x, v = sol["disc.position"], sol["disc.velocity"]
    spin = np.einsum("ki,ki->k", sol["disc.rotation"][:, :, 0], sol["disc.angular_velocity"])
    assert_close(x[:, 2], np.full(len(x), 0.5 * np.cos(lean)), 1e-9)
    assert_close(spin, np.full(len(x), spin[0]), 1e-9)
    heading = np.unwrap(np.arctan2(v[:, 1], v[:, 0]))
    assert_close(heading - heading[0], turning * sol.t, 1e-8)
    assert_close(np.linalg.norm(v, axis=1), np.full(len(x), 0.5 * abs(spin[0])), 1e-9)
    assert_close(np.linalg.norm(sol["floor.force"][:, :2], axis=1), np.full(len(x), 0.5 * abs(spin[0] * turning)), 1e-8)
    assert_close(sol["floor.force"][:, 2], np.full(len(x), 9.81), 1e-8)


def test_a_disc_that_is_nudged_does_not_stay():
    sol = zd.simulate(zd.models.rolling_disc(nudge=0.2), 1.0, step=5e-3)
    assert np.ptp(sol["disc.position.z"]) > 0.01
    assert sol["disc.velocity.z"][0] < 0


@pytest.mark.parametrize("incline", [0.1, 0.8])
def test_a_coin_whirs(incline):
    """Its contact goes round at the rate of Moffatt's formula, and its centre rests."""
    sol = zd.simulate(zd.models.coin(incline=incline), 0.05, t_eval=np.linspace(0, 0.05, 101), **EXACT)
    axle = sol["coin.rotation"][:, :, 2]
    heading = np.unwrap(np.arctan2(axle[:, 1], axle[:, 0]))
    rate = np.sqrt(4 * 9.81 / (0.012 * np.sin(incline)))
    assert_close(np.abs(heading - heading[0]), rate * sol.t, 1e-7)
    assert_close(sol["coin.position"], np.tile([0, 0, 0.012 * np.sin(incline)], (101, 1)), 1e-9, scale=0.01)


def test_a_coin_that_is_damped_sinks_and_whirs_faster():
    sol = zd.simulate(zd.models.coin(damping=4e-7), 0.3, step=2e-4)
    axle = sol["coin.rotation"][:, :, 2]
    rate = np.gradient(np.unwrap(np.arctan2(axle[:, 1], axle[:, 0])), sol.t)
    assert sol["coin.position.z"][-1] < 0.9 * sol["coin.position.z"][0]
    assert abs(rate[-100:].mean()) > 1.05 * abs(rate[:100].mean())


def stone_by_hand(spin, t_eval):
    """The body's axes, its angular velocity there and its centre: no force but the contact's, eliminated by hand."""
    semiaxes, J, low = np.array([0.2, 0.03, 0.02]), np.array([[2e-4, -2e-5, 0], [-2e-5, 1.6e-3, 0], [0, 0, 1.7e-3]]), 0.01
    tilt = 0.5 * np.pi / 180
    start = (about((1, 0, 0), tilt) @ about((0, 1, 0), tilt)).T

    def arm(n):     # from the centre of mass to the contact, in the body's axes, with n the vertical there
        return -semiaxes**2 * n / np.linalg.norm(semiaxes * n) + (0, 0, low)

    def arm_rate(n, n_rate):
        size = np.linalg.norm(semiaxes * n)
        return -semiaxes**2 * n_rate / size + semiaxes**2 * n * ((semiaxes**2 * n) @ n_rate) / size**3

    def change(t, y):
        R, w = y[:9].reshape(3, 3), y[9:]       # rows: the body's axes in the drawing
        n = R[:, 2]
        n_rate = np.cross(n, w)
        r, r_rate = arm(n), arm_rate(n, n_rate)
        # v = -w x r, F = v' + w x v + g n, J w' + w x J w = r x F, of mass 1
        cross = np.array([np.cross(axis, r) for axis in np.eye(3)]).T       # w' x r
        known = -np.cross(w, r_rate) - np.cross(w, np.cross(w, r)) + 9.81 * n
        turned = np.array([np.cross(r, column) for column in cross.T]).T
        rate = np.linalg.solve(J + turned, np.cross(r, known) - np.cross(w, J @ w))
        return np.concatenate([np.cross(R, w, axis=0).ravel(), rate])

    first = np.concatenate([start.ravel(), start @ (0, 0, spin)])
    y = scipy.integrate.solve_ivp(change, (0, t_eval[-1]), first, method="DOP853", rtol=1e-9, atol=1e-10, t_eval=t_eval).y.T
    return np.einsum("kij,ki->kj", y[:, :9].reshape(-1, 3, 3), y[:, 9:])


def test_the_rattleback_as_by_hand_and_turns_round():
    t = np.linspace(0, 0.1, 3)
    sol = zd.simulate(zd.models.rattleback(), 0.1, t_eval=t, **EXACT)
    assert_close(sol["stone.angular_velocity"], stone_by_hand(-5.0, t), 1e-6)
    sol = zd.simulate(zd.models.rattleback(), 6.0, step=1e-3, save_every=100)
    assert np.abs(sol.energy_violation).max() < 1e-3 * sol.kinetic_energy[0]
    spin = sol["stone.angular_velocity.z"]
    assert spin[0] == pytest.approx(-5.0)
    assert spin[-1] > 4.0
    liked = zd.simulate(zd.models.rattleback(spin=5.0), 6.0, step=2e-3, save_every=100)
    assert liked["stone.angular_velocity.z"].min() > 3.0


@pytest.mark.parametrize(("model", "wrong", "code", "said"), [
    ("rolling_disc", {"lean": 1.6}, "out-of-range", "^lean must"),
    ("rolling_disc", {"turning": 0.0}, "missing-argument", "^spin must.*is 0"),
    ("hookes_joint", {"bend": 1.6}, "out-of-range", "^bend must"),
    ("double_cardan", {"last_bend": -1.6}, "out-of-range", "last_bend"),
    ("bennett", {"second_twist": 0.5}, "geometry", None), ("bennett", {"angle": 0.0}, "geometry", "neither 0"),
    ("coin", {"incline": 0.0}, "out-of-range", "incline.*than 0"),
    ("coin", {"gravity": -1.0}, "out-of-range", "gravity.*least 0")])
def test_what_does_not_roll_or_turn(model, wrong, code, said):
    with refused(code, said):
        getattr(zd.models, model)(**wrong)
