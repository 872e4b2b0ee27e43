"""Springs with laws of their own: signs, against stiffnesses, actuators, and SciPy with equations by hand; energy; files."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import assert_close, refused

LAYOUTS = ["joint", "absolute"]


def scene(dimension, name="k", **given):
    """A mass that swings and stretches on a spring of 0.3 m, in the plane or in space."""
    zero = (0.0,) * (dimension - 2)
    m = zd.Mechanism("swing", dimension=dimension, gravity=(0, -9.81, *zero))
    m.spring(name, m.ground.point((0, 0, *zero)), m.particle("mass", 1.5, at=(0.4, 0, *zero)), **given)
    return m


def swing(dimension, **given):
    """The same with a torsion spring at the hinge of a bar."""
    m = zd.Mechanism("bar", dimension=dimension, gravity=(0, -9.81, 0)[:dimension])
    zero, axis = (0.0,) * (dimension - 2), {"axis": (0, 0, 1)} if dimension == 3 else {}
    bar = m.link("bar", (0, 0, *zero), (1, 0, *zero), mass=1.0)
    m.torsion_spring("k", m.revolute("pin", m.ground, bar.start, **axis), **given)
    return m


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("law", [lambda length, speed: 60 * (length - 0.3) + 0 * speed, lambda length: 60 * (length - 0.3)])
def test_a_law_of_a_spring_is_its_tension(dimension, law):
    """The same motion as that of a stiffness, and the force that it measures, with the damping beside it."""
    known = zd.simulate(scene(dimension, stiffness=60, length=0.3, damping=0.7), 1.0, step=1e-3)
    sol = zd.simulate(scene(dimension, force=law, damping=0.7), 1.0, step=1e-3)
    assert_close(sol.p, known.p, 1e-12, scale=1.0)
    for measure in ("k.force", "k.length", "k.speed"):
        assert_close(sol[measure], known[measure], 1e-11, scale=1.0)
    assert_close(sol["k.force"], 60 * (sol["k.length"] - 0.3) + 0.7 * sol["k.speed"], 1e-12, scale=1.0)
    assert_close(np.gradient(sol["k.length"], sol.t, edge_order=2), sol["k.speed"], 1e-4, scale=1.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_law_of_a_torsion_spring_acts_on_the_second_body(dimension):
    given = {"stiffness": 5.0, "damping": 0.2}, {"torque": lambda angle, speed: -5 * angle, "damping": 0.2}
    known, sol = (zd.simulate(swing(dimension, **each), 1.0, step=1e-3) for each in given)
    assert_close(sol.p, known.p, 1e-12, scale=1.0)
    for measure in ("k.torque", "pin.torque"):
        assert_close(sol[measure], known[measure], 1e-11, scale=1.0)


@pytest.mark.parametrize(("make", "measure", "word", "law"), [
    (scene, "k.length", "force", lambda length, speed: 500 * (length - 0.3)),
    (swing, "pin.angle", "torque", lambda angle, speed: -50 * angle)])
def test_the_laws_of_the_docstrings_restore(make, measure, word, law):
    """The spring is driven back: from outside inwards, and from inside outwards."""
    for side in (-1, 1):
        m = make(2, **{word: law})
        m.gravity[:] = 0
        rest = 0.3 if make is scene else 0.0
        m.start({measure: rest + 0.05 * side})
        found = zd.simulate(m, 0.02, step=1e-3)[measure] - rest
        assert abs(found[-1]) < abs(found[0])
        assert f"{word}=lambda" in getattr(zd.Mechanism, {"force": "spring", "torque": "torsion_spring"}[word]).__doc__


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("compiled", [None, True])
def test_an_elastic_pendulum_of_a_stiffening_spring(layout, compiled):
    """Against SciPy with the equations of a point by hand; the balance of energy counts the law's work as an input."""
    def law(L, v, t):
        return 40 * (L - 0.3) + 900 * (L - 0.3) ** 3 + 0.4 * v * abs(v) + np.sin(5 * t)

    m = scene(2, force=law, of={"L": "k.length", "v": "k.speed"}, damping=0.3)
    sol = zd.simulate(m.system(layout, compiled=compiled), 2.0, rtol=1e-11, atol=1e-12, t_eval=np.linspace(0, 2, 41))

    def rates(t, y):
        at, v = y[:2], y[2:]
        length = np.hypot(*at)
        speed = at @ v / length
        return [*v, *(np.array([0, -9.81]) - (law(length, speed, t) + 0.3 * speed) * at / length / 1.5)]

    known = solve_ivp(rates, (0, 2), [0.4, 0, 0, 0], rtol=1e-12, atol=1e-13, t_eval=sol.t, method="DOP853")
    assert_close(sol["mass.position"], known.y[:2].T, 1e-8, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-8
    assert_close(sol.potential_energy, 1.5 * 9.81 * sol["mass.position.y"], 1e-12, scale=1.0)


def test_a_called_law_and_a_constant_pull_as_well():
    """A function with state is called with the same sign; a number is a constant tension, which inputs and parameters change."""
    calls = []

    def called(length, speed):
        calls.append(length)
        return 60 * (length - 0.3)

    known = zd.simulate(scene(2, stiffness=60, length=0.3, damping=0.7), 0.5, step=1e-3)
    assert_close(zd.simulate(scene(2, force=called, damping=0.7), 0.5, step=1e-3).p, known.p, 1e-12, scale=1.0)
    assert calls
    m = scene(2, force=3.0, damping=0.7)
    law = zd.simulate(scene(2, force=lambda: 3.0, damping=0.7), 0.5, step=1e-3)
    sol = zd.simulate(m, 0.5, step=1e-3)
    assert_close(sol.p, law.p, 1e-13, scale=1.0)
    assert m.system().parameters["k.force"] == 3.0
    changed = zd.simulate(m.with_parameters({"k.force": 5.0}), 0.5, step=1e-3)
    run = zd.Run(m, step=1e-3, inputs=["k.force"])
    run["k.force"] = 5.0
    run.step(500)
    assert_close(run.p, changed.p[-1], 1e-12, scale=1.0)
    assert np.abs(changed.p[-1] - sol.p[-1]).max() > 1e-3


@pytest.mark.parametrize("make", [lambda: scene(2, force=lambda length: 60 * length, damping=0.5), lambda: scene(3, force=2.0),
                                  lambda: swing(2, torque=lambda angle, speed: -5 * angle), lambda: swing(3, torque=1.0)])
def test_files_and_lifts_have_the_law(make, tmp_path):
    m = make()
    known = zd.simulate(m, 0.5, step=1e-3)
    assert_close(zd.simulate(zd.load(m.save(tmp_path / "m")), 0.5, step=1e-3).p, known.p, 1e-14, scale=1.0)
    if m.dimension == 2:
        lifted, measure = zd.simulate(m.lifted(), 0.5, step=1e-3), "k.force" if "mass" in m._elements else "k.torque"
        assert_close(lifted[measure], known[measure], 1e-9, scale=1.0)


@pytest.mark.parametrize(("make", "given", "sentence"), [
    (scene, {}, "spring 'k' must have stiffness or force, not neither"),
    (scene, {"stiffness": 1.0, "force": 1.0}, "spring 'k' must have stiffness or force, not both"),
    (scene, {"force": 1.0, "length": 0.3}, "length= of spring 'k' must be given with stiffness"),
    (scene, {"stiffness": 1.0, "of": {"a": "mass.position.x"}}, "of= of spring 'k' must be given with force"),
    (swing, {"torque": 1.0, "angle": 0.0}, "angle= of torsion spring 'k' must be given with stiffness"),
    (swing, {}, "torsion spring 'k' must have stiffness or torque, not neither")])
def test_either_a_stiffness_or_a_law(make, given, sentence):
    with refused("conflicting-arguments", sentence):
        make(2, **given)


@pytest.mark.parametrize("law", [lambda length: 60 * length, 60 * sp.Symbol("length"),
                                 zd.table([0, 9], [0, 540], argument="length", kind="linear")])
def test_a_parameter_and_an_own_quantity_of_one_name(law, tmp_path):
    """A law must not ask for it; `of=` says which is meant, and a parameter that is added later changes no law."""
    m = scene(2, force=law)
    known = zd.simulate(m, 0.3, step=1e-3)
    m.parameter("length", 7.0)
    with refused("duplicate-name", "force of spring 'k2' asks for 'length', which is 'k2.length' and a parameter of 'swing'"):
        m.spring("k2", m.ground.point((0, 1)), m["mass"], force=law)
    for each in (m, zd.load(m.save(tmp_path / "m"))):
        assert_close(zd.simulate(each, 0.3, step=1e-3).p, known.p, 1e-14, scale=1.0)
    m.spring("k2", m.ground.point((0, 1)), m["mass"], force=law, of={"length": "k2.length"})
    sol = zd.simulate(m, 0.3, step=1e-3)
    assert_close(sol["k2.force"], 60 * sol["k2.length"], 1e-12, scale=1.0)


def test_a_parameter_and_the_angle_of_a_joint():
    m = swing(2, stiffness=1.0)
    m.parameter("angle", 0.5)
    for verb, what in ((m.motor, "motor"), (m.torsion_spring, "torsion spring")):
        with refused("duplicate-name", f"torque of {what} 'second' asks for 'angle', which is 'pin.angle'"):
            verb("second", "pin", torque=lambda angle: -angle)
    with refused("wrong-type", "must be a dict of measures"):
        m.motor("second", "pin", torque=lambda angle: -angle, of="pin.angle")


def test_a_law_between_coincident_points_has_no_direction():
    m = zd.Mechanism("none")
    m.spring("k", m.ground.point((0, 0)), m.particle("mass", 1.0, at=(0, 0)), force=lambda length: length)
    with refused("geometry", "spring 'k' must be apart at the start: its force"):
        zd.simulate(m, 0.1)
