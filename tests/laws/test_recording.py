"""Functions that are recorded: the core has their values and derivatives; what cannot be recorded is called."""

import copy
import inspect
import math
import pickle
import re

import numpy as np
import pytest

import written_laws
import zerodrift as zd
from digits import in_core, slope_of
from native_systems import needs_compiler
from support import assert_close, called, refused
from zerodrift.laws.recording import record
from zerodrift.mechanisms.elements.user_functions import Law
from zerodrift.mechanisms.equations.function_calls import Holonomic

LAW_ROUNDING = 1e-13        # of the largest of values of the function
PID = written_laws.CALLS[0][0]
BORDERS = [0.0, 1.0, -1.0, 0.1, -0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.5, 2.0, 3.0, -2.0, 0.6, 0.9, 1.2, 1e-9]


def names_of(function):
    if isinstance(function, np.ufunc):
        return ["t"]
    found = inspect.signature(function).parameters.values()
    return [each.name for each in found if each.default is each.empty]


def law_of(function):
    names = names_of(function)
    return Law("law", function, of={name: f"{name}.angle" for name in names if name != "t"})


def check_values(function):
    law = law_of(function)
    assert law.formula is not None, law.why_called
    chance, names = np.random.default_rng(3), names_of(function)
    points = np.vstack([chance.uniform(-3, 5, (200, len(names))), chance.choice(BORDERS, (200, len(names)))])
    own = [i for i, name in enumerate(names) if name != "t"]
    t = points[:, names.index("t")] if "t" in names else np.zeros(len(points))
    found = in_core(law)(t, points[:, own].copy())
    with np.errstate(all="ignore"):
        expected = np.array([float(function(*point) if isinstance(function,
                                                                  np.ufunc) else function(**dict(zip(names, point, strict=True))))
                             for point in points.tolist()])
    assert np.isfinite(expected).all()
    assert_close(found, expected, LAW_ROUNDING, scale=1.0)
    by_formula = [law.value(t[i], points[i, own], {}) for i in range(len(points))]
    assert_close(by_formula, expected, LAW_ROUNDING, scale=1.0)


def check_slopes(function):
    """Check derivatives of the graph against differences of the formula in 50 digits."""
    law = law_of(function)
    chance, own = np.random.default_rng(4), [name for name in law.names if name != "t"]
    points = chance.uniform(-3, 5, (30, 1 + len(own)))
    found = in_core(law, Holonomic)(points[:, 0].copy(), points[:, 1:].copy())
    for point, (_, *slopes) in zip(points, found, strict=True):
        known = dict(zip(("t", *own), point, strict=True))
        for name, slope in zip((*own, "t"), slopes, strict=False):
            assert_close(slope, slope_of(law.formula, known, name), 1e-12, scale=1.0)


@pytest.mark.parametrize("function", written_laws.RECORDED,
                         ids=lambda function: getattr(function, "__name__", type(function).__name__))
def test_the_core_has_values_and_derivatives_of_the_function(function):
    check_values(function)
    check_slopes(function)


@pytest.mark.parametrize("shape", written_laws.SHAPES)
def test_functions_of_every_shape_are_recorded(shape):
    for body in written_laws.BODIES:
        function = written_laws.written(written_laws.SHAPES[shape], body)
        check_values(function)
        check_slopes(function)


@pytest.mark.parametrize(("shape", "reason"), written_laws.WITH_STATE.items())
def test_functions_with_state_are_called_whatever_they_compute(shape, reason):
    for body in written_laws.BODIES:
        law = law_of(written_laws.written(shape, body))
        assert law.formula is None
        assert re.search(reason, law.why_called), law.why_called
    assert not written_laws.HISTORY
    assert written_laws.STATE == {"last": 0.0}


@pytest.mark.parametrize(("function", "reason"), written_laws.CALLS, ids=[reason for _, reason in written_laws.CALLS])
def test_what_cannot_be_recorded_is_called_and_nothing_changes(function, reason):
    def state():
        return copy.deepcopy((written_laws.STATE, written_laws.HISTORY, written_laws.K,
                              vars(function) if function is PID else None))

    before, law = state(), law_of(function)
    assert law.formula is None
    assert re.search(reason, law.why_called), law.why_called
    assert state() == before
    assert law_of(function).why_called == law.why_called


