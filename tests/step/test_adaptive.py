"""Steps chosen by their error: what that reaches, how many they may be, and which settings are refused."""

import math
import re

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import energy_models
import zerodrift as zd
from support import INTEGRATORS, SYSTEMS, refused
from symbolic_counterparts import rolling_disc

ADAPTIVE = [name for name in INTEGRATORS if zd.integrators()[name].error_order]
WITHIN = 3000       # global error of tolerance: half a second of the liveliest system multiplies what steps leave by this


def adaptive(system, t_end=0.5, tol=1e-8, **options):
    return zd.simulate(system, t_end, **({"rtol": tol, "atol": tol, "integrator": "dormand_prince"} | options))


@pytest.fixture(scope="module")
def references():
    return {name: zd.simulate(system, 0.5, step=1 / 1600, integrator="dop853") for name, system in SYSTEMS.items()}


@pytest.mark.parametrize("method", ADAPTIVE)
def test_error_follows_the_tolerance(system, references, method):
    reference = next(sol for sol in references.values() if sol.system is system)
    for tol in (1e-6, 1e-9):
        sol = adaptive(system, tol=tol, integrator=method)
        error = np.abs(np.hstack([sol.p[-1] - reference.p[-1], sol.v[-1] - reference.v[-1]])).max()
        assert error <= WITHIN * tol
        assert sol.t[-1] == 0.5
        assert (np.diff(sol.t) > 0).all()


def test_formulations_choose_steps_alike(system, formulation):
    a, b = (adaptive(system, tol=1e-9, formulation=name, integrator="dop853") for name in (formulation, "schur"))
    assert np.abs(a.p[-1] - b.p[-1]).max() <= WITHIN * 1e-9
    if system.m:
        assert np.abs(a.position_violation).max(initial=0) <= 1e-12
        assert np.abs(a.velocity_violation).max() <= 1e-12 * (1 + np.abs(a.v).max())


def test_a_tighter_tolerance_costs_more_and_pays(bar):
    loose, tight = adaptive(bar, 2.0, 1e-5), adaptive(bar, 2.0, 1e-10)
    exact = zd.simulate(bar, 2.0, step=1e-3, integrator="dop853").p[-1]
    assert tight.stats["steps"] > 3 * loose.stats["steps"]
    assert np.abs(tight.p[-1] - exact).max() < 1e-3 * np.abs(loose.p[-1] - exact).max()


def test_rejected_steps_are_counted_and_leave_no_trace(bar):
    sol = adaptive(bar, 2.0, first_step=0.5)
    assert sol.stats["rejected"] > 0
    assert len(sol.t) == sol.stats["steps"] + 1
    assert sol.t[1] < 0.5
    assert np.abs(sol.position_violation).max() <= 1e-12


def test_a_step_whose_correction_fails_is_tried_smaller(bar):
    """Without a bound by the error, the first step is far too large to be corrected."""
    with pytest.raises(zd.ZerodriftError):
        zd.simulate(bar, 2.0, step=1.0, integrator="dormand_prince")
    sol = adaptive(bar, 2.0, rtol=0.9, atol=1e3, first_step=1.0, stabilization=zd.Projection(max_iterations=3))
    assert sol.stats["rejected"] > 0
    assert np.abs(sol.position_violation).max() <= 1e-12


def test_first_and_largest_step_are_kept(bar):
    sol = adaptive(bar, 1.0, 1e-3, first_step=1e-3, max_step=0.01)
    assert sol.t[1] == 1e-3
    assert np.diff(sol.t).max() <= 0.01 * (1 + 1e-12)


def test_records_grow_as_long_as_they_have_to(bar, monkeypatch):
    whole = adaptive(bar, 2.0)
    monkeypatch.setattr("zerodrift.runs.samples.recording.FIRST_BLOCK", 3)
    pieces = adaptive(bar, 2.0)
    assert pieces.p.tobytes() == whole.p.tobytes()
    assert pieces.iterations.tobytes() == whole.iterations.tobytes()


