"""Closed-form functions solve what the leading matrices solve: compared with NumPy on random systems, each order."""

import pickle

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from covering import spread
from native_systems import needs_compiler
from random_symbolic import random_system
from support import numbers
from zerodrift._private.core import ffi, lib
from zerodrift.symbolics.emit import closed_form, closed_form_writer
from zerodrift.symbolics.graph.lowering import Lowering

sp = pytest.importorskip("sympy")
pytestmark = needs_compiler
SEEDS = spread(range(12), 5)
ALWAYS_SOUND = 2.0**-6     # relative determinant with which steps are accepted: ZD_SMALL_PIVOT of csrc/step_limits.h


def doubles(*shape):
    array = np.full(shape, np.nan)
    return array, ffi.from_buffer("double[]", array) if array.size else ffi.NULL


def of(array):
    return ffi.from_buffer("double[]", np.atleast_1d(np.ascontiguousarray(array, float)))


class ClosedForm:
    """The closed-form functions of a system, called one by one."""

    def __init__(self, system, core=None):
        self.system = system
        self.core = core or system._closed_form_core()
        self.closed_form = self.core.c.closed_form[0]
        self.orders = range(self.closed_form.orders)

    def accelerate(self, i, t, p, v, added=None):
        core = self.core
        order = self.closed_form.order + i
        found = {"pdot": doubles(core.nq), "vdot": doubles(core.nv), "lambda": doubles(core.m), "power": doubles(1),
                 "pivots": doubles(order.solves + core.nv - core.m)}
        status = order.accelerate(order, core.c.data, core.initial_inputs(), of(t), of(p), of(v),
                                  ffi.NULL if added is None else of(added), *(memory for _, memory in found.values()))
        assert status == 0
        return {name: array for name, (array, _) in found.items()}

    def correct(self, i, t, p, v):
        found = {"Phi": doubles(self.core.mh), "dp": doubles(self.core.nq), "dv": doubles(self.core.nv)}
        order = self.closed_form.order + i
        status = order.correct(order, self.core.c.data, self.core.initial_inputs(), of(t), of(p), of(v),
                                              *(memory for _, memory in found.values()))
        assert status == 0
        return {name: array for name, (array, _) in found.items()}

    def finish(self, i, t, p, v, allowed):
        core = self.core
        order, finished = self.closed_form.order + i, np.array(v)
        found = {"Phi": doubles(core.mh), "dp": doubles(core.nq), "pdot": doubles(core.nq), "vdot": doubles(core.nv),
                 "lambda": doubles(core.m), "power": doubles(1), "pivots": doubles(order.solves + core.nv - core.m)}
        status = order.finish(order, core.c.data, core.initial_inputs(), of(t), of(p), ffi.from_buffer("double[]", finished),
                              of(np.full(core.mh, allowed)), *(memory for _, memory in found.values()))
        return status, finished, {name: array for name, (array, _) in found.items()}

    def embed(self, i, t, p, v, added, allowed):
        core = self.core
        order, embedded = self.closed_form.embedding + i, np.array(v)
        r = core.nv - core.m
        found = {"Phi": doubles(core.mh), "dp": doubles(core.nq), "D": doubles(core.m, r), "pdot": doubles(core.nq),
                 "vdot": doubles(core.nv), "lambda": doubles(core.m), "power": doubles(1), "pivots": doubles(order.solves + r)}
        status = order.embed(order, core.c.data, core.initial_inputs(), of(t), of(p), ffi.from_buffer("double[]", embedded),
                             of(added), of(np.full(core.mh, allowed)), *(memory for _, memory in found.values()))
        return status, embedded, {name: array for name, (array, _) in found.items()}

    def smallest(self, order, pivots, C):
        """The smallest pivot of the rows, in parts of the largest entries of these."""
        relative = np.abs(pivots[: order.solves])
        for k in range(self.core.m):
            relative[order.solve[k]] /= np.abs(C[order.row[k]]).max()
        return relative.min(initial=1.0)


def solved(e, force, right):
    """M x + C^T lambda = force, C x = right."""
    m, n = e.C.shape
    K = np.block([[e.M, e.C.T], [e.C, np.zeros((m, m))]])
    x = np.linalg.solve(K, np.concatenate([force, right]))
    return x[:n], x[n:], np.linalg.cond(K)


