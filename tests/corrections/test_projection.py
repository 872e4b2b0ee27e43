"""Corrections: (25)-(27) against NumPy and their own properties, (23) in test_integrators, (28) and (29)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tolerances as tol
import zerodrift as zd
from support import (
    SYSTEMS,
    assert_close,
    condition,
    motion,
    numbers,
    solved,
    violated_states,
)


def metric_of(name, M):
    return M if name == "mass" else np.eye(len(M))


def corrected(system, formulation, state, **options):
    """What a formulation makes of a violated state; skips what it does not correct as its state cannot violate it."""
    t, p, v = state
    again = zd.project(system, p, v, t, formulation=formulation, projection=zd.Projection(**options))
    if all(np.array_equal(a, b) for a, b in zip(again, (p, v), strict=True)):
        pytest.skip("nothing is corrected")
    return again


def test_default_projection_reaches_its_tolerance(system):
    for t, p, v in violated_states(system):
        p, v = zd.project(system, p, v, t)
        e = numbers(system, t, p, v)
        assert np.abs(e.Phi).max(initial=0) <= zd.Projection().tol
        assert np.abs(e.C @ v + e.Phi_t).max(initial=0) <= tol.VELOCITY * (np.abs(e.C) @ np.abs(v)).max(initial=1)


@pytest.mark.parametrize("metric", zd.Projection.METRICS)
def test_position_correction_is_25a(system, formulation, metric):
    """Delta p = A x with x from (8), right side -[0; Phi; 0], until the tolerance is reached."""
    for state in violated_states(system):
        t, p, v = state
        q, w = corrected(system, formulation, state, metric=metric, velocities=False)
        assert np.array_equal(w, v)
        for _ in range(20):
            e = numbers(system, t, p, v)
            if np.abs(e.Phi).max(initial=0) <= zd.Projection().tol:
                break
            rhs = np.concatenate([-e.Phi, np.zeros(system.mn)])
            p = p + e.A @ solved(metric_of(metric, e.M), e.C, np.zeros(system.nv), rhs)[0]
        assert_close(q, p, tol.STEPPED, scale=1)


@pytest.mark.parametrize("metric", zd.Projection.METRICS)
def test_velocity_correction_is_25b(system, formulation, metric):
    for state in violated_states(system):
        t, p, v = state
        q, w = corrected(system, formulation, state, metric=metric, positions=False)
        e = numbers(system, t, p, v)
        expected = v + solved(metric_of(metric, e.M), e.C, np.zeros(system.nv), -(e.C @ v + e.Phi_t))[0]
        assert np.array_equal(q, p)
        assert_close(w, expected, tol.SOLVED * condition(e.M, e.C), scale=1)


def along_manifold(C, nv):
    """D: the motions along the manifold, C D = 0."""
    return np.linalg.svd(C)[2][len(C):].T if len(C) else np.eye(nv)


@pytest.mark.parametrize("metric", zd.Projection.METRICS)
def test_corrections_are_orthogonal_to_the_manifold(system, formulation, metric):
    """D^T M Delta v = 0, and the same for Delta p of one iteration: no motion along the manifold sees anything of them."""
    for state in violated_states(system):
        t, p, v = state
        e = numbers(system, t, p, v)
        once = 0.9 * np.abs(e.Phi).max(initial=1e-9)    # reached by the first iteration
        q, w = corrected(system, formulation, state, metric=metric, tol=once)
        if not np.array_equal(q, p):
            change = np.linalg.lstsq(e.A, q - p, rcond=None)[0]
            assert_close(along_manifold(e.C, system.nv).T @ metric_of(metric, e.M) @ change, np.zeros(system.nv - system.m),
                         tol.STEPPED, scale=np.abs(e.M @ change).max())
        e = numbers(system, t, q, v)
        change = w - v
        assert_close(along_manifold(e.C, system.nv).T @ metric_of(metric, e.M) @ change, np.zeros(system.nv - system.m),
                     tol.STEPPED, scale=np.abs(e.M @ change).max() if metric == "mass" else np.abs(change).max())


def test_projection_is_idempotent(system, formulation):
    for state in violated_states(system):
        p, v = corrected(system, formulation, state)
        q, w = zd.project(system, p, v, state[0], formulation=formulation)
        assert np.array_equal(p, q)
        assert_close(w, v, tol.VELOCITY, scale=1)


def test_metrics_differ(bar):
    state = violated_states(bar, 1)[0]
    mass, identity = (corrected(bar, "schur", state, metric=metric)[1] for metric in zd.Projection.METRICS)
    assert np.abs(mass - identity).max() > 1e-6


def test_identity_metric_serves_a_run(bar):
    """Its matrix must not be taken for that of the accelerations, which stay those of (8)."""
    sol = motion(bar, 0.5, 50, stabilization=zd.Projection(metric="identity"))
    assert np.abs(sol.position_violation).max() <= zd.Projection().tol
    _, multipliers = zd.acceleration(bar, sol.p[-1], sol.v[-1])
    assert_close(sol.multipliers[-1], multipliers, tol.STEPPED)


# ---- within a run ----


def test_every_step_ends_within_tolerance(system, formulation, integrator):
    sol = motion(system, 1.0, 50, formulation=formulation, integrator=integrator, stabilization=zd.Projection(tol=1e-11))
    assert np.abs(sol.position_violation).max(initial=0) <= 1e-11
    for t, p, v, Psi in zip(sol.t, sol.p, sol.v, sol.velocity_violation, strict=True):
        e = numbers(system, t, p, v)
        assert_close(Psi, e.C @ v + e.Phi_t, tol.SAME, scale=(np.abs(e.C) @ np.abs(v)).max(initial=1))
        assert np.abs(Psi).max(initial=0) <= tol.VELOCITY * (np.abs(e.C) @ np.abs(v)).max(initial=1)


def test_recorded_violations_are_those_of_the_states(system):
    sol = motion(system, 0.5, 25, stabilization=None)
    for t, p, v, Phi, Psi in zip(sol.t, sol.p, sol.v, sol.position_violation, sol.velocity_violation, strict=True):
        e = numbers(system, t, p, v)
        assert_close(Phi, e.Phi, tol.SAME, scale=1)
        assert_close(Psi, e.C @ v + e.Phi_t, tol.SAME, scale=(np.abs(e.C) @ np.abs(v)).max(initial=1))


def test_every_k_th_step(system):
    """As if the run had no stabilization, were stopped every k steps and projected by hand; and so after the last step."""
    h, k, steps = 0.02, 3, 8
    sol = zd.simulate(system, steps * h, step=h, stabilization=zd.Projection(every=k))
    p, v, done = system.p0, system.v0, 0
    while done < steps:
        ahead = min(done + k, steps)
        part = zd.simulate(system, (done * h, ahead * h), p, v, step=h, stabilization=None)
        p, v = zd.project(system, part.p[-1], part.v[-1], ahead * h)
        assert_close(sol.p[ahead - 1], part.p[-2], tol.STEPPED, scale=1)
        assert_close(sol.p[ahead], p, tol.STEPPED, scale=1)
        assert_close(sol.v[ahead], v, tol.STEPPED, scale=1)
        done = ahead


def test_every_k_th_step_in_every_formulation(system, formulation):
    sol = motion(system, 1.0, 20, formulation=formulation, stabilization=zd.Projection(every=6))
    corrected_rows = [0, 6, 12, 18, 20]
    assert np.abs(sol.position_violation[corrected_rows]).max(initial=0) <= zd.Projection().tol
    assert not np.delete(sol.iterations, corrected_rows).any()


def test_positions_only(bar):
    sol = motion(bar, 1.0, 20, stabilization=zd.Projection(velocities=False))
    assert np.abs(sol.position_violation).max() <= zd.Projection().tol
    assert np.abs(sol.velocity_violation).max() > 1e-6
    assert sol.stats["velocity_corrections"] == 0
    assert sol.stats["position_iterations"] > 0


def test_velocities_only(bar):
    sol = motion(bar, 1.0, 20, stabilization=zd.Projection(positions=False))
    assert np.abs(sol.position_violation).max() > 1e-8
    assert np.abs(sol.velocity_violation).max() <= tol.VELOCITY * np.abs(sol.v).max()
    assert sol.stats["velocity_corrections"] == 20
    assert sol.stats["position_iterations"] == sol.iterations.max() == 0


def test_neither_is_no_stabilization(bar):
    nothing = motion(bar, 1.0, 20, stabilization=zd.Projection(positions=False, velocities=False))
    assert np.array_equal(nothing.p, motion(bar, 1.0, 20, stabilization=None).p)


def test_iterations_are_counted(bar):
    sol = motion(bar, 8.0, 160)
    assert sol.iterations[0] == 0
    assert sol.stats["position_iterations"] == sol.iterations.sum()
    assert sol.stats["max_position_iterations"] == sol.iterations.max() >= 2
    rare = motion(bar, 8.0, 160, save_every=40)
    assert np.array_equal(rare.iterations[1:], sol.iterations[1:].reshape(4, 40).max(axis=1))


def test_baumgarte_bounds_what_drifts(bar):
    """The paper's case (b): better than nothing, worse than projection."""
    drift = {name: np.abs(motion(bar, 2.0, 200, stabilization=name).position_violation).max()
             for name in (None, "baumgarte", "projection")}
    assert drift["projection"] < drift["baumgarte"] < drift[None]