def test_slices_change_no_bit(bar, monkeypatch):
    whole = adaptive(bar, 2.0)
    monkeypatch.setattr("zerodrift.runs.simulate.SLICE", 0.0)
    assert adaptive(bar, 2.0).p.tobytes() == whole.p.tobytes()


def test_integrals_along_the_state_are_controlled_too():
    sol = zd.simulate(energy_models.slider_crank(), 5.0, rtol=1e-9, atol=1e-9, integrator="dop853")
    assert np.abs(sol.energy_violation).max() < 1e-8


def test_a_motion_that_ends_is_followed_to_its_end():
    """X'' = 2 x^3 from x = x' = 1 is 1 / (1 - t)."""
    system = zd.System(1, mass=[[1.0]], force=lambda p: 2 * p**3, p0=[1.0], v0=[1.0])
    with pytest.raises(zd.ZerodriftError) as caught, np.errstate(all="ignore"):
        adaptive(system, 2.0)
    sol = caught.value.solution
    assert 0.99 < sol.t[-1] < 1.0 + 1e-6
    early = sol.t < 0.5
    assert np.abs(sol.p[early, 0] - 1 / (1 - sol.t[early])).max() < 1e-6


def test_adaptive_steps_survive_saving_and_serve_again(bar, tmp_path):
    sol = adaptive(bar, 0.5, t_eval=[0.1, 0.2])
    again = zd.load(sol.save(tmp_path / "motion"))
    assert again.settings["t_eval"].tolist() == [0.1, 0.2]
    assert zd.simulate(bar, 0.5, **again.settings).p.tobytes() == sol.p.tobytes()
    assert "rtol 1e-08" in repr(sol)


# ---- bad arguments ----


BAR = SYSTEMS["four_bar"]


@pytest.mark.parametrize(("options", "code", "message"), [
    ({"integrator": "rk4"}, "step-size", "^step must.*'rk4'.*'dormand_prince'"),
    ({"integrator": "rk4", "rtol": 1e-6}, "step-size", "'rk4'"),
    ({"step": 0.1, "rtol": 1e-6}, "conflicting-arguments", None),
    ({"step": 0.1, "max_step": 1.0}, "conflicting-arguments", "max_step"),
    ({"rtol": 1e-15}, "tolerance", "^rtol must.*least 2.2"),
    ({"rtol": -1.0}, "tolerance", "^rtol must"),
    ({"rtol": np.nan}, "tolerance", "^rtol must"),
    ({"rtol": 1.1}, "tolerance", "^rtol must be at most 1"),
    ({"rtol": 1e300}, "tolerance", "^rtol must be at most 1"),
    ({"atol": 0.0}, "tolerance", "^atol must.*than 0"),
    ({"max_step": 0.0}, "step-size", "max_step"),
    ({"first_step": -1.0}, "step-size", "first_step"),
    ({"max_move": 0.0}, "step-size", "max_move.*than 0"),
    ({"t_eval": []}, "not-increasing", "t_eval"),
    ({"t_eval": [0.2, 0.1]}, "not-increasing", "t_eval"),
    ({"t_eval": [0.1, 0.1]}, "not-increasing", "t_eval"),
    ({"t_eval": [0.5, 1.5]}, "out-of-range", "between 0.*and 1"),
    ({"t_eval": [-0.5]}, "out-of-range", "between 0.*and 1"),
    ({"t_eval": [[0.5]]}, "shape", "t_eval"),
    ({"t_eval": [np.nan]}, "not-finite", "t_eval"),
    ({"t_eval": [0.5], "save_every": 2}, "conflicting-arguments", "save_every.*be 1.*t_eval"),
])
def test_bad_values(options, code, message):
    with refused(code, message):
        zd.simulate(BAR, 1.0, **({"integrator": "dop853"} | options))


