"""The terms of random trees with loops against derivatives: of poses, energies and constraints."""

import numpy as np
import pytest

import tolerances as tol
from mechanism_tables import random_mechanism
from support import along, assert_close, numbers, solved

SEEDS = range(12)


@pytest.fixture(scope="module", params=SEEDS)
def mechanism(request):
    return random_mechanism(request.param, bodies=2 + request.param % 5, loops=request.param % 3)


def poses_of(system, p):
    return system._core.poses(p)[0].ravel()


def test_rates_of_poses_are_their_derivatives(mechanism):
    p, v = mechanism.p0, mechanism.v0
    rates = mechanism._core.poses(p, v)[1].ravel()
    assert_close(rates, along(lambda p: poses_of(mechanism, p), (p, v)), tol.DIFFERENCE, scale=1)


def test_the_state_follows_from_poses(mechanism):
    core, p, v = mechanism._core, mechanism.p0, mechanism.v0
    q, w = core.state(*core.poses(p, v))
    assert_close(q, p, tol.SAME, scale=1)
    assert_close(w, v, tol.SAME, scale=1)


def test_the_mass_matrix_is_that_of_all_bodies(mechanism):
    p = mechanism.p0
    J = np.array([along(lambda p: poses_of(mechanism, p), (p, w)) for w in np.eye(mechanism.nv)]).T
    weights = np.concatenate([[body.mass, body.mass, body.inertia] for body in mechanism._core.tables.bodies])
    M = mechanism.evaluate().M
    assert (M == M.T).all()
    assert_close(M, J.T @ (weights[:, None] * J), tol.DIFFERENCE, scale=1)


def test_constraints_and_their_derivatives(mechanism):
    p, v = mechanism.p0, mechanism.v0

    def Psi(p):
        e = numbers(mechanism, 0.0, p, v)
        return e.C @ v + e.Phi_t

    e = numbers(mechanism, 0.0, p, v)
    slopes = [along(lambda p: numbers(mechanism, 0.0, p, v).Phi, (p, w)) for w in np.eye(mechanism.nv)]
    assert_close(e.Phi, np.zeros(mechanism.mh), tol.START, scale=1, what="the drawing")
    assert_close(e.C, np.array(slopes).T, tol.DIFFERENCE, scale=1, what="C")
    assert_close(e.xi, -along(Psi, (p, v)), tol.DIFFERENCE, scale=1, what="xi")


@pytest.mark.parametrize("seed", SEEDS)
def test_bias_and_force_are_those_of_lagrange(seed):
    system = random_mechanism(seed, bodies=2 + seed % 5, damped=False)
    p, v = system.p0, system.v0

    def lagrangian(p):
        e = numbers(system, 0.0, p, v)
        return v @ e.M @ v / 2 - e.V

    Mdot = along(lambda p: numbers(system, 0.0, p, v).M, (p, v))
    gradient = np.array([along(lagrangian, (p, w)) for w in np.eye(system.nv)])
    assert_close(numbers(system, 0.0, p, v).force, gradient - Mdot @ v, tol.DIFFERENCE, scale=1)


def test_energy_changes_by_the_power(mechanism):
    p, v = mechanism.p0, mechanism.v0

    def energy(p, v):
        e = numbers(mechanism, 0.0, p, v)
        return v @ e.M @ v / 2 + e.V

    e = numbers(mechanism, 0.0, p, v)
    C, xi = (e.C, e.xi) if mechanism.m else (np.zeros((0, mechanism.nv)), np.zeros(0))
    independent = mechanism.m == 0 or np.linalg.matrix_rank(C) == mechanism.m
    if not independent:
        pytest.skip("a joint too many")
    vdot, _ = solved(e.M, C, e.force, xi)
    assert_close(along(energy, (p, v), (v, vdot)), np.float64(e.power), tol.DIFFERENCE, scale=1 + abs(energy(p, v)))
