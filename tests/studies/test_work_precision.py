"""`zd.work_precision`: every way to simulate is a row, measured against what is known, and nothing is lost."""

import csv
import sys

import matplotlib
import numpy as np
import pytest

import zerodrift as zd
from support import FORMULATIONS, SYSTEMS, refused

matplotlib.use("Agg")
from matplotlib import pyplot as plt

BAR, PENDULUM = SYSTEMS["four_bar"], SYSTEMS["pendulum"]
CHOOSING = [name for name in zd.integrators() if zd.integrators()[name].error_order]


def measured(system=BAR, t_end=0.5, **options):
    few = {"formulations": ["schur"], "integrators": ["rk4", "dop853"], "steps": [0.02, 0.01], "tolerances": [1e-6], "rounds": 1}
    return zd.work_precision(system, t_end, **(few | options))


@pytest.fixture(scope="module")
def result():
    return measured()


def test_every_system_is_measured_by_every_method(system):
    result = measured(system, 0.2, formulations=None, integrators=None, steps=[0.01])
    ways = {(row.setting.formulation, row.setting.integrator, row.setting.tolerance) for row in result.rows}
    assert ways == {(formulation, integrator, tolerance) for formulation in FORMULATIONS for integrator in zd.integrators(system)
                    for tolerance in (None, 1e-6) if (tolerance is None or integrator in CHOOSING)}
    assert all(row.success and row.seconds > 0 and row.error < 0.1 for row in result.rows)


def test_the_error_is_that_of_the_run_itself():
    """Also at times at which no step of the run ends."""
    exact = zd.reference(BAR, 0.5, error=1e-10, t_eval=np.linspace(0, 0.5, 33))
    for row in measured(reference=exact).rows:
        sol = zd.simulate(BAR, 0.5, **row.setting.settings, closed_form=False)     # formulations are compared without
        at = zd.simulate(BAR, 0.5, **row.setting.settings, closed_form=False, t_eval=exact.solution.t)
        error = np.abs(at.p - exact.solution.p).max()
        assert abs(row.error - error) <= exact.error
        assert row.steps == sol.stats["steps"]
        assert row.position_violation == np.abs(sol.position_violation).max()
        assert row.energy_violation == np.abs(sol.energy_violation).max()


def test_a_step_that_ends_well_is_judged_on_its_way():
    result = measured(SYSTEMS["oscillator"], integrators=["rk4"], steps=[0.5], tolerances=[],
                      reference=lambda t: [0.1 * np.cos(np.sqrt(10) * t) + np.sin(2 * np.pi * t)])
    assert 0.9 < result.rows[0].error < 1.1


def test_the_defaults_span_errors_from_large_to_small():
    result = zd.work_precision(PENDULUM, 1.0, formulations=["schur"], rounds=1)
    errors = [row.error for row in result.rows if row.success]
    assert min(errors) < 1e-9
    assert max(errors) > 1e-3


def test_corrections_are_combined_too():
    result = measured(steps=[0.01], tolerances=[], integrators=["rk4"], stabilizations=[None, "projection", "baumgarte"],
                      energy=[False, True])
    assert len({(row.setting.stabilization, row.setting.energy) for row in result.rows}) == len(result.rows) == 6


@pytest.mark.parametrize("reference", [lambda t: [0.1 * np.cos(np.sqrt(10) * t)],
                                       zd.simulate(SYSTEMS["oscillator"], 0.5, step=0.01)])
def test_references_of_other_kinds(reference):
    result = measured(SYSTEMS["oscillator"], integrators=["rk4"], tolerances=[], reference=reference)
    assert all(row.error < 1e-6 for row in result.rows)
    assert np.isnan(result.reference_error)


def test_what_the_reference_does_not_exclude_is_reported():
    """A system that depends on time may change between two evaluated steps, unseen by both."""
    driven = zd.System(1, mass=[[1.0]], force=lambda t: np.array([np.sin(t)]), p0=[0.0], v0=[0.0])
    few = {"formulations": ["schur"], "integrators": ["rk4"]}
    found = measured(driven, **few, steps=[0.1], tolerances=[])
    tuning = zd.tune(driven, 0.5, error=1e-4, **few, rounds=1)
    by_steps = zd.stability_map(driven, 0.5, steps=[0.1], values=[1.0], ways={"plain": {}})
    for said, shown in ((found.reference_caveats, found), (tuning.evidence.reference_caveats, tuning),
                        (by_steps.reference_caveats, by_steps)):
        assert "no max_step was said" in said[0]
        assert f"not excluded of the reference: {said[0]}" in repr(shown)
    assert measured(driven, **few, steps=[0.1], tolerances=[],
                    reference=zd.reference(driven, 0.5, max_step=0.1)).reference_caveats == ()


