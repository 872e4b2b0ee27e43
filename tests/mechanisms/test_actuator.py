"""Actuators between two points: against the geometry of a triangle, the balance of power, and springs of the same force."""

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from support import assert_close, refused

t = sp.Symbol("t")
LAYOUTS = ["joint", "absolute"]


def digger(**drive):
    """An arm of 2 m on a hinge, with a cylinder from 1 m below the hinge to its middle."""
    m, ends = hinged()
    m.actuator("cylinder", *ends, **drive)
    return m


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("length", [lambda t: 1.5 + 0.1 * np.sin(3 * t), 1.5 + sp.sin(3 * t) / 10], ids=["callable", "sympy"])
def test_a_prescribed_length_moves_the_arm_as_the_triangle_says(layout, length):
    """L^2 = 2 + 2 sin(angle); and work is done on nothing but the arm, T' + V' = P."""
    sol = zd.simulate(digger(length=length).system(layout), 1.0, step=1e-3)
    expected = 1.5 + 0.1 * np.sin(3 * sol.t)
    np.testing.assert_allclose(sol["cylinder.length"], expected, atol=1e-11)
    np.testing.assert_allclose(sol["cylinder.speed"], 0.3 * np.cos(3 * sol.t), atol=1e-10)
    np.testing.assert_allclose(sol["hinge.angle"], np.arcsin(expected**2 / 2 - 1), atol=1e-10)
    np.testing.assert_allclose(sol["cylinder.power"], sol["cylinder.force"] * sol["cylinder.speed"], atol=1e-9)
    assert np.abs(sol.energy_violation).max() < 1e-8 * np.ptp(sol.potential_energy)
    assert sol.unique("cylinder.force")


@pytest.mark.parametrize("layout", LAYOUTS)
def test_at_rest_it_carries_the_moment_of_the_weight(layout):
    """With the arm level: force times the lever sin(45 degrees) is the weight times 1 m."""
    m = digger(length=np.sqrt(2.0))
    sol = zd.simulate(m.system(layout), 0.1, step=0.01)
    np.testing.assert_allclose(sol["cylinder.force"], 30 * 9.81 * np.sqrt(2.0), rtol=1e-12)
    assert "driven: cylinder (length)" in str(m)
    assert "freedom 0" in str(m)
    longer = m.with_parameters({"cylinder.length": 1.5})
    assert longer.p0[-1] == pytest.approx(np.arcsin(1.5**2 / 2 - 1))


def hinged():
    m = zd.Mechanism("hinged", gravity=(0, -9.81))
    arm = m.link("arm", (0, 0), (2, 0), mass=30.0)
    m.revolute("hinge", m.ground, arm.start)
    return m, (m.ground.point((0, -1)), arm.point((1, 0)))


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_force_by_the_law_of_a_spring_is_a_spring(layout):
    """It pushes where a spring pulls less: forces have opposite signs."""
    sprung, ends = hinged()
    sprung.spring("coil", *ends, stiffness=500.0, length=1.2)
    pushed, ends = hinged()
    pushed.spring("gauge", *ends, stiffness=0.0)
    pushed.actuator("cylinder", *ends, force=lambda x: -500.0 * (x - 1.2), of={"x": "gauge.length"})
    first, second = (zd.simulate(each.system(layout), 1.0, step=1e-3) for each in (sprung, pushed))
    np.testing.assert_allclose(second["hinge.angle"], first["hinge.angle"], atol=1e-11)
    np.testing.assert_allclose(second["cylinder.force"], -first["coil.force"], atol=1e-8)
    np.testing.assert_allclose(second["hinge.force"], first["hinge.force"], atol=1e-8)
    np.testing.assert_allclose(second["cylinder.power"], second["cylinder.force"] * second["cylinder.speed"], atol=1e-8)


@pytest.mark.parametrize(("given", "code", "sentence"), [
    ({}, "conflicting-arguments", "'cylinder'"),
    ({"length": 1.0, "force": 1.0}, "conflicting-arguments", "'cylinder'"),
    ({"length": 0.0}, "out-of-range", "'cylinder'.*0"),
    ({"length": lambda a: a, "of": {"a": "hinge.angle"}}, "user-function", "hinge.angle"),
    ({"force": lambda z: z}, "user-function", "'cylinder'.*'z'"),
])
def test_what_is_wrong_is_named(given, code, sentence):
    m, ends = hinged()
    with refused(code, sentence):
        m.actuator("cylinder", *ends, **given)


def test_starts_leave_a_prescribed_length_to_the_actuator():
    m = digger(length=1.5)
    with refused("prescribed-twice", "'cylinder.length'"):
        m.start({"cylinder.length": 1.4})
    free = digger(force=0.0)
    free.start({"cylinder.length": 1.5, "cylinder.speed": 0.2})
    sol = zd.simulate(free, 0.1, step=0.01)
    assert sol["cylinder.length"][0] == pytest.approx(1.5)
    assert sol["cylinder.speed"][0] == pytest.approx(0.2)


def test_a_length_that_cannot_be_reached_is_reported():
    with pytest.raises(zd.InconsistentStart, match=r"cannot be met together; .* 'cylinder' by"):
        zd.simulate(digger(length=3.0), 0.1, step=0.01)


def pulled(**law):
    """A mass on a spring and a damper, which is an actuator if a law is given."""
    m = zd.Mechanism("pulled", gravity=(0, -9.81))
    mass = m.particle("mass", 1.0, at=(0.4, 0))
    if law:
        m.actuator("k", m.ground.point((0, 0)), mass, **law)
    else:
        m.spring("k", m.ground.point((0, 0)), mass, stiffness=50.0, length=0.3, damping=2.0)
    return m


@pytest.mark.parametrize("law", [
    {"force": lambda length, speed: -50 * (length - 0.3) - 2 * speed},
    {"force": lambda a, b: -50 * (a - 0.3) - 2 * b, "of": {"a": "k.length", "b": "k.speed"}}], ids=["own names", "of"])
def test_a_law_names_the_length_and_speed_of_its_own_actuator(law, tmp_path):
    m, known = pulled(**law), zd.simulate(pulled(), 1.0, step=0.01)
    assert_close(zd.simulate(m, 1.0, step=0.01).p, known.p, 1e-12, scale=1.0)
    assert_close(zd.simulate(zd.load(m.save(tmp_path / "m")), 1.0, step=0.01).p, known.p, 1e-12, scale=1.0)


def test_a_motor_names_the_angle_and_speed_of_its_joint():
    m = zd.Mechanism("swing", parameters={"bias": 2.0})
    link = m.link("link", (0, 0), (1, 0), mass=3.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.motor("drive", pin, torque=lambda angle, speed, bias: -5 * angle + 0 * speed + bias)
    sol = zd.simulate(m, 1.0, step=1e-3)
    omega = np.sqrt(5 / (3.0 / 12 + 3.0 / 4))
    assert_close(sol["pin.angle"], 0.4 * (1 - np.cos(omega * sol.t)), 1e-10, scale=1.0)
