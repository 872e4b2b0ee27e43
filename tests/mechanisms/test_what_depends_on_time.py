"""Stiffnesses that depend on time, against laws that say the same, and SciPy; masses and gravity, which are refused."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import assert_close, refused


def hung(**given):
    m = zd.Mechanism("hung")
    m.spring("k", m.ground.point((0, 0)), m.particle("mass", 2.0, at=(0, -1)), **given)
    return m


@pytest.mark.parametrize("given", [lambda t: 5 + t, sp.Symbol("t"), zd.table([0.0, 1.0, 2.0, 3.0], [1.0, 2.0, 2.0, 1.0])],
                         ids=["function", "expression", "table"])
def test_they_are_refused_with_what_to_take(given):
    m = zd.Mechanism("none")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    for call, hint in ((lambda: hung(stiffness=5.0, damping=given), "lambda speed"),
                       (lambda: m.bushing("b", m.ground, link, at=(0, 0), stiffness=(1.0, given)), "stiffness of 'b'"),
                       (lambda: zd.Mechanism("g", gravity=(0, given)), r"force\(\)"),
                       (lambda: m.particle("p", given, at=(0, 0)), "acceleration"),
                       (lambda: m.body("p", given, 1.0), "acceleration")):
        with refused("wrong-type", f"must be a number, not a function: .*{hint}" if "'" not in hint else hint):
            call()


def stiffness(t):
    return 50 + 20 * np.sin(3 * t)


def called():
    """The same as a function with state, which is not recorded."""
    calls = []

    def law(t):
        calls.append(t)
        return stiffness(t)
    return law


def bar(dimension, which=None, **given):
    """A bar with a torsion spring at its hinge, or on an angle of a universal joint."""
    zero = (0,) * (dimension - 2)
    m = zd.Mechanism("bar", dimension=dimension, gravity=(0, -9.81, *zero))
    link = m.link("bar", (0, 0, *zero), (1, 0, *zero), mass=1.0)
    if which:
        pin = m.universal("pin", m.ground, link, at=(0, 0, 0), axes=((0, 0, 1), (0, 1, 0)))
    else:
        pin = m.revolute("pin", m.ground, link.start, **({"axis": (0, 0, 1)} if zero else {}))
    m.torsion_spring("k", getattr(pin, which) if which else pin, **given)
    return m


def apart(dimension, **given):
    """A particle that swings on a spring."""
    zero = (0,) * (dimension - 2)
    m = zd.Mechanism("hung", dimension=dimension, gravity=(0, -9.81, *zero))
    m.spring("k", m.ground.point((0, 0, *zero)), m.particle("mass", 2.0, at=(0.3, -1, *zero)), **given)
    return m


SPRINGS = [(lambda **given: apart(2, **given), {"length": 0.8}, {"force": lambda t, length: stiffness(t) * (length - 0.8)}),
           (lambda **given: apart(3, **given), {"length": 0.8}, {"force": lambda t, length: stiffness(t) * (length - 0.8)}),
           (lambda **given: bar(2, **given), {"angle": -0.4}, {"torque": lambda t, angle: -stiffness(t) * (angle + 0.4)}),
           (lambda **given: bar(3, **given), {"angle": -0.4}, {"torque": lambda t, angle: -stiffness(t) * (angle + 0.4)}),
           (lambda **given: bar(3, "angle2", **given), {}, {"torque": lambda t, angle: -stiffness(t) * angle})]
STIFFNESSES = [stiffness, 50 + 20 * sp.sin(3 * sp.Symbol("t")), called()]


@pytest.mark.parametrize(("make", "slack", "law"), SPRINGS, ids=["plane", "space", "torsion", "in space", "universal"])
@pytest.mark.parametrize("given", STIFFNESSES, ids=["function", "expression", "call"])
def test_a_stiffness_of_time_is_a_law(make, slack, law, given, tmp_path):
    """Tension and torque of k(t) times the elongation or the angle, also in files, lifted, compiled, and with a damping."""
    known = zd.simulate(make(**law, damping=0.3), 0.5, step=1e-3)
    effort = "k.torque" if "torque" in law else "k.force"
    m = make(stiffness=given, damping=0.3, **slack)
    every = [m, *([] if given is STIFFNESSES[2] else [zd.load(m.save(tmp_path / "m")), m.system(compiled=True)])]
    for each in every:
        sol = zd.simulate(each, 0.5, step=1e-3)
        assert_close(sol.p, known.p, 1e-12, scale=1.0)
        assert_close(sol[effort], known[effort], 1e-10, scale=10.0)
        assert np.abs(sol.energy_violation).max() < 1e-6
    if m.dimension == 2:
        assert_close(zd.simulate(m.lifted(), 0.5, step=1e-3)[effort], known[effort], 1e-9, scale=10.0)


@pytest.mark.parametrize(("make", "slack", "law"), SPRINGS, ids=["plane", "space", "torsion", "in space", "universal"])
def test_a_stiffness_that_does_not_change_is_that_number(make, slack, law):
    """As a function its work is an input of energy, as a number its potential."""
    known = zd.simulate(make(stiffness=40.0, damping=0.3, **slack), 0.5, step=1e-3)
    sol = zd.simulate(make(stiffness=lambda: 40.0, damping=0.3, **slack), 0.5, step=1e-3)
    assert_close(sol.p, known.p, 1e-12, scale=1.0)


def test_a_stiffness_that_changes():
    """The spring of a swing, k(t) = 50 + 20 sin 3 t: its work is what the balance of energy counts."""
    m = hung(stiffness=stiffness, length=0.8)
    m.force("weight", m["mass"], along=(0, -1), value=lambda t: 2.0 * (9.81 + np.cos(t)))
    sol = zd.simulate(m, 2.0, rtol=1e-11, atol=1e-12, t_eval=np.linspace(0, 2, 21))
    known = solve_ivp(lambda t, y: [y[1], (50 + 20 * np.sin(3 * t)) * (-y[0] - 0.8) / 2 - 9.81 - np.cos(t)], (0, 2), [-1.0, 0.0],
                      rtol=1e-12, atol=1e-13, t_eval=sol.t)
    assert_close(sol["mass.position.y"], known.y[0], 1e-9, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-9


def test_a_rocket_that_burns():
    """Its speed is that of Tsiolkovsky, u ln(m0 / m) - g t, with thrust u dm/dt."""
    m = zd.Mechanism("rocket", gravity=(0, -9.81))
    rocket = m.particle("rocket", 2.0, at=(0, 0))
    m.force("less", rocket, along=(0, 1), value=lambda t, a: 0.5 * t * a, of={"a": rocket.acceleration.y})
    m.force("weight", rocket, along=(0, 1), value=lambda t: 0.5 * t * 9.81)
    m.force("thrust", rocket, along=(0, 1), value=0.5 * 60.0)
    sol = zd.simulate(m, 3.0, rtol=1e-10, atol=1e-10)
    assert_close(sol["rocket.velocity.y"], 60.0 * np.log(2.0 / (2.0 - 0.5 * sol.t)) - 9.81 * sol.t, 1e-8, scale=1.0)


def test_numbers_and_measures_of_a_stiffness():
    """Its length is a parameter; it may be a table, or read measures, of=; an input needs a number."""
    m = apart(2, stiffness=zd.table([0, 1], [50, 80], kind="linear"), length=0.8)
    known = zd.simulate(apart(2, force=lambda t, length: (50 + 30 * t) * (length - 0.9)), 0.5, step=1e-3)
    assert_close(zd.simulate(m.with_parameters({"k.length": 0.9}), 0.5, step=1e-3).p, known.p, 1e-12, scale=1.0)
    given = {"stiffness": lambda t, y: 50 + t - y, "of": {"y": "mass.position.y"}, "length": 0.8}
    sol = zd.simulate(apart(2, **given), 0.5, step=1e-3)
    assert_close(sol["k.force"], (50 + sol.t - sol["mass.position.y"]) * (sol["k.length"] - 0.8), 1e-12, scale=1.0)
    with refused("wrong-value", "must begin with a number"):
        zd.Run(m, step=1e-3, inputs=["k.force"])
