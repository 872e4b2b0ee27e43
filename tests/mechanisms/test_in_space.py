"""`Mechanism(dimension=3)`: known motions, mechanisms of the plane rebuilt in space, redundancy, measures, drives and forces."""

import pickle

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import zerodrift as zd
from reference_files import table
from support import assert_close, refused

TILTED = Rotation.from_rotvec([0.3, 0.6, -0.2]).as_matrix()      # so that no axis of a mechanism is one of the drawing's
EXACT = {"integrator": "dop853", "step": None, "rtol": 1e-12, "atol": 1e-12}


def heavy_top():
    m = zd.Mechanism("heavy top", dimension=3, gravity=(0, 0, -9.81))
    top = m.body("top", 15.0, (0.234375, 0.46875, 0.234375), com=(0, 1, 0))
    m.spherical("tip", m.ground, top, at=(0, 0, 0))
    m.start({"top.angular_velocity": (0, 150, -4.61538)})
    return m


@pytest.mark.parametrize("coordinates", ["absolute", "joint"])
def test_the_heavy_top_of_its_reference(formulation, coordinates):
    reference = table("heavy_top")
    end = 101 if formulation == "schur" else 11
    t = reference["t"][:end]
    sol = zd.simulate(heavy_top().system(coordinates), t[-1], t_eval=t, formulation=formulation, **EXACT)
    expected = {name: reference[name][:end] for name in reference}
    for i, axis in enumerate("xyz"):
        assert_close(sol[f"top.center.position.{axis}"], expected[axis], 1e-10, scale=1.0)
        assert_close(sol[f"top.center.velocity.{axis}"], expected[f"v{axis}"], 1e-10, scale=5.0)
        assert_close(sol[f"tip.force.{axis}"], -expected[f"lam{i + 1}"], 1e-10, scale=1500.0)      # there on the ground
    own = np.einsum("kij,ki->kj", sol["top.rotation"], sol["top.angular_velocity"])
    assert_close(own, np.stack([expected[f"w{i}"] for i in (1, 2, 3)], axis=1), 1e-10)
    q = np.stack([expected[f"e{i}"] for i in range(4)], axis=1)
    assert_close(np.abs((sol["top.quaternion"] * q).sum(axis=1)), np.ones(end), 1e-12)


def four_bar(turned=None):
    """The paper's, in the plane or in a plane of space; with the moments of inertia of slender rods."""
    if turned is None:
        m, place, more = zd.Mechanism("plane", gravity=(0, -9.81)), (lambda x, y: (x, y)), {}
    else:
        m = zd.Mechanism("space", dimension=3, gravity=turned @ (0, -9.81, 0))
        place, more = (lambda x, y: turned @ (x, y, 0)), {"axis": turned[:, 2]}

    def link(name, start, end, mass, length):
        J = mass * length**2 / 12
        kind = {} if turned is None else {"inertia": (0.3 * J, J, J), "normal": turned[:, 2]}
        return m.link(name, place(*start), place(*end), mass, length=length, **kind)

    crank, coupler = link("crank", (0, 0), (0, 0.3), 1.5, 0.3), link("coupler", (0, 0.3), (0.95, 0.6), 5.0, 1.0)
    rocker = link("rocker", (0.95, 0.6), (1, 0), 3.0, 0.6)
    m.revolute("A", m.ground, crank.start, damping=0.1, **more)
    m.revolute("B", crank.end, coupler.start, **more)
    m.revolute("C", coupler.end, rocker.start, **more)
    m.revolute("D", rocker.end, m.ground.point(place(1, 0)), **more)
    m.spring("spring", crank.end, m.ground.point(place(1.2, 0.8)), stiffness=30.0, length=0.4, damping=0.5)
    m.force("push", coupler.end, along=place(0.6, 0.8), value=lambda t: 5 * np.sin(3 * t))
    m.start({"A.angle": 0.0, "A.speed": 1.0})
    return m


