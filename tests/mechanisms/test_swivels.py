"""Damping, drives and springs of spherical and universal joints, against closed forms and Euler's equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import refused

LAYOUTS = ["joint", "absolute"]


def ball(kind, inertia=(0.5, 0.7, 0.9), first=None, **given):
    """A body about its mass centre."""
    m = zd.Mechanism("ball", dimension=3)
    body = m.body("b", 1.0, inertia)
    getattr(m, kind)("s", m.ground if first is None else first(m), body, at=(0, 0, 0), **given)
    return m


@pytest.mark.parametrize("closed_form", [None, False])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_damped_ball_joint_slows_a_body_down_as_euler_says(layout, closed_form):
    inertia, c, w0 = np.array([0.5, 0.7, 0.9]), 0.3, np.array([1.0, 2.0, -1.5])
    m = ball("spherical", inertia, damping=c)
    m.start({"b.angular_velocity": w0})
    sol = zd.simulate(m.system(layout), 1.0, rtol=1e-11, atol=1e-12, closed_form=closed_form)
    own = solve_ivp(lambda t, w: (-np.cross(w, inertia * w) - c * w) / inertia, (0, 1), w0, rtol=1e-12, atol=1e-13).y[:, -1]
    assert sol["b.rotation"][-1].reshape(3, 3).T @ sol["b.angular_velocity"][-1] == pytest.approx(own, abs=1e-9)
    assert sol["s.torque"] == pytest.approx(-c * sol["b.angular_velocity"], abs=1e-12)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_damped_universal_joint_slows_both_angles_down(layout):
    """Of a body with three equal moments the angles do not act on each other."""
    m, c, t = ball("universal", (0.4, 0.4, 0.4), axes=((1, 0, 0), (0, 0, 1)), damping=0.2), 0.2, 0.8
    m.start({"s.angle1_speed": 2.0, "s.angle2_speed": -3.0})
    sol = zd.simulate(m.system(layout), t, rtol=1e-11, atol=1e-12)
    for angle, speed in (("angle1", 2.0), ("angle2", -3.0)):
        assert sol[f"s.{angle}_speed"][-1] == pytest.approx(speed * np.exp(-c / 0.4 * t), abs=1e-9)


@pytest.mark.parametrize("kind", ["spherical", "universal"])
def test_damping_between_moving_bodies_keeps_their_angular_momentum(kind):
    m = zd.Mechanism("two", dimension=3)
    a, b = m.body("a", 2.0, (1.0, 2.0, 1.5)), m.body("b", 1.0, (0.5, 0.8, 0.7), at=(1, 0, 0))
    axes = {} if kind == "spherical" else {"axes": ((1, 0, 0), (0, 1, 0))}
    getattr(m, kind)("s", a, b, at=(0.5, 0.1, 0), damping=0.7, **axes)
    apart = {"b.angular_velocity": (0.0, 1.0, 0.5)} if kind == "spherical" else {"s.angle1_speed": 1.0, "s.angle2_speed": -2.0}
    m.start({"a.angular_velocity": (1.0, -0.5, 2.0), "a.velocity": (0.0, 0.0, 0.0), **apart})
    sol = zd.simulate(m, 1.0, rtol=1e-11, atol=1e-12)

    def momentum(k):
        L = np.zeros(3)
        for name, mass, inertia in (("a", 2.0, (1.0, 2.0, 1.5)), ("b", 1.0, (0.5, 0.8, 0.7))):
            R = sol[f"{name}.rotation"][k].reshape(3, 3)
            L += R @ (np.array(inertia) * (R.T @ sol[f"{name}.angular_velocity"][k]))
            L += mass * np.cross(sol[f"{name}.position"][k], sol[f"{name}.velocity"][k])
        return L

    apart = sol["b.angular_velocity"] - sol["a.angular_velocity"]
    assert momentum(-1) == pytest.approx(momentum(0), abs=1e-9)
    assert np.linalg.norm(apart[-1]) < 0.9 * np.linalg.norm(apart[0])
    if kind == "spherical":
        assert sol["s.torque"] == pytest.approx(-0.7 * apart, abs=1e-12)


def test_its_damping_is_a_parameter_and_is_saved(tmp_path):
    m = ball("spherical", damping=0.3)
    m.start({"b.angular_velocity": (0, 0, 1.0)})
    again = zd.load(m.save(tmp_path / "m"))
    assert again["s"].damping == 0.3
    system = again.system().with_parameters({"s.damping": 0.9})
    assert zd.simulate(system, 1.0, rtol=1e-11)["b.angular_velocity.z"][-1] == pytest.approx(np.exp(-1.0), abs=1e-9)


def test_a_particle_has_no_damping_at_a_ball_joint():
    m = zd.Mechanism("string", dimension=3)
    with refused("wrong-element", "damping of 's'"):
        m.spherical("s", m.body("b", 1.0, (1, 1, 1)).point((1, 0, 0)), m.particle("p", 1.0, at=(1, 0, 0)), damping=1.0)
