"""Runs side by side in vector lanes: those of `simulate` up to rounding, with bits that do not depend on their neighbours."""

import numpy as np
import pytest

import energy_models
import symbolic_counterparts
import zerodrift as zd
from lanes import ALONE, LANES, UNITS, made, plan_of, rows_of
from zerodrift._private import gateway

KINDS = {name: getattr(zd.systems, name) for name in ("four_bar", "oscillator", "pendulum", "knife_edge")} | {
    "slider_crank": lambda: energy_models.slider_crank().starting(v0=[1.0, -0.5, 0.0]), "arm": symbolic_counterparts.arm,
    "sleigh": symbolic_counterparts.chaplygin_sleigh}
TIMES = np.linspace(0.013, 0.4, 6)
COURSES = {"rk4": {"step": 0.01}, "heun": {"step": 0.01, "integrator": "heun", "save_every": 7},
           "within": {"step": 0.013, "t_eval": TIMES}, "dop853": {"integrator": "dop853", "rtol": 1e-9, "t_eval": TIMES},
           "dormand_prince": {"integrator": "dormand_prince", "t_eval": TIMES},
           "uncorrected": {"step": 0.01, "stabilization": None},
           "every third": {"step": 0.007, "stabilization": zd.Projection(every=3), "t_eval": TIMES},
           "every other": {"integrator": "dop853", "rtol": 1e-8, "stabilization": zd.Projection(every=2), "t_eval": TIMES},
           "every seventh": {"step": 0.01, "stabilization": zd.Projection(every=7), "save_every": 3}}
pytestmark = pytest.mark.skipif(not gateway.has_lanes("baseline"), reason="the compiler has no vectors")


def names_of(system):
    return [variable.name for group in (system.coordinates, system.velocities, system.constraints) for variable in group]


def starts_of(system, count=11):
    """Velocities that differ, and that constraints which stand still allow."""
    shares = np.linspace(0.5, 1.5, count) if system.name != "arm" else np.ones(count)
    return shares[:, None] * system.v0


@pytest.mark.pairs(kind=list(KINDS), course=list(COURSES), unit=UNITS)
def test_runs_are_those_of_simulate_up_to_rounding(kind, course, unit):
    system, options = KINDS[kind](), COURSES[course] | {"vector": unit}
    starts, names = starts_of(system), names_of(system)
    part = made(plan_of(system, 0.4, v0=starts, names=names, **options))
    assert (part.paths == LANES).all()
    for run in (0, 7, 10):
        sol = zd.simulate(system, 0.4, v0=starts[run], **options)
        assert np.array_equal(list(part.times())[run], sol.t)
        for name in names:      # rounding grows over a run, and with adaptive steps, whose errors include it
            size = max(1.0, np.abs(sol[name]).max())
            assert np.abs(rows_of(part, name)[run] - sol[name]).max() < 1e-10 * size, name


@pytest.mark.parametrize("kind", KINDS)
def test_a_step_is_that_of_simulate_within_eight_roundings(kind):
    system = KINDS[kind]()
    starts, names = starts_of(system), names_of(system)[:system.nq + system.nv]
    part = made(plan_of(system, 0.01, v0=starts, names=names, step=0.01))
    for run, start in enumerate(starts):
        sol = zd.simulate(system, 0.01, v0=start, step=0.01)
        for name in names:
            size = max(1.0, np.abs(sol[name]).max())     # what cancels is as uncertain as what it is the difference of
            assert np.abs(rows_of(part, name)[run] - sol[name]).max() <= 8 * 2**-53 * size


@pytest.mark.parametrize("course", ["rk4", "within", "dop853"])
def test_bits_do_not_depend_on_neighbours_nor_on_the_range(course):
    """Some of which fail, and some of which lanes cannot make."""
    system = zd.systems.four_bar()
    shares = np.array([1.0, 0.3, 400.0, np.nan, 1.7, 60.0, 1.2, 0.9, 1.1, 30.0, 2.0])
    starts = np.nan_to_num(shares)[:, None] * system.v0 + np.isnan(shares)[:, None]
    plan = plan_of(system, 0.4, v0=starts, names=["alpha1", "alpha2_dot"], **COURSES[course])
    whole = made(plan)
    alone = [made(plan, run, run + 1) for run in range(len(shares))]
    turned = made(plan_of(system, 0.4, v0=starts[::-1], names=["alpha1", "alpha2_dot"], **COURSES[course]))
    for run, single in enumerate(alone):
        for name in plan.names:
            assert np.array_equal(rows_of(whole, name)[run], single.arrays[name])
            assert np.array_equal(rows_of(turned, name)[::-1][run], single.arrays[name])
        assert (whole.failed[run], whole.paths[run]) == (single.failed[0], single.paths[0])
        assert whole.messages[run] == single.messages[0]
    assert whole.failed[3]
    assert whole.messages[3].startswith("InconsistentStart: ")
    assert set(whole.paths) == {LANES, ALONE}


@pytest.mark.skipif(len(UNITS) < 3, reason="the processor has one vector unit at most")
@pytest.mark.parametrize("course", ["rk4", "dop853"])
def test_vector_units_give_the_same_bits(course):
    system = zd.systems.four_bar()
    parts = [made(plan_of(system, 2.0, v0=starts_of(system), names=["alpha3"], **{**COURSES[course], "vector": unit}))
             for unit in UNITS[1:]]
    assert np.array_equal(parts[0].arrays["alpha3"], parts[1].arrays["alpha3"])


