"""Measures of several bodies, and of all that acts on the ground."""

import numpy as np
import pytest

import zerodrift as zd
from every_model import MODELS
from support import refused

AXES = "xyz"


def world(sol, body, dimension):
    """Rotations (k, 3, 3) of a body at each sample."""
    if dimension == 3:
        return sol[f"{body}.rotation"]
    return np.broadcast_to(np.eye(3), (len(sol.t), 3, 3))


def loose(dimension):
    """Bodies that turn and fly, one with a mass at its end, a spring between them, one on a hinge."""
    space = (0.0,) * (dimension - 2)
    m = zd.Mechanism("loose", dimension=dimension, gravity=(0.3, -9.81, *[1.0] * len(space)))
    inertia = ((0.3, 0.05, -0.02), (0.05, 0.4, 0.01), (-0.02, 0.01, 0.5)) if space else 0.4
    a = m.body("a", 2.0, inertia, at=(1, 2, *space), com=(0.1, -0.2, *[0.3] * len(space)))
    b = m.body("b", 3.0, inertia, at=(-1, 1, *space))
    bar = m.link("bar", (0, 0, *space), (1, 0, *space), mass=1.5)
    m.particle("tip", 0.7, at=bar.end)
    m.particle("free", 0.4, at=(3, 3, *space))
    m.revolute("pin", m.ground, bar.start, **({"axis": (0.0, 0.6, 0.8)} if space else {}))
    m.spring("spring", a.point((0.2, 0, *space)), b.point((0, 0.3, *space)), stiffness=50.0, length=0.5)
    m.spring("tether", m.ground.point((0, 3, *space)), b.point((0.1, 0, *space)), stiffness=80.0)
    spin = (3.0, -2.0, 1.0) if space else 2.0
    m.start({"a.angular_velocity": spin, "b.velocity": (1.0, 0.5, *[0.2] * len(space)), "pin.speed": 2.0})
    m.group("all", m.bodies)
    m.group("two", ["a", bar])
    return m


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_sums_over_bodies(dimension, coordinates):
    m = loose(dimension)
    sol = zd.simulate(m.system(coordinates), 0.5, step=1e-3)
    centres, momenta, moments, mass = 0.0, 0.0, 0.0, 0.0
    for body in (m["a"], m["bar"]):
        r, v = sol[body.center.position], sol[body.center.velocity]
        centres, momenta, mass = centres + body.mass * r, momenta + body.mass * v, mass + body.mass
        if dimension == 2:
            moments = moments + body.mass * (r[:, 0] * v[:, 1] - r[:, 1] * v[:, 0]) + body.inertia * sol[body.angular_velocity]
        else:
            R = world(sol, body.name, 3)
            J = R @ np.asarray(body.inertia) @ R.transpose(0, 2, 1)
            moments = moments + body.mass * np.cross(r, v) + np.einsum("kij,kj->ki", J, sol[body.angular_velocity])
    assert sol["two.center.position"] == pytest.approx(centres / mass, rel=1e-12)
    assert sol["two.center.velocity"] == pytest.approx(momenta / mass, rel=1e-12)
    assert sol["two.momentum"] == pytest.approx(momenta, rel=1e-12)
    assert sol["two.angular_momentum"] == pytest.approx(moments, rel=1e-10, abs=1e-12)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_what_acts_on_the_ground_is_the_sum_of_joints_and_springs_there(dimension, coordinates):
    """A hinge with its moment, and a tether."""
    m = loose(dimension)
    sol = zd.simulate(m.system(coordinates), 0.5, step=1e-3)
    anchor = np.array([0, 3, *[0.0] * (dimension - 2)])
    end = sol["b.position"] + (sol["b.rotation"] @ [0.1, 0, 0] if dimension == 3 else
                               0.1 * np.transpose([np.cos(sol["b.angle"]), np.sin(sol["b.angle"])]))
    along = (end - anchor) / np.linalg.norm(end - anchor, axis=1)[:, None]
    tether = sol["tether.force"][:, None] * along
    force = tether - sol["pin.force"]
    size = np.abs(force).max()
    assert sol["ground.force"] == pytest.approx(force, abs=1e-9 * size)
    moment = np.cross(np.append(anchor, 0)[:3], np.pad(tether, ((0, 0), (0, 3 - dimension))))
    expected = moment[:, 2] if dimension == 2 else moment - sol["pin.torque"]
    assert sol["ground.torque"] == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
    about = sol.ground_load(about=anchor)
    assert about.force == pytest.approx(sol["ground.force"])
    lever = np.cross(np.append(anchor, 0)[:3], np.pad(force, ((0, 0), (0, 3 - dimension))))
    assert about.torque == pytest.approx(expected - (lever[:, 2] if dimension == 2 else lever), abs=1e-9 * size)


