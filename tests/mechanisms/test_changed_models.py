"""Elements of mechanisms that are removed or replaced."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused


def pair():
    m = zd.Mechanism("pair", gravity=(0, -9.81))
    one, other = m.link("one", (0, 0), (1, 0), mass=1.0), m.link("other", (1, 0), (2, 0), mass=1.0)
    m.revolute("root", m.ground, one.start)
    m.revolute("knee", one.end, other.start)
    m.motor("drive", "root", torque=lambda t: np.sin(t), rotor=0.1, ratio=5.0)
    m.spring("spring", m.ground.point((0, 1)), m.point("tip", other, (0.5, 0)), stiffness=30.0)
    m.force("wind", other, along=(1, 0), value=lambda w: -w, of={"w": "one.angular_velocity"})
    m.group("both", [one, other])
    m.start({"root.angle": 0.1, "other.angular_velocity": 1.0})
    return m


def test_without_its_motor_a_model_falls_and_keeps_its_energy():
    m = zd.models.scissor_lift()
    m.remove(m.motors[0])
    free = zd.simulate(m, 0.2, step=1e-3)
    assert not m.motors
    assert "drive.force" not in m.measures
    energy = free.kinetic_energy + free.potential_energy
    assert free.kinetic_energy[-1] > 1.0
    assert energy == pytest.approx(np.full(len(energy), energy[0]), abs=1e-6 * free.kinetic_energy[-1])


@pytest.mark.parametrize(("name", "dependent"), [
    ("other", ["knee", "spring", "wind", "both"]), ("one", ["root", "knee", "wind"]), ("root", ["drive"]), ("tip", ["spring"])])
def test_what_others_depend_on_is_not_removed(name, dependent):
    m = pair()
    before = list(m._elements)
    with refused("wrong-element", name) as caught:
        m.remove(name)
    assert all(repr(each) in str(caught.value) for each in dependent)
    assert list(m._elements) == before
    assert zd.simulate(m, 0.01, step=1e-3).success


def test_all_that_depends_goes_first():
    m = pair()
    for name in ("both", "wind", "spring", "knee", "other"):
        m.remove(name)
    assert [body.name for body in m.bodies] == ["one", "drive rotor"]
    assert zd.simulate(m, 0.01, step=1e-3).success
    m.remove("drive")
    assert [body.name for body in m.bodies] == ["one"]
    alone = zd.Mechanism("pair", gravity=(0, -9.81))
    alone.revolute("root", alone.ground, alone.link("one", (0, 0), (1, 0), mass=1.0).start)
    alone.start({"root.angle": 0.1})
    assert np.array_equal(zd.simulate(m, 0.1, step=1e-3).p, zd.simulate(alone, 0.1, step=1e-3).p)
    with refused("wrong-element", "ground"):
        m.remove(m.ground)
    with refused("wrong-name", "nothing"):
        m.remove("nothing")


def test_a_motor_is_replaced_at_its_joint():
    m, other = pair(), pair()
    made = m.replace("drive", torque=2.0)
    assert m["drive"] is made
    assert made.joint is m["root"]
    assert not {"drive rotor", "drive shaft", "drive gear"} & m._elements.keys()
    other.remove("drive")
    other.motor("drive", "root", torque=2.0)
    assert zd.simulate(m, 0.1, step=1e-3).p == pytest.approx(zd.simulate(other, 0.1, step=1e-3).p, rel=1e-12)
    order = list(m._elements)
    m.replace("drive", speed=1.0)
    assert list(m._elements) == order
    with pytest.raises(TypeError):
        m.replace("drive", torque=1.0, speed=2.0)
    assert m["drive"].drives == "speed"
    with refused("wrong-type", "motor"):
        m.replace("spring", stiffness=2.0)


def test_an_actuator_is_replaced():
    m = zd.Mechanism("lift", gravity=(0, -9.81))
    load = m.particle("load", 2.0, at=(0, 1))
    m.slot("guide", m.ground, load, axis=(0, 1))
    m.actuator("ram", m.ground.point((0, 0)), load, length=1.0)
    assert zd.Instant(m)["ram.force"] == pytest.approx(2 * 9.81)
    m.replace("ram", force=30.0)
    assert zd.Instant(m)["load.acceleration"][1] == pytest.approx(30.0 / 2 - 9.81)
