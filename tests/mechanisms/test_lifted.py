"""Mechanisms of the plane in space: the same motions, and the same reactions where they are determined."""

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from covering import spread
from every_model import MECHANISMS
from support import assert_close, refused
from zerodrift.mechanisms.building.plane_to_space import LIFTED
from zerodrift.mechanisms.elements.bodies import kind_of

LIFTABLE = [name for name, made in MECHANISMS.items()
            if all(kind_of(each) in LIFTED for each in made()._elements.values() if each.name != "ground")]
ROUGH = {"jansen", "klann", "stephenson"}       # sketches: the two assemblies stop within 1e-6 of each other


def both(name):
    """A model and itself in space, with one angle held where its drawing is a sketch; in absolute coordinates."""
    m = MECHANISMS[name]()
    space = m.lifted()
    if name in ROUGH:
        body = m[next(motor.joint.name for motor in m.motors)].second.body
        angle = float(zd.simulate(m, 1e-6, step=1e-6)[f"{body.name}.angle"][0])
        m.start({f"{body.name}.angle": angle})
        space = m.lifted()
    return m.system("absolute"), space


@pytest.mark.parametrize("name", spread(LIFTABLE, 8))
def test_a_model_in_space_is_that_of_the_plane(name):
    step = 1e-4 if name == "andrews" else 2e-3
    plane, space = (zd.simulate(m, 5 * step, step=step, formulation="augmented", integrator="dop853") for m in both(name))
    m = MECHANISMS[name]()
    for body in m.bodies:
        for what in ("position", "velocity"):
            assert_close(space[f"{body.name}.{what}"][:, :2], plane[f"{body.name}.{what}"], 1e-9, scale=1.0)
        if body.turns:
            R, angle = space[f"{body.name}.rotation"], plane[f"{body.name}.angle"]
            assert_close(R[:, 0, 0] + 1j * R[:, 1, 0], np.exp(1j * angle), 1e-9, scale=1.0)
    compared = 0
    for joint in m.joints:
        force, known = plane[f"{joint.name}.force"], plane.unique(f"{joint.name}.force")
        assert_close(space[f"{joint.name}.force"][:, :2][:, known], force[:, known], 1e-8, scale=1.0 + np.abs(force).max())
        compared += int(known.sum())
        if hasattr(joint, "torque") and plane.unique(f"{joint.name}.torque") and f"{joint.name}.torque" in space.system.measures:
            torque = plane[f"{joint.name}.torque"]
            assert_close(space[f"{joint.name}.torque"][:, 2], torque, 1e-8, scale=1.0 + np.abs(torque).max())
    assert compared > 0
    for motor in m.motors:
        effort = "torque" if motor.coordinate == "angle" else "force"
        expected = plane[f"{motor.name}.{effort}"]
        assert_close(space[f"{motor.name}.{effort}"], expected, 1e-7, scale=1.0 + np.abs(expected).max())


def everything():
    """A mechanism with elements that no model has: free particles and bodies, an actuator, forces that turn, user constraints."""
    m = zd.Mechanism("all", gravity=(1.0, -9.81), parameters={"k": 3.0})
    arm = m.link("arm", (0, 0), (1, 0.5), mass=1.0)
    m.revolute("pin", m.ground, arm.start, damping=0.2)
    m.point("P", arm, (0.5, 0.1))
    puck = m.body("puck", 2.0, 0.3, at=(2, 1), angle=0.4, com=(0.1, 0))
    bob, bead = m.particle("bob", 1.0, at=(3, 0)), m.particle("bead", 0.5, at=(1.5, -1))
    m.particle("load", 0.4, at="P")
    m.spring("spring", arm.end, puck.center, stiffness=20.0, damping=0.1)
    m.rod("rod", puck.point((0, 0)), bob)
    m.slot("wire", m.ground, bead, axis=(1, 0.2))
    m.actuator("cylinder", "P", bead, force=sp.Symbol("k") * sp.cos(sp.Symbol("t")))
    m.force("push", puck.point((0.3, 0)), along=(0, 1), value=lambda w, k: k - w, of={"w": puck.angular_velocity}, frame=puck)
    m.torque("twist", puck, against=arm, value=sp.Symbol("arm.angular_velocity") * -0.3 + sp.Symbol("bob.position.x"))
    m.constraint("height", lambda y, t: y - 0.1 * t, of={"y": bob.position.y})
    m.start({puck.angular_velocity: 0.5, bead.velocity.x: 0.3, "arm.velocity": (0, 0)}, wish={"arm.angle": 0.5})
    return m


