"""The projection: (25)-(27) against NumPy, and their own properties."""

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from support import along_manifold, assert_close, condition, motion, numbers, solved, violated_states


def metric_of(name, M):
    return M if name == "mass" else np.eye(len(M))


def corrected(system, formulation, state, **options):
    """State after the projection of a violated state; skips formulations whose state cannot violate the constraints."""
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


def test_neither_means_without_stabilization(bar):
    nothing = motion(bar, 1.0, 20, stabilization=zd.Projection(positions=False, velocities=False))
    assert np.array_equal(nothing.p, motion(bar, 1.0, 20, stabilization=None).p)


def test_iterations_are_counted(bar):
    sol = motion(bar, 8.0, 160)
    assert sol.iterations[0] == 0
    assert sol.stats["position_iterations"] == sol.iterations.sum()
    assert sol.stats["max_position_iterations"] == sol.iterations.max() >= 2
    rare = motion(bar, 8.0, 160, save_every=40)
    assert np.array_equal(rare.iterations[1:], sol.iterations[1:].reshape(4, 40).max(axis=1))
