"""Measures of one's own: against NumPy's arithmetic on what they read, in solutions, events, outputs and files."""

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from support import assert_close, called, refused

LAYOUTS = ["joint", "absolute"]


def scene(dimension=2, law=lambda F, v, a: a * F * v, **more):
    """A damped pendulum on a spring, with the power of its spring, and what its pin bears."""
    m = zd.Mechanism("scene", dimension=dimension, gravity=(0, -9.81, 0)[:dimension], parameters={"a": -1.0})
    zero, axis = (0.0,) * (dimension - 2), {"axis": (0, 0, 1)} if dimension == 3 else {}
    bar = m.link("bar", (0, 0, *zero), (1, 0.2, *zero), mass=2.0)
    pin = m.revolute("pin", m.ground, bar.start, damping=0.4, **axis)
    spring = m.spring("coil", m.ground.point((1.5, 0.5, *zero)), bar.end, stiffness=60.0, length=0.2)
    m.measure("power", law, of={"F": spring.force, "v": spring.speed}, unit="W")
    x, y, t = sp.symbols("x y t")
    m.measure("load", sp.sqrt(x**2 + y**2) + t, of={"x": pin.force.x, "y": pin.force.y}, unit="N", **more)
    return m


def expected(sol):
    return -sol["coil.force"] * sol["coil.speed"], np.hypot(*sol["pin.force"].T[:2]) + sol.t


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("compiled", [None, False, True])
def test_they_are_functions_of_other_measures(dimension, layout, compiled):
    system = scene(dimension).system(layout, compiled=compiled)
    sol = zd.simulate(system, 1.0, step=0.01, outputs=["power", "load", "coil.force"])
    power, load = expected(sol)
    assert_close(sol["power"], power, 1e-12, scale=1.0)
    assert_close(sol["load"], load, 1e-12, scale=1.0)
    assert_close(zd.simulate(system, 1.0, step=0.01)["load"], load, 1e-12, scale=1.0)
    assert_close(sol.at(0.5)["power"], power[50], 1e-9, scale=1.0)
    assert {"power", "load"} <= set(system.measures)
    assert sol.unique("power") is sol.unique("load") is True
    run = zd.Run(system, step=0.01)
    run.step(100)
    assert_close(run["load"], load[-1], 1e-12, scale=1.0)
    stored = np.trapezoid(power, sol.t)
    energy = 30.0 * ((sol["coil.length"] - 0.2)**2)
    assert_close(stored, energy[0] - energy[-1], 1e-3, scale=1.0)      # the trapezoidal rule over 100 samples


def test_motion_is_that_without_them():
    """They act on nothing: not one bit of a motion depends on them, in closed form and by matrices."""
    m = scene()
    for layout in LAYOUTS:
        plain = zd.Mechanism("scene", gravity=(0, -9.81))
        bar = plain.link("bar", (0, 0), (1, 0.2), mass=2.0)
        plain.revolute("pin", plain.ground, bar.start, damping=0.4)
        plain.spring("coil", plain.ground.point((1.5, 0.5)), bar.end, stiffness=60.0, length=0.2)
        first, second = (zd.simulate(each.system(layout), 1.0, step=0.01) for each in (plain, m))
        assert np.array_equal(first.p, second.p)
        assert first.stats["closed_form_steps"] == second.stats["closed_form_steps"]


def test_events_stop_where_they_have_a_value():
    sol = zd.simulate(scene(), 2.0, rtol=1e-10, atol=1e-10, events=zd.Event("load", value=22.0, terminal=True))
    assert sol.t[-1] < 2.0
    assert_close(expected(sol)[1][-1], 22.0, 1e-8, scale=1.0)
    x = sp.Symbol("x")
    zero = zd.simulate(scene(), 2.0, rtol=1e-10, atol=1e-10, events=zd.Event(x**2 - 484, of={"x": "load"}, terminal=True))
    assert_close(zero.t[-1], sol.t[-1], 1e-8, scale=1.0)


def test_functions_that_are_called_are_measures_as_well():
    m = scene(law=called(lambda F, v, a: a * F * v))
    assert "measure 'power' (call: " in str(m)
    sol = zd.simulate(m, 0.5, step=0.01)
    assert_close(sol["power"], expected(sol)[0], 1e-12, scale=1.0)
    assert m.system(compiled=True).compiled      # equations do not depend on them


def test_parameters_of_them_change():
    m = scene()
    sol = zd.simulate(m.with_parameters(a=2.0), 0.5, step=0.01)
    assert_close(sol["power"], 2 * sol["coil.force"] * sol["coil.speed"], 1e-12, scale=1.0)
    runs = zd.ensemble(m, 0.5, parameters=zd.grid({"a": [1.0, 2.0]}), step=0.01, outputs=["power"])
    assert_close(runs["power"][1], 2 * runs["power"][0], 1e-12, scale=1.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_files_lifts_and_blocks_have_them(dimension, tmp_path):
    m = scene(dimension)
    known = zd.simulate(m, 0.5, step=0.01)
    loaded = zd.load(m.save(tmp_path / "m"))
    assert_close(zd.simulate(loaded, 0.5, step=0.01)["load"], known["load"], 1e-12, scale=1.0)
    if dimension == 2:
        assert_close(zd.simulate(m.lifted(), 0.5, step=0.01)["power"], known["power"], 1e-8, scale=1.0)


@pytest.mark.parametrize(("law", "of", "code", "sentence"), [
    (lambda x: x, {"x": "pin.force"}, "wrong-measure", "'pin.force' is not one"),
    (lambda x: x, {"x": "power"}, "wrong-measure", "'power' is one of your own"),
    (lambda x: x, {"x": "absent.force"}, "wrong-name", "there is no 'absent'"),
    (lambda q: q, {}, "user-function", "q")])
def test_what_they_cannot_read_is_named(law, of, code, sentence):
    m = scene()
    with refused(code, sentence):
        m.measure("wrong", law, of=of)
        zd.simulate(m, 0.1, step=0.01)["wrong"]


def test_other_laws_do_not_read_them():
    m = scene()
    with refused("wrong-measure", "'power' is one of your own"):
        m.motor("drive", m["pin"], torque=lambda x: x, of={"x": "power"})
    with refused("duplicate-name", "power"):
        m.measure("power", 1.0)
