"""Rows and events between steps leave a run as it is: the same steps to the same end, to the last bit."""

import numpy as np
import pytest

import zerodrift as zd
from large_mechanisms import four_bars
from support import SYSTEMS


def middle(sol):
    """An event halfway between where the first coordinate begins and ends."""
    half = 0.5 * (sol.p[0, 0] + sol.p[-1, 0])
    return lambda t, p, v: p[0] - half


def assert_same_run(one, other):
    assert other.p[-1].tobytes() == one.p[-1].tobytes()
    assert other.v[-1].tobytes() == one.v[-1].tobytes()
    for count in ("steps", "rejected", "subdivided", "rank_drops", "closed_form_steps"):
        assert other.stats[count] == one.stats[count], count


def assert_undisturbed(system, end, count, **options):
    between = np.append(np.linspace(0.001, end - 0.001, count), end)
    plain = zd.simulate(system, end, **options)
    rows = zd.simulate(system, end, t_eval=between, **options)
    assert rows.stats["output_steps"] > 0.9 * count - 2   # else nothing lay between steps
    assert_same_run(plain, rows)
    event = zd.simulate(system, end, events=middle(plain), **options)
    assert_same_run(plain, event)
    assert_same_run(plain, zd.simulate(system, end, events=middle(plain), t_eval=between, **options))


def steps_of(integrator):
    chosen = {"rtol": 1e-4, "atol": 1e-5}
    return [{"step": 0.03}, chosen] if zd.integrators()[integrator].error_order else [{"step": 0.03}]


def test_every_method_in_every_formulation(system, integrator, formulation):
    """Methods remember Jacobians and where iterations have led, formulations which variables they have chosen."""
    for steps in steps_of(integrator):
        assert_undisturbed(system, 0.5, 17, integrator=integrator, formulation=formulation, **steps)


@pytest.mark.pairs(name=["four_bar", "pendulum"], options={
    "general": {"closed_form": False}, "energy": {"energy": True}, "baumgarte": {"stabilization": "baumgarte"},
    "none": {"stabilization": None}, "every 3": {"stabilization": zd.Projection(every=3)}})
@pytest.mark.each_value
@pytest.mark.filterwarnings("ignore::zerodrift.CorrectionWarning", "ignore::zerodrift.AccuracyWarning")
def test_whatever_else_is_done(name, options, formulation):
    """Over several turns, in which independent variables are chosen anew."""
    for integrator in ("dormand_prince", "radau", "trapezoidal"):
        for steps in steps_of(integrator):
            assert_undisturbed(SYSTEMS[name], 2.0, 31, integrator=integrator, formulation=formulation, **options, **steps)


def test_past_a_bifurcation(formulation):
    """Near one, formulations in independent velocities have (p, v) in their place."""
    system = zd.systems.four_bar(lengths=(1, 0.3, 1, 0.3), gravity=0, crank_rate=2 * np.pi)
    for options in ({"step": 1 / 53}, {"integrator": "dormand_prince", "rtol": 1e-7, "atol": 1e-9}):
        assert_undisturbed(system, 0.6, 61, formulation=formulation, on_singular="continue", **options)


def test_many_rows(formulation):
    """Structures of many constraints are factored by blocks, as are independent variables, which are chosen anew four times."""
    assert_undisturbed(four_bars(15).system(), 1.0, 23, formulation=formulation, step=0.02)
    assert_undisturbed(four_bars(15).system(), 1.0, 23, formulation=formulation, integrator="dop853", rtol=1e-6, atol=1e-6)
