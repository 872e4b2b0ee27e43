"""Bushings with laws of their own: signs, against stiffnesses, momenta and energy, rates of their measures, files."""

import numpy as np
import pytest
import sympy as sp
from scipy.spatial.transform import Rotation

import zerodrift as zd
from support import assert_close, refused
from zerodrift.mechanisms.elements.frames import about

R = about((0.3, 0.6, -0.2), 0.7)        # so that no direction is one of the drawing's
FORCE, TORQUE = np.array([200.0, 300.0, 500.0]), np.array([20.0, 45.0, 30.0])
DAMPED = np.array([3.0, 5.0, 2.0])


def pair(dimension, **given):
    """Two bodies that turn, on a bushing; its point is the mass centre of the second."""
    more = (0.0,) * (dimension - 2)
    m = zd.Mechanism("pair", dimension=dimension, parameters={"a": 2.0})
    turned = {"rotation": R} if more else {"angle": 0.4}
    one = m.body("one", 2.0, (0.3, 0.4, 0.5) if more else 0.5, **turned)
    other = m.body("other", 1.0, (0.2, 0.1, 0.2) if more else 0.2, at=(0.4, 0.1, *more))
    frame = {"axis": (0.6, 0.8, 0.0), "normal": (0.0, 0.0, 1.0)} if more else {}
    m.bushing("mount", one, other, at=(0.4, 0.1, *more), **frame, **given)
    m.start({"one.angular_velocity": (2.0, -1.0, 0.5) if more else 1.5, "other.velocity": (0.3, 0.5, -0.2)[:dimension],
             "other.angular_velocity": (-0.5, 1.0, 2.0) if more else -0.7})
    return m


def linear(dimension):
    """A law that is a stiffness, and a stiffness, without torques in space, whose law has no potential."""
    n, k = dimension, float(TORQUE[0])
    force = {"force": lambda displacement: -FORCE[:n] * displacement}
    return ({**force, "torque": lambda angle: -k * angle}, {"stiffness": FORCE[:2], "torsion": k}) if n == 2 else (
        force, {"stiffness": FORCE})


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("compiled", [None, True])
def test_a_law_that_is_a_stiffness(dimension, layout, compiled):
    damping = {"damping": DAMPED[:dimension], "torsion_damping": 0.3}
    law, stiffness = (zd.simulate(pair(dimension, **each, **damping).system(layout, compiled=compiled), 0.4, step=2e-3)
                      for each in linear(dimension))
    assert_close(law.p, stiffness.p, 1e-12, scale=1.0)
    for measure in ("force", "torque", "displacement", "velocity", "angle", "angular_velocity"):
        assert_close(law[f"mount.{measure}"], stiffness[f"mount.{measure}"], 1e-10, scale=10.0)


def force(displacement, velocity, angle, angular_velocity, t, a, x):
    """Components that depend on all there is."""
    turned = angle if np.ndim(angle) == 0 else angle[0]
    spin = angular_velocity if np.ndim(angular_velocity) == 0 else angular_velocity @ angular_velocity
    stiff = FORCE[:len(displacement)] * displacement * (1 + displacement @ displacement)
    return -stiff - a * velocity * spin + np.sin(t) * turned + x


def torque(angle, angular_velocity, displacement):
    return -30.0 * angle**3 - 0.4 * angular_velocity * np.hypot(displacement[0], 0.1)


def slopes(values, h):
    """Differences of order four."""
    return (8 * (values[3:-1] - values[1:-3]) - values[4:] + values[:-4]) / (12 * h)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("is_called", [False, True])