@pytest.mark.parametrize(("every", "corrected"), [(1, 41), (3, 14), (7, 6), (40, 2), (41, 1), (50, 1)])
def test_corrections_are_counted_and_made_at_the_last_step(every, corrected):
    """Runs of 41 steps, in lanes at different steps: a lane takes the next run when its own has ended."""
    system, stabilization = zd.systems.four_bar(), zd.Projection(every=every)
    ens = zd.ensemble(system, 0.41, v0=starts_of(system), step=0.01, stabilization=stabilization, outputs=["alpha1"])
    assert "11 in vector lanes" in repr(ens)
    for run in (0, 10):
        again = ens[run]
        alone = zd.simulate(system, 0.41, v0=starts_of(system)[run], step=0.01, stabilization=stabilization)
        assert again.stats["velocity_corrections"] == alone.stats["velocity_corrections"] == corrected
        assert np.array_equal(again["alpha1"], ens["alpha1"][run])
        assert np.abs(again.position_violation[-1]).max() <= 1e-12 * again.position_size.max()


def test_a_run_that_changes_its_order_of_elimination_stays_in_its_lane():
    """A pendulum that goes round: x and y take turns."""
    system = zd.systems.pendulum()
    starts = np.linspace(0.1, 8.0, 9)[:, None] * [0.0, 1.0]
    part = made(plan_of(system, 4.0, v0=starts, names=["x", "y"], step=0.01))
    assert (part.paths == LANES).all()
    for run in (0, 8):
        sol = zd.simulate(system, 4.0, v0=starts[run], step=0.01)
        assert np.abs(rows_of(part, "x")[run] - sol["x"]).max() < 1e-9


def test_what_lanes_cannot_make_is_what_simulate_makes():
    """Steps that are too long to be accepted: the run is made individually from its start."""
    system = zd.systems.four_bar()
    starts = np.array([1.0, 40.0])[:, None] * system.v0
    part = made(plan_of(system, 0.5, v0=starts, names=["alpha1"], step=0.02))
    with pytest.warns(zd.AccuracyWarning):
        sol = zd.simulate(system, 0.5, v0=starts[1], step=0.02)
    assert part.paths.tolist() == [LANES, ALONE]
    assert np.array_equal(rows_of(part, "alpha1")[1], sol["alpha1"])


def test_runs_that_take_too_many_steps_fail_as_ever():
    system = zd.systems.four_bar()
    part = made(plan_of(system, 8.0, v0=starts_of(system, 3), integrator="dop853", t_eval=[8.0], max_steps=20))
    assert part.failed.all()
    assert all("max_steps" in message for message in part.messages)


@pytest.mark.parametrize("options", [{"stabilization": "baumgarte"}, {"closed_form": False},
                                     {"stabilization": zd.Projection(metric="identity")}, {"integrator": "trapezoidal"}],
                         ids=["baumgarte", "closed_form", "metric", "implicit"])
def test_what_takes_the_matrix_path(options):
    system = zd.systems.four_bar()
    part = made(plan_of(system, 0.1, v0=starts_of(system, 3), names=["alpha1"], step=0.01, **options))
    assert (part.paths == ALONE).all()
    assert np.array_equal(rows_of(part, "alpha1")[1], zd.simulate(system, 0.1, step=0.01, **options)["alpha1"])


def test_parameters_vary_from_lane_to_lane():
    system, damping = energy_models.slider_crank(), np.linspace(1.0, 20.0, 5)
    ens = zd.ensemble(system, 0.4, parameters={"damping": damping}, step=0.01, outputs=["phi"])
    assert "5 in vector lanes" in repr(ens)
    for run in (0, 4):
        own = system.with_parameters(damping=damping[run])
        assert np.abs(ens["phi"][run] - zd.simulate(own, 0.4, step=0.01)["phi"]).max() < 1e-11
    kept, sol = ens[3], zd.simulate(system.with_parameters(damping=damping[3]), 0.4, step=0.01)
    assert np.array_equal(kept["phi"], ens["phi"][3])
    assert (kept.message, kept.stats["steps"], kept.stats["closed_form_steps"]) == ("done", 40, 40)
    assert np.array_equal(kept.iterations, sol.iterations)
    for name in ("v", "multipliers", "kinetic_energy", "potential_energy", "energy_input", "energy_violation",
                 "position_violation"):
        assert np.abs(getattr(kept, name) - getattr(sol, name)).max() < 1e-9, name
    assert np.array_equal(kept.position_size, sol.position_size)


def test_symbolic_systems_have_lanes_of_their_own():
    """Two rods of a compound pendulum whose masses vary, one of them springy."""
    import sympy as sp
    from sympy.physics.mechanics import dynamicsymbols

    x, y, s = dynamicsymbols("x y s")
    L, m, g, c = sp.symbols("L m g c", positive=True)
    t = dynamicsymbols._t
    system = zd.symbolic([x, y, s], kinetic=m * (x.diff(t)**2 + y.diff(t)**2 + s.diff(t)**2) / 2, name="springy",
                         potential=m * g * y + c * s**2 / 2 + c * x * s**2, constraints={"rod": x**2 + y**2 - L**2},
                         parameters={L: 1.0, m: 1.0, g: 9.81, c: 2.0}, p0=[0.6, -0.8, 0.1], v0=[0.0, 0.0, 0.0])
    masses, lengths = np.linspace(0.5, 2.0, 9), np.linspace(0.9, 1.1, 9)
    ens = zd.ensemble(system, 0.5, parameters={"m": masses, "L": lengths}, step=0.01, outputs=["x", "s"])
    assert "9 in vector lanes" in repr(ens)
    for run in (0, 8):
        own = system.with_parameters(m=masses[run], L=lengths[run])
        sol = zd.simulate(own, 0.5, *zd.assemble(own, own.p0, own.v0), step=0.01)
        for name in ("x", "s"):
            assert np.abs(ens[name][run] - sol[name]).max() < 1e-12
    assert np.array_equal(ens["s"][4], ens[4]["s"])
