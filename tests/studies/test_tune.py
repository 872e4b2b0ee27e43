"""`zd.tune`: the settings that it chooses meet the requested error. Times are not asserted."""

import numpy as np
import pytest

import zerodrift as zd
from support import SYSTEMS, refused
from zerodrift.studies import bench as bench_of_studies
from zerodrift.studies import compare
from zerodrift.studies.bench import Bench

BAR = SYSTEMS["four_bar"]
FEW = {"formulations": ["schur", "independent"], "integrators": ["rk4", "dop853"], "rounds": 1}


@pytest.mark.parametrize("error", [1e-4, 1e-8])
def test_the_error_is_met_on_every_system(system, error):
    """By a run of one's own, at every row, against a reference of another formulation."""
    tuning = zd.tune(system, 0.5, error=error, **FEW)
    sol = zd.simulate(system, 0.5, **tuning.settings)
    ref = zd.reference(system, 0.5, error=1e-10, formulations=("nullspace", "augmented"))
    assert np.abs(compare.difference(sol, ref)).max() <= error + ref.error
    assert tuning.row in tuning.evidence.rows
    assert f"Tuning of {system.name}" in repr(tuning)


def test_errors_are_those_at_the_steps_of_the_run():
    """Output times that all runs share are fewer, and miss up to some per cent of a run's error."""
    from zerodrift.studies.bench import Setting

    reference = zd.reference(BAR, 4.0, error=1e-11)
    bench, missed = Bench(BAR, (0.0, 4.0), None, None, reference, closed_form=None), []
    for row in bench.timed([Setting("schur", "dop853", 4 / steps, None) for steps in (320, 480, 640)]):
        sol = zd.simulate(BAR, 4.0, **row.setting.settings)
        error = np.abs(compare.difference(sol, reference)).max()
        assert bench.verified(row).error >= error - 2 * reference.error
        missed.append(error - row.error)
    assert max(missed) > 0


def test_the_evidence_has_every_setting_once():
    tuning = zd.tune(BAR, 1.0, error=1e-6, **FEW)
    assert len(tuning.evidence.rows) == len({row.setting for row in tuning.evidence.rows})
    assert {row.setting.integrator for row in tuning.evidence.rows} == {"rk4", "dop853"}


def test_steps_finer_than_those_of_the_sweep_are_tried():
    tuning = zd.tune(BAR, 1.0, error=1e-6, formulations=["schur"], integrators=["rk4"], rounds=1)
    assert tuning.row.error <= 1e-6


def test_a_budget_that_all_keep_is_used_for_accuracy():
    tuning = zd.tune(SYSTEMS["pendulum"], 0.5, budget=100.0, **FEW)
    assert tuning.row.error < 1e-10


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")     # the reference is that of an explicit method
def test_of_a_stiff_system_it_takes_the_implicit_method():
    """A light mass that follows a slow one, which stability holds to steps of some 5e-4 s."""
    sympy = pytest.importorskip("sympy")
    p, v = sympy.symbols("x y"), sympy.symbols("vx vy")
    stiff = zd.symbolic(p, speeds=v, kinetic=(v[0]**2 + v[1]**2) / 2, p0=[1.0, 1.0], v0=[0.0, 0.0],
                        force=[-p[0], 1e8 * (p[0] - p[1]) + 2e4 * (v[0] - v[1])])
    tuning = zd.tune(stiff, 0.3, error=1e-5, formulations=["schur"], integrators=["dop853", "radau"], rounds=1)
    assert tuning.settings["integrator"] == "radau"
    assert tuning.row.error <= 1e-5


# ---- what it refuses ----


def test_an_error_below_round_off_is_refused():
    with pytest.raises(zd.UnreachableTolerance, match="to which double precision limits these methods on this motion"):
        zd.tune(BAR, 8.0, error=1e-13, formulations=["schur"], integrators=["dop853"])


def test_an_error_that_no_method_allowed_reaches_is_refused():
    with pytest.raises(zd.UnreachableTolerance, match=r"reached by none of .* has an error of"):
        zd.tune(BAR, 1.0, error=1e-9, formulations=["schur"], integrators=["euler"])


def test_a_budget_that_no_run_keeps_is_refused():
    with pytest.raises(ValueError, match="budget = 1e-12 s is kept by none of"):
        zd.tune(BAR, 0.5, budget=1e-12, **FEW)


@pytest.mark.parametrize("options", [{}, {"error": 1e-6, "budget": 1.0}])
def test_one_of_error_and_budget_is_needed(options):
    with refused("conflicting-arguments"):
        zd.tune(BAR, 1.0, **options)


@pytest.mark.parametrize("options", [{"error": 0.0}, {"budget": -1.0}])
def test_bad_values(options):
    with refused("out-of-range", "than 0"):
        zd.tune(BAR, 1.0, **options)


def test_an_interruption_of_the_search_keeps_all_that_was_measured(monkeypatch):
    """Also what the sweep before it has. Here each error is found after its run, so that none is lost with others."""
    system, rows, measured = zd.systems.oscillator(), Bench._rows, []
    methods = {"formulations": ["schur"], "integrators": ["rk4"]}
    sweep = zd.work_precision(system, 1.0, rounds=1, **methods)

    def interrupted(bench, combinations, outcomes, stop):
        if len(measured) == len(sweep.rows) + 1:
            raise KeyboardInterrupt
        measured.extend(combinations)
        return rows(bench, combinations, outcomes, stop)

    monkeypatch.setattr(bench_of_studies, "TOGETHER", 0.0)
    monkeypatch.setattr(bench_of_studies, "processors", lambda: 1)
    monkeypatch.setattr(Bench, "_rows", interrupted)
    with pytest.raises(zd.Interrupted, match="interrupted from the keyboard") as caught:
        zd.tune(system, 1.0, error=1e-6, **methods)
    partial = caught.value.solution
    assert not partial.complete
    assert {row.setting for row in partial.rows} == set(measured)


def test_an_interrupted_verification_keeps_all_entries(monkeypatch):
    """The interrupted run raises an error with a solution, which has no entries."""
    def interrupted(bench, row):
        raise zd.Interrupted("interrupted from the keyboard", zd.simulate(BAR, 0.01, step=1e-3))

    monkeypatch.setattr(Bench, "verified", interrupted)
    with pytest.raises(zd.Interrupted, match=r"interrupted from the keyboard after [1-9]") as caught:
        zd.tune(BAR, 0.1, error=1e-4, **FEW)
    assert len(caught.value.solution.rows) > 1