@pytest.mark.parametrize("wanted", ["schur", "nullspace", "independent"])
def test_a_mechanism_of_the_plane_in_space(wanted):
    """Reactions agree, too, except those that are not determined."""
    R = TILTED
    space, plane = four_bar(R), four_bar()
    sol, other = (zd.simulate(m, 0.4, formulation=wanted, integrator="dop853", step=1e-2)
                  for m in (space, plane.system("absolute")))
    assert_close(sol["A.angle"], other["A.angle"], 1e-9)
    for name in ("A.speed", "A.acceleration", "spring.force", "spring.length"):
        assert_close(sol[name], other[name], 1e-8)
    for name in ("C.force", "coupler.end.position", "coupler.center.acceleration"):
        assert_close((sol[name] @ R)[:, :2], other[name], 1e-8)
    assert_close(sol["rocker.angular_velocity"] @ R[:, 2], other["rocker.angular_velocity"], 1e-9)
    assert_close(sol["A.torque"] @ R[:, 2], other["A.torque"], 1e-8)       # its damping
    assert np.abs(sol.energy_violation).max() < 1e-9
    np.testing.assert_allclose((sol.p[:, :21].reshape(-1, 3, 7)[:, :, 3:] ** 2).sum(axis=2), 1, rtol=0, atol=8 * 2.0**-52)


def test_three_constraints_of_a_four_bar_are_redundant():
    said = str(four_bar(np.eye(3)))
    assert "freedom 1 (Gruebler -2); joint coordinates 3, 5 constraints closing 1 loop at C; absolute 18, 20 constraints" in said
    assert "; 3 of 20 constraints are redundant: " in said
    assert "reactions not determined: A.z, A.about third, A.about normal, B.z" in said
    assert "a singular pose" not in said
    sol = zd.simulate(four_bar(np.eye(3)), 0.05, step=0.01)
    assert sol.unique("C.force").tolist() == [True, True, False]
    assert sol.unique("C.torque").tolist() == [False, False, True]


def test_a_stretched_arm_is_singular_and_not_redundant():
    m = zd.Mechanism("arm", dimension=3)
    upper, lower = m.link("upper", (0, 0, 0), (1, 0, 0), 1.0), m.link("lower", (1, 0, 0), (2, 0, 0), 1.0)
    m.spherical("shoulder", m.ground, upper.start)
    m.revolute("elbow", upper.end, lower.start, axis=(0, 0, 1))
    m.rod("string", m.ground.point((0, 0, 0)), lower.end)
    assert "a singular pose: string is redundant as drawn, and not nearby" in str(m)
    assert "no redundant constraints" in str(m)


# ---- single joints ----


def test_a_compound_pendulum_about_any_axis():
    """Its energy gives its speed, and what carries it follows from its centre's acceleration."""
    m = zd.Mechanism("pendulum", dimension=3, gravity=TILTED @ (0, -9.81, 0))
    J = np.array([[0.3, 0.02, 0], [0.02, 0.2, 0.01], [0, 0.01, 0.4]])
    body = m.body("body", 2.0, J, at=(0.1, 0.2, 0.3), rotation=TILTED, com=(0.5, 0, 0))
    m.revolute("pin", m.ground, body.point((0, 0, 0)), axis=TILTED[:, 2])
    sol = zd.simulate(m, 1.0, **EXACT)
    angle, speed = sol["pin.angle"], sol["pin.speed"]
    about = 0.4 + 2.0 * 0.25
    assert_close(0.5 * about * speed**2, 2.0 * 9.81 * 0.5 * -np.sin(angle), 1e-10)
    assert_close(sol["pin.acceleration"], -2.0 * 9.81 * 0.5 * np.cos(angle) / about, 1e-9)
    carried = 2.0 * (sol["body.center.acceleration"] - TILTED @ (0, -9.81, 0))
    assert_close(sol["pin.force"], carried, 1e-9)
    assert_close(sol["pin.torque"] @ TILTED[:, 2], np.zeros(len(sol.t)), 1e-10, scale=10.0)
    spin, change = np.array([0, 0, 1.0]) * speed[:, None], np.array([0, 0, 1.0]) * sol["pin.acceleration"][:, None]
    moment = change @ J + np.cross(spin, spin @ J)      # in the body's axes, about its centre
    own = np.einsum("kji,kj->ki", sol["body.rotation"], sol["pin.force"])
    torque = np.einsum("kji,kj->ki", sol["body.rotation"], sol["pin.torque"])
    assert_close(torque, moment + np.cross([0.5, 0, 0], own), 1e-9)


