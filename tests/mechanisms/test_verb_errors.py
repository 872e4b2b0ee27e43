"""Errors of arguments name the method of the mechanism, the argument and its unit."""

import re

import pytest

import zerodrift as zd


@pytest.fixture
def m():
    m = zd.Mechanism("arm")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    return m


@pytest.mark.parametrize(("call", "sentence"), [
    (lambda m: m.motor("drive", "pin", rpm=300), "motor has no argument 'rpm'; speed= is in rad/s or m/s; it takes name, joint"),
    (lambda m: m.spring("s", "link.start", "pin", k=3.0), "spring has no argument 'k'; use stiffness=; it takes name, first"),
    (lambda m: m.body("b", 1.0, I=2.0), "body has no argument 'I'; inertia= is in kg m^2; it takes name, mass, inertia"),
    (lambda m: m.body("b", 1.0, colour="red"), "body has no argument 'colour'; it takes name, mass, inertia"),
    (lambda m: m.motor("drive"), "motor 'drive' must have joint; it takes name, joint"),
    (lambda m: m.revolute("other", m.ground), "revolute 'other' must have second; it takes name, first, second"),
    (lambda m: m.motor("drive", "pin", 3.0), "motor must be given name and joint by position and other arguments by name, not 3"),
    (lambda m: m.measure("x", "link.angle", rpm=3), "measure has no argument 'rpm'; it takes name, value, of, unit"),
    (lambda m: m.replace(torque=1.0), "replace must have name; it takes name, **changed"),
    (lambda m: m.body("b", name="c", mass=1.0), "body: multiple values for argument 'name'"),
    (lambda m: m.link("l", (0, 0), (1, 0), 1.0, com=(0, 0)), "Its centre of mass is its middle; that of m.body(com=) is"),
    (lambda m: m.motor("drive", m["link"].angle, speed=1.0), "m.constraint(name, lambda a, t: a - 2.0 * t, of={'a': 'link."),
    (lambda m: zd.fmu(m, "x.fmu", step=0.01, parameters=["link.mass"]), "'parameters' must be an argument of the export or"),
    (lambda m: m.system(compile=True), "system has no argument 'compile'; it takes coordinates, compiled")])
def test_errors_of_arguments(m, call, sentence):
    before = list(m._elements)
    with pytest.raises(TypeError, match=re.escape(sentence)):
        call(m)
    assert list(m._elements) == before


def test_a_universal_joint_has_two_coordinates_and_no_speed():
    m = zd.Mechanism("shaft", dimension=3)
    one, other = m.body("one", 1.0, (1, 1, 1)), m.body("other", 1.0, (1, 1, 1))
    joint = m.universal("J", one, other, at=(0, 0, 0), axes=((1, 0, 0), (0, 1, 0)))
    with pytest.raises(ValueError, match=r"'m'.*angle1"):
        m.motor("m", joint, speed=1.0)