def test_what_is_free_in_the_plane_stays_there():
    m = everything()
    space = m.lifted()
    assert [joint.name for joint in space.joints] == ["pin", "rod", "wire", "puck in its plane"]
    assert space["bob in its plane"].of == ("bob.position.z",)
    plane, sol = (zd.simulate(each, 0.2, step=1e-2, integrator="dop853") for each in (m.system("absolute"), space))
    for name in ("puck.position", "bob.velocity", "bead.position", "load.position", "P.velocity", "rod.force", "wire.force"):
        assert_close(sol[name][:, :2], plane[name], 1e-9, scale=1.0)
        assert_close(sol[name][:, 2], np.zeros(21), 1e-12, scale=1.0)
    assert_close(sol["puck.angular_velocity.z"], plane["puck.angular_velocity"], 1e-10)


def test_a_wheel_and_a_belt():
    """A wheel that rolls on a line is a disc in space, which stays in its plane."""
    m = zd.Mechanism("wheels", gravity=(0, -9.81))
    wheel, rack = m.body("wheel", 1.0, 0.1, at=(0, 0.5)), m.body("rack", 1.0, 0.1, at=(0, 2))
    m.rolling("road", m.ground, wheel, radius=0.5, normal=(0, 1))
    m.prismatic("rail", m.ground, rack, axis=(1, 0))
    m.coupler("belt", {"rack.position.x": 1.0, "wheel.position.x": -2.0})
    m.torque("drive", wheel, value=0.3)
    plane, space = (zd.simulate(each, 0.5, step=1e-2) for each in (m.system("absolute"), m.lifted()))
    assert_close(space["wheel.position"][:, :2], plane["wheel.position"], 1e-10)
    assert_close(space["road.force"][:, :2], plane["road.force"], 1e-9)
    assert_close(space["rack.velocity.x"], plane["rack.velocity.x"], 1e-10)
    assert plane["rack.velocity.x"][-1] < -0.1


def mounted():
    m = zd.Mechanism("mount", gravity=(0, -9.81))
    body = m.body("body", 1.0, 0.1, at=(0.2, 0.1), angle=0.3)
    m.bushing("mount", m.ground.point((0.1, 0)), body, stiffness=(100.0, 300.0), damping=(1.0, 2.0), torsion=5.0,
              torsion_damping=0.1)
    return m


def test_a_soft_joint():
    m = mounted()
    plane, space = (zd.simulate(each, 0.5, step=1e-3) for each in (m, m.lifted()))
    assert np.ptp(plane["body.angle"]) > 0.01
    assert_close(space["body.position"][:, :2], plane["body.position"], 1e-9)
    assert_close(space["mount.force"][:, :2], plane["mount.force"], 1e-8)
    assert_close(space["mount.torque"][:, 2], plane["mount.torque"], 1e-8)


def test_what_cannot_be_lifted_is_named(monkeypatch):
    monkeypatch.delitem(LIFTED, "bushing")      # stands for a new kind of element
    m = mounted()
    with refused("wrong-dimension", "'mount'"):
        m.lifted()
    m = zd.Mechanism("sail")
    body = m.body("body", 1.0, 0.1)
    m.force("wind", body, along=(1, 0), value=lambda a: np.cos(a), of={"a": body.angle})
    with refused("wrong-dimension", "'body.angle'.*'body'"):
        m.lifted()
    with refused("wrong-dimension", "'chain'"):
        zd.models.chain(2).lifted()


def test_the_start_of_a_group_that_hangs_nowhere_is_that_in_the_plane():
    """A drive between two free bodies turns the lighter one, which is drawn first; the heavier one is kept in the plane."""
    m = zd.Mechanism("adrift")
    light, heavy = m.body("light", 1.0, 0.1, at=(0, 0)), m.body("heavy", 2.0, 0.1, at=(1, 0))
    m.motor("drive", m.revolute("hinge", light, heavy, at=(0.5, 0)), speed=3.0)
    for each, layout in ((m, "joint"), (m, "absolute"), (m.lifted(), "joint"), (m.lifted(), "absolute")):
        run = zd.Run(each.system(layout), step=0.01)
        assert run["heavy.velocity"][:2] == pytest.approx([0, 0], abs=1e-12)
        assert run["light.velocity"][:2] == pytest.approx([0, 1.5], abs=1e-12)
