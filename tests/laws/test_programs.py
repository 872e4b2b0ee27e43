"""Closed forms as programs that the core runs have the bits of compiled ones: functions, and runs."""

import functools

import numpy as np
import pytest

import symbolic_counterparts
import zerodrift as zd
from mechanisms.known import four_bar
from mechanisms.random_mechanisms import Maker
from native_systems import needs_compiler
from random_symbolic import random_system
from support import assert_same_bits
from vector_units import SETS, DirectSet, available, closed_form_sets, sets_by_programs

sp = pytest.importorskip("sympy")
STATES = 3


def with_everything():
    """Functions of the C library, sines of sines, choices by the state, roots, and powers."""
    x, y, vx, vy, t, a, b = sp.symbols("x y vx vy t a b")
    inside = sp.And(x > -a, sp.Or(y < b, sp.Not(sp.Lt(vx, vy))))
    force = [sp.Piecewise((sp.exp(-x), inside), (sp.atan2(y, 2 + x), a > y), (vx, True)),
             sp.Piecewise((sp.Abs(y) * vy, a > b), (sp.sqrt(1 + x**2), True)) + y ** sp.Rational(5, 3) + sp.sin(a * sp.cos(x))]
    return zd.symbolic([x, y], speeds=[vx, vy], kinetic=(vx**2 + (2 + sp.sin(x * t)) * vy**2) / 2, potential=sp.cosh(x / 9),
                       force=force, constraints=[sp.sin(x) + y * sp.sqrt(4 + y**2) - sp.sin(t / 9)], time=t,
                       parameters={a: 0.3, b: 0.2}, p0=[0.0, 0.0], v0=[0.0, 0.0])


SYMBOLIC = {"four bar": symbolic_counterparts.four_bar, "arm": symbolic_counterparts.arm, "skate": symbolic_counterparts.skate,
            "with everything": lambda: with_everything()}
SYSTEMS = {**{f"random {seed}": functools.partial(random_system, seed) for seed in range(4)}, "with everything": with_everything,
           "mechanism": lambda: Maker(2).m.system(compiled=True), "mechanism in absolute coordinates":
           lambda: four_bar().system("absolute", compiled=True)}


@functools.cache
def both(name):
    system = SYSTEMS[name]()
    return closed_form_sets(system), sets_by_programs(system)


@needs_compiler
@pytest.mark.parametrize("of", SETS, ids=SETS.get)
@pytest.mark.parametrize("name", SYSTEMS)
def test_functions_have_the_bits_of_compiled_ones(name, of):
    _, lanes = available(of)
    rng = np.random.default_rng(5)
    compiled, programs = both(name)
    called = [DirectSet(sets[of], sizes, np.tile(data, (lanes, 1)), of_mechanism=is_mechanism)
              for (sets, sizes, data, *_), is_mechanism in ((compiled, name.startswith("mechanism")), (programs, True))]
    nq, nv, _, m = compiled[1]
    for _ in range(STATES):
        state = (rng.uniform(0, 2, lanes), compiled[3] + rng.normal(size=(lanes, nq)) / 4, rng.normal(size=(lanes, nv)),
                 rng.normal(size=(lanes, m)))
        for i in called[0].orders:
            one, other = (each.all(i, *state) for each in called)
            assert one.keys() == other.keys()
            for key in one:
                assert np.array_equal(one[key].view(np.int64), other[key].view(np.int64)), (name, i, key)


RUNS = {"dependent": {}, "independent": {"formulation": "mixed"}}


@needs_compiler
@pytest.mark.parametrize("vector", ["baseline", "avx2", "avx512"])
@pytest.mark.pairs(name=["four_bar", "quarter_car", "snakeboard", "flyball_governor"], settings=[*RUNS])
def test_runs_have_the_bits_of_compiled_ones(name, settings, vector):
    """Fixed steps, none of which is by matrices: the terms of these are summed in another order in code."""
    available({"baseline": (0, 1), "avx2": (1, 1), "avx512": (2, 1)}[vector])
    m = getattr(zd.models, name)()
    one, other = (zd.simulate(m.system(compiled=compiled), 0.1, step=1e-3, vector=vector, **RUNS[settings])
                  for compiled in (None, True))
    assert one.stats["closed_form_steps"] == other.stats["closed_form_steps"] == one.stats["steps"]
    assert np.array_equal(one.p, other.p)
    assert np.array_equal(one.v, other.v)


@pytest.fixture
def interpreted(monkeypatch):
    """Makes a symbolic system again, without a compiler."""
    def make(function):
        with monkeypatch.context() as context:
            context.setenv("CC", "no-such-compiler")
            with pytest.warns(zd.NoCompilerWarning):
                return function()
    return make


@needs_compiler
@pytest.mark.parametrize("name", [*(f"random {seed}" for seed in range(8)), *SYMBOLIC])
def test_symbolic_systems_have_the_bits_of_compiled_ones(name, interpreted):
    """Terms along matrices, with sines of the core, and closed forms."""
    made = SYMBOLIC.get(name) or functools.partial(random_system, int(name.split()[-1]))
    one, other = made(), interpreted(made)
    assert (one.compiled, other.compiled) == (True, False)
    start = zd.assemble(one, one.p0, one.v0)
    for settings in ({"closed_form": False}, {"formulation": "mixed", "closed_form": False}, {}):
        assert_same_bits(*(zd.simulate(system, 0.1, *start, step=0.01, **settings) for system in (one, other)))
    if one.points(one.p0) is not None:
        assert np.array_equal(one.points(one.p0), other.points(other.p0))


@needs_compiler
def test_inputs_and_lanes_need_no_compiler(interpreted):
    """Numbers that follow from inputs alone are computed anew when these change."""
    q, u, a, b = sp.symbols("q u a b")

    def make():
        return zd.symbolic([q], speeds=[u], kinetic=u**2 * (2 + sp.cos(q)) / 2, force=[sp.cos(a * b) - u], p0=[0.3], v0=[0.0],
                           parameters={a: 2.0, b: 0.5}, inputs=[b])

    ends = []
    for system in (make(), interpreted(make)):
        many = zd.ManyRuns(system, runs=5, step=0.01, inputs=["b"])
        alone = zd.Run(system, step=0.01, inputs=["b"])
        for i in range(3):
            many["b"], alone["b"] = np.arange(5.0) + i, 3.0 + i
            many.step(10)
            alone.step(10)
        assert np.array_equal(many.p[3], alone.p)
        ends.append(many.p)
    assert np.array_equal(*ends)


def test_a_system_without_a_closed_form_says_why():
    sol = zd.simulate(zd.models.whipple_bicycle(), 0.01, step=1e-3)
    assert sol.stats["matrix_path_reason"] == "they would take more than 2000 operations"
    sol = zd.simulate(zd.models.four_bar().system(compiled=False), 0.01, step=1e-3)
    assert sol.stats["matrix_path_reason"] == "compiled=False"


def test_a_run_says_that_equations_are_interpreted():
    text = str(zd.simulate(zd.models.four_bar(), 0.1, step=1e-3))
    assert "evaluation  closed form by tables; m.system(compiled=True) saves about" in text