# ---- assembling ----


def test_assembling_holds_what_is_named(system):
    """As many coordinates and rates as there are degrees of freedom, chosen so that the others follow from them."""
    for t, p, v in violated_states(system, 2):
        C = numbers(system, t, p, v).C
        free = system.nq - system.mh if system.nq == system.nv else 0
        D = along_manifold(C[:system.mh], system.nv)
        held, basis = [], np.zeros((0, D.shape[1]))
        for i in np.argsort(-np.linalg.norm(D, axis=1))[:system.nv]:
            trial = np.vstack([basis, D[i]])
            if len(held) < free and np.linalg.svd(trial)[1][-1] > 0.2:
                held, basis = [*held, i], trial
        names = [system.coordinates[i].name for i in held]
        names += [system.velocities[i].name for i in held] if system.mn == 0 else []
        q, w = zd.assemble(system, p, v, hold=names, t=t)
        assert np.array_equal(q[held], p[held])
        if system.mn == 0:
            assert_close(w[held], v[held], tol.VELOCITY, scale=1)
        e = numbers(system, t, q, w)
        assert np.abs(e.Phi).max(initial=0) <= 1e-12
        assert np.abs(e.C @ w + e.Phi_t).max(initial=0) <= tol.VELOCITY * (np.abs(e.C) @ np.abs(w)).max(initial=1)


