"""Events of runs in vector lanes: where `simulate` finds them up to rounding, with bits that do not depend on neighbours."""

import functools

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from lanes import ALONE, LANES
from zerodrift._private import gateway
from zerodrift.ensembles import batch as batches

BAR = zd.systems.four_bar()
STARTS = np.linspace(0.5, 1.5, 11)[:, None] * BAR.v0
TIMES = np.linspace(0.05, 2.0, 37)
ACROSS = sp.cos(sp.Symbol("alpha1") - sp.Symbol("alpha3"))
EVENTS = {
    "numbers": [zd.Event("alpha1", value=2.0), zd.Event("alpha2_dot", direction=1), zd.Event("alpha2_dot", direction=-1)],
    "terminal": [zd.Event("alpha2_dot"), zd.Event("alpha3", value=-1.0, terminal=2), zd.Event("alpha3", value=-1.0)],
    "expressions": [zd.Event(ACROSS), zd.Event("alpha2_dot", terminal=3), zd.Event(sp.Symbol("t"), value=0.333)],
    "ended between": [zd.Event(sp.Symbol("t"), value=0.777, terminal=True), zd.Event("alpha1", value=2.0, terminal=9)],
}
COURSES = {"rk4": {"step": 0.01}, "seldom": {"step": 0.01, "save_every": 7}, "within": {"step": 0.013, "t_eval": TIMES},
           "dop853": {"integrator": "dop853", "rtol": 1e-9, "atol": 1e-11, "t_eval": TIMES},
           "dormand_prince": {"integrator": "dormand_prince", "rtol": 1e-9, "atol": 1e-11, "t_eval": TIMES},
           # by 1e-6 and more from where shorter steps would have them
           "long": {"integrator": "dop853", "rtol": 1e-4, "atol": 1e-4, "t_eval": TIMES},
           "longer": {"integrator": "dormand_prince", "rtol": 1e-4, "atol": 1e-4, "t_eval": TIMES}}
ALIKE = 1e-9        # rounding grows over two seconds; the tolerance of adaptive steps, whose errors include it
pytestmark = pytest.mark.skipif(not gateway.has_lanes("baseline"), reason="the compiler has no vectors")


def ensemble(events, starts=STARTS, system=BAR, **options):
    return zd.ensemble(system, 2.0, v0=starts, outputs=["alpha1", "closure_x"], events=events, threads=1, **options)


def assert_alike(one, other, bound):
    assert len(one) == len(other)
    assert np.abs(one - other).max(initial=0) <= bound


@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize("events", EVENTS)
def test_events_are_those_of_simulate_up_to_rounding(events, course):
    ens = ensemble(EVENTS[events], **COURSES[course])
    assert (ens._part.paths == LANES).all()
    assert not ens.failed.any()
    for run in (0, 4, 10):
        sol, kept = zd.simulate(BAR, 2.0, v0=STARTS[run], events=EVENTS[events], **COURSES[course]), ens[run]
        assert (kept.status, kept.message) == (sol.status, kept.message)
        assert kept.message.rpartition(": ")[2] == sol.message.rpartition(": ")[2]
        assert_alike(kept.t, sol.t, ALIKE)
        for name in ("p", "v", "multipliers"):
            assert_alike(getattr(kept, name), getattr(sol, name), ALIKE * max(1, np.abs(getattr(sol, name)).max()))
        for name in ("t_events", "p_events", "v_events"):
            for mine, its in zip(getattr(kept, name), getattr(sol, name), strict=True):
                assert_alike(mine, its, ALIKE)
        assert np.array_equal(kept["alpha1"][:ens._part.rows[run]], ens["alpha1"][run][:ens._part.rows[run]])
        for kept_times, times in zip(kept.t_events, ens.t_events[run], strict=True):
            assert np.array_equal(kept_times, times)


@pytest.mark.parametrize("course", ["rk4", "dop853"])
def test_bits_do_not_depend_on_neighbours(course):
    """Some of which lanes cannot make, and some of which fail."""
    shares = np.array([1.0, 0.3, 400.0, 1.7, 60.0, 1.2, 0.9, 1.1, 30.0, 2.0])
    starts = shares[:, None] * BAR.v0
    starts[3] += 1.0
    events = EVENTS["numbers"] + EVENTS["terminal"]
    whole, turned = (ensemble(events, order, **COURSES[course]) for order in (starts, starts[::-1]))
    assert 0 < (whole._part.paths == ALONE).sum() < 10
    assert whole.failed[3]
    for run in range(10):
        alone = ensemble(events, starts[run:run + 1], **COURSES[course])
        for other, there in ((turned, 9 - run), (alone, 0)):
            assert np.array_equal(whole["alpha1"][run][:whole._part.rows[run]],
                                  other["alpha1"][there][:whole._part.rows[run]], equal_nan=True)
            assert whole.messages[run] == other.messages[there]
            for mine, its in zip(whole.t_events[run], other.t_events[there], strict=True):
                assert np.array_equal(mine, its)