def test_a_spherical_pendulum_keeps_its_momentum():
    m = zd.Mechanism("pendulum", dimension=3, gravity=(0, 0, -9.81))
    bob = m.particle("bob", 2.0, at=(0.6, 0, -0.8))
    rod = m.rod("rod", m.ground.point((0, 0, 0)), bob)
    m.start({bob.velocity: (0, 1.5, 0)})
    sol = zd.simulate(m, 2.0, **EXACT)
    x, v = sol["bob.position"], sol["bob.velocity"]
    assert_close(np.cross(x, v)[:, 2], np.full(len(x), 0.9), 1e-11)
    assert_close(sol[rod.tension], 2.0 * ((v**2).sum(axis=1) + x @ (0, 0, -9.81)), 1e-9)


def test_a_cone_pendulum_stands():
    """A link on a ball goes round at a constant angle where its speed is right."""
    m = zd.Mechanism("cone", dimension=3, gravity=(0, 0, -9.81))
    link = m.link("link", (0, 0, 0), (0.6, 0, -0.8), 1.0, inertia=(0.01, 1 / 12, 1 / 12))
    m.spherical("ball", m.ground, link.start)
    rate = np.sqrt(9.81 * 0.5 / ((1 / 3 - 0.01) * 0.8))
    m.start({"link.angular_velocity": (0, 0, rate)})
    sol = zd.simulate(m, 1.0, step=1e-3, formulation="augmented")
    assert_close(sol["link.end.position.z"], np.full(len(sol.t), -0.8), 1e-9)


def test_a_free_body_turns_about_its_middle_axis():
    """Its energy and its angular momentum stay, in the drawing's axes."""
    m = zd.Mechanism("racket", dimension=3)
    m.body("racket", 1.0, [[0.2, 0.05, 0], [0.05, 0.3, 0], [0, 0, 0.45]], rotation=TILTED, com=(0.1, 0, 0))
    m.start({"racket.angular_velocity": (0.1, 3.0, 0.2)})
    sol = zd.simulate(m, 5.0, step=2e-3, integrator="dop853")
    R = sol["racket.rotation"]
    J = R @ np.array([[0.2, 0.05, 0], [0.05, 0.3, 0], [0, 0, 0.45]]) @ R.transpose(0, 2, 1)
    momentum = np.einsum("kij,kj->ki", J, sol["racket.angular_velocity"])
    assert_close(momentum, np.tile(momentum[0], (len(momentum), 1)), 1e-12)
    assert_close(sol["racket.center.velocity"], np.tile(sol["racket.center.velocity"][0], (len(R), 1)), 1e-12, scale=1.0)


# ---- drives and forces ----


def turntable(**drive):
    m = zd.Mechanism("turntable", dimension=3)
    table = m.body("table", 2.0, (0.3, 0.3, 0.5))
    m.revolute("axle", m.ground, table, at=(0, 0, 0), axis=(0, 0, 1))
    m.motor("drive", "axle", **drive)
    return m


@pytest.mark.parametrize("drive", [{"angle": lambda t: 4 * np.sin(2 * t)}, {"speed": lambda t: 8 * np.cos(2 * t)}],
                         ids=["angle", "speed"])
def test_a_motor_through_half_a_turn_and_more(drive):
    m = turntable(**drive)
    m.start({"table.angular_velocity.z": 8.0})
    sol = zd.simulate(m, 2.0, step=1e-2, integrator="dop853")
    assert_close(sol["axle.angle"], 4 * np.sin(2 * sol.t), 1e-9)
    assert_close(sol["drive.torque"], -0.5 * 16 * np.sin(2 * sol.t), 1e-8)
    assert_close(sol["drive.power"], sol["drive.torque"] * sol["axle.speed"], 1e-12)
    assert_close(sol["axle.torque"][:, 2], sol["drive.torque"], 1e-10)