def swing(law, kind="torque"):
    m = zd.Mechanism("swing", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    if kind == "torque":
        m.torque("drive", link, value=law, of={"q": pin.angle, "u": pin.speed})
    elif kind == "angle":
        m.motor("drive", pin, angle=law)
    else:
        slide = m.prismatic("slide", m.ground, m.body("block", 0.3, 0.1, at=(2, 0)), axis=(0, 1), at=(2, 0))
        if kind == "constraint":
            m.constraint("joined", law, of={"a": pin.angle, "x": slide.displacement})
        elif kind == "cam":
            m.cam("joined", pin, slide, profile=law)
        else:
            m.nonholonomic("joined", law, of={"u": pin.speed, "v": slide.speed, "a": pin.angle})
    return m


SMOOTH = {"torque": lambda t, q, u: -5 * math.sin(q) - 0.3 * u * abs(u) + (2.0 if q > -0.5 else q),
          "angle": lambda t: 0.3 * math.sin(3 * t) ** 2 + np.where(t < 0.2, 0.0, (t - 0.2) ** 3),
          "constraint": lambda t, a, x: x - 0.2 * math.cosh(a) * (1 + 0.1 * t) if a > -9 else x,
          "cam": lambda angle: 0.1 * max(0.0, angle + 0.3) ** 3 - 0.2 * angle, "nonholonomic": lambda a, u,
          v: v - u * math.cos(a)}


@pytest.mark.parametrize("kind", SMOOTH)
@pytest.mark.parametrize("compiled", [None, False, pytest.param(True, marks=needs_compiler)])
def test_motions_are_those_of_calls(kind, compiled):
    """Calls have derivatives of their own, by forward differentiation of NumPy's functions."""
    of_numpy = {"constraint": lambda t, a, x: x - 0.2 * np.cosh(a) * (1 + 0.1 * t), "angle": lambda t: (
        0.3 * np.sin(3 * t) ** 2 + (0.0 if t < 0.2 else (t - 0.2) ** 3)), "nonholonomic": lambda a, u, v: v - u * np.cos(a)}
    ours, theirs = swing(SMOOTH[kind], kind), swing(called(of_numpy.get(kind, SMOOTH[kind])), kind)
    one, other = (zd.simulate(each, 0.5, step=0.005, integrator="rk4") for each in (ours.system(compiled=compiled), theirs))
    assert one.system._core._law.rows[0].law.formula is not None
    assert one.stats["closed_form_steps"] == (0 if compiled is False else one.stats["steps"])
    assert other.stats["closed_form_steps"] == 0
    assert_close(one.p, other.p, 1e-11, scale=1.0)
    assert_close(one.v, other.v, 1e-10, scale=1.0)


def test_numbers_from_outside_count_as_they_are_when_a_run_begins():
    gains = {"k": 1.0}
    m = swing(lambda t, q, u: gains["k"] * 3.0)
    first, system = zd.simulate(m, 0.1, step=0.01), m.system()
    gains["k"] = 2.0
    assert np.array_equal(zd.simulate(system, 0.1, step=0.01).p, first.p)
    assert_close(zd.simulate(m, 0.1, step=0.01).p, zd.simulate(swing(lambda t: 6.0), 0.1, step=0.01).p, 1e-14, scale=1.0)


def test_laws_that_read_what_another_may_change_are_called():
    state = {"on": 0.0}

    def switch(t):
        state["on"] = 1.0 if t > 0.05 else 0.0
        return 0.0

    m = swing(lambda t: 5.0 * state["on"])
    m.torque("switch", "link", value=switch)
    m.torque("other", "link", value=lambda t: 2.0 * t)
    system = m.system()
    assert [m[name].law.formula is None for name in ("drive", "switch", "other")] == [True, True, False]
    assert zd.simulate(system, 0.2, step=0.01)["drive.torque"][-1] == 5.0


def test_parameters_stay_parameters():
    m = zd.Mechanism("swing", parameters={"k": 2.0})
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.torque("drive", link, value=lambda k, q: -k * (q if q > 0.1 else 0.1), of={"q": pin.angle})
    for k in (2.0, 3.0):
        changed, fixed = zd.simulate(m.with_parameters(k=k), 0.2, step=0.01), copy.deepcopy(m)
        fixed.parameters["k"] = k
        assert_close(changed.p, zd.simulate(fixed, 0.2, step=0.01).p, 1e-14, scale=1.0)
    assert changed.p[-1] != zd.simulate(m, 0.2, step=0.01).p[-1]


def test_only_the_selected_side_must_be_finite():
    formula, *_ = record(lambda x: np.where(x > 0, 1 / x, 0.0) + (math.log(x) if x > 1 else 0.0), ["x"], {})
    assert formula.value({"x": 0.0}) == 0.0
    law = law_of(lambda x: np.where(x > 0, 1 / x, 0.0))
    assert list(in_core(law)(np.zeros(2), np.array([[0.0], [2.0]]))) == [0.0, 0.5]


def test_derivatives_at_a_border_are_those_of_the_selected_side_and_zero_of_abs():
    m = zd.Mechanism("line")
    guide = m.prismatic("guide", m.ground, m.body("body", 1.0, at=(0, 0)), axis=(1, 0))
    other = m.prismatic("other", m.ground, m.body("second", 1.0, at=(0, 1)), axis=(1, 0))
    m.constraint("c", lambda x, y: y - (2 * x if x >= 0 else 3 * x) - abs(x),
                 of={"x": guide.displacement, "y": other.displacement})
    terms = m.system(compiled=False).evaluate([0.0, 0.0], [1.0, 0.0])
    assert terms.C.tolist() == [[-2.0, 1.0]]


def test_tables_within_functions_are_tables():
    curve = zd.table([0.0, 1.0, 2.0], [0.0, 1.0, 4.0], argument="x")
    law = law_of(lambda x: 2 * curve(x) if x < 2 else 8.0)
    assert law.tables == curve.tables
    assert_close(in_core(law)(np.zeros(3), np.array([[0.5], [1.5], [3.0]])), [0.5, 4.5, 8.0], 1e-13, scale=1.0)


def test_recorded_laws_are_pickled_as_formulas_also_of_functions_without_a_module():
    m = swing(lambda t: 0.2 * t**3 if t < 1 else t, "angle")
    again = pickle.loads(pickle.dumps(m.system()))
    assert np.array_equal(zd.simulate(again, 0.1, step=0.01).p, zd.simulate(m, 0.1, step=0.01).p)


def test_equations_are_refused_with_the_reason():
    with refused("not-portable", "'drive'.*it has a try or with statement"):
        swing(called(lambda t: t)).system(compiled=True)
