"""Stiffnesses and gravity that depend on time, against forces that say the same, and SciPy; masses, which are refused."""

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


# ---- gravity ----

WEIGHTS = {"bar": 2.0, "bob": 0.7, "free": 1.5, "body": 2.0}        # kg


def under(dimension, **given):
    """A bar with a particle at its end, a free particle, and a body that turns about a centre off its origin."""
    more = (0,) * (dimension - 2)
    m = zd.Mechanism("under", dimension=dimension, **given)
    bar = m.link("bar", (0, 0, *more), (1, 0, *more), mass=WEIGHTS["bar"])
    m.revolute("pin", m.ground, bar.start, **({"axis": (0, 0, 1)} if more else {}))
    m.particle("bob", WEIGHTS["bob"], at=bar.end)
    m.particle("free", WEIGHTS["free"], at=(0, 0, *more))
    m.body("body", WEIGHTS["body"], (0.1, 0.2, 0.3) if more else 0.3, at=(2, 1, *more), com=(0.3, 0.1, *more))
    m.start({"body.angular_velocity": (1.0, -2, 3) if more else 3.0, "body.velocity": (0.1, 0.2, *more)})
    return m


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("compiled", [None, True])
def test_gravity_of_time_is_the_weight_of_each_body(dimension, layout, compiled, tmp_path):
    """At its centre of mass, particles included; the energy that it gives is an input."""
    more = (0,) * (dimension - 2)
    m, known = under(dimension, gravity=lambda t: (0.3 * np.sin(4 * t), -9.81 + 3 * np.sin(2 * t), *more)), under(dimension)
    for name, mass in WEIGHTS.items():
        known.force(f"{name} x", name, along=(1, 0, *more), value=lambda t, mass=mass: mass * 0.3 * np.sin(4 * t))
        known.force(f"{name} y", name, along=(0, 1, *more), value=lambda t, mass=mass: mass * (-9.81 + 3 * np.sin(2 * t)))
    found, known, again = (zd.simulate(each.system(layout, compiled=compiled), 0.5, step=1e-3)
                           for each in (m, known, zd.load(m.save(tmp_path / "m"))))
    assert_close(found.p, known.p, 1e-13, scale=1.0)
    assert_close(again.p, found.p, 1e-14, scale=1.0)
    assert_close(found["pin.force"], known["pin.force"], 1e-12, scale=10.0)
    assert np.abs(found.energy_violation).max() < 1e-9
    if dimension == 2:
        assert_close(zd.simulate(m.lifted(), 0.5, step=1e-3)["body.position"][:, :2], found["body.position"], 1e-10, scale=1.0)


@pytest.mark.parametrize(("given", "parameters", "fallen"), [
    (lambda g, t: (0, -g - 5 * t), {"g": 2.0}, 1 + 5 / 6), ((0, -2 - 5 * sp.Symbol("t")), {}, 1 + 5 / 6),
    ((0, zd.table([0, 2], [-9, -1], kind="linear")), {}, 4.5 - 4 / 6), ((0, lambda t: -6 * t), {}, 1.0)])
def test_gravity_as_functions_expressions_and_tables(given, parameters, fallen):
    """The fall of a particle in 1 s; other masses fall alike, and gravity that is assigned adds."""
    m = under(2, gravity=given, parameters=parameters)
    for each in (m, m.with_parameters({"free.mass": 3.0})):
        assert_close(zd.simulate(each, 1.0, rtol=1e-10, atol=1e-10)["free.position.y"][-1], -fallen, 1e-9, scale=1.0)
    m.gravity[1] = -2.0
    assert_close(zd.simulate(m, 1.0, rtol=1e-10, atol=1e-10)["free.position.y"][-1], -fallen - 1, 1e-9, scale=1.0)
    assert "varying gravity" in str(under(2, gravity=given, parameters=parameters))


@pytest.mark.parametrize(("given", "code", "sentence"), [
    (lambda x: (0, x), "user-function", "gravity has the argument 'x'"),
    ((0, lambda t: t, 0), "shape", "one law for each of 2 directions")])
def test_gravity_that_is_refused(given, code, sentence):
    with refused(code, sentence):
        zd.Mechanism("none", gravity=given)


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