def states(system, seed, count=5):
    """The start, and others: constraints need not hold where equations are solved."""
    rng = np.random.default_rng(1000 + seed)
    for k in range(count):
        yield rng.uniform(0, 2), system.p0 + (k > 0) * rng.normal(size=system.nq) / 2, rng.normal(size=system.nv)


def assert_near(found, expected, size):
    assert np.abs(found - expected).max(initial=0.0) <= size * max(1.0, np.abs(expected).max(initial=0.0))


def assert_finishes(closed_form, i, t, p, v, corrected):
    """A step ends with a correction, and then the acceleration at the corrected velocities."""
    status, finished, found = closed_form.finish(i, t, p, v, np.inf)
    assert status == 0
    assert_near(finished, v - corrected["dv"], tol.SAME)
    expected = closed_form.accelerate(i, t, p, finished)
    for name in ("vdot", "lambda", "power", "pivots"):
        assert_near(found[name], expected[name], tol.SAME)
    assert_near(found["Phi"], corrected["Phi"], tol.SAME)
    if corrected["Phi"].size:
        status, finished, found = closed_form.finish(i, t, p, v, -1.0)
        assert status == lib.ZD_NO_CONVERGENCE
        assert (finished == v).all()
        assert_near(found["dp"], corrected["dp"], tol.SAME)


@pytest.mark.parametrize("seed", SEEDS)
def test_closed_form_functions_solve_the_equations(seed):
    system = random_system(seed)
    if not system._closed_form.source:
        C = system.evaluate().C
        assert np.linalg.svd(C / np.abs(C).max(axis=1, keepdims=True))[1].min() < 0.05      # too near a bifurcation
        return
    closed_form, compared = ClosedForm(system), 0
    for t, p, v in states(system, seed):
        e = numbers(system, t, p, v)
        added = np.random.default_rng(seed).normal(size=system.m)
        vdot, multipliers, condition = solved(e, e.force, e.xi + added)
        for i in closed_form.orders:
            a = closed_form.accelerate(i, t, p, v, added)
            smallest = closed_form.smallest(closed_form.closed_form.order[i], a["pivots"], e.C)
            if smallest < ALWAYS_SOUND:
                continue
            compared += 1
            error = tol.SOLVED * condition / smallest**2
            assert_near(a["vdot"], vdot, error)
            assert_near(a["lambda"], multipliers, error)
            assert_near(a["power"], e.power + multipliers @ e.Phi_t, 10 * error)
            assert (a["pivots"][closed_form.closed_form.order[i].solves:] > 0).all()
            if system.nq and e.A is not None and system.evaluate(p, v, t).A is not None:
                assert_near(a["pdot"], e.A @ v, tol.SAME)
            assert_near(closed_form.accelerate(i, t, p, v)["vdot"], solved(e, e.force, e.xi)[0], error)
            if not system.m:
                continue
            c = closed_form.correct(i, t, p, v)
            assert_near(c["Phi"], e.Phi, tol.SAME)
            zero = np.zeros(system.nv)
            assert_near(c["dv"], solved(e, zero, e.C @ v + e.Phi_t)[0], error)
            assert_near(c["dp"], e.A @ solved(e, zero, np.concatenate([e.Phi, np.zeros(system.mn)]))[0], error)
            assert_finishes(closed_form, i, t, p, v, c)
    assert compared >= 3


@pytest.mark.parametrize("seed", SEEDS[:5])
def test_functions_for_independent_velocities_solve_the_equations(seed):
    """Each order for other velocities: these stay, and all else follows from them."""
    system = random_system(seed)
    if not system._closed_form.embedding.source:
        assert not system._closed_form.source
        return
    core = system._closed_form_core(embeds=True)
    closed_form, rng, compared, sets = ClosedForm(system, core), np.random.default_rng(seed), 0, set()
    for i in range(closed_form.closed_form.embeddings):
        order = closed_form.closed_form.embedding[i]
        solved_for = [order.column[k] for k in range(system.m)]
        free = [j for j in range(system.nv) if j not in solved_for]
        sets.add(tuple(free))
        for t, p, v in states(system, seed):
            compared += assert_embeds(closed_form, i, (t, p, v), free, solved_for, rng.normal(size=system.m))
    assert compared >= 3
    assert len(sets) == closed_form.closed_form.embeddings