@pytest.mark.parametrize("name", [each for each in MODELS if hasattr(zd.models, each)][::4])
def test_the_rate_of_all_momentum_is_weight_less_the_load_on_the_ground(name):
    """By differences of runs of all models, which share no line with reactions."""
    m = getattr(zd.models, name)()
    if not isinstance(m, zd.Mechanism) or "ground.force" not in m.measures:
        pytest.skip("no ground")
    m.group("everything", [body for body in m.bodies if body.mass])
    mass = sum(body.mass for body in m.bodies)
    sol = zd.simulate(m, 4e-3, step=1e-4)
    h = sol.t[1] - sol.t[0]
    P = sol["everything.momentum"]
    rate = (P[:-4] - 8 * P[1:-3] + 8 * P[3:-1] - P[4:]) / (12 * h)
    size = mass * 9.81 + np.abs(sol["ground.force"]).max()
    assert rate + sol["ground.force"][2:-2] == pytest.approx(mass * np.broadcast_to(m.gravity, rate.shape), abs=1e-6 * size)


def test_outputs_ensembles_lanes_and_files(tmp_path):
    m = zd.models.four_bar()
    m.group("pair", [m.bodies[0], m.bodies[1]])
    names = ["ground.force", "ground.torque", "pair.momentum", "pair.center.position"]
    path = f"{m.bodies[0].name}.mass"
    values = np.linspace(1.0, 3.0, 9)
    ens = zd.ensemble(m, 0.1, parameters={path: values}, step=1e-3, outputs=names)
    for i in (0, 5):
        sol = zd.simulate(m.with_parameters({path: values[i]}), 0.1, step=1e-3, outputs=names)
        again = zd.simulate(zd.load(m.save(tmp_path / "m")).with_parameters({path: values[i]}), 0.1, step=1e-3)
        for name in names:
            assert ens[name][i] == pytest.approx(sol[name], rel=1e-9)
            assert again[name] == pytest.approx(sol[name], rel=1e-12)
    assert zd.Instant(m.lifted())["pair.momentum"][:2] == pytest.approx(zd.Instant(m)["pair.momentum"], rel=1e-9)


def test_kinematics_have_the_load_of_a_prescribed_motion():
    m = zd.Mechanism("hoist", gravity=(0, -9.81))
    load = m.particle("load", 2.0, at=(0.5, 0))
    m.slot("guide", m.ground, load, axis=(0, 1))
    kin = zd.kinematics(m, {"load.position.y": lambda t: 0.1 * np.sin(3 * t)}, np.linspace(0, 1, 11))
    force = -2.0 * (9.81 - 0.9 * np.sin(3 * kin.t))
    assert kin["ground.force"][:, 1] == pytest.approx(force, rel=1e-9)
    assert kin["ground.torque"] == pytest.approx(0.5 * force, rel=1e-9)


def test_wrong_groups():
    m = zd.models.four_bar()
    with refused("wrong-element", "mass"):
        m.group("none", [m.ground])
    with refused("wrong-name", "nobody"):
        m.group("some", ["nobody"])