def test_a_motor_of_constant_speed_starts_where_it_is():
    m = turntable(speed=2.0)
    sol = zd.simulate(m, 4.0, step=1e-2)
    assert_close(sol["axle.angle"], 2.0 * sol.t, 1e-12)


def test_torques_in_axes_of_the_drawing_and_of_bodies():
    """A body that spins: what turns with it is another torque than what stays."""
    for frame, expected in ((None, (1.0, 0.0, 0.0)), ("body", (0.0, 1.0, 0.0))):
        m = zd.Mechanism("body", dimension=3)
        body = m.body("body", 1.0, (0.4, 0.4, 0.4), rotation=Rotation.from_euler("z", 90, degrees=True).as_matrix())
        m.torque("kick", body, value=0.8, axis=(1, 0, 0), frame=frame)
        m.force("push", body, along=(0, 0, 1), value=3.0, frame=frame and body)
        sol = zd.simulate(m, 1e-3, step=1e-3)
        assert_close(sol["body.angular_acceleration"][0], 2.0 * np.array((1.0, 0, 0)), 1e-13)
        assert_close(sol["body.acceleration"][0], np.array((0, 0, 3.0)), 1e-13)
        turned = m.system()
        p = turned.p0.copy()
        p[3:] = Rotation.from_euler("z", 180, degrees=True).as_quat(scalar_first=True)
        sol = zd.simulate(turned, 1e-3, p, turned.v0, step=1e-3)
        assert_close(sol["body.angular_acceleration"][0], 2.0 * np.array(expected), 1e-13)


def test_a_torque_between_two_bodies():
    m = zd.Mechanism("wheel on a body", dimension=3)
    body, wheel = m.body("body", 1.0, (0.4, 0.4, 0.6)), m.body("wheel", 1.0, (0.1, 0.1, 0.2))
    m.revolute("axle", body, wheel, at=(0, 0, 0), axis=(0, 0, 1))
    m.torque("motor", wheel, value=0.3, axis=(0, 0, 1), against=body)
    sol = zd.simulate(m, 1.0, step=0.05)
    assert_close(sol["wheel.angular_velocity.z"], 0.3 / 0.2 * sol.t, 1e-10)
    assert_close(sol["body.angular_velocity.z"], -0.3 / 0.6 * sol.t, 1e-10)


def test_gears_and_screws():
    """A gear of 3 to 2 goes on through many turns; a screw weighs on its motor by its pitch."""
    m = zd.Mechanism("gears", dimension=3, gravity=(0, 0, -9.81))
    wheels = [m.body(f"wheel{i}", 1.0, (0.1, 0.1, 0.2)) for i in range(2)]
    nut = m.body("nut", 5.0, (0.1, 0.1, 0.1), at=(0, 0, 1))
    pins = [m.revolute(f"pin{i}", m.ground, wheel.point((0, 0, 0)), axis=(0, 0, 1)) for i, wheel in enumerate(wheels)]
    m.gear("teeth", *pins, ratio=-1.5)
    m.prismatic("guide", m.ground, nut, axis=(0, 0, 1))
    m.screw("thread", wheels[1], nut, axis=(0, 0, 1), pitch=-0.01)
    m.motor("drive", pins[0], speed=20.0)
    sol = zd.simulate(m, 2.0, step=1e-2)
    assert_close(sol["pin1.angle"], -30.0 * sol.t, 1e-11)
    assert_close(sol["guide.displacement"], 0.01 * -30.0 / (2 * np.pi) * sol.t, 1e-11)
    assert_close(sol["drive.torque"], np.full(len(sol.t), -1.5 * 5.0 * 9.81 * 0.01 / (2 * np.pi)), 1e-8)


