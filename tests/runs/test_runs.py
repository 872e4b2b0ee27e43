"""Runs: the same bits whatever the slicing and threads; where they start; and what a run costs, counted."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from large_mechanisms import four_bars, star
from support import FORMULATIONS, INTEGRATORS, assert_same_bits, motion, refused
from zerodrift.runs import simulate as simulation

# ---- repeatability ----


def test_slicing_changes_no_bit(system, formulation, integrator, monkeypatch):
    runs = []
    for seconds in (1e9, 0.0):
        monkeypatch.setattr(simulation, "SLICE", seconds)
        runs.append(motion(system, 1.0, 100, formulation=formulation, integrator=integrator))
    assert_same_bits(*runs)
    assert runs[0].stats | {"seconds": 0} == runs[1].stats | {"seconds": 0}


def test_many_slices_are_many(bar, monkeypatch):
    """Or the test above would show nothing; and progress goes from somewhere to the end."""
    monkeypatch.setattr(simulation, "SLICE", 0.0)
    parts = []
    motion(bar, 1.0, 100, progress=parts.append)
    assert len(parts) > 3
    assert parts == sorted(parts)
    assert parts[-1] == 1


def test_a_slice_takes_steps_however_short_it_is(bar, monkeypatch):
    monkeypatch.setattr(simulation, "SLICE", -1.0)
    slices = []

    def count(part):
        slices.append(part)
        assert len(slices) <= 100

    motion(bar, 1.0, 100, progress=count)


def test_threads_change_no_bit(system):
    """One system, shared by runs in several threads at once."""
    def run(_):
        return motion(system, 2.0, 2000)

    with ThreadPoolExecutor(4) as pool:
        runs = list(pool.map(run, range(8)))
    for other in runs[1:]:
        assert_same_bits(runs[0], other)


def test_threads_with_different_settings_do_not_meet(bar):
    settings = [{"formulation": f, "integrator": i} for f in FORMULATIONS for i in INTEGRATORS]
    alone = [motion(bar, 1.0, 400, **each) for each in settings]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda each: motion(bar, 1.0, 400, **each), settings))
    for one, other in zip(alone, together, strict=True):
        assert_same_bits(one, other)


def test_looking_at_every_row_costs_nothing(system, formulation):
    """Multipliers are recorded from what the next step needs anyway; after a step that has left the closed-form path, the
    next one need not need it.
    """
    full, sparse = (motion(system, 1.0, 100, formulation=formulation, save_every=every).stats for every in (1, 100))
    left = full["steps"] - full["closed_form_steps"] if full["closed_form_steps"] else 0
    assert 0 <= full["factorizations"] - sparse["factorizations"] <= left
    assert 0 <= full["solves"] - sparse["solves"] <= left


# ---- long runs ----


@pytest.mark.parametrize("energy", [None, True])
def test_a_million_steps_are_as_good_as_the_first(bar, energy):
    """Violations do not grow, nor does energy where it is corrected; elsewhere its error grows as time does, not faster."""
    sol = zd.simulate(bar, 1000.0, step=1e-3, save_every=1000, energy=energy)
    assert len(sol.t) == 1001
    assert np.abs(sol.position_violation).max() <= sol.settings["stabilization"].tol
    assert np.abs(sol.velocity_violation).max() <= 3 * tol.VELOCITY * np.abs(sol.v).max()     # three links of a metre
    size = np.abs(sol.energy_violation)
    if energy:
        assert size.max() <= tol.ENERGY * (sol.kinetic_energy + 3 * np.abs(sol.potential_energy)).max()
    else:
        assert size[-1] <= 20 * size[:100].max()


# ---- the start ----


def test_a_run_starts_at_the_given_time(system):
    p, v = zd.assemble(system, system.p0, 0.5 * system.v0, t=2.0)
    sol = zd.simulate(system, (2.0, 2.1), p, v, step=0.05)
    assert np.array_equal(sol.p[0], p)
    assert np.array_equal(sol.v[0], v)


def test_a_start_within_the_tolerance_asked_for_is_taken(bar):
    p = bar.p0 + 1e-7
    sol = zd.simulate(bar, 0.1, p, bar.v0, step=0.05, stabilization=zd.Projection(tol=1e-6))
    assert np.array_equal(sol.p[0], p)


# ---- cost, counted: nothing is computed twice ----


def test_cost_of_a_step(bar):
    """RK4 with projection: the velocity correction's matrix serves the first of the next step's four stages."""
    stats = motion(bar, 8.0, 800, closed_form=False).stats
    iterations = stats["position_iterations"]
    assert stats["velocity_corrections"] == stats["steps"] == 800
    assert stats["factorizations"] == 1 + 4 * 800 + iterations
    assert stats["solves"] == 1 + 5 * 800 + iterations
    assert stats["evaluations"] <= 2 * stats["factorizations"] + 800


@pytest.mark.parametrize("make", [four_bars, star])
@pytest.mark.parametrize("n", [2, 20])
def test_cost_of_a_step_of_declared_structure(make, n):
    """The same, with few rows and with so many that nothing dense is made, and where one body has many joints."""
    stats = zd.simulate(make(n).system("absolute"), 0.1, step=5e-3, closed_form=False).stats
    assert stats["velocity_corrections"] == stats["steps"] == 20
    assert stats["factorizations"] == 1 + 4 * 20 + stats["position_iterations"]
    assert stats["solves"] == 1 + 5 * 20 + stats["position_iterations"]


def test_cost_of_a_step_without_corrections(bar):
    stats = motion(bar, 8.0, 800, closed_form=False, stabilization=None).stats
    assert stats["factorizations"] == stats["solves"] == 1 + 4 * 800
    assert stats["position_iterations"] == stats["velocity_corrections"] == stats["energy_corrections"] == 0


def test_energy_correction_needs_no_further_matrix(bar):
    stats = motion(bar, 8.0, 800, closed_form=False, energy=True).stats
    assert stats["factorizations"] == 1 + 4 * 800 + stats["position_iterations"]
    assert stats["energy_corrections"] == 800


def test_cost_of_a_closed_form_step(bar):
    """A step starts with the accelerations at the end of the last one; a correction's last call includes the velocities."""
    stats = motion(bar, 8.0, 800, save_every=800).stats
    assert stats["closed_form_steps"] == stats["velocity_corrections"] == 800
    assert stats["factorizations"] == 1
    assert stats["evaluations"] <= 20 + (4 + 1) * 800 + stats["position_iterations"] + 800 // 8


def test_implicit_iterations_are_counted(bar):
    assert motion(bar, 1.0, 100).stats["implicit_iterations"] == 0
    assert 100 <= motion(bar, 1.0, 100, integrator="trapezoidal").stats["implicit_iterations"] <= 500


def test_an_instant_of_a_system_without_layout_is_refused_for_a_mechanism():
    with refused("wrong-element", "pendulum"):
        zd.simulate(zd.models.four_bar(), 0.1, zd.Instant(zd.systems.pendulum()), step=0.01)