def test_more_events_than_there_is_room_for_at_first(monkeypatch):
    monkeypatch.setattr(batches, "FEW_EVENTS", 1)
    few, many = ensemble(EVENTS["numbers"], step=0.01), None
    monkeypatch.undo()
    many = ensemble(EVENTS["numbers"], step=0.01)
    assert max(map(len, many.t_events[10])) > 1
    for run in range(11):
        for mine, its in zip(few.t_events[run], many.t_events[run], strict=True):
            assert np.array_equal(mine, its)


def test_what_has_no_finite_value_fails_as_that_run():
    """It is found at a run's start, within it, or never."""
    events = [zd.Event(sp.log(3.5 + sp.Symbol("alpha2_dot"))), zd.Event("alpha1", value=2.0)]
    starts = np.array([0.1, 1.0, 2.0, 3.0])[:, None] * BAR.v0
    ens = ensemble(events, starts, step=0.01)
    for run in range(4):
        sol = zd.simulate(BAR, 2.0, v0=starts[run], step=0.01, events=events, on_failure="return")
        assert ens.failed[run] != sol.success
        assert ens.messages[run] == sol.message
    assert ens.failed.any()
    assert not ens.failed.all()


def test_what_takes_the_matrix_path():
    """Callables; and expressions of parameters that vary, which are each run's own."""
    asked = zd.ensemble(BAR, 1.0, v0=STARTS, step=0.01, events=lambda t, p, v: p[0] - 2.0, threads=1)
    gravity = np.array([3.0, 9.81])
    event = zd.Event(sp.Symbol("alpha1") - sp.Symbol("gravity") / 5)
    varied = zd.ensemble(BAR, 1.0, parameters={"gravity": gravity}, step=0.01, events=event, threads=1)
    assert not asked._part.paths.any()
    assert not varied._part.paths.any()
    for run in range(2):
        sol = zd.simulate(BAR.with_parameters(gravity=gravity[run]), 1.0, step=0.01, events=event)
        assert np.array_equal(sol.t_events[0], varied.t_events[run][0])


def test_general_steps_write_their_events_down_without_python():
    ens = ensemble(EVENTS["terminal"], step=0.01, closed_form=False)
    assert (ens._part.paths == ALONE).all()
    for run in (0, 10):
        sol = zd.simulate(BAR, 2.0, v0=STARTS[run], step=0.01, closed_form=False, events=EVENTS["terminal"])
        assert ens.messages[run] == sol.message
        for mine, its in zip(ens.t_events[run], sol.t_events, strict=True):
            assert np.array_equal(mine, its)


@functools.cache
def rod():
    """A point on a rod with a thrust across it."""
    t, g, u = sp.symbols("t g u")
    x, y = sp.Function("x")(t), sp.Function("y")(t)
    return zd.symbolic([x, y], kinetic=(x.diff(t)**2 + y.diff(t)**2) / 2, potential=g * y, force=[-u * y, u * x],
                       constraints={"rod": x**2 + y**2 - 1}, parameters={g: 9.81, u: 2.0}, inputs=[u], p0=[1.0, 0.0],
                       v0=[0.0, 0.0])


@pytest.mark.parametrize("terminal", [0, 2])
@pytest.mark.parametrize("course", [
    {"step": 0.01}, {"step": 0.013, "integrator": "heun"}, {"integrator": "dormand_prince", "rtol": 1e-7, "atol": 1e-9}])
def test_events_act_as_in_simulate(course, terminal):
    events = [zd.Event("x", value=-0.5, direction=-1, then={"u": 6.0}), zd.Event("x", value=0.5, direction=1, then={"u": 1.0}),
              zd.Event("x", value=0.5, direction=1, then={"u": 1.5}, terminal=terminal)]
    starts = np.column_stack([np.zeros(11), np.linspace(-1, 1, 11)])
    given = {"events": events, "t_eval": np.linspace(0, 4, 41), **course}
    ens = zd.ensemble(rod(), 4.0, p0=np.tile(rod().p0, (11, 1)), v0=starts, outputs=["x", "rod"], **given)
    assert (ens._part.paths == LANES).all()
    for run, v0 in enumerate(starts):
        sol = zd.simulate(rod(), 4.0, rod().p0, v0, **given)
        count = ens._part.rows[run]
        assert len(ens.t_events[run][0]) > 0
        for name in ("x", "rod"):
            assert_alike(ens[name][run][:count], sol[name][:count], ALIKE)
        for mine, its in zip(ens.t_events[run], sol.t_events, strict=True):
            assert_alike(mine, its, ALIKE)
    assert ens[3]["u"][-1] == zd.simulate(rod(), 4.0, rod().p0, starts[3], **given)["u"][-1]


def test_events_that_chatter_in_lanes_are_failed_runs():
    events = [zd.Event("x_dot", value=0.0, then={"u": 10.0}), zd.Event("x_dot", value=1e-13, then={"u": -10.0})]
    ens = zd.ensemble(rod(), 4.0, p0=np.tile(rod().p0, (3, 1)), v0=np.zeros((3, 2)), events=events, step=0.01, t_eval=[4.0])
    assert ens.failed.all()
    assert "an event must not act again and again" in ens.messages[0]