def test_assembling_starts_from_rest(bar):
    p, v = zd.assemble(bar, bar.p0, hold="alpha1")
    assert p[0] == bar.p0[0]
    assert not v.any()


def test_assembling_changes_nothing_it_was_given(bar):
    p, v = np.array([1.2, 0.3, -1.5]), np.array([2.0, 0.0, 0.0])
    zd.assemble(bar, p, v)
    zd.project(bar, p, v)
    assert p.tolist() == [1.2, 0.3, -1.5]
    assert v.tolist() == [2.0, 0.0, 0.0]


# ---- energy ----


def with_energy(system):
    if not system.has_energy:
        pytest.skip("declares no potential")
    return system


def test_energy_balance_holds_along_the_motion(system, formulation):
    """E - E0 - input of (28), where nothing corrects it: as small as the motion is exact."""
    sol = motion(with_energy(system), 0.5, 500, formulation=formulation)
    kept = sol.kinetic_energy + sol.potential_energy - sol.energy_input
    scale = np.abs(sol.kinetic_energy).max() + np.abs(sol.potential_energy).max()
    assert_close(sol.energy_violation, kept - kept[0], tol.SAME, scale=scale)
    assert np.abs(sol.energy_violation).max() <= tol.CONVERGED * scale


def test_recorded_energies_are_those_of_the_states(system):
    sol = motion(with_energy(system), 0.5, 25)
    for k, (t, p, v) in enumerate(zip(sol.t, sol.p, sol.v, strict=True)):
        e = numbers(system, t, p, v)
        assert_close(sol.kinetic_energy[k], v @ e.M @ v / 2, tol.SAME)
        assert_close(sol.potential_energy[k], e.V, tol.SAME)


@pytest.mark.filterwarnings("ignore::zerodrift.CorrectionWarning")
def test_energy_correction_leaves_round_off(system, formulation, integrator):
    """After every step, but for those that are counted as left out."""
    sol = motion(with_energy(system), 2.0, 100, formulation=formulation, integrator=integrator, energy=True)
    T, V = sol.kinetic_energy, sol.potential_energy
    allowed = tol.ENERGY * (T + np.abs(V) + np.abs(T[0] + V[0]))
    assert (np.abs(sol.energy_violation) > allowed).sum() <= sol.stats["energy_skipped"]
    assert sol.stats["energy_skipped"] + sol.stats["energy_corrections"] <= sol.stats["steps"]


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
    """An oscillator at a turning point has no kinetic energy to scale: steps are chosen to meet each one exactly."""
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
@settings(deadline=None, max_examples=150)
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


def test_the_integral_of_the_violation_is_fed_back(bar):
    """(23) with the term of the paper's reference [16]: RK4 on (p, v, s), sdot = Phi, xi_stab = ... - integral s, in NumPy."""
    gains = zd.Baumgarte(alpha=10.0, beta=25.0, integral=100.0)

    def rates(t, y):
        p, v, s = np.split(y, [3, 6])
        e = numbers(bar, t, p, v)
        xi = e.xi - gains.alpha * (e.C @ v) - gains.beta * e.Phi - gains.integral * s
        return np.concatenate([v, solved(e.M, e.C, e.force, xi)[0], e.Phi])

    y, h, steps = np.concatenate([bar.p0, bar.v0, np.zeros(2)]), 0.05, 20
    for _ in range(steps):
        k1 = rates(0, y)
        k2 = rates(0, y + h / 2 * k1)
        k3 = rates(0, y + h / 2 * k2)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + rates(0, y + h * k3))
    sol, without = (zd.simulate(bar, steps * h, step=h, stabilization=each) for each in (gains, zd.Baumgarte(10.0, 25.0)))
    assert_close(np.concatenate([sol.p[-1], sol.v[-1]]), y[:6], tol.STEPPED)
    assert np.abs(sol.p[-1] - without.p[-1]).max() > 1e-6       # it does something
