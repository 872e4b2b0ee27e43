"""Rotors of motors against closed forms, and the angular momentum of their energy."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused

LAYOUTS = ["joint", "absolute"]
J, N, TORQUE = 0.02, 10.0, 1.5


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("ratio", [N, -N])
def test_an_arm_on_an_arm_with_a_geared_rotor_in_closed_form(dimension, layout, ratio):
    """The second arm turns about its mass centre, so that all is linear: M (theta, q)'' = (0, torque)."""
    flat, axis = (slice(dimension),), {} if dimension == 2 else {"axis": (0, 0, 1)}
    m = zd.Mechanism("arms", dimension=dimension)
    arms = [m.body(name, mass, inertia if dimension == 2 else (inertia,) * 3, at=(x, 0, 0)[flat[0]])
            for name, mass, inertia, x in (("a", 1.0, 0.5, 0.0), ("b", 2.0, 0.4, 1.0))]
    m.revolute("base", m.ground, arms[0], at=(0, 0, 0)[flat[0]], **axis)
    elbow = m.revolute("elbow", *arms, at=(1, 0, 0)[flat[0]], **axis)
    m.motor("drive", elbow, torque=TORQUE, rotor=J, ratio=ratio)
    sol = zd.simulate(m.system(layout), 0.8, rtol=1e-11, atol=1e-12)
    M = np.array([[0.5 + 0.4 + 2.0 + J, 0.4 + ratio * J], [0.4 + ratio * J, 0.4 + ratio**2 * J]])
    expected = np.linalg.solve(M, [0, TORQUE]) * 0.8**2 / 2
    assert [sol["base.angle"][-1], sol["elbow.angle"][-1]] == pytest.approx(expected, abs=1e-8)
    assert sol["drive shaft.angle"][-1] == pytest.approx(ratio * expected[1], abs=1e-7)


def test_a_rotor_of_a_displacement_adds_its_inertia_times_the_square_of_its_ratio():
    m = zd.Mechanism("screw drive", dimension=3)
    cart = m.body("cart", 2.0, (0.1, 0.1, 0.1))
    track = m.prismatic("track", m.ground, cart, axis=(1, 2, 0))
    m.motor("drive", track, force=3.0, rotor=0.01, ratio=40.0)
    sol = zd.simulate(m, 0.5, rtol=1e-11, atol=1e-12)
    assert sol["track.displacement"][-1] == pytest.approx(3 / (2 + 0.01 * 40**2) * 0.5**2 / 2, abs=1e-10)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_momentum_of_a_rotor_is_about_its_axis_alone(layout):
    """Two free bodies and a motor between them in space: angular momentum by the energy that the rotor adds."""
    I1, I2, a = np.array([0.5, 0.7, 0.9]), np.array([0.2, 0.3, 0.25]), np.array([0.6, 0.0, 0.8])
    m = zd.Mechanism("satellite", dimension=3)
    hull, wheel = m.body("hull", 3.0, I1), m.body("wheel", 1.0, I2, at=(0.3, 0.1, 0.2))
    hinge = m.revolute("hinge", hull, wheel, at=(0.3, 0.1, 0.2), axis=a)
    m.motor("drive", hinge, torque=lambda t: 0.3 * np.cos(t), rotor=J, ratio=N)
    m.start({"hull.angular_velocity": (0.4, 0.6, -0.3), "hinge.speed": 1.0, "hull.velocity": (0, 0, 0)})
    sol = zd.simulate(m.system(layout), 1.0, rtol=1e-11, atol=1e-12)

    def momentum(k):
        R1, R2 = (sol[f"{name}.rotation"][k].reshape(3, 3) for name in ("hull", "wheel"))
        w1, w2 = (sol[f"{name}.angular_velocity"][k] for name in ("hull", "wheel"))
        axis = R1 @ a
        L = R1 @ (I1 * (R1.T @ w1)) + R2 @ (I2 * (R2.T @ w2)) + J * (axis @ w1 + N * sol["hinge.speed"][k]) * axis
        return L + sum(mass * np.cross(sol[f"{name}.position"][k], sol[f"{name}.velocity"][k])
                       for name, mass in (("hull", 3.0), ("wheel", 1.0)))

    assert momentum(-1) == pytest.approx(momentum(0), abs=1e-8)
    assert abs(sol["hinge.angle"][-1]) > 0.1


def test_rotors_are_saved_and_refused_where_there_is_no_axis(tmp_path):
    m = zd.Mechanism("wheel", dimension=3)
    pin = m.revolute("pin", m.ground, m.body("wheel", 1.0, (0.1, 0.1, 0.1)), at=(0, 0, 0), axis=(0, 1, 0))
    m.motor("drive", pin, torque=1.0, rotor=0.01, ratio=3.0)
    end = zd.simulate(zd.load(m.save(tmp_path / "m")), 1.0, rtol=1e-10)["pin.speed"][-1]
    assert end == pytest.approx(1 / (0.1 + 0.01 * 9), abs=1e-8)
    flat = zd.Mechanism("flat")
    track = flat.prismatic("track", flat.ground, flat.body("cart", 1.0, 0.1), axis=(1, 0))
    with refused("wrong-element", "rotor of motor 'drive'"):
        flat.motor("drive", track, force=1.0, rotor=0.1)
    with refused("out-of-range", "ratio of motor 'idle'"):
        m.motor("idle", pin, torque=1.0, rotor=0.01, ratio=0.0)
    assert "idle rotor" not in m._elements
    with refused("inertia", "one axis|largest moment"):
        m.body("thin", 1.0, (0.0, 0.0, 1.0))