def test_what_is_as_in_scipy_and_what_is_not(bar):
    """`max_step=inf` does not bound steps, as in SciPy; time goes forward, `atol` is one number, a start is not an event."""
    assert adaptive(bar, 0.5, max_step=np.inf).p.tobytes() == adaptive(bar, 0.5).p.tobytes()
    with refused("not-increasing", "t_span.*0.*after 1"):
        zd.simulate(bar, (1.0, 0.0), **CHOSEN)
    with refused("wrong-type", "^atol must"):
        zd.simulate(bar, 1.0, atol=np.array([1e-9, 1e-6]), **CHOSEN)
    spring = zd.systems.oscillator(mass=1.0, stiffness=1.0, x0=0.0, v0=1.0)
    sol = zd.simulate(spring, 7.0, integrator="dop853", rtol=1e-10, atol=1e-10, events=lambda t, p, v: p[0])
    np.testing.assert_allclose(sol.t_events[0], [np.pi, 2 * np.pi], atol=1e-8)      # and not at t = 0


# ---- how many ----


CHOSEN = {"rtol": 1e-6, "integrator": "dop853"}


def spike():
    """A spring that is hard for a short time: there the steps lie."""
    return zd.System(["x"], mass=[[1.0]], p0=[1.0],
                     force=lambda t, p: np.array([-1e10 * np.exp(-((t - 0.6) / 0.01) ** 2) * p[0]]))


@pytest.mark.parametrize("most", [300, 1000, 3001])
def test_too_many_steps_end_a_run_and_it_says_where_they_lie(most):
    options = {"rtol": 1e-12, "atol": 1e-14, "integrator": "dormand_prince", "max_step": 0.003}
    with refused("too-many-steps", f"max_steps = {most} steps .* half of the steps lie between t = ") as failed:
        zd.simulate(spike(), 1.0, max_steps=most, **options)
    partial = failed.value.solution
    assert partial.stats["steps"] == len(partial.t) - 1 == most
    low, high = map(float, re.search(r"between t = (\S+) and ([^:]+):", str(failed.value)).groups())
    half = most // 2
    spans = partial.t[half:] - partial.t[:-half]
    shortest = spans.argmin()
    assert high - low < 1.1 * spans.min()       # of every step; the core keeps the times of 256
    assert abs(low - partial.t[shortest]) < 0.1 * spans.min()
    returned = zd.simulate(spike(), 1.0, max_steps=most, on_failure="return", **options)
    assert not returned.success
    assert str(failed.value) == f"{returned.message} [zd:too-many-steps]"
    assert returned.p.tobytes() == partial.p.tobytes()
    assert returned.settings["max_steps"] == most


def test_the_bound_is_exact_and_changes_nothing_else(bar):
    free = zd.simulate(bar, 2.0, **CHOSEN, max_steps=None)
    steps = free.stats["steps"]
    assert free.settings["max_steps"] is None
    assert zd.simulate(bar, 2.0, **CHOSEN, max_steps=steps).p.tobytes() == free.p.tobytes()
    with pytest.raises(zd.StepFailed):
        zd.simulate(bar, 2.0, **CHOSEN, max_steps=steps - 1)
    default = zd.simulate(bar, 2.0, **CHOSEN)
    assert default.settings["max_steps"] == 1_000_000
    assert zd.simulate(bar, 2.0, **default.settings).p.tobytes() == free.p.tobytes()


def test_steps_of_fixed_size_have_no_bound(bar):
    sol = zd.simulate(bar, 1.0, step=0.01, max_steps=5)
    assert sol.success
    assert "max_steps" not in sol.settings


@pytest.mark.parametrize(("value", "error"), [(0, ValueError), (-1, ValueError), (2.5, TypeError), (True, TypeError)])
def test_bounds_that_are_none(bar, value, error):
    with pytest.raises(error, match="max_steps must be"):
        zd.simulate(bar, 1.0, **CHOSEN, max_steps=value)


