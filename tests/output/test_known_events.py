"""Events that the core evaluates itself: with the bits of callables that say the same, and refused where nothing can be read."""

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from support import refused
from zerodrift._private import gateway
from zerodrift._private.gateway.known_events import COORDINATE, MEASURE, VELOCITY, Reading
from zerodrift.errors import ZerodriftError
from zerodrift.symbolics.compile import compilers

A1, A3, RATE, GRAVITY, T = sp.symbols("alpha1 alpha3 alpha1_dot gravity t")
EXPRESSION_ROUNDING = 1e-13  # of an expression that SymPy or the compiler may write in another order


def pendulum():
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    return m, link


def found(system, event, **options):
    sol = zd.simulate(system, 2.0, **({"step": 0.01} | options), events=event)
    return sol.t_events[0], sol.p_events[0], sol.v_events[0], sol.message


def assert_same_bits(some, others):
    assert len(some[0])
    assert some[-1] == others[-1]
    for one, other in zip(some[:-1], others[:-1], strict=True):
        assert np.array_equal(one, other)


@pytest.mark.parametrize("terminal", [False, True])
@pytest.mark.parametrize("options", [{}, {"step": None, "integrator": "dop853", "rtol": 1e-8},
                                     {"formulation": "mixed", "stabilization": zd.Projection(every=3)}],
                         ids=["closed_form", "chosen", "general"])
@pytest.mark.parametrize(("what", "value", "function"), [
    ("alpha1", 2.0, lambda p: p[0]), ("alpha2_dot", 0.0, lambda v: v[1]), (sp.Symbol("alpha3") + T, 0.0, lambda t, p: p[2] + t)],
    ids=["coordinate", "velocity", "expression"])
def test_bits_are_those_of_a_callable(what, value, function, options, terminal):
    bar = zd.systems.four_bar()
    known, asked = (found(bar, zd.Event(each, value=value, terminal=terminal), **options) for each in (what, function))
    assert_same_bits(known, asked)


def test_measures_are_those_of_a_callable():
    m, link = pendulum()
    height = link.end.position.y
    for known, asked in (
            (zd.Event(height, value=-0.5), zd.Event(lambda y: y + 0.5, of={"y": height})),
            (zd.Event(sp.Symbol("y") + 0.5, of={"y": height}), zd.Event(lambda y: y + 0.5, of={"y": height})),
            (zd.Event(sp.Symbol("link.angle") * 2, value=-2.0), zd.Event(lambda a: a * 2, value=-2.0, of={"a": "link.angle"}))):
        assert_same_bits(found(m, known), found(m, asked))


def test_expressions_of_symbolic_systems_have_their_own_symbols():
    x, y = dynamicsymbols("x y")
    L, g = sp.symbols("L g")
    pendulum = zd.symbolic([x, y], kinetic=(x.diff()**2 + y.diff()**2) / 2, potential=g * y, constraints=[x**2 + y**2 - L**2],
                           parameters={L: 1.0, g: 9.81}, p0=[1.0, 0.0], v0=[0.0, 0.0])
    event = x * x.diff() + y.diff() / L + sp.cos(dynamicsymbols._t) - g / 9.81
    known = found(pendulum, event)
    asked = found(pendulum, lambda t, p, v: p[0] * v[0] + v[1] / 1.0 + np.cos(t) - 1)
    assert len(known[0]) == len(asked[0]) > 0
    assert np.abs(known[0] - asked[0]).max() < EXPRESSION_ROUNDING


def test_parameters_have_the_values_of_the_system():
    bar = zd.systems.four_bar(gravity=5.0)
    expression = zd.Event(sp.sin(A1) + RATE * GRAVITY / 50)
    assert np.abs(found(bar, expression)[0] - found(bar, lambda t, p, v: np.sin(p[0]) + v[0] / 10)[0]).max() < EXPRESSION_ROUNDING


def test_without_a_compiler_it_is_evaluated_in_python(monkeypatch):
    bar, expression = zd.systems.four_bar(), sp.tanh(A1 - 2) + 1e-3 * A3     # not compiled before
    monkeypatch.setattr(compilers, "find", lambda: None)
    without = found(bar, expression)
    monkeypatch.undo()
    assert np.abs(without[0] - found(bar, expression)[0]).max() < EXPRESSION_ROUNDING


def test_what_has_no_finite_value_is_named():
    with pytest.raises(ZerodriftError, match=r"event 1 must have a finite value") as caught:
        zd.simulate(zd.systems.four_bar(), 2.0, step=0.01, events=["alpha2", sp.log(2 - A1)])
    assert 0 < len(caught.value.solution.t) < 200


@pytest.mark.parametrize(("what", "code", "error"), [
    (sp.Symbol("alpha4"), "unknown-choice", "events"),
    (dynamicsymbols("alpha1").diff(dynamicsymbols._t, 2), "expression", "which"),
    (dynamicsymbols("beta").diff(), "expression", "which"), (A1 * sp.I, "expression", None),
    (sp.Function("f")(A1), "unknown-choice", None)])
def test_expressions_that_cannot_be_read_are_refused(what, code, error):
    with refused(code, error):
        zd.simulate(zd.systems.four_bar(), 1.0, step=0.01, events=zd.Event(what))


def test_names_bound_for_a_measure_are_refused():
    with refused("conflicting-arguments", r"^of must be left out of events: it.*'alpha1' is a measure"):
        zd.simulate(zd.systems.four_bar(), 1.0, step=0.01, events=zd.Event("alpha1", of={"alpha2": "alpha2"}))


@pytest.mark.parametrize("reading", [Reading(COORDINATE, 3), Reading(VELOCITY, -1), Reading(MEASURE, 0)])
def test_the_core_refuses_to_read_what_is_not_there(reading):
    bar = zd.systems.four_bar()
    known = zd.runs.arguments.events.Watched("events", None, 0, 0, gateway.KnownEvent((reading,), 0.0))
    watcher = gateway.Watcher(bar._core, [known], bar._core)
    chosen = {"formulation": "schur", "integrator": "rk4", "stabilization": None, "energy": None, "step": 0.01, "save_every": 1}
    options = zd.runs.arguments.settings.core_settings((0.0, 1.0), chosen)
    with pytest.raises(ZerodriftError, match="an event must read quantities that the system has"):
        gateway.Run(bar._core, options, np.array(bar.p0), np.array(bar.v0), watcher)
