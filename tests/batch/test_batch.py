"""Runs that the core makes from tables: each has the bits that `simulate` gives it, and fails by itself."""

import threading

import numpy as np
import pytest

import zerodrift as zd
from lanes import rows_of
from large_mechanisms import four_bars
from support import SYSTEMS
from zerodrift._private import gateway
from zerodrift.ensembles.batch import batch_of
from zerodrift.ensembles.part import BY_CORE
from zerodrift.ensembles.plan import checked
from zerodrift.ensembles.run_range import never, run_range
from zerodrift.ensembles.runs import Runs

COURSES = {"fixed": {"step": 0.01, "closed_form": False}, "saved": {"step": 0.01, "save_every": 7, "closed_form": False},
           "chosen": {"integrator": "dop853", "rtol": 1e-8, "closed_form": False, "t_eval": np.linspace(0.05, 0.4, 4)}}


def made(system, span, parameters=None, p0=None, v0=None, names=None, stop=never, **options):
    runs = Runs(system, parameters, p0, v0, None, (), assembles=True)
    plan = checked(runs, span, names, None, keeps=False, **options)
    assert batch_of(plan) is not None
    return run_range(plan, 0, runs.count, stop)


@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize("kind", sorted({"four_bar", "arm", "skate"} & {*SYSTEMS}))
def test_runs_have_the_bits_that_simulate_gives_them(kind, course):
    system = SYSTEMS[kind]
    names = [variable.name for group in (system.coordinates, system.velocities, system.constraints) for variable in group]
    speeds = np.linspace(0.5, 1.5, 3)
    found = made(system, 0.4, v0=speeds[:, None] * system.v0, names=names, **COURSES[course])
    for run, speed in enumerate(speeds):
        if kind == "arm" and speed != 1:    # a start that the moving constraint forbids
            with pytest.raises(zd.InconsistentStart) as refused:
                zd.simulate(system, 0.4, system.p0, speed * system.v0, **COURSES[course])
            assert f"{found.messages[run]} [zd:inconsistent-start]" == f"InconsistentStart: {refused.value}"
            continue
        sol = zd.simulate(system, 0.4, system.p0, speed * system.v0, **COURSES[course])
        assert (found.rows[run], found.failed[run], found.messages[run]) == (len(sol.t), False, "done")
        assert np.array_equal(list(found.times())[run], sol.t)
        for name in names:
            assert np.array_equal(rows_of(found, name)[run], sol[name])


@pytest.mark.parametrize("course", COURSES)
def test_hinged_bodies_have_the_bits_that_simulate_gives_them(course):
    """More of them than are solved with dense matrices."""
    system, options = four_bars(7).system("absolute"), COURSES[course] | {"closed_form": None}
    names, shares = ["rod3.x", "bar2.y_dot", system.constraints[0].name], (0.5, 1.0, 1.5)
    found = made(system, 0.4, p0=np.tile(system.p0, (3, 1)), v0=np.multiply.outer(shares, system.v0), names=names, **options)
    assert (found.paths == BY_CORE).all()
    for run, share in enumerate(shares):
        sol = zd.simulate(system, 0.4, system.p0, share * system.v0, **options)
        for name in names:
            assert np.array_equal(rows_of(found, name)[run], sol[name])


def test_parameters_stand_in_tables():
    bar, gravity = zd.systems.four_bar(masses=(2.0, 5.0, 3.0)), np.array([1.0, np.nan, 9.81, 20.0])
    lengths = np.array([[1.0, 0.3, 1.0, 0.6]] * 3 + [[1.0, 0.3, 1.0, 9.0]])
    found = made(bar, 0.1, {"gravity": gravity, "lengths": lengths}, step=0.01)
    assert found.failed.tolist() == [False, True, False, True]
    assert found.messages[1] == "ValueError: gravity must be finite, not nan [zd:not-finite]"
    assert "cannot close the loop" in found.messages[3]
    for run in (0, 2):
        own = bar.with_parameters(gravity=gravity[run], lengths=lengths[run])
        p, v = zd.assemble(own, own.p0, own.v0)
        assert np.array_equal(rows_of(found, "alpha1")[run], zd.simulate(own, 0.1, p, v, step=0.01)["alpha1"])


def test_runs_that_are_stopped_say_so():
    stop = gateway.Stop()
    stop.set()
    assert not len(made(zd.systems.four_bar(), 0.1, {"gravity": [1.0, 2.0]}, step=0.01, stop=stop).rows)


def test_long_runs_are_stopped_within_them():
    """A run of 10^10 steps; one that has ended would have its samples."""
    stop = gateway.Stop()
    timer = threading.Timer(0.05, stop.set)
    timer.start()
    assert not len(made(zd.systems.four_bar(), 1e7, {"gravity": [1.0]}, step=0.001, save_every=10**9, stop=stop).rows)
    timer.join()


def test_a_run_that_fails_keeps_the_rows_it_has():
    """A fall so long that a pendulum gets too fast for its steps."""
    pendulum, options = zd.systems.pendulum(), {"step": 0.05, "integrator": "euler", "stabilization": None}
    found = made(pendulum, 400.0, v0=[[0.0, 0.0], [0.0, 1e60]], **options)
    with pytest.raises(zd.ZerodriftError) as failed:
        zd.simulate(pendulum, 400.0, v0=[0.0, 1e60], **options)
    partial = failed.value.solution
    assert found.failed[1]
    assert found.messages[1] == partial.message
    assert found.rows[1] == len(partial.t)
    assert np.array_equal(rows_of(found, "x")[1], partial["x"])


def test_doubtful_runs_are_reported_once():
    bar = zd.systems.four_bar()
    with pytest.warns(zd.AccuracyWarning, match="2 of 3 runs are doubtful; run 1: "):
        ens = zd.ensemble(bar, 2.0, v0=[bar.v0, 12 * bar.v0, 13 * bar.v0], step=0.02)
    assert len(ens) == 3


@pytest.mark.parametrize("needs_python", [{"events": [lambda t, p, v: p[0]], "step": 0.1}, {"integrator": "dop853"}],
                         ids=["events", "rows"])
def test_what_needs_python_is_left_to_it(needs_python):
    runs = Runs(zd.systems.four_bar(), {"gravity": [1.0, 2.0]}, None, None, None, (), assembles=True)
    assert batch_of(checked(runs, 1.0, None, None, keeps=False, **needs_python)) is None