def test_forces_momenta_and_power(dimension, is_called):
    """Force and torque along the first body's axes, on the second: Newton's and Euler's equations, and the balance of energy."""
    seen = []

    def called(angle, angular_velocity, displacement):
        seen.append(0)
        return torque(angle, angular_velocity, displacement)

    m = pair(dimension, force=force, torque=called if is_called else torque, of={"x": "one.position.x"})
    assert ("call" in str(m)) == is_called
    sol = zd.simulate(m, 0.04 if is_called else 0.4, step=1e-3, integrator="rk4" if is_called else "dop853")
    h, n = sol.t[1], len(sol.t)
    if dimension == 2:
        axes = Rotation.from_euler("z", sol["one.angle"][:, None]).as_matrix()[:, :2, :2]
        inertia, spins = 0.2, sol["other.angular_velocity"]
        momentum = inertia * spins
        angle = sol["other.angle"] - sol["one.angle"] + 0.4
        relative = spins - sol["one.angular_velocity"]
    else:
        own = R.T @ np.column_stack([(0.6, 0.8, 0), (0, 0, 1), np.cross((0.6, 0.8, 0), (0, 0, 1))])
        axes = sol["one.rotation"] @ own
        momentum = np.einsum("kij,j,klj,kl->ki", of := sol["other.rotation"], (0.2, 0.1, 0.2), of, sol["other.angular_velocity"])
        started = axes[0].T @ of[0]
        angle = Rotation.from_matrix(np.transpose(axes, (0, 2, 1)) @ of @ started.T).as_rotvec()
        relative = np.einsum("kji,kj->ki", axes, sol["other.angular_velocity"] - sol["one.angular_velocity"])
    apart = np.einsum("kji,kj->ki", axes, sol["other.position"] - sol["one.position"])
    for measure, known in (("displacement", apart - apart[0]), ("angle", angle), ("angular_velocity", relative)):
        assert_close(sol[f"mount.{measure}"], known, 1e-12, scale=1.0)
    assert_close(slopes(apart, h), sol["mount.velocity"][2:-2], 1e-6, scale=1.0)
    values = {word: sol[f"mount.{word}"] for word in ("displacement", "velocity", "angle", "angular_velocity")}
    pushes = [force(**{word: value[k] for word, value in values.items()}, t=sol.t[k], a=2.0, x=sol["one.position.x"][k])
              for k in range(n)]
    turns = [torque(values["angle"][k], values["angular_velocity"][k], values["displacement"][k]) for k in range(n)]
    assert_close(sol["mount.force"], np.einsum("kij,kj->ki", axes, pushes), 1e-11, scale=100.0)
    assert_close(sol["mount.torque"], turns if dimension == 2 else np.einsum("kij,kj->ki", axes, turns), 1e-11, scale=10.0)
    assert_close(sol["other.center.acceleration"], sol["mount.force"], 1e-11, scale=100.0)
    assert_close(slopes(momentum, h), sol["mount.torque"][2:-2], 1e-6, scale=10.0)
    total = 2 * sol["one.velocity"] + sol["other.velocity"]
    assert_close(total, np.tile(total[0], (n, 1)), 1e-12, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-7


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("word", "value", "rate"), [("force", "displacement", "velocity"),
                                                     ("torque", "angle", "angular_velocity")])
def test_the_laws_of_the_docstring_restore(dimension, word, value, rate):
    text = f"{word}=lambda {value}, {rate}: -500 * {value} - 5 * {rate}"
    assert text in " ".join(zd.Mechanism.bushing.__doc__.split())
    more = (0.0,) * (dimension - 2)
    for side in (-1, 1):
        m = zd.Mechanism("one", dimension=dimension)
        block = m.body("block", 1.0, (0.3, 0.4, 0.5) if more else 0.5)
        m.bushing("mount", m.ground, block, at=(0, 0, *more), **{word: eval(text.partition("=")[2])})
        start = ("block.position", np.array([0.01, -0.02, 0.01][:dimension])) if word == "force" else (
            ("block.rotation", about((0.6, 0, 0.8), side * 0.01)) if more else ("block.angle", 0.01))
        m.start({start[0]: start[1] if start[0] == "block.rotation" else side * start[1]})
        found = zd.simulate(m, 0.02, step=1e-3)[f"mount.{value}"]
        assert np.linalg.norm(found[-1]) < 0.95 * np.linalg.norm(found[0])


x, w = sp.Symbol("mount.displacement.x"), sp.Symbol("mount.angular_velocity")


