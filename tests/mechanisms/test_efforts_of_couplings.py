"""The efforts of gears, racks, cams and couplers: with those of joints they are mass times acceleration of every body."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused

STEP = 1e-3
DIFFERENCED = 2e-4      # of the largest: central differences are off by STEP^2 / 6 times third derivatives of up to some hundred


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def moving_train():
    """A pinion on a swinging arm drives a rack on it, a gear a second wheel, and a cam on that wheel a follower."""
    m = zd.Mechanism("train", gravity=(0.3, -9.81))
    arm = m.body("arm", 3.0, 0.4, at=(0, 0), com=(0.2, 0.1), angle=0.3)
    pinion, wheel = m.body("pinion", 1.0, 0.02, at=(0.5, 0.1)), m.body("wheel", 1.5, 0.03, at=(0.9, 0.2), com=(0.01, 0))
    rack, follower = m.body("rack", 2.0, 0.1, at=(0.4, 0.3)), m.body("follower", 0.5, 0.05, at=(1.1, 0.4))
    joints = {"O": m.revolute("O", m.ground, arm.point((0, 0))), "J": m.revolute("J", arm, pinion.point((0, 0))),
              "K": m.revolute("K", wheel.point((0, 0)), arm),      # the wrong way round, so that signs are seen
              "X": m.prismatic("X", arm, rack, at=(0.4, 0.3), axis=(1, 0.5), damping=0.5),
              "Y": m.prismatic("Y", follower, arm, at=(1.1, 0.4), axis=(0, 1))}
    teeth = m.rack_pinion("teeth", joints["J"], joints["X"], ratio=0.3)
    mesh = m.gear("mesh", joints["J"], joints["K"], ratio=1.5)
    cam = m.cam("cam", joints["K"], joints["Y"], profile=lambda angle: 0.05 * np.sin(angle + 0.4))
    m.motor("drive", joints["J"], torque=1.0)
    m.torsion_spring("coil", joints["K"], stiffness=2.0, angle=0.4, damping=0.1)        # in K.torque
    # what each coupling does along the coordinates of joints, per joint
    along = {"J": lambda sol: -0.3 * sol[teeth.force] - 1.5 * sol[mesh.torque], "X": lambda sol: sol[teeth.force],
             "K": lambda sol: sol[mesh.torque] + sol[cam.cam_torque], "Y": lambda sol: sol[cam.force]}
    return m, joints, along


def wrenches(m, joints, along, sol):
    """Force (k, 2) and torque (k,) about the mass centre on each body, of all that is reported of joints and couplings."""
    centres = {body.name: centre(sol, body) for body in m.bodies}
    total = {name: [np.zeros_like(at), np.zeros(len(sol.t))] for name, at in centres.items()}
    for name, joint in joints.items():
        force, torque = sol[joint.force].copy(), sol[joint.torque].copy()
        effort = along.get(name, lambda sol: np.zeros(len(sol.t)))(sol)
        if joint.coordinate == "angle":
            torque += effort
        else:
            angle = 0.0 if joint.first.body is m.ground else sol[joint.first.body.angle]
            force += effort[:, None] * np.stack([np.cos(angle) * joint.axis[0] - np.sin(angle) * joint.axis[1],
                                                 np.sin(angle) * joint.axis[0] + np.cos(angle) * joint.axis[1]], axis=-1)
        place = sol[joint.second.body.position] + turned(sol[joint.second.body.angle], joint.second.local)
        for sign, body in ((-1.0, joint.first.body), (1.0, joint.second.body)):
            if body is m.ground:
                continue
            total[body.name][0] += sign * force
            total[body.name][1] += sign * (torque + cross(place - centres[body.name], force))
    return centres, total


def turned(angle, local):
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=-1)


def centre(sol, body):
    return sol[body.position] + turned(sol[body.angle], body.center.local)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_what_is_reported_is_mass_times_acceleration_of_every_body(layout):
    m, joints, along = moving_train()
    sol = zd.simulate(m.system(layout), 0.3, step=STEP)
    centres, total = wrenches(m, joints, along, sol)
    for body in m.bodies:
        force, torque = total[body.name]
        acceleration = np.diff(centres[body.name], 2, axis=0) / STEP**2
        needed = body.mass * (acceleration - m.gravity)
        np.testing.assert_allclose(force[1:-1], needed, atol=DIFFERENCED * np.abs(needed).max())
        turning = body.inertia * np.diff(sol[body.angle], 2) / STEP**2
        np.testing.assert_allclose(torque[1:-1], turning, atol=DIFFERENCED * max(1.0, np.abs(turning).max()))
    assert min(np.abs(effort(sol)).max() for effort in along.values()) > 0.1     # zeros would prove nothing


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_rack_on_a_straight_guide(layout):
    """The example of a book: m x'' = F, J a'' = T - r F, x = r a."""
    m = zd.Mechanism("rack")
    pinion = m.revolute("J", m.ground, m.body("pinion", 1.0, 0.1).point((0, 0)))
    rack = m.prismatic("X", m.ground, m.body("bar", 2.0, 0.1), axis=(1, 0))
    teeth = m.rack_pinion("teeth", pinion, rack, ratio=0.02)
    m.motor("drive", pinion, torque=1.0)
    sol = zd.simulate(m.system(layout), 0.1, step=0.01)
    np.testing.assert_allclose(sol[teeth.force], 2.0 * 0.02 / (0.1 + 2.0 * 0.02**2), rtol=1e-12)
    np.testing.assert_allclose(sol[rack.force], 0.0, atol=1e-12)
    assert sol.unique("teeth.force")


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_differential(layout):
    """Three wheels of inertia J, a0 + a1 = 2 a2, torque T on the third: J a1'' is the effort on the second."""
    m = zd.Mechanism("differential")
    pins = [m.revolute(f"pin{i}", m.ground, m.body(f"wheel{i}", 1.0, 0.1, at=(i, 0)).point((0, 0))) for i in range(3)]
    cage = m.coupler("cage", {pins[0].angle: 1.0, pins[1].angle: 1.0, pins[2].angle: -2.0})
    m.motor("drive", pins[2], torque=3.0)
    sol = zd.simulate(m.system(layout), 0.1, step=0.01)
    np.testing.assert_allclose(sol[cage.torque], 1.0, rtol=1e-12)      # a third of the torque for each


def test_a_coupling_has_the_effort_of_its_unit():
    m = zd.Mechanism("bead")
    bead = m.particle("bead", 0.1, at=(1, 1))
    line = m.coupler("line", {bead.position.x: 1.0, bead.position.y: -1.0})
    assert line.force.name == "line.force"
    with refused("wrong-attribute", "'line'"):
        _ = line.torque
    hinge = m.revolute("hinge", m.ground, m.body("wheel", 1.0, 0.1).point((0, 0)))
    locked = {verb: getattr(m, verb)(verb, lambda x: 2.0 * x, of={"x": measure}).torque.name
              for verb, measure in (("coupler", hinge.angle), ("constraint", hinge.angle), ("nonholonomic", hinge.speed))}
    assert locked == {verb: f"{verb}.torque" for verb in locked}


ROPE = {"ax": "a.position.x", "ay": "a.position.y", "bx": "b.position.x", "by": "b.position.y"}


@pytest.mark.parametrize("verb", ["coupler", "constraint"])
@pytest.mark.parametrize("form", ["joint", "absolute"])
def test_the_tension_of_a_rope_over_pulleys_wherever_it_is_read(verb, form):
    """Atwood's machine, 1 kg and 3 kg: 2 m M / (m + M) g pulls on both; the value is the length, which tension shortens."""
    m = zd.Mechanism("pulley", gravity=(0, -9.81))
    m.particle("a", 1.0, at=(-1, -2)), m.particle("b", 3.0, at=(1, -1))
    rope = getattr(m, verb)("rope", lambda ax, ay, bx, by: np.hypot(ax + 1, ay) + np.hypot(bx - 1, by) - 3, of=ROPE)
    system, tension = m.system(form), -14.715
    sol = zd.simulate(system, 0.1, step=0.01, outputs=["rope.force"], events=zd.Event("rope.force", value=10.0))
    run = zd.Run(system, step=0.01)
    run.step(3)
    motion = {"a.position.x": lambda t: -1.0 + 0.0 * t, "b.position.x": lambda t: 1.0 + 0.0 * t,
              "b.position.y": lambda t: -1.0 - 0.5 * 9.81 / 2 * t * t}
    kin = zd.kinematics(system, motion, np.array([0.0, 0.1]))
    runs = zd.ensemble(system, 0.1, v0=np.zeros((2, system.nv)), step=0.01, outputs=["rope.force"])
    forces = zd.inverse_dynamics(system, kin, efforts=[])
    for found in (sol["rope.force"], sol.outputs["rope.force"], run[rope.force], zd.Instant(system)["rope.force"],
                  forces["rope.force"], runs["rope.force"]):
        np.testing.assert_allclose(found, tension, rtol=1e-9)
    assert "rope.force" in m.measures
    for read in (sol, run, zd.Instant(system), kin):
        with refused("duplicate-name", r"rope\.force"):
            read["rope"]


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_the_force_of_a_blade(layout):
    """A sleigh at 45 degrees is pushed along x: the blade carries the push across it."""
    m = zd.Mechanism("sleigh")
    sleigh = m.body("sleigh", 1.0, 0.1, angle=np.pi / 4)
    blade = m.nonholonomic("blade", lambda a, u, v: u * np.sin(a) - v * np.cos(a),
                           of={"a": sleigh.angle, "u": sleigh.velocity.x, "v": sleigh.velocity.y})
    m.force("push", sleigh.center, value=(2.0, 0.0))
    np.testing.assert_allclose(zd.Instant(m.system(layout))[blade.force], -2.0 * np.sin(np.pi / 4), rtol=1e-12)


def test_a_coupler_of_one_angle_reports_its_torque():
    """An angle of a universal joint is a t^2 / 10: I alpha = 0.2 N m."""
    m = zd.Mechanism("u", dimension=3)
    m.universal("u", m.ground, m.body("b", 1.0, (1, 1, 1)), at=(0, 0, 0), axes=((1, 0, 0), (0, 0, 1)))
    m.coupler("drive", lambda a, t: a - 0.1 * t * t, of={"a": "u.angle1"})
    np.testing.assert_allclose(zd.simulate(m, 0.5)["drive.torque"], 0.2, rtol=1e-6)
