"""Rows of runs that the core makes many at once, and in threads: those of `simulate`, bit for bit."""

import _thread
import threading

import numpy as np
import pytest

import zerodrift as zd
from mechanisms.random_mechanisms import Maker
from support import SYSTEMS, refused
from watched import pendulum
from zerodrift.runs.arguments import settings
from zerodrift.studies import reference_runs
from zerodrift.studies.bench import Bench, Setting

STABILIZATIONS = (None, zd.Projection(), zd.Baumgarte(5.0, 6.25), zd.Baumgarte(1000.0, 250000.0))


def ways(system, formulations=("schur", "independent"), steps=(0.02, 0.3)):
    """Settings of all kinds, some of them much too coarse, as far as the system has what they take."""
    energies = (None, zd.EnergyCorrection()) if system.has_energy else (None,)
    every = [Setting(formulation, integrator, step, None, stabilization, energy) for formulation in formulations
             for integrator in ("rk4", "radau") for step in steps for stabilization in STABILIZATIONS
             for energy in energies]
    return [way for way in every if not settings.disagreement(way.settings)]


def assert_the_same(system, combinations, monkeypatch, closed_form=False, t_end=0.3):
    """By the core and by `simulate`; returns the rows."""
    bench = Bench(system, (0.0, t_end), None, None, lambda t: np.zeros(system.nq), closed_form)
    assert not bench.needs_python
    found = [row._replace(seconds=0.0) for row in bench.rows(combinations)]
    with monkeypatch.context() as patched:
        patched.setattr(Bench, "needs_python", True)
        alone = [row._replace(seconds=0.0) for row in bench.rows(combinations)]
    assert list(map(repr, found)) == list(map(repr, alone))     # of numbers all digits, and NaN where it is
    return found


@pytest.mark.parametrize("name", SYSTEMS)
def test_rows_have_the_bits_of_single_runs(name, monkeypatch):
    rows = assert_the_same(SYSTEMS[name], ways(SYSTEMS[name]), monkeypatch, closed_form=None)
    assert any(row.success for row in rows)


@pytest.mark.parametrize("seed", range(8))
def test_of_random_mechanisms_too(seed, monkeypatch):
    """Their failures are rows of their own: a gain that is far too high ends in no number, or in a refused step."""
    system = Maker(seed).m.system()
    if Bench(system, (0.0, 0.1), None, None, lambda t: np.zeros(system.nq)).needs_python:
        pytest.skip("it has laws in Python, which take the road of single runs")
    assert_the_same(system, ways(system, ["schur"]), monkeypatch)


def test_a_run_that_diverges_is_a_cell_of_its_own(monkeypatch):
    rows = assert_the_same(SYSTEMS["four_bar"], ways(SYSTEMS["four_bar"], ["schur"], [0.01]), monkeypatch)
    failed = [row for row in rows if not row.success]
    assert failed
    assert len(failed) < len(rows)
    assert np.isnan([row.error for row in failed]).all()
    assert all(row.message != "done" for row in failed)


def test_a_run_that_cannot_begin_says_why_as_any_other():
    bar = SYSTEMS["four_bar"]
    bench = Bench(bar, (0.0, 0.1), 1.1 * bar.p0, bar.v0, lambda t: np.zeros(3))
    with pytest.raises(zd.InconsistentStart) as alone:
        zd.simulate(bar, 0.1, 1.1 * bar.p0, bar.v0, step=0.01, closed_form=False)
    with pytest.raises(zd.InconsistentStart) as refused:
        bench.rows([Setting("schur", "rk4", 0.01, None)])
    assert str(refused.value) == str(alone.value)


@pytest.mark.usefixtures("few_places")
def test_python_takes_turns_in_the_thread_that_called():
    seen = set()
    system = pendulum(lambda: seen.add(threading.get_ident()))
    found = zd.stability_map(system, 0.05, steps=[0.01], values=[1.0, 2.0], reference=lambda t: np.zeros(2))
    assert found.survived("projection").all()
    zd.reference(system, 0.05, error=1e-6)
    assert seen == {threading.get_ident()}


# ---- the runs of a reference, side by side ----


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_reference_is_that_of_runs_one_by_one(name, monkeypatch):
    found = zd.reference(SYSTEMS[name], 0.2)
    monkeypatch.setattr(reference_runs.Motion, "run_side_by_side", lambda *given: None)
    alone = zd.reference(SYSTEMS[name], 0.2)
    assert (repr(found), found.caveats) == (repr(alone), alone.caveats)
    assert (found.error, found.velocity_error, found.differences) == (alone.error, alone.velocity_error, alone.differences)
    assert found.solution.p.tobytes() == alone.solution.p.tobytes()


def test_what_a_run_raises_is_raised_when_it_is_requested(monkeypatch):
    motion, way = motion_of(SYSTEMS["four_bar"]), reference_runs.Way(30, "hamilton", "rk4")
    motion.run_side_by_side([way], 30)
    with refused("unknown-choice"):
        motion.run(way, 30)


def test_ctrl_c_stops_the_runs_of_a_reference():
    """Each would take a minute."""
    motion = motion_of(SYSTEMS["four_bar"])
    asked = [reference_runs.Way(30_000_000, formulation, "dop853") for formulation in ("schur", "augmented", "nullspace")]
    threading.Timer(0.2, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        motion.run_side_by_side(asked, 1)
    assert not motion._made_before


def motion_of(system):
    return reference_runs.Motion(system, (0.0, 0.5), None, None, None, settings.STABILIZATION, "schur",
                          {"first_step": None, "max_step": None})