@pytest.mark.parametrize("size", [1e160, 1e200, 1e300])
def test_steps_that_cannot_be_small_enough_end_the_run(size):
    """Accelerations whose square is not a double asked for a first step of zero, and then another."""
    system = zd.System(1, mass=[[1.0]], force=[size], p0=[0.0], v0=[1.0])
    with pytest.raises((zd.StepFailed, zd.Diverged)):
        zd.simulate(system, 1.0, rtol=1e-6, integrator="dop853", p0=[1.0])


@pytest.mark.parametrize("equations", ["augmented", "mixed", "independent"])
@pytest.mark.parametrize("method", ["dop853", "dormand_prince", "radau"])
def test_no_step_moves_a_coordinate_further_than_it_may(method, equations):
    bar = zd.systems.four_bar()
    options = {"rtol": 1e-6, "atol": 1e-6, "integrator": method, "formulation": equations}
    free, held = (zd.simulate(bar, 2.0, **options, **more) for more in ({}, {"max_move": 0.02}))
    moves = np.abs(np.diff(held.p, axis=0))
    integrated = moves.max(axis=1) if equations != "independent" else moves.min(axis=1)
    assert integrated.max() <= 0.02 + 1e-6      # corrections move it by the error of a step besides
    assert np.abs(np.diff(free.p, axis=0)).max() > 0.05
    assert moves.max(axis=1).mean() > 0.01      # steps are not needlessly short
    assert held.stats["rejected"] < held.stats["steps"]


@pytest.mark.parametrize(("max_move", "code"), [(1e-300, "step-underflow"), (1e-14, "too-many-steps"), (1e-4, "too-many-steps")])
def test_steps_that_moves_make_short_name_the_bound_of_moves(max_move, code):
    with refused(code, f"max_move = {max_move:g}"):
        zd.simulate(BAR, 1.0, max_move=max_move, max_steps=300)
    with refused("too-many-steps", "the motion changes quickly"):
        zd.simulate(BAR, 1.0, rtol=1e-10, max_move=10.0, max_steps=10)


def test_a_thin_wall_is_leapt_over_until_moves_are_bounded():
    """A push by 1 J where the body passes 5 m, 2 mm wide: from 1 m/s to sqrt(3) m/s."""
    x, u = sp.symbols("x u")
    push = 1 / (1e-3 * np.sqrt(np.pi)) * sp.exp(-((x - 5) / 1e-3)**2)
    system = zd.symbolic([x], speeds=[u], kinetic=u**2 / 2, force=[push], p0=[0.0], v0=[1.0])
    options = {"rtol": 1e-9, "atol": 1e-9, "integrator": "dop853"}
    leapt, met = (zd.simulate(system, 8.0, **options, **more).v[-1, 0] for more in ({}, {"max_move": 1e-3}))
    assert leapt == 1.0
    assert abs(met - np.sqrt(3)) < 1e-7


def test_ensembles_bound_moves_too():
    bar = zd.systems.four_bar()
    options = {"rtol": 1e-6, "atol": 1e-6, "integrator": "dop853", "max_move": 0.05}
    ens = zd.ensemble(bar, 1.0, parameters={"gravity": np.array([9.81, 9.0])}, **options)
    sol = zd.simulate(bar.with_parameters(gravity=9.0), 1.0, **options)
    assert np.abs(ens[1].p[-1] - sol.p[-1]).max() < 1e-12


def falling(force):
    """A mass of 1 kg at x = 1 m under a force of x, by equations."""
    return zd.System(["x"], mass=[[1.0]], force=lambda p: [force(p[0])], p0=[1.0], v0=[0.0])


def sliding(force, dimension=2):
    """The same as a mechanism."""
    m = zd.Mechanism("wall", dimension=dimension)
    at = np.eye(dimension)[0]
    body = m.particle("body", 1.0, at=at)
    m.force("push", body, at, value=force, of={"x": body.position.x})
    return m