def test_hookes_joint_turns_unevenly():
    """The tangents of both angles are as one to the cosine of the angle between the shafts."""
    bend = np.pi / 6
    out = np.array([np.cos(bend), np.sin(bend), 0])
    m = zd.Mechanism("Hooke", dimension=3)
    one, other = m.link("one", (-1, 0, 0), (0, 0, 0), 1.0), m.link("other", (0, 0, 0), out, 1.0)
    m.revolute("in", m.ground, one.start, axis=(1, 0, 0))
    m.cylindrical("out", m.ground, other.end, axis=out)
    m.universal("cross", one.end, other.start, axes=((0, 0, 1), (-np.sin(bend), np.cos(bend), 0)))
    m.motor("drive", "in", speed=3.0)
    sol = zd.simulate(m, 2.0, step=2e-3)
    driven, turned = sol["out.angle"], 3.0 * sol.t
    assert_close(np.sin(driven) * np.cos(turned), np.sin(turned) * np.cos(driven) * np.cos(bend), 1e-9, scale=1.0)


# ---- measures ----


@pytest.mark.parametrize("order", ["zyx", "xyz", "zxz", "yxy", "xzy"])
def test_angles_are_those_of_scipy(order):
    sol = zd.simulate(heavy_top(), 0.1, step=2e-3)
    expected = Rotation.from_matrix(sol["top.rotation"][1:]).as_euler(order.upper())    # at first, axes may be in line
    body = heavy_top()["top"]
    assert_close(np.exp(1j * sol[body.rotation.euler(order)][1:]), np.exp(1j * expected), 1e-12)
    q = Rotation.from_matrix(sol["top.rotation"]).as_quat(scalar_first=True)
    assert_close(np.abs((sol[body.quaternion] * q).sum(axis=1)), np.ones(len(sol.t)), 1e-13)
    assert (np.abs(np.diff(sol["top.quaternion"], axis=0)).max() < 0.5)


READERS = {
    "solution": lambda m, name: zd.simulate(m, 0.6, step=0.1)[name][-1],
    "recorded": lambda m, name: zd.simulate(m, 0.6, step=0.1, outputs=[name])[name][-1],
    "at": lambda m, name: zd.simulate(m, 1.0, step=0.1).at(0.6)[name],
    "run": lambda m, name: advanced(zd.Run(m, step=0.1))[name],
    "runs": lambda m, name: advanced(zd.ManyRuns(m, step=0.1, runs=2))[name][1],
    "instant": lambda m, name: zd.Instant(m, 0.6, *(sol.p[-1] for sol in [zd.simulate(m, 0.6, step=0.1)]))[name],
    "kinematics": lambda m, name: zd.kinematics(m, {"pin.angle": lambda t: 2.0 * t}, np.array([0.0, 0.6]))[name][-1]}


def advanced(run):
    run.advance_to(0.6)
    return run


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize(("quantity", "expected"), [
    ("rotation", lambda turned: turned.as_matrix()), ("quaternion", lambda turned: turned.as_quat(scalar_first=True)),
    ("euler.zyx", lambda turned: turned.as_euler("ZYX"))])
def test_orientations_have_one_shape_wherever_they_are_read(reader, quantity, expected):
    """A wheel that turns at 2 rad/s about a tilted axis: its orientation after 0.6 s is SciPy's."""
    m = zd.Mechanism("wheel", dimension=3)
    wheel = m.body("wheel", 1.0, (1.0, 1.0, 1.0))
    m.revolute("pin", m.ground, wheel, at=(0, 0, 0), axis=TILTED[:, 2])
    m.start({"pin.speed": 2.0})
    found, known = READERS[reader](m, f"wheel.{quantity}"), expected(Rotation.from_rotvec(1.2 * TILTED[:, 2]))
    assert np.shape(found) == known.shape
    assert_close(found, known, 1e-9, scale=1.0)


def test_orientations_at_rest_and_in_ensembles():
    m = zd.Mechanism("hung", dimension=3, gravity=(0, 0, -9.81))
    hung = m.body("hung", 1.0, (1.0, 1.0, 1.0), rotation=TILTED)
    m.bushing("soft", m.ground.point((0, 0, 0)), hung.point((0, 0, 0)), stiffness=1.0, torsion=1.0)
    at_rest = zd.equilibrium(m)
    assert_close(at_rest["hung.rotation"], TILTED, 1e-9, scale=1.0)
    assert_close(at_rest["hung.quaternion"], Rotation.from_matrix(TILTED).as_quat(scalar_first=True), 1e-9, scale=1.0)
    for given in ({"parameters": {"hung.mass": [1.0, 2.0]}}, {"v0": np.zeros((2, 6))}):
        found = zd.ensemble(m, 0.2, step=0.1, outputs=["hung.rotation"], **given)["hung.rotation"]
        assert_close(found, np.broadcast_to(TILTED, (2, 3, 3, 3)), 1e-9, scale=1.0)


