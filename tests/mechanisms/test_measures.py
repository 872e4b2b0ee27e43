"""Measures of bodies, points, joints and bushings against differences, rigid bodies' kinematics and Newton's laws."""

import numpy as np
import pytest

import zerodrift as zd
from support import difference, refused

LAYOUTS = ["joint", "absolute"]


def mounted():
    """A heavy box on a bushing of a swinging arm, and a slider on the box."""
    m = zd.Mechanism("mounted", gravity=(0.3, -9.81))
    arm = m.link("arm", (0, 0), (1, 0.2), mass=1.1)
    box = m.body("box", 2.0, 0.3, at=(1, 0.3), angle=0.7, com=(0.05, -0.02))
    bead = m.particle("bead", 0.2, at=(1.5, 0.5))
    m.revolute("hinge", m.ground, arm.start)
    m.bushing("mount", arm, box, at=(1, 0.25), stiffness=(300, 500), damping=(3, 5), torsion=20, torsion_damping=0.3)
    m.slot("groove", box, bead, axis=(1, 0.3))
    m.start({arm.angular_velocity: 1.5, box.angular_velocity: -0.5})
    return m


@pytest.fixture(scope="module", params=LAYOUTS)
def sol(request):
    return zd.simulate(mounted().system(request.param), 0.5, step=1e-3)


@pytest.mark.parametrize("what", ["box.position", "box.angle", "arm.end.position", "box.center.position", "bead.position",
                                  "groove.displacement", "hinge.angle"])
def test_accelerations_are_rates_of_velocities(sol, what):
    """By differences of five rows; at the 60 rad/s of the box on its bushing these miss (60 h)^4 / 30 of a value, 4e-7."""
    owner, _, quantity = what.rpartition(".")
    rate = {"position": "velocity", "angle": "angular_velocity", "displacement": "speed"}[quantity]
    second = {"position": "acceleration", "angle": "angular_acceleration", "displacement": "acceleration"}[quantity]
    if owner == "hinge":
        rate, second = "speed", "acceleration"
    values = sol[f"{owner}.{rate}"]
    for row in (20, 300):
        expected = difference(lambda s, row=row: values[row + round(s * 1e3)], 0.0, 1e-3)
        np.testing.assert_allclose(sol[f"{owner}.{second}"][row], expected, rtol=1e-6, atol=1e-6)


def test_accelerations_of_a_body_are_those_of_rigid_bodies(sol):
    """a_C = a_O + alpha x r - omega^2 r, and the same for velocities."""
    angle, r = sol["box.angle"], np.array([0.05, -0.02])
    arm = np.column_stack([np.cos(angle) * r[0] - np.sin(angle) * r[1], np.sin(angle) * r[0] + np.cos(angle) * r[1]])
    across = np.column_stack([-arm[:, 1], arm[:, 0]])
    omega, alpha = sol["box.angular_velocity"][:, None], sol["box.angular_acceleration"][:, None]
    np.testing.assert_allclose(sol["box.center.velocity"], sol["box.velocity"] + omega * across, atol=1e-12)
    expected = sol["box.acceleration"] + alpha * across - omega**2 * arm
    np.testing.assert_allclose(sol["box.center.acceleration"], expected, atol=1e-10)


def test_a_bushing_carries_what_its_bodies_need(sol):
    """Newton's and Euler's laws of the box, on which the bushing, the bead in its groove, and gravity act."""
    gravity = np.array([0.3, -9.81])
    force = 2.0 * (sol["box.center.acceleration"] - gravity) + sol["groove.force"]
    np.testing.assert_allclose(sol["mount.force"], force, atol=1e-9)
    angle = sol["box.angle"] - 0.7
    c, s = np.cos(angle), np.sin(angle)
    to_mount = np.array([1.0, 0.25]) - np.array([1.0, 0.3])
    place = sol["box.position"] + np.column_stack([c * to_mount[0] - s * to_mount[1], s * to_mount[0] + c * to_mount[1]])

    def moment(at, force):
        lever = at - sol["box.center.position"]
        return lever[:, 0] * force[:, 1] - lever[:, 1] * force[:, 0]

    needed = 0.3 * sol["box.angular_acceleration"] + moment(sol["bead.position"], sol["groove.force"])
    np.testing.assert_allclose(sol["mount.torque"], needed - moment(place, sol["mount.force"]), atol=1e-9)


