"""Motions against solutions from elsewhere: closed forms and files in tests/references/, whose README says where from."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import energy_models
import tolerances as tol
import zerodrift as zd
from native_systems import needs_compiler
from reference_files import ROUND_OFF, definition, end, falls_at_order_four, number, table
from rotating_bodies import about_a_point, held_at_a_point
from structured import four_bars as rods_of_four_bars
from support import OWN, assert_close
from symbolic_counterparts import chaplygin_sleigh, rolling_disc

# ---- knife edge ----


def test_knife_edge_against_its_closed_form(formulation):
    given = definition("knife_edge")
    x, y, phi = (float(given["ref_t6"][name]) for name in ("x", "y", "phi"))
    steps = (0.05, 0.025, 0.0125, 0.00625, 0.002)
    falls_at_order_four(steps, [
        np.abs(end(zd.systems.knife_edge(), 6.0, step, formulation=formulation).p[-1] - (x, y, phi)).max() for step in steps])


def test_knife_edge_reaction_is_that_of_the_closed_form():
    given = definition("knife_edge")
    sol = zd.simulate(zd.systems.knife_edge(), 6.0, step=0.002, save_every=50)
    size = 2 * given["m"] * given["g"] * np.sin(np.pi / 4)
    assert_close(sol.multipliers[:, 0], size * np.sin(np.pi / 3 * sol.t), 1e-9)


# ---- Chaplygin sleigh ----


def test_chaplygin_sleigh_against_its_closed_form(formulation):
    x, y, phi, _, omega = map(float, definition("chaplygin_sleigh")["ref"]["10"])
    steps = (0.05, 0.025, 0.0125, 0.00625, 0.001)
    runs = [end(chaplygin_sleigh(), 10.0, step, formulation=formulation) for step in steps]
    falls_at_order_four(steps, [max(np.abs(run.p[-1] - (x, y, phi)).max(), abs(run.v[-1, 2] - omega)) for run in runs])


def test_chaplygin_sleigh_along_the_way():
    reference = table("chaplygin_sleigh")
    sol = zd.simulate(chaplygin_sleigh(), 10.0, step=0.00125, save_every=80)
    assert_close(sol.t, reference["t"], 1e-12)
    assert_close(sol.p, np.stack([reference[name] for name in ("x_blade", "y_blade", "phi")], axis=1), 1e-9)
    assert_close(sol.multipliers[:, 0], reference["lam"], 1e-9)


# ---- rolling disc ----


def test_rolling_disc_in_general_motion(formulation):
    reference = table("rolling_disc")
    centre = np.stack([reference[name] for name in "xyz"], axis=1)
    steps = (0.01, 0.005, 0.001)
    disc = rolling_disc()
    runs = [zd.simulate(disc, 5.0, step=step, save_every=round(0.01 / step), formulation=formulation) for step in steps]
    falls_at_order_four(steps, [np.abs(run.p[:, :3] - centre).max() for run in runs])
    lambdas = np.stack([reference[name] for name in ("lam_N", "lam_x", "lam_y")], axis=1)
    assert_close(runs[-1].multipliers, lambdas, 1e-8)
    assert_close(runs[-1].kinetic_energy + runs[-1].potential_energy, reference["E"], 1e-10)


def test_rolling_disc_keeps_its_steady_lean():
    given = definition("rolling_disc")["steady"]
    lean = np.pi / 9
    disc = rolling_disc(lean=lean, yaw_rate=given["precession"], spin_rate=float(given["axle_spin"]))
    sol = zd.simulate(disc, 10.0, step=0.002, save_every=100)
    assert_close(sol.p[:, 4], np.full(len(sol.t), lean), 1e-10)
    turn = zd.simulate(disc, 2 * np.pi / 1.5, step=2 * np.pi / 1.5 / 2000)
    circle = turn.p[:-1, :2] - turn.p[:-1, :2].mean(axis=0)
    assert_close(np.hypot(*circle.T), np.full(2000, float(given["centre_circle_radius"])), 1e-9)


# ---- slider-crank ----


def test_slider_crank_loses_energy_as_the_reference_does(formulation):
    reference = table("sundials_slider_crank")
    p = np.stack([reference[name] for name in ("q", "x", "p")], axis=1)
    v = np.stack([reference[name] for name in ("q_d", "x_d", "p_d")], axis=1)
    steps = (0.05, 0.025, 0.0125, 0.0025)
    runs = [zd.simulate(energy_models.slider_crank(), 10.0, step=step, save_every=round(0.25 / step), formulation=formulation)
            for step in steps]
    falls_at_order_four(steps, [max(np.abs(run.p - p).max(), np.abs(run.v - v).max()) for run in runs])
    assert_close(runs[-1].multipliers, np.stack([reference["lam1"], reference["lam2"]], axis=1), 1e-9)
    assert runs[-1].energy_input[-1] < -0.1
    assert np.abs(runs[-1].energy_violation).max() < ROUND_OFF


def test_energy_correction_of_a_system_that_loses_energy():
    sol = zd.simulate(energy_models.slider_crank(), 10.0, step=0.05, energy=True)
    assert np.abs(sol.energy_violation).max() < 1e-14
    assert sol.stats["energy_skipped"] == 0


# ---- pendulum ----


def test_pendulum_of_the_benchmark_library(formulation):
    given = definition("A01_pendulum")
    expected = number(given["reference_x0_plus1"]["10"])
    pendulum = zd.systems.pendulum(angle=np.pi / 2)
    steps = (0.005, 0.0025, 0.00125, 0.00025)
    falls_at_order_four(steps, [
        np.abs(end(pendulum, 10.0, step, formulation=formulation).p[-1] - expected).max() for step in steps])


def test_pendulum_returns_to_its_start_after_thirty_seconds(formulation):
    """Fifteen periods; the problem of CVODE's own projection."""
    given = definition("sundials_cvPendulum")
    pendulum = zd.systems.pendulum(angle=np.pi / 2, gravity=float(given["g"]))
    steps = (0.005, 0.0025, 0.0005, 0.00015)
    runs = [end(pendulum, 30.0, step, formulation=formulation) for step in steps]
    falls_at_order_four(steps, [np.abs(np.hstack([run.p[-1], run.v[-1]]) - (1, 0, 0, 0)).max() for run in runs])
    assert np.abs(runs[0].position_violation).max() <= 1e-12


