"""Closed-form functions of several trajectories give each what it has alone: to the last bit, whatever is in the other lanes."""

import functools

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from mechanisms.known import four_bar
from mechanisms.random_mechanisms import Maker
from native_systems import needs_compiler
from random_symbolic import random_system
from symbolic_counterparts import OF_PARAMETERS
from vector_units import SETS, DirectSet, available, closed_form_sets
from zerodrift._private.core import ffi

sp = pytest.importorskip("sympy")
pytestmark = needs_compiler
SEEDS = (0, 1)      # driven, with a kinematic matrix
STATES = 3


def with_everything():
    """Functions of the C library, choices by the state and by parameters, roots, and what is none of these."""
    x, y, vx, vy, t, a, b = sp.symbols("x y vx vy t a b")
    inside = sp.And(x > -a, sp.Or(y < b, sp.Not(sp.Lt(vx, vy))))
    force = [sp.Piecewise((sp.exp(-x), inside), (sp.atan2(y, 2 + x), a > y), (vx, True)),
             sp.Piecewise((sp.Abs(y) * vy, a > b), (sp.sqrt(1 + x**2), True)) + sp.Max(x, y, t) + y ** sp.Rational(5, 3)]
    return zd.symbolic([x, y], speeds=[vx, vy], kinetic=(vx**2 + (2 + sp.sin(x * t)) * vy**2) / 2, potential=sp.cosh(x / 9),
                       force=force, constraints=[sp.sin(x) + y * sp.sqrt(4 + y**2) - sp.sin(t / 9)], time=t,
                       parameters={a: 0.3, b: 0.2}, p0=[0.0, 0.0], v0=[0.0, 0.0])


SYSTEMS = {**{name: getattr(zd.systems, name) for name in OF_PARAMETERS},
           **{f"random {seed}": functools.partial(random_system, seed) for seed in SEEDS}, "with everything": with_everything,
           "mechanism": lambda: Maker(2).m.system(compiled=True), "mechanism in absolute coordinates":
           lambda: four_bar().system("absolute", compiled=True)}


@functools.cache
def sets_of(name):
    """All sets of a system, by unit and lanes, with its sizes, its data and its start."""
    system = SYSTEMS[name]()
    return closed_form_sets(system)


def inputs(name, lanes, seed):
    """(data, t, p, v, added) of so many trajectories around the start."""
    _, (nq, nv, _, m), data, p0 = sets_of(name)
    rng = np.random.default_rng(seed)
    return (data * (1 + rng.uniform(0, 0.01, (lanes, data.size))), rng.uniform(0, 2, lanes),
            p0 + rng.normal(size=(lanes, nq)) / 4, rng.normal(size=(lanes, nv)), rng.normal(size=(lanes, m)))


def functions(name, of, data):
    """Closed-form functions of a set with these data, (lanes, doubles)."""
    sets, sizes, _, _ = sets_of(name)
    return DirectSet(sets[of], sizes, data, of_mechanism=name.startswith("mechanism"))


def one_by_one(name, unit, given):
    """By the functions for one trajectory."""
    data, *states = given
    each = [functions(name, (unit, 1), data[k:k + 1]) for k in range(len(data))]
    singles = [[one.all(i, *(x[k:k + 1] for x in states)) for k, one in enumerate(each)] for i in each[0].orders]
    return [{key: np.concatenate([each[key] for each in found]) for key in found[0]} for found in singles]


def assert_same_bits(found, expected, lanes):
    assert found.keys() == expected.keys()
    for key in found:
        a, b = found[key][lanes], expected[key][lanes]
        assert np.array_equal(np.ascontiguousarray(a).view(np.int64), np.ascontiguousarray(b).view(np.int64)), key


@pytest.mark.parametrize("of", [each for each in SETS if each != (0, 1)], ids=SETS.get)
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_lane_has_the_bits_of_a_trajectory_by_itself(name, of):
    """And those of all units that contract are the same."""
    unit, lanes = available(of)
    for seed in range(STATES):
        given = inputs(name, lanes, seed)
        expected = one_by_one(name, min(unit, 1), given)
        called = functions(name, of, given[0])
        for i in called.orders:
            assert_same_bits(called.all(i, *given[1:]), expected[i], slice(None))


@pytest.mark.parametrize("of", [each for each in SETS if each[1] > 1], ids=SETS.get)
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_lane_does_not_depend_on_its_neighbours(name, of):
    """Not on their places either, nor on whether they are numbers at all."""
    _, lanes = available(of)
    given, rng = inputs(name, lanes, 7), np.random.default_rng(1)
    alone = functions(name, of, given[0]).all(0, *given[1:])
    for k in range(lanes):
        data, *states = (x.copy() for x in given)
        for x in states:
            x[np.arange(lanes) != k] = rng.choice([np.nan, np.inf, 1e9, -1e300, 0.0], x[1:].shape)
        assert_same_bits(functions(name, of, data).all(0, *states), alone, [k])
    order = np.roll(np.arange(lanes), 1)
    moved = functions(name, of, given[0][order]).all(0, *(x[order] for x in given[1:]))
    assert_same_bits(moved, {key: value[order] for key, value in alone.items()}, slice(None))


@pytest.mark.parametrize("name", SYSTEMS)
def test_contraction_changes_no_more_than_rounding(name):
    available((1, 1))
    given = inputs(name, 20, 3)
    for plain, contracted in zip(one_by_one(name, 0, given), one_by_one(name, 1, given), strict=True):
        for lane in range(20):
            solves = len(plain["pivots"][lane]) - (sets_of(name)[1][1] - sets_of(name)[1][3])
            if np.abs(plain["pivots"][lane, :solves]).min(initial=1.0) < 0.2:
                continue        # what is divided by less loses digits on both
            for key in plain:
                written = ~np.isnan(plain[key][lane])       # pdot by systems with A alone
                size = max(1.0, np.abs(plain[key][lane][written]).max(initial=0.0))
                error = np.abs(contracted[key][lane] - plain[key][lane])[written].max(initial=0.0)
                assert error <= 100 * tol.SAME * size, key


def test_a_compiler_that_has_no_vectors_writes_the_plain_functions():
    """The compiler emits the requested sets that it supports, or else the baseline."""
    functions = random_system(2)._closed_form
    plain = functions.library_of("0x40000000")
    table = ffi.cast("const zd_closed_form *", zd._private.gateway.address_of(plain, "zd_symbolic_closed_form"))
    assert (table[0].unit, table[0].lanes) == (0, 1)
