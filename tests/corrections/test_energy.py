"""The correction of the energy, (29): what it scales, how often, and where it is left out."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tolerances as tol
import zerodrift as zd
from covering import draws
from support import SYSTEMS, assert_close, motion, with_energy


@pytest.mark.filterwarnings("ignore::zerodrift.CorrectionWarning")
def test_energy_correction_leaves_round_off(system, formulation, integrator):
    """Round-off remains after every step, except after those that are counted as left out."""
    sol = motion(with_energy(system), 2.0, 100, formulation=formulation, integrator=integrator, energy=True)
    T, V = sol.kinetic_energy, sol.potential_energy
    allowed = tol.ENERGY * (T + np.abs(V) + np.abs(T[0] + V[0]))
    assert (np.abs(sol.energy_violation) > allowed).sum() <= sol.stats["energy_skipped"]
    assert sol.stats["energy_skipped"] + sol.stats["energy_corrections"] <= sol.stats["steps"] + sol.stats["subdivided"]


def test_energy_correction_scales_velocities(bar):
    """(29): one step with it is one step without, times a factor; and what was projected stays so."""
    without, scaled = (motion(bar, 0.05, 1, energy=energy) for energy in (None, True))
    factor = np.sqrt(1 - without.energy_violation[1] / without.kinetic_energy[1])
    assert factor != 1
    assert np.array_equal(scaled.p, without.p)
    assert_close(scaled.v[1], factor * without.v[1], tol.SAME)


def test_energy_correction_every_k_th_step(bar):
    sol = motion(bar, 1.0, 20, energy=zd.EnergyCorrection(every=6))
    assert sol.stats["energy_corrections"] == 4         # after 6, 12, 18 and the last
    small = np.abs(sol.energy_violation) <= tol.ENERGY * sol.kinetic_energy.max() + 1e-13
    assert np.flatnonzero(small).tolist() == [0, 6, 12, 18, 20]


def test_energy_corrections_left_out_are_counted_and_said():
    """An oscillator at a turning point has no kinetic energy to scale; steps of this size meet each turning point exactly."""
    oscillator = SYSTEMS["oscillator"]
    half_period = np.pi / np.sqrt(10)
    with pytest.warns(zd.CorrectionWarning, match=r"\d+ of 60 energy corrections were left out"):
        sol = motion(oscillator, 6 * half_period, 60, energy=True)
    skipped = sol.stats["energy_skipped"]
    assert 0 < skipped <= 6
    assert sol.energy_skipped.sum() == skipped
    assert set(np.flatnonzero(sol.energy_skipped)) <= set(range(10, 61, 10))     # the turning points
    allowed = tol.ENERGY * sol.potential_energy[0]
    assert (np.abs(sol.energy_violation) > allowed).sum() == skipped
    assert np.isfinite(sol.v).all()


@pytest.mark.filterwarnings("ignore::zerodrift.CorrectionWarning", "ignore::zerodrift.StabilityWarning")
@settings(deadline=None, max_examples=draws(30, 150))
@given(st.floats(-20, 1), st.floats(0.01, 3.0), st.integers(1, 40), st.sampled_from(["euler", "heun", "rk4", "trapezoidal"]))
def test_energy_corrections_are_bounded_and_counted_where_they_cannot_work(rate, angle, steps, integrator):
    """From nearly no kinetic energy to plenty, over turning points: a factor between 0.7 and 1.3, or none, which the row says."""
    pendulum = zd.systems.pendulum(angle=angle, rate=10.0**rate)
    h, p, v, largest = 0.02, pendulum.p0, pendulum.v0, 9.81 + 0.5 * 10.0 ** (2 * rate)
    for k in range(steps):
        without, scaled = (zd.simulate(pendulum, (k * h, (k + 1) * h), p, v, step=h, integrator=integrator, energy=energy)
                           for energy in (None, True))
        speed, corrected = (np.linalg.norm(sol.v[-1]) for sol in (without, scaled))
        error, kinetic, skipped = without.energy_violation[-1], without.kinetic_energy[-1], scaled.energy_skipped[-1]
        assert np.isfinite(scaled.v).all()
        assert np.sqrt(0.5) * speed * (1 - 1e-12) <= corrected <= np.sqrt(1.5) * speed * (1 + 1e-12)
        assert skipped == scaled.stats["energy_skipped"]
        assert skipped == (abs(error) > 0.5 * kinetic) or abs(error) <= tol.ENERGY * largest
        assert abs(scaled.energy_violation[-1]) <= tol.ENERGY * 2 * largest or skipped
        assert corrected == speed or not skipped
        p, v = scaled.p[-1], scaled.v[-1]