def test_vectors_are_turned_into_axes_of_bodies(sol):
    m = mounted()
    along, across = (np.array([np.cos(sol["arm.angle"] + turn), np.sin(sol["arm.angle"] + turn)]).T for turn in (0, np.pi / 2))
    force = sol["hinge.force"]
    expected = np.column_stack([(force * along).sum(axis=1), (force * across).sum(axis=1)])
    for name, body in (("hinge.force", "arm"), (m["hinge"].force, m["arm"])):
        np.testing.assert_allclose(sol[name, body], expected, atol=1e-12)
    np.testing.assert_allclose(sol["hinge.force.y", "arm"], expected[:, 1], atol=1e-12)
    assert np.array_equal(sol["box.angular_velocity", "box"], sol["box.angular_velocity"])
    assert np.array_equal(sol["hinge.force", "ground"], force)
    assert np.array_equal(sol[m["hinge"].force, m.ground], force)


@pytest.mark.parametrize(("key", "missing"), [(("hinge.force", "bead"), "bead.angle"), (("hinge.forces", "arm"), "hinge.forces"),
                                             (("hinge.force", "leg"), "leg.angle"), ((3, "arm"), "3")])
def test_frames_that_are_not_there(sol, key, missing):
    with refused("wrong-name", f"nothing in mounted is called '?{missing}'?"):
        sol[key]


def test_a_link_is_where_its_start_is():
    m = zd.Mechanism("m")
    link = m.link("link", (1, 2), (3, 2), mass=1.0)
    m.revolute("A", m.ground, link.start)
    sol = zd.simulate(m, 0.1, step=0.1)
    np.testing.assert_allclose(sol[link.position][0], [1, 2])
    np.testing.assert_allclose(sol[link.center.position][0], [2, 2])
    assert "start" in type(link).position.__doc__


def test_names_stand_for_centres_and_particles_are_their_own():
    m = zd.Mechanism("m")
    link, bob = m.link("link", (0, 0), (2, 0), mass=1.0), m.particle("bob", 1.0, at=(1, 1))
    m.spring("s", "link.center", bob, stiffness=3.0)
    m.revolute("A", m.ground, link.start)
    assert bob.center.position == bob.position
    m.start({"link.center.velocity.y": 0.5})
    sol = zd.simulate(m, 0.1, step=0.1)
    assert sol["A.speed"][0] == pytest.approx(0.5)
    assert sol["s.length"][0] == pytest.approx(1.0)


def test_outputs_of_accelerations_and_frames():
    sol = zd.simulate(mounted(), 0.1, step=0.01, outputs=["box.acceleration", "mount.force", "box.angle"])
    plain = zd.simulate(mounted(), 0.1, step=0.01)
    for name in ("box.acceleration", ("mount.force", "box")):
        np.testing.assert_allclose(sol[name], plain[name], rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("dimension", [2, 3])
def test_components_are_as_many_as_their_names(dimension):
    """Measures of all kinds, also sums of forces: of a compliant contact of several parts, and of joints on the ground."""
    m = zd.Mechanism("m", gravity=(0, -9.81, 0)[:dimension], dimension=dimension)
    for k in range(4):
        ball = m.body(f"b{k}", 1.0, 0.1 if dimension == 2 else np.eye(3), at=(2.0 * k, 0.1, 0.0)[:dimension])
        if k:
            axis = {} if dimension == 2 else {"axis": (0, 0, 1)}
            m.revolute(f"j{k}", m.ground, ball, at=(2.0 * k, 1.0, 0.0)[:dimension], **axis)
    shape = m.ground.segment((-1, 0), (1, 0)) if dimension == 2 else m.ground.plane((0, 0, 0), (0, 1, 0))
    m.contact("floor", m["b0"], shape, radius=0.2, stiffness=1e3)
    sol = zd.simulate(m, 0.01)
    for name in m.system().measures:
        shape = np.shape(sol[name])[1:]
        if len(shape) == 1:
            assert np.array_equal(np.column_stack([sol[f"{name}.{axis}"] for axis in "xyz"[:shape[0]]]), sol[name])
            with pytest.raises(KeyError):
                sol[f"{name}.{'zw'[shape[0] - 2]}"]
    assert sol["floor.force.y"][0] == pytest.approx(100.0)