def assert_embeds(closed_form, i, state, free, solved_for, added):
    """Compare the dependent velocities of an embedding; True if it is well conditioned there and was compared."""
    t, p, v = state
    system, (status, embedded, found) = closed_form.system, closed_form.embed(i, t, p, v, added, np.inf)
    assert status == 0
    e = numbers(system, t, p, embedded)
    W, U = e.C[:, solved_for], e.C[:, free]
    smallest = closed_form.smallest(closed_form.closed_form.embedding[i], found["pivots"], e.C)
    assert (embedded[free] == v[free]).all()
    if smallest < ALWAYS_SOUND:
        return False
    vdot, multipliers, condition = solved(e, e.force, e.xi + added)
    error = tol.SOLVED * condition / smallest**2
    assert_near(e.C @ embedded, -e.Phi_t, error)
    assert_near(found["D"], -np.linalg.solve(W, U), error)
    assert_near(found["vdot"], vdot, error)
    assert_near(found["lambda"], multipliers, error)
    assert_near(found["power"], e.power + multipliers @ e.Phi_t, 10 * error)
    assert_near(found["Phi"], e.Phi, tol.SAME)
    w = np.zeros(system.nv)
    w[solved_for] = np.linalg.solve(W, np.concatenate([e.Phi, np.zeros(system.mn)]))
    if system.mh:
        status, embedded, found = closed_form.embed(i, t, p, v, added, -1.0)
        assert status == lib.ZD_NO_CONVERGENCE
        assert (embedded == v).all()
        assert_near(found["dp"], e.A @ w, error)
    return True


def test_orders_are_for_different_places():
    """A mass on a circle: x is solved for where it is steep, y where that is."""
    x, y, vx, vy = sp.symbols("x y vx vy")
    system = zd.symbolic([x, y], speeds=[vx, vy], kinetic=(vx**2 + vy**2) / 2, potential=10 * y,
                         constraints=[(x**2 + y**2 - 1) / 2], parameters={}, p0=[1.0, 0.0], v0=[0.0, 0.0])
    closed_form = ClosedForm(system)
    assert [closed_form.closed_form.order[i].column[0] for i in closed_form.orders] == [0, 1]
    sol = zd.simulate(system, 2.0, step=0.01)
    assert sol.stats["closed_form_steps"] == sol.stats["steps"]      # at each place one of the two serves


def redundant(scale):
    """Two constraints, of which the second is redundant up to a term of size `scale`."""
    x, y, z, vx, vy, vz = sp.symbols("x y z vx vy vz")
    return zd.symbolic([x, y, z], speeds=[vx, vy, vz], kinetic=(vx**2 + vy**2 + vz**2) / 2, potential=10 * y,
                       constraints=[x + sp.sin(y), 2 * x + 2 * sp.sin(y) + scale * z], parameters={}, p0=[0.0, 0.0, 0.0],
                       v0=[0.0, 0.0, 0.0])


@pytest.mark.parametrize("scale", [0, 1e-9, 1e-4])
def test_nothing_is_written_where_rows_depend_on_each_other_or_nearly(scale):
    system = redundant(scale)
    sol = zd.simulate(system, 0.1, step=0.01)
    assert not system._closed_form.source
    assert_says(system, sol, "constraints depend on each other at the start, or nearly")


def assert_says(system, sol, why):
    """The texts of system and motion give this reason for the matrix path, and no vector unit was used."""
    assert repr(system).endswith(f" constraints, no closed-form functions: {why}>")
    assert f"\n  evaluation  matrices, no closed form: {why}\n" in repr(sol)
    assert sol.settings["vector"] is None
    again = zd.simulate(system, sol.t_span, **sol.settings)
    assert np.array_equal(again.p, sol.p)


@pytest.mark.parametrize(("bound", "why", "scale"), [
    ("MAX_OPERATIONS", f"they would take more than {closed_form_writer.MAX_OPERATIONS} operations", 1.0),
    ("MAX_STATEMENTS", "a function would have more than 10 statements", 2.0)])
