"""Systems that are off by rounding, which references are checked with; and whether a system says that it depends on time."""

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from support import SYSTEMS
from zerodrift._private import gateway

SIZE = 2.0**-30     # well above rounding
PERTURBED = ("A", "M", "d", "f", "C", "Phi_t", "xi")


@pytest.fixture
def perturbed(system):
    return gateway.perturbed(system._core, SIZE, seed=7)


def terms_at(core, factors, t, p, v):
    """The terms of a core at a place that is off by some factors."""
    return core.evaluate(t * factors["t"][0], p * factors["p"], v * factors["v"])


def test_each_term_is_off_by_its_factors(system, perturbed):
    chance = np.random.default_rng(3)
    t, p, v = 0.7, system.p0 + chance.normal(size=system.nq) / 10, system.v0 + chance.normal(size=system.nv)
    found, factors = perturbed.evaluate(t, p, v), perturbed.factors
    expected = terms_at(system._core, factors, t, p, v)
    assert set(found) == set(expected)
    for name, value in expected.items():
        assert np.array_equal(found[name], value * factors.get(name, 1.0)), name


def test_factors_are_one_or_two_units_off_either_way(perturbed):
    for name, factors in perturbed.factors.items():
        assert set(np.unique(np.round((factors - 1) / SIZE))) <= {-2.0, -1.0, 1.0, 2.0}, name
    assert np.array_equal(perturbed.factors["M"], perturbed.factors["M"].T)
    assert {name for name in perturbed.factors if name[0] in "AMdfCPx"} - {"p", "v", "t"} <= set(PERTURBED)


def test_other_seeds_are_rounded_otherwise(system):
    first, again, other = (gateway.perturbed(system._core, SIZE, seed) for seed in (1, 1, 2))
    assert np.array_equal(first.factors["M"], again.factors["M"])
    assert any(not np.array_equal(first.factors[name], other.factors[name]) for name in first.factors)


def test_what_a_callable_raises_comes_out():
    def force(p):
        if p[0] < 0:
            raise KeyError("too far")
        return -p

    with pytest.raises(KeyError, match="too far"):
        zd.reference(zd.System(1, mass=[[1.0]], force=force, p0=[1.0]), 3.0)
    core = zd.System(1, mass=[[1.0]], force=force, p0=[1.0])._core
    with pytest.raises(KeyError, match="too far"):
        gateway.perturbed(core, SIZE, seed=1).evaluate(0.0, np.array([-1.0]), np.array([0.0]))


# ---- whether terms depend on time ----


def test_built_in_systems_say_whether_they_depend_on_time(system):
    """Terms of systems that declare themselves independent of time are equal at all times."""
    p, v = system.p0, system.v0
    now, later = (system._core.evaluate(t, p, v) for t in (0.0, 1.7))
    same = all(np.array_equal(now[name], later[name]) for name in now)
    assert same == system._core.timeless


def test_there_are_both_kinds():
    assert {system._core.timeless for system in SYSTEMS.values()} == {True, False}


@pytest.mark.parametrize(("terms", "timeless"), [
    ({"mass": [[1.0]]}, True),
    ({"mass": [[1.0]], "force": lambda p: -p}, True),
    ({"mass": [[1.0]], "force": lambda t, p: -p}, False),
    ({"mass": lambda t: np.array([[1.0]])}, False),
    ({"mass": [[1.0]], "constraints": lambda p, t: p[:1] - np.stack([t])}, False),
])
def test_callables_say_it_by_their_arguments(terms, timeless):
    assert zd.System(1, **terms, p0=[0.0])._core.timeless is timeless


@pytest.mark.parametrize(("force", "timeless"), [
    ("-x", True), ("-k*x", True), ("-x + 0*t", True), ("sin(t)", False), ("k*t*v", False)])
def test_expressions_say_it_by_their_symbols(force, timeless):
    x, v, k, t = sp.symbols("x v k t")
    names = {"x": x, "v": v, "k": k, "t": t}
    system = zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=None, time=t, force=[sp.sympify(force, names)],
                         parameters={k: 1.0}, p0=[1.0], progress=False)
    assert system._core.timeless is timeless
    assert system.with_parameters(k=2.0)._core.timeless is timeless
    assert (zd.reference(system, 0.5).caveats == ()) is timeless
    assert zd.reference(system, 0.5, max_step=0.1).caveats == ()


def test_of_compiled_functions_nothing_is_known():
    """They are taken to depend on time, unless the library says otherwise."""
    bar = SYSTEMS["four_bar"]
    core = gateway.NativeCore((bar.nq, bar.nv, bar.mh, bar.mn), [], 1, None, ())
    assert not core.timeless
    assert gateway.NativeCore((bar.nq, bar.nv, bar.mh, bar.mn), [], 1, None, (), timeless=True).timeless