@pytest.mark.usefixtures("few_places")
def test_a_system_without_constraints_and_potential_has_no_such_numbers():
    free = zd.System(1, mass=[[1.0]], p0=[0.0], v0=[1.0])
    row = measured(free, integrators=["rk4"], steps=[0.1], tolerances=[]).rows[0]
    assert np.isnan([row.position_violation, row.velocity_violation, row.energy_violation]).all()


def test_failures_are_rows():
    result = measured(t_end=8.0, integrators=["rk4"], steps=[0.05, 0.002], tolerances=[], stabilizations=[None])
    failed, done = result.rows
    assert not failed.success
    assert "left the range of doubles" in failed.message
    assert np.isnan(failed.error)
    assert done.success
    assert "1 failed" in repr(result)
    assert failed not in result.pareto()


def test_corrections_left_out_are_said_in_the_row():
    row = measured(SYSTEMS["oscillator"], 8.0, integrators=["euler"], steps=[0.01], tolerances=[], energy=[True]).rows[0]
    assert "energy corrections left out" in row.message


def test_no_row_dominates_one_of_the_front(result):
    front = result.pareto()
    assert front
    for mine in front:
        assert not any(row.seconds <= mine.seconds and row.error <= mine.error and row != mine for row in result.rows)


def test_rounds_keep_the_rows(result):
    again = measured(rounds=3)
    assert [row._replace(seconds=0) for row in again.rows] == [row._replace(seconds=0) for row in result.rows]


# ---- tables ----


def test_the_table_as_a_file(result, tmp_path):
    with open(result.to_csv(tmp_path / "rows.csv")) as file:
        rows = list(csv.DictReader(file))
    assert [float(row["error"]) for row in rows] == [row.error for row in result.rows]
    assert rows[0]["step"] == "0.02"
    assert rows[0]["tolerance"] == ""


def test_the_table_as_a_data_frame(result):
    pandas = pytest.importorskip("pandas")
    frame = result.to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert frame["integrator"].tolist() == [row.setting.integrator for row in result.rows]


def test_without_pandas_it_says_so(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with refused("missing-package", "needs pandas"):
        result.to_dataframe()


# ---- progress and Ctrl-C ----


def test_progress_goes_from_nothing_to_all():
    parts = []
    measured(progress=parts.append, rounds=2)
    assert parts == sorted(parts)
    assert parts[-1] == 1.0
    assert len(parts) == 10


def test_an_interruption_keeps_what_is_done():
    def interrupt(part):
        if part > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(zd.Interrupted, match="after 3 of 5 rows") as caught:
        measured(progress=interrupt)
    partial = caught.value.solution
    assert len(partial.rows) == 3
    assert not partial.complete
    assert "interrupted" in repr(partial)


def test_an_interrupted_run_interrupts_all():
    calls = []

    def force(t):
        calls.append(t)
        if len(calls) > 50:
            raise KeyboardInterrupt
        return [0.0]

    system = zd.System(1, mass=[[1.0]], force=force, p0=[0.0], v0=[1.0])
    with pytest.raises(zd.Interrupted):
        measured(system, reference=lambda t: [t])


# ---- the diagram ----


def test_one_line_per_method_and_the_front(result):
    ax = zd.plot.work_precision(result)
    ax.figure.canvas.draw()
    methods = {row.setting.method for row in result.rows}
    assert len(ax.lines) == len(methods) + 2        # the front, and the error of the reference
    assert ax.get_xscale() == ax.get_yscale() == "log"
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels[:3] == ["rk4", "dop853", "schur"]
    plt.close("all")


# ---- bad arguments ----


@pytest.mark.parametrize(("options", "code", "message"), [
    ({"integrators": ["newton"]}, "unknown-choice", "integrators"),
    ({"integrators": "rk4"}, "wrong-type", "integrators"),
    ({"steps": [0.0]}, "step-size", "steps.*than 0"),
    ({"rounds": 0}, "out-of-range", "rounds.*between 1"),
    ({"steps": [], "integrators": ["rk4"]}, "wrong-value", "at least one combination must be possible"),
    ({"reference": 3.0}, "wrong-type", "reference"),
    ({"stabilizations": ["glue"]}, "unknown-choice", "stabilization"),
])
def test_bad_arguments(options, code, message):
    with refused(code, message):
        measured(**options)
