"""Values between steps: at times asked for before the run, and afterwards between its rows."""

import numpy as np
import pytest

import zerodrift as zd
from support import SYSTEMS

TIMES = np.array([0.0, 0.013, 0.1, 0.10001, 0.237, 0.5])


def test_values_at_given_times_are_those_between_rows(system, formulation):
    """The first as the run goes, the second afterwards from its rows; rounding where variables are changed."""
    options = {"step": 0.02, "formulation": formulation}
    at = zd.simulate(system, 0.5, t_eval=TIMES, **options)
    p, v = zd.simulate(system, 0.5, **options)(TIMES)
    assert at.t.tolist() == TIMES.tolist()
    assert np.abs(at.p - p).max() <= 1e-12 * (1 + np.abs(p).max())
    assert np.abs(at.v - v).max() <= 1e-11 * (1 + np.abs(v).max())


def test_values_between_steps_satisfy_the_constraints(system, formulation):
    sol = zd.simulate(system, 0.5, step=0.02, formulation=formulation, t_eval=np.linspace(0, 0.5, 60))
    assert np.abs(sol.position_violation).max(initial=0) <= 1e-12
    assert np.abs(sol.velocity_violation).max(initial=0) <= 1e-12 * (1 + np.abs(sol.v).max())


def test_saving_between_steps_leaves_the_steps_alone(bar):
    plain = zd.simulate(bar, 0.5, step=0.02)
    watched = zd.simulate(bar, 0.5, step=0.02, t_eval=np.append(np.linspace(0.001, 0.499, 99), 0.5))
    assert watched.p[-1].tobytes() == plain.p[-1].tobytes()
    assert watched.stats["steps"] == plain.stats["steps"]
    assert watched.stats["output_steps"] == 99


@pytest.mark.parametrize("method", ["rk4", "dormand_prince", "trapezoidal", "rattle"])
def test_order_is_kept_between_steps(bar, method):
    times = np.linspace(0.1, 0.5, 23)
    exact = zd.simulate(bar, 0.5, step=1 / 2000, integrator="dop853")(times)[0]
    errors = [np.abs(zd.simulate(bar, 0.5, step=0.5 / n, integrator=method)(times)[0] - exact).max() for n in (40, 80, 160)]
    declared = zd.integrators()[method].order
    assert np.log2(errors[0] / errors[2]) / 2 > declared - 0.5


def test_a_run_stops_when_all_that_is_asked_for_is_saved(bar):
    sol = zd.simulate(bar, 8.0, step=0.01, t_eval=[0.5])
    assert sol.success
    assert sol.stats["steps"] == 50


def test_one_time_gives_one_state(bar):
    sol = zd.simulate(bar, 0.5, step=0.02)
    p, v = sol(0.25)
    assert p.shape == v.shape == (3,)
    assert (sol(sol.t[3])[0] == sol.p[3]).all()


def test_values_between_rows_of_uncorrected_motions(bar):
    """There rows violate the constraints, and so do the values between them: nothing is corrected that was not to be."""
    sol = zd.simulate(bar, 2.0, step=0.02, stabilization=None)
    p, _ = sol(np.array([1.999]))
    assert 1e-9 < np.abs(bar.evaluate(p[0]).Phi).max() < 1e-2


BAR = SYSTEMS["four_bar"]


def test_values_between_rows_that_are_not_there():
    sol = zd.simulate(BAR, 0.5, step=0.02)
    with pytest.raises(ValueError, match="t must be between 0 and"):
        sol(0.6)
    with pytest.raises(ValueError, match="need every step saved"):
        zd.simulate(BAR, 0.5, step=0.02, save_every=2)(0.1)


SOL = zd.simulate(BAR, 0.1, step=0.01)


def test_values_at_no_times():
    p, v = SOL([])
    assert p.shape == v.shape == (0, 3)
    assert SOL(np.zeros((2, 0)))[0].shape == (2, 0, 3)


LATE = np.append(np.linspace(0, 0.1, 200), 0.2)


@pytest.mark.parametrize(("times", "error", "message"), [
    (LATE, ValueError, r"be between 0 and 0.1, not 0.2\d* \(entry 200\)"), ([0.1j], TypeError, "hold real numbers"),
    (np.ma.masked_array([0.0, 0.1], [False, True]), ValueError, "hold real numbers, none of them masked"),
    ([0.0, np.nan], ValueError, r"be finite, not nan \(entry 1\)"), (["a"], TypeError, "hold real numbers"),
    ([[0.0], [0.0, 0.1]], ValueError, "not be a ragged sequence")])
def test_times_that_are_none(times, error, message):
    for call in (lambda: SOL(times), lambda: zd.simulate(BAR, 0.1, step=0.01, t_eval=times)):
        with pytest.raises(error, match=message) as refused:
            call()
        assert len(str(refused.value)) < 140


def test_times_that_do_not_increase():
    with pytest.raises(ValueError, match=r"t_eval must increase, but 0.05\d* \(entry 2\) comes after 0.06"):
        zd.simulate(BAR, 0.1, step=0.01, t_eval=[0.0, 0.06, 0.05])
    with pytest.raises(ValueError, match="needs at least one time"):
        zd.simulate(BAR, 0.1, step=0.01, t_eval=np.zeros(0))


def chosen(system, rtol, times=None, **options):
    return zd.simulate(system, 2.0, integrator="dop853", rtol=rtol, atol=rtol, t_eval=times, **options)


@pytest.mark.parametrize("options", [{}, {"direct": False}, {"formulation": "augmented"}, {"energy": True},
                                     {"stabilization": "baumgarte"}], ids=str)
def test_the_polynomial_of_a_method_errs_as_its_steps_do(bar, options):
    """By how much the rows between steps are off, beside the rows at their ends: at either, what the tolerance leaves."""
    times = np.linspace(0, 2, 217)
    exact = zd.simulate(bar, 2.0, step=2 / 1600, integrator="dop853")
    for rtol in (1e-4, 1e-7, 1e-10):
        at_ends = chosen(bar, rtol, **options)
        between = chosen(bar, rtol, times, **options)
        assert between.stats["steps"] == at_ends.stats["steps"]
        assert between.v[-1].tobytes() == at_ends.v[-1].tobytes()
        error = max(np.abs(at_ends.p - exact(at_ends.t)[0]).max(), rtol)
        assert np.abs(between.p - exact(times)[0]).max() <= 3 * error


def test_values_of_the_polynomial_satisfy_the_constraints(bar):
    sol = chosen(bar, 1e-5, np.linspace(0, 2, 101), energy=True)
    assert sol.stats["output_steps"] > 90
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert np.abs(sol.energy_violation).max() <= 1e-12 * np.abs(sol.potential_energy).max()


def test_no_more_is_evaluated_than_three_stages_and_what_is_saved(bar):
    steps, times = chosen(bar, 1e-6), np.linspace(0.013, 1.987, 20)
    between = chosen(bar, 1e-6, times)
    assert between.stats["evaluations"] - steps.stats["evaluations"] <= 20 * 11     # shorter steps alone would take more
