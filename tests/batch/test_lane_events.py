"""Events of runs in vector lanes: where `simulate` finds them up to rounding, with bits that do not depend on neighbours."""

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