def test_pendulum_of_two_thousand_seconds():
    given = definition("A01_pendulum")
    sol = zd.simulate(zd.systems.pendulum(angle=np.pi / 2), 2000.0, step=0.01, integrator="dop853", save_every=100)
    for t in ("100", "1000", "2000"):
        assert_close(sol.p[int(t)], number(given["reference_x0_plus1"][t]), 1e-8)     # an error that grows with time
    assert np.abs(sol.position_violation).max() <= 1e-12


# ---- driven arm ----


@needs_compiler
def test_driven_arm_is_where_it_is_prescribed_to_be(formulation):
    sol = zd.simulate(OWN["arm"], 2.0, step=0.005, formulation=formulation)
    assert np.abs(sol.p[:, 2] - 2.0 * sol.t - np.sin(5.0 * sol.t)).max() < 1e-11


# ---- a row of two four-bars: where its rods lie flat, the number of freedoms jumps from 1 to 3 ----


@cache
def four_bars(loops=2):
    """Rods of 1 m and 1 kg by their angles, those that stand on the ground first; upright at the start, their ends at 1 m/s."""
    upright, across = dynamicsymbols(f"a0:{loops + 1}"), dynamicsymbols(f"b1:{loops + 1}")
    tips = [sp.Matrix([i + sp.cos(angle), sp.sin(angle)]) for i, angle in enumerate(upright)]
    along = [sp.Matrix([sp.cos(angle), sp.sin(angle)]) for angle in across]
    rate = [angle.diff(dynamicsymbols._t) for angle in (*upright, *across)]
    middles = [tip + rod / 2 for tip, rod in zip(tips, along, strict=False)]
    speeds = [middle.diff(dynamicsymbols._t) for middle in middles]
    return zd.symbolic(
        [*upright, *across],
        kinetic=sum(w**2 for w in rate[:loops + 1]) / 6
        + sum(speed.dot(speed) / 2 + w**2 / 24 for speed, w in zip(speeds, rate[loops + 1:], strict=True)),
        potential=9.81 * (sum(tip[1] for tip in tips) / 2 + sum(middle[1] for middle in middles)),
        constraints=[row for i in range(loops) for row in tips[i] + along[i] - tips[i + 1]],
        p0=[np.pi / 2] * (loops + 1) + [0.0] * loops, v0=[-1.0] * (loops + 1) + [0.0] * loops, name="four_bars")


def off_four_bars(formulation, units=0, **options):
    """Largest error of the first rod's end in ten seconds, m, and the motion; initial speeds are off by `units` of rounding."""
    reference, system = table("A02_fourbar_N2"), four_bars()
    if "step" not in options:
        options["t_eval"] = reference["t"]
    v0 = system.v0 * (1 + units * tol.EPS)
    sol = zd.simulate(system, 10.0, None, v0, formulation=formulation, on_singular="continue", **options)
    row = np.searchsorted(reference["t"], sol.t + 1e-9) - 1     # each time is one of the reference's
    tip = np.stack([np.cos(sol.p[:, 0]), np.sin(sol.p[:, 0])], axis=1)
    return np.abs(tip - np.stack([reference["B0x"], reference["B0y"]], axis=1)[row]).max(), sol


