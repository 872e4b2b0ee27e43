"""Time is never accumulated, and a run of fixed steps ends exactly at the requested time."""

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from support import assert_close


@pytest.mark.parametrize("t_span", [1.0, 1, (0, 1), [0.0, 1.0], np.array([0, 1]), np.float32(1)], ids=repr)
def test_forms_of_t_span(t_span):
    sol = zd.simulate(zd.systems.oscillator(), t_span, step=0.25)
    assert sol.t_span == (0.0, 1.0)
    assert sol.t.tolist() == [0, 0.25, 0.5, 0.75, 1]


def test_time_is_not_accumulated(bar):
    sol = zd.simulate(bar, (3.0, 4.0), step=0.01)
    assert sol.t.tolist() == [3.0 + k * 0.01 for k in range(100)] + [4.0]


def test_a_shorter_last_step(system, integrator):
    """It ends where asked, and is the step that a run from there would take."""
    sol = zd.simulate(system, 0.1, step=0.03, integrator=integrator)
    assert sol.t.tolist() == [0, 0.03, 0.06, 3 * 0.03, 0.1]
    last = zd.simulate(system, (sol.t[3], 0.1), sol.p[3], sol.v[3], step=0.03, integrator=integrator)
    assert last.t.tolist() == [sol.t[3], 0.1]
    assert_close(last.p[-1], sol.p[-1], tol.STEPPED)
    assert_close(last.v[-1], sol.v[-1], tol.STEPPED)


def test_the_last_step_of_a_whole_number_of_steps_has_their_size(system, integrator):
    """0.1 - 4 * 0.02 is 0.020000000000000004, by the rounding of times: a longer run has the same bits there."""
    assert 0.1 - 4 * 0.02 != 0.02
    whole, longer = (zd.simulate(system, end, step=0.02, integrator=integrator) for end in (0.1, 0.12))
    assert whole.t[-1] == longer.t[5]
    assert np.array_equal(whole.p[-1], longer.p[5])
    assert np.array_equal(whole.v[-1], longer.v[5])


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.parametrize(("end", "step", "steps"), [(1.0, 0.1, 10), (0.3, 0.1, 3), (8.0, 0.05, 160), (1.0, 1 / 3, 3),
                                                    (1.0, 2.0, 1), (1.0, 0.0999999, 11), (1.0, 0.15, 7)])
def test_a_whole_number_of_steps_is_recognized(end, step, steps):
    sol = zd.simulate(zd.systems.oscillator(), end, step=step)
    assert sol.stats["steps"] == steps == len(sol.t) - 1
    assert sol.t[-1] == end


@pytest.mark.parametrize("step", [1.0, 1e30])
def test_the_smallest_part_of_a_step(bar, step):
    """Also where it is so small that as a double it is zero."""
    sol = zd.simulate(bar, 1e-300, step=step)
    assert list(sol.t) == [0.0, 1e-300]
