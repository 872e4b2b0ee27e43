"""Elements that systems and solutions share: what an earlier run says of itself cannot be changed afterwards."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused


@pytest.fixture
def pendulum():
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start, damping=0.1)
    m.spring("spring", m.ground.point((0, 1)), link.end, stiffness=3.0)
    m.torsion_spring("clock", pin, stiffness=1.0)
    m.motor("motor", pin, torque=0.5)
    return m


@pytest.mark.parametrize(("element", "attribute"), [
    ("link", "mass"), ("link", "inertia"), ("link", "length"), ("pin", "damping"), ("spring", "stiffness"),
    ("clock", "stiffness"), ("motor", "law"), ("link", "pose"), ("pin", "first")])
def test_attributes_are_set_once(pendulum, element, attribute):
    with refused("wrong-attribute", rf"{attribute} of '{element}' must not change.*with_parameters"):
        setattr(pendulum[element], attribute, 2.0)


def test_arrays_of_elements_are_read_only():
    m = zd.Mechanism("guide")
    force = m.force("push", m.particle("bob", 1.0, at=(0, 0)), along=(1, 0), value=1.0)
    with pytest.raises(ValueError, match="read-only"):
        force.along[:] = (0, 1)


def test_parameters_make_a_system_with_another_value(pendulum, tmp_path):
    """As the error says: the first run keeps its mass and its reactions, in memory and in a file."""
    first = zd.simulate(pendulum, 0.1, step=0.01)
    before = first["pin.force"].copy()
    heavy = zd.simulate(pendulum.with_parameters({"link.mass": 100.0}), 0.1, step=0.01)
    again = zd.load(first.save(tmp_path / "first"))
    for sol in (first, again):
        assert sol.system.parameters["link.mass"] == 1.0
        assert np.array_equal(sol["pin.force"], before)
    assert heavy.system.parameters["link.mass"] == 100.0
    assert np.abs(heavy["pin.force"] - before).max() > 100.0
