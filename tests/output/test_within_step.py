"""Values between steps: at times asked for before the run, and afterwards between its rows."""

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from large_mechanisms import four_bars
from support import SYSTEMS, refused

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


def test_a_run_stops_when_all_that_is_requested_is_saved(bar):
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
    with refused("out-of-range", "^t must.*between 0"):
        sol(0.6)
    with refused("not-available"):
        zd.simulate(BAR, 0.5, step=0.02, save_every=2)(0.1)


SOL = zd.simulate(BAR, 0.1, step=0.01)


def test_values_at_no_times():
    p, v = SOL([])
    assert p.shape == v.shape == (0, 3)
    assert SOL(np.zeros((2, 0)))[0].shape == (2, 0, 3)


LATE = np.append(np.linspace(0, 0.1, 200), 0.2)


@pytest.mark.parametrize(("times", "code", "message"), [
    (LATE, "out-of-range", r"be between 0 and 0.1, not 0.2\d* \(entry 200\)"), ([0.1j], "wrong-type", "hold real numbers"),
    (np.ma.masked_array([0.0, 0.1], [False, True]), "not-finite", None),
    ([0.0, np.nan], "not-finite", "entry 1"), (["a"], "wrong-type", "hold real numbers"),
    ([[0.0], [0.0, 0.1]], "shape", None)])
def test_times_that_are_none(times, code, message):
    for call in (lambda: SOL(times), lambda: zd.simulate(BAR, 0.1, step=0.01, t_eval=times)):
        with refused(code, message) as caught:
            call()
        assert len(str(caught.value)) < 140


def test_times_that_do_not_increase():
    with refused("not-increasing", r"t_eval must increase, but 0.05\d* \(entry 2\) comes after 0.06"):
        zd.simulate(BAR, 0.1, step=0.01, t_eval=[0.0, 0.06, 0.05])
    with refused("not-increasing"):
        zd.simulate(BAR, 0.1, step=0.01, t_eval=np.zeros(0))


def chosen(system, rtol, times=None, **options):
    return zd.simulate(system, 2.0, **{"integrator": "dop853", "rtol": rtol, "atol": rtol, "t_eval": times, **options})


@pytest.mark.parametrize("options", [{}, {"closed_form": False}, {"formulation": "augmented"}, {"energy": True},
                                     {"stabilization": "baumgarte"}, {"integrator": "dormand_prince"},
                                     {"formulation": "mixed"}, {"formulation": "independent", "energy": True},
                                     {"formulation": "independent", "closed_form": False},
                                     {"formulation": "mixed", "closed_form": False},
                                     {"integrator": "dormand_prince", "closed_form": False, "energy": True}], ids=str)
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


INTERPOLATED = ["dormand_prince", "dop853"]
WITHIN = np.array([0.011, 0.012, 0.1, 0.10001, 0.237, 0.4, 0.4321, 0.5])


@pytest.mark.pairs(method=INTERPOLATED)
@pytest.mark.filterwarnings("ignore::zerodrift.CorrectionWarning")       # near rest energies are left alone
def test_the_same_bits_between_rows_as_while_the_run_goes_on(system, formulation, method):
    """The step is made again from a row, with what the run has measured at its start, and its polynomial taken at once."""
    options = {"integrator": method, "rtol": 1e-5, "atol": 1e-6, "formulation": formulation, "energy": system.has_energy or None}
    at = zd.simulate(system, 0.5, t_eval=WITHIN, **options)
    p, v = zd.simulate(system, 0.5, **options)(WITHIN[::-1])
    if formulation in ("mixed", "independent"):     # in velocities that are chosen at the row, and the run may have others
        assert np.abs(p[::-1] - at.p).max() <= 1e-6
        assert np.abs(v[::-1] - at.v).max() <= 1e-6 * (1 + np.abs(v).max())
    else:
        assert (p[::-1] == at.p).all()
        assert (v[::-1] == at.v).all()
    assert np.abs(at.position_violation).max(initial=0) <= 1e-12
    assert np.abs(at.velocity_violation).max(initial=0) <= 1e-12 * (1 + np.abs(at.v).max())
    assert_on_constraints(system, WITHIN[::-1], p, v)


def assert_on_constraints(system, times, p, v):
    """As the terms of the system say, not what the run has recorded."""
    for t, p_there, v_there in zip(times, p, v, strict=True):
        e = system.evaluate(p_there, v_there, t)
        assert e.Phi is None or np.abs(e.Phi).max() <= 1e-12
        if system.m:
            assert np.abs(e.C @ v_there + (0 if e.Phi_t is None else e.Phi_t)).max() <= 1e-12 * (1 + np.abs(v).max())


@pytest.mark.parametrize("method", INTERPOLATED)
def test_the_same_bits_where_an_event_has_ended_the_run(bar, method):
    """Its last step ends at the event, and is not a part of a longer one that was interpolated."""
    options = {"integrator": method, "rtol": 1e-6, "atol": 1e-6,
               "events": [zd.Event(lambda t, p, v: p[0] - 1.0, terminal=True), lambda t, p, v: p[0] - 0.8]}
    sol = zd.simulate(bar, 8.0, **options)
    times = np.linspace(0, sol.t[-1], 83)
    at = zd.simulate(bar, 8.0, t_eval=times[:-1], **options)
    p, v = sol(times)
    assert (p[:-1] == at.p[:82]).all()
    assert (v[:-1] == at.v[:82]).all()
    step = zd.simulate(bar, (sol.t[-2], sol.t[-1]), sol.p[-2], sol.v[-2], integrator=method, step=sol.t[-1] - sol.t[-2])
    assert np.abs(step.p[-1] - sol.p[-1]).max() <= 1e-14