@pytest.mark.parametrize("law", [
    {"force": (-300 * x**3, 5.0), "torque": -3 * w},
    {"force": (lambda displacement: -300 * displacement[0]**3, lambda a: 2.5 * a),
     "torque": lambda angular_velocity: -3 * angular_velocity},
    {"force": (zd.table(np.linspace(-1, 1, 801), -300 * np.linspace(-1, 1, 801)**3, argument="s"), 5.0),
     "torque": lambda u: -3 * u, "of": {"s": "mount.displacement.x", "u": "mount.angular_velocity"}}])
def test_one_law_for_each_direction(law, tmp_path):
    """Expressions, functions of vectors, tables, numbers; in files, and lifted into space."""
    m = pair(2, **law)
    known = zd.simulate(pair(2, force=lambda displacement: (-300 * displacement[0]**3, 5.0),
                             torque=lambda angular_velocity: -3 * angular_velocity), 0.4, step=2e-3)
    for each in (m, zd.load(m.save(tmp_path / "m"))):
        assert_close(zd.simulate(each, 0.4, step=2e-3).p, known.p, 1e-9, scale=1.0)
    lifted = zd.simulate(m.lifted(), 0.4, step=2e-3)
    assert_close(lifted["mount.force"][:, :2], known["mount.force"], 1e-7, scale=10.0)
    assert_close(lifted["mount.torque"][:, 2], known["mount.torque"], 1e-7, scale=1.0)


def test_files_of_space_and_other_elements_that_read_it(tmp_path):
    m = pair(3, force=force, torque=torque, of={"x": "one.position.x"}, damping=DAMPED)
    m.measure("power", lambda v: v**2, of={"v": m["mount"].velocity.y})
    known = zd.simulate(m, 0.2, step=2e-3)
    again = zd.simulate(zd.load(m.save(tmp_path / "m")), 0.2, step=2e-3)
    assert_close(again.p, known.p, 1e-13, scale=1.0)
    assert_close(again["power"], known["mount.velocity"][:, 1]**2, 1e-12, scale=1.0)


@pytest.mark.parametrize(("given", "code", "sentence"), [
    ({"force": lambda displacement: -displacement, "stiffness": 1.0}, "conflicting-arguments", "force of bushing 'mount' must"),
    ({"torque": lambda angle: -angle, "torsion": 1.0}, "conflicting-arguments", "torque of bushing 'mount' must be"),
    ({"force": 1.0}, "shape", "one law for each of 2 directions"),
    ({"force": (1.0, 2.0, 3.0)}, "shape", "one law for each of 2 directions"),
    ({"of": {"x": "one.position.x"}}, "conflicting-arguments", "of= of bushing 'mount' must be given with force"),
    ({"force": lambda length: (0, 0)}, "user-function", "force of bushing 'mount' has the argument 'length'"),
    ({"stiffness": lambda t: 5.0}, "wrong-type", r"lambda t, displacement: -k\(t\)")])
def test_refusals(given, code, sentence):
    with refused(code, sentence):
        pair(2, **given)


def test_a_matrix_and_a_parameter_of_its_own_name():
    with refused("conflicting-arguments", "must be given without torsion"):
        pair(3, stiffness=np.diag([1.0, 1, 1, 0, 0, 0]) + np.roll(np.eye(6), 3, 0) * 0.1, torque=lambda angle: -angle)
    m = pair(2)
    m.parameter("angle", 0.5)
    with refused("duplicate-name", "torque of bushing 'second' asks for 'angle'"):
        m.bushing("second", m["one"], m["other"], at=(0, 0), torque=lambda angle: -angle)


@pytest.mark.parametrize(("law", "sentence"), [(lambda displacement: 5.0, "must return 2 numbers, not 5.0"),
                                               (lambda displacement: (1.0, 2.0, 3.0), "must return 2 numbers")])
def test_other_numbers_of_components(law, sentence):
    with refused("shape", sentence):
        zd.simulate(pair(2, force=law), 0.1)