def test_entries_without_axes_have_numbers_in_all_tables(tmp_path):
    m = zd.Mechanism("hung", dimension=3)
    m.body("hung", 1.0, (1.0, 1.0, 1.0), rotation=TILTED)
    names = [f"hung.rotation[{i}, {j}]" for i in range(3) for j in range(3)]
    sol = zd.simulate(m, 0.1, step=0.1)
    assert sol.to_csv(tmp_path / "hung.csv", ["hung.rotation"]).read_text().splitlines()[0] == "t [s]," + ",".join(
        f'"{name}"' for name in names)
    ens = zd.ensemble(m, 0.1, v0=np.zeros((2, 6)), step=0.1, outputs=["hung.rotation", "hung.position"])
    table = pytest.importorskip("pandas") and ens.to_pandas()
    assert list(table.columns) == [*names, *(f"hung.position.{axis}" for axis in "xyz")]
    assert_close(table[names].to_numpy(), np.broadcast_to(TILTED.ravel(), (4, 9)), 1e-12)


def test_a_system_keeps_its_names():
    system = heavy_top().system("absolute")
    again = pickle.loads(pickle.dumps(system))
    assert again.coordinates == system.coordinates
    assert [name for name, _ in system.coordinates] == ["top.x", "top.y", "top.z", "top.e0", "top.e1", "top.e2", "top.e3"]
    assert [str(variable.unit) for variable in system.velocities] == ["m/s"] * 3 + ["rad/s"] * 3
    assert {"top.rotation", "tip.force", "tip.position", "top.center.velocity"} <= set(system.measures)
    assert zd.check(system)
    assert system.points(system.p0).shape[1] == 3
    assert repr(heavy_top()) == "<Mechanism heavy top: space, 1 body, 1 joint; no forces but gravity (0, 0, -9.81)>"


def test_numbers_change_by_path():
    system = heavy_top().system("absolute")
    system = system.with_parameters({"top.mass": 7.5, "top.inertia.yy": 0.4, "top.com.y": 0.5, "gravity.z": -1.0})
    assert_close(np.diag(system.evaluate().M), np.array([7.5] * 3 + [0.234375, 0.4, 0.234375]), 1e-15)
    assert_close(system.p0[:3], np.array([0, 0.5, 0]), 1e-15)
    with refused("inertia", "'top'"):
        heavy_top().with_parameters({"top.inertia.yy": 4.0})


def test_particles_on_a_body_shift_its_centre():
    m = zd.Mechanism("dumbbell", dimension=3)
    bar = m.body("bar", 0.0)
    for i, place in enumerate([(1, 0, 0), (-1, 0.5, 0), (0, 0, 2)]):
        m.particle(f"end{i}", 1.0 + i, at=bar.point(place))
    M = np.diag(m.evaluate().M)
    masses, places = np.arange(1.0, 4.0), np.array([(1, 0, 0), (-1, 0.5, 0), (0, 0, 2)])
    arms = places - masses @ places / 6
    J = sum(mass * ((arm @ arm) * np.eye(3) - np.outer(arm, arm)) for mass, arm in zip(masses, arms, strict=True))
    assert_close(M[:3], np.full(3, 6.0), 1e-15)
    assert_close(np.sort(M[3:]), np.linalg.eigvalsh(J), 1e-14)
    m.start({"bar.angular_velocity": (0.3, 0.1, -0.2)})
    sol = zd.simulate(m, 0.5, step=1e-2)
    assert_close(sol["end2.position"][0], np.array([0, 0, 2.0]), 1e-14)
    assert_close(sol["bar.rotation"][0], np.eye(3), 1e-14, scale=1.0)