@pytest.mark.parametrize("method", INTERPOLATED)
def test_a_value_does_not_depend_on_what_else_is_requested(bar, method):
    """One time of a step, or many."""
    options = {"integrator": method, "rtol": 1e-5, "atol": 1e-6}
    every = zd.simulate(bar, 2.0, t_eval=np.linspace(0, 2, 481), **options)
    for stride in (3, 11, 160):
        some = zd.simulate(bar, 2.0, t_eval=every.t[5::stride], **options)
        assert (some.p == every.p[5::stride]).all()
        assert (some.v == every.v[5::stride]).all()
        assert (some.multipliers == every.multipliers[5::stride]).all()


def ball():
    """Two bodies on balls, in unit quaternions: increments about where a step begins are what `independent` integrates."""
    m = zd.Mechanism("balls", dimension=3, gravity=(0, 0, -9.81))
    arm, tool = m.body("arm", 1.0, (1, 2, 2), at=(0.5, 0, 0)), m.body("tool", 2.0, (1, 1.5, 2), at=(1.4, 0.3, 0.1))
    m.spherical("shoulder", m.ground, arm, at=(0, 0, 0))
    m.spherical("wrist", arm, tool, at=(1, 0, 0))
    m.start({"arm.angular_velocity": (1.0, 0.5, -0.3), "tool.angular_velocity": (3.0, 0.5, 1)})
    return m.system("absolute")


CHOSEN_ANEW = {"turning pendulum": (zd.systems.pendulum, (0.0, 8.0), 2.0), "unit quaternions": (ball, None, 2.0),
               "many rows": (lambda: four_bars(15).system(), None, 0.6)}


@pytest.mark.parametrize("method", [*INTERPOLATED, "radau"])
@pytest.mark.parametrize("name", CHOSEN_ANEW)
@pytest.mark.parametrize("variables", ["mixed", "independent"])
def test_the_polynomial_where_variables_are_chosen_anew_at_the_end_of_its_step(name, variables, method):
    """Values within the step use the variables of that step, and the run continues in the new ones, undisturbed by samples."""
    make, v0, end = CHOSEN_ANEW[name]
    system, times = make(), np.linspace(0, end, 241)
    options = {"integrator": method, "formulation": variables, "closed_form": False}
    exact = zd.simulate(system, end, None, v0, integrator="dop853", rtol=1e-11, atol=1e-11, t_eval=times)
    for rtol in (1e-4, 1e-7):
        steps = zd.simulate(system, end, None, v0, rtol=rtol, atol=rtol, **options)
        rows = zd.simulate(system, end, None, v0, rtol=rtol, atol=rtol, t_eval=times, **options)
        error = np.abs(steps.p[-1] - exact.p[-1]).max()
        assert np.abs(rows.p - exact.p).max() <= 30 * max(error, rtol)      # of Radau's stages, which have a lower order
        assert np.abs(rows.velocity_violation).max(initial=0) <= 1e-12 * (1 + np.abs(rows.v).max())
        assert np.abs(rows.position_violation).max(initial=0) <= 1e-10
        assert rows.p[-1].tobytes() == steps.p[-1].tobytes()
        assert rows.v[-1].tobytes() == steps.v[-1].tobytes()
        assert rows.stats["repartitions"] == steps.stats["repartitions"]
        assert rows.stats["evaluations"] - steps.stats["evaluations"] < 8 * len(times)      # a step takes more
        assert name != "turning pendulum" or steps.stats["repartitions"] > 5


def with_steps(system, method, n, times=None, **options):
    """Solution with n adaptive steps of one size, which the tolerances do not limit."""
    of_one_size = {"rtol": 0.9, "atol": 1e3, "first_step": 0.5 / n, "max_step": 0.5 / n}
    return zd.simulate(system, 0.5, integrator=method, t_eval=times, **of_one_size, **options)


@pytest.mark.pairs(case=[("dormand_prince", (10, 40), 4.5), ("dop853", (8, 16), 6.5)])
@pytest.mark.filterwarnings("ignore::zerodrift.AccuracyWarning")
def test_the_order_of_polynomials(system, formulation, case):
    """Their error within a step is one power of h above their order, which is that of the method less one."""
    method, steps, slope = case
    times = np.linspace(0.013, 0.487, 11)
    exact = zd.simulate(system, 0.5, step=0.5 / 400, integrator="dop853", t_eval=times)
    errors = [np.abs(with_steps(system, method, n, times, formulation=formulation).p - exact.p).max() for n in steps]
    if errors[1] > 1e-12:       # else it is rounding
        assert np.log2(errors[0] / errors[1]) / np.log2(steps[1] / steps[0]) > slope


@pytest.mark.parametrize("closed_form", [False, None])
@pytest.mark.parametrize("method", INTERPOLATED)
def test_values_between_rows_where_a_run_had_chosen_other_variables(method, closed_form):
    """A particle on a sphere: the long steps of `dop853` err by 4e-3 m in the variables that are best where they begin."""
    x, y, z = dynamicsymbols("x y z")
    system = zd.symbolic([x, y, z], mass=sp.eye(3), potential=9.81 * z, constraints=[x**2 + y**2 + z**2 - 1], p0=[1, 0, 0],
                         v0=[0, 1.2, 0], progress=False)
    options = {"formulation": "independent", "integrator": method, "rtol": 1e-5, "atol": 1e-7, "closed_form": closed_form}
    times = np.linspace(0.01, 7.99, 400)
    at, run = zd.simulate(system, 8.0, t_eval=times, **options), zd.simulate(system, 8.0, **options)
    assert run.stats["repartitions"] > 10
    assert np.abs(run(times)[0] - at.p).max() < 1e-5