def test_nothing_is_written_that_is_too_long(bound, why, scale, monkeypatch):
    """A fresh system for each bound, as the code of a system is kept."""
    monkeypatch.setattr(closed_form_writer, bound, 10)
    system = redundant(scale)
    sol = zd.simulate(system, 0.1, step=0.01)
    assert not system._closed_form.source
    assert_says(system, sol, why)
    assert_says(pickle.loads(pickle.dumps(system)), sol, why)


def test_a_system_that_is_too_large_says_so_at_once(monkeypatch):
    """Its program is not kept."""
    why = f"they would take more than {closed_form_writer.MAX_OPERATIONS} operations"
    monkeypatch.setattr(closed_form_writer, "MAX_OPERATIONS", 3)
    x, vx = sp.symbols("x vx")
    system = zd.symbolic([x], speeds=[vx], kinetic=vx**2 / 2, potential=sp.sin(1.25 * x), parameters={}, p0=[0.0], v0=[1.0])
    assert repr(system).endswith(f"no closed-form functions: {why}>")
    assert_says(system, zd.simulate(system, 0.01, step=0.01), why)


def test_nothing_is_written_with_functions_of_ones_own():
    class Twice(sp.Function):
        pass

    lowering = Lowering(None)
    lowering.emit("call", Twice, lowering.emit("number", 1.0))
    assert closed_form.as_json(lowering, {}) == "SymPy has no function Twice"


def test_more_constraints_than_velocities_have_none():
    x, vx = sp.symbols("x vx")
    system = zd.symbolic([x], speeds=[vx], kinetic=vx**2 / 2, constraints=[x, 2 * x], parameters={}, p0=[0.0], v0=[0.0])
    assert_says(system, zd.simulate(system, 0.1, step=0.01), "there are more constraints than velocities")


def test_they_are_compiled_once_for_all_parameters_and_starts():
    system = random_system(2)
    other = system.with_parameters(a=0.5)
    library = system._closed_form.library()
    assert other._closed_form.library() is library
    assert system.starting(v0=system.v0)._closed_form.library() is library
    v = np.ones(system.nv)
    e = numbers(other, 0.0, system.p0, v)
    vdot, _, condition = solved(e, e.force, e.xi)
    assert_near(ClosedForm(other).accelerate(0, 0.0, system.p0, v)["vdot"], vdot, tol.SOLVED * condition / ALWAYS_SOUND**2)


def test_a_system_takes_them_along():
    system = random_system(2)
    again = pickle.loads(pickle.dumps(system.with_parameters(a=0.5)))
    assert again._closed_form.source == system._closed_form.source
    assert again._closed_form.constants == system._closed_form.constants


def test_nothing_is_compiled_where_they_are_not_wanted(monkeypatch):
    system = random_system(4)
    monkeypatch.setattr(type(system._closed_form), "library", lambda self: pytest.fail("compiled"))
    zd.simulate(system, 0.1, step=0.01, closed_form=False)


def test_they_are_made_for_runs_that_take_them_and_for_no_others(formulation, integrator):
    """Runs that do not use closed-form functions neither make them nor take those that exist."""
    pendulum = zd.systems.pendulum()
    x, y, vx, vy = sp.symbols("x y vx vy")
    system = zd.symbolic([x, y], speeds=[vx, vy], kinetic=(vx**2 + vy**2) / 2, potential=9.81 * y, constraints=[x**2 + y**2 - 1],
                         p0=pendulum.p0)
    options = {"step": 0.001, "formulation": formulation, "integrator": integrator}
    zd.simulate(system, 0.01, closed_form=False, **options)
    embeds = formulation in ("mixed", "independent")
    functions, others = system._closed_form, system._closed_form.embedding
    if embeds:
        functions, others = others, functions
    assert not functions._libraries
    sol = zd.simulate(system, 0.01, **options)
    made = bool(functions._libraries)
    sol(0.0055)
    assert bool(functions._libraries) == made      # values between rows are made as the run was
    assert not others._libraries
    system._closed_form_core(embeds=embeds)
    assert (zd.simulate(system, 0.01, **options).stats["closed_form_steps"] > 0) == made