@pytest.mark.parametrize(("method", "tolerance", "allowed", "steps"), [
    ("dop853", 1e-7, 5e-4, 400), ("dop853", 1e-10, 3e-7, 900), ("dop853", 1e-13, 2e-8, 2000),
    ("dormand_prince", 1e-7, 2e-3, 500), ("dormand_prince", 1e-10, 1e-6, 1600), ("dormand_prince", 1e-13, 2e-8, 7000)])
def test_a_row_of_four_bars_by_adaptive_steps(method, tolerance, allowed, steps, formulation):
    """Ten passages of bifurcations. Every formulation keeps the digits, and none creeps: bounds are some ten times the error, and
    twice the steps, of those in dependent variables over eight speeds.
    """
    error, sol = off_four_bars(formulation, integrator=method, rtol=tolerance, atol=tolerance)
    assert error < allowed
    assert sol.stats["steps"] < steps


@pytest.mark.parametrize(("method", "step", "allowed"), [("rk4", 0.01, 1e-5), ("rk4", 0.005, 1e-6), ("dop853", 0.01, 3e-5),
                                                             ("dop853", 0.005, 1e-5), ("dop853", 0.0025, 3e-5)])
def test_a_row_of_four_bars_by_fixed_steps(method, step, allowed, formulation):
    """Some stages come so near a bifurcation that accelerations have but five digits, whatever is integrated; how near, the last
    bit of the start decides: of three starts that differ by it, one may be off by a hundred times as much as the others.
    """
    runs = [off_four_bars(formulation, units, integrator=method, step=step, save_every=round(0.01 / step)) for units in (0, 1, 2)]
    assert np.median([error for error, _ in runs]) < allowed
    for _, sol in runs:
        changed = sol.stats["repartitions"]
        assert 0 < changed < sol.stats["steps"] / 10 if formulation in ("mixed", "independent") else changed == 0


@needs_compiler
@pytest.mark.filterwarnings("ignore::zerodrift.AccuracyWarning")       # of small pivots, which come with the digits that are lost
@pytest.mark.parametrize("road", ["schur", "mixed", "independent"])
def test_a_row_of_forty_four_bars_among_bodies(road):
    """Through the first position in which all rods lie flat; each takes two digits of those that are left."""
    reference, rods = table("A02_fourbar_N40"), rods_of_four_bars(40, angle=np.pi / 2)
    speeds = np.zeros(3 * len(rods.masses))
    speeds[2::6], speeds[0::6], speeds[3::6] = -1.0, 0.5, 1.0       # what stands turns, and takes what lies on it along
    sol = zd.simulate(rods.system(), 1.0, None, speeds, step=1e-3, save_every=50, formulation=road)
    tip = np.stack([np.cos(sol.p[:, 2]), np.sin(sol.p[:, 2])], axis=1)
    place = np.stack([reference["B0x"], reference["B0y"]], axis=1)[:len(tip)]
    assert_close(sol.t, reference["t"][:len(tip)], 1e-12)
    assert np.abs(tip - place).max() < 1e-8


# ---- heavy top ----


@pytest.mark.parametrize("top", [pytest.param("top", marks=needs_compiler), held_at_a_point, about_a_point])
def test_heavy_top_with_unit_quaternions(top, formulation):
    """In C, and symbolically: held by constraints, or by coordinates about its fixed point."""
    given, reference = definition("heavy_top"), table("heavy_top")
    held, inertia, arm = top != about_a_point, (0.234375, 0.46875, 0.234375), given["params"]["X"]
    top = OWN[top] if top == "top" else top(given["params"]["m"], inertia, tuple(arm), tuple(given["initial"]["omega_body"]))
    sol = zd.simulate(top, 2.0, step=1e-3, save_every=10, formulation=formulation, integrator="dop853")
    places = np.stack([reference[name] for name in ("x", "y", "z", "e0", "e1", "e2", "e3")], axis=1)
    rates = np.stack([reference[name] for name in ("vx", "vy", "vz", "w1", "w2", "w3")], axis=1)
    assert_close(sol.t, reference["t"], 1e-12)
    assert np.abs(sol.p - (places if held else places[:, 3:])).max() < 1e-10
    assert np.abs(sol.v - (rates if held else rates[:, 3:])).max() < 1e-10
    if held:
        assert_close(sol.multipliers, np.stack([reference[f"lam{i}"] for i in (1, 2, 3)], axis=1), 1e-10)