def sliding_in_space(force):
    return sliding(force, 3)


@pytest.mark.parametrize("make", [falling, sliding, sliding_in_space])
@pytest.mark.parametrize(("method", "rtol"), [("dop853", 1e-6), ("dormand_prince", 1e-6), ("radau", 1e-3)])
def test_steps_whose_stages_leave_the_domain_of_a_force_are_repeated_shorter(make, method, rtol):
    """A mass that falls on a repelling wall at x = 0, behind which the force is not a number; beside SciPy."""
    values = []

    def force(x):
        with np.errstate(invalid="ignore"):
            values.append(-9.81 + 0.01 / np.sqrt(x)**3)
        return values[-1]

    system = make(force)
    sol = zd.simulate(system, 2.0, integrator=method, rtol=rtol, atol=rtol / 1000)
    exact = solve_ivp(lambda t, y: [y[1], -9.81 + 0.01 / y[0]**1.5 if y[0] > 0 else np.nan], (0, 2), [1.0, 0.0], method="DOP853",
                      rtol=1e-11, atol=1e-13)
    assert np.isnan(values).any()
    assert abs(sol.p[-1, 0] - exact.y[0, -1]) < 20 * rtol       # errors are means over as many as three coordinates


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_where_the_domain_of_a_force_ends_it_is_named(method):
    """Free fall reaches x = 0 at sqrt(2 / 9.81) = 0.4515 s."""
    def force(p):
        with np.errstate(invalid="ignore"):
            return -9.81 + 0 * np.sqrt(p)

    system = zd.System(["x"], mass=[[1.0]], force=force, p0=[1.0], v0=[0.0])
    with refused("not-finite", r"^force is not finite at t = 0\.4515") as caught:
        zd.simulate(system, 2.0, integrator=method)
    assert abs(caught.value.solution.t[-1] - np.sqrt(2 / 9.81)) < 1e-6
    with refused("not-finite", r"^mass is not finite at t = 0: "):
        zd.simulate(zd.System(["x"], mass=lambda p: [[np.nan]], p0=[1.0], v0=[0.0]), 2.0, integrator=method)


def test_a_drive_whose_rate_is_not_finite_is_named():
    """The rate of sqrt(t) at 0, of sqrt(1 - t) at 1; compiled or not, its value is finite there."""
    t = sp.symbols("t")
    for angle, expected in ((sp.sqrt(t), "0"), (lambda t: np.sqrt(t), "0"), (sp.sqrt(1 - t), "1")):
        m = zd.Mechanism("arm")
        m.motor("drive", m.revolute("pin", m.ground, m.link("arm", (0, 0), (1, 0), mass=1.0).start), angle=angle)
        with np.errstate(divide="ignore", invalid="ignore"), \
                refused("not-finite", f"^angle of motor 'drive' must be finite, with its derivatives, at t = {expected}"):
            zd.simulate(m, 1.5, step=0.1)


def test_an_exception_ends_adaptive_steps_at_once():
    calls = []

    def force(p):
        calls.append(p[0])
        return [-9.81 + 0.01 / math.pow(p[0], 1.5)]     # raises a ValueError below 0

    with pytest.raises(ValueError, match="math domain error"):
        zd.simulate(zd.System(["x"], mass=[[1.0]], force=force, p0=[1.0], v0=[0.0]), 2.0)
    assert min(calls[:-1]) > 0 > calls[-1]


def test_a_disc_that_nearly_falls_flat_in_trial_steps_swings_round():
    disc = rolling_disc(lean=1.37)
    exact = zd.simulate(disc, 3.0, rtol=1e-10, atol=1e-10)
    assert np.abs(zd.simulate(disc, 3.0, rtol=1e-3, atol=1e-6).p[-1] - exact.p[-1]).max() < 0.02
