"""All formulations solve the same equations: against an independent solve of (8), and against each other."""

import numpy as np
import pytest
from mpmath import mp

import tolerances as tol
import zerodrift as zd
from support import assert_close, condition, consistent_states, motion, numbers, saddle_matrix, solved


def test_accelerations_and_multipliers_solve_8(system, formulation):
    """With the sign of (7): M vdot + d = f - C^T lambda."""
    for t, p, v in consistent_states(system):
        e = numbers(system, t, p, v)
        allowed = tol.SOLVED * condition(e.M, e.C)
        expected = solved(e.M, e.C, e.force, e.xi)
        vdot, multipliers = zd.acceleration(system, p, v, t, formulation=formulation)
        assert_close(vdot, expected[0], allowed, scale=1)
        assert_close(multipliers, expected[1], allowed, scale=1)
        assert_close(e.M @ vdot + e.C.T @ multipliers, e.force, allowed, scale=1)
        assert_close(e.C @ vdot, e.xi, allowed, scale=1)


def test_recorded_multipliers_are_those_of_the_recorded_states(system, formulation):
    sol = motion(system, 0.5, 50, formulation=formulation)
    for t, p, v, recorded in zip(sol.t, sol.p, sol.v, sol.multipliers, strict=True):
        e = numbers(system, t, p, v)
        assert_close(recorded, solved(e.M, e.C, e.force, e.xi)[1], tol.SOLVED * condition(e.M, e.C), scale=1)


def test_motion_is_the_same_in_every_formulation(system, formulation):
    expected, sol = (motion(system, 0.5, 500, **options) for options in ({}, {"formulation": formulation}))
    assert_close(sol.p, expected.p, tol.CONVERGED)
    assert_close(sol.v, expected.v, tol.CONVERGED)


def test_constraints_in_other_units_change_nothing(formulation):
    """A mechanism a thousand times smaller, in masses a million times larger: the same angles, (8) scaled through."""
    big = zd.systems.four_bar()
    lengths, masses, gravity = (np.array(big.parameters[name]) for name in ("lengths", "masses", "gravity"))
    small = zd.systems.four_bar(lengths=lengths / 1000, masses=masses * 1e6, gravity=float(gravity) / 1000)
    for t, p, v in consistent_states(big):
        vdot, multipliers = zd.acceleration(big, p, v, t, formulation=formulation)
        again, larger = zd.acceleration(small, p, v, t, formulation=formulation)
        assert_close(again, vdot, tol.STEPPED)
        assert_close(larger, 1000 * multipliers, tol.STEPPED)


@pytest.mark.parametrize("mass", [3.0, 1e-2, 1e-4, 1e-6, 1e-9])
def test_a_light_link_costs_no_digits(formulation, mass, monkeypatch):
    """Against fifty digits: (13) inverts M, whose condition is 1e9 here, and its own refinement has to make up for that."""
    bar = zd.systems.four_bar(masses=(1.5, 5.0, mass))
    monkeypatch.setattr(mp, "dps", 50)
    for _, p, v in consistent_states(bar, 8):
        e = numbers(bar, 0.0, p, v)
        exact = mp.lu_solve(mp.matrix(saddle_matrix(e.M, e.C).tolist()), mp.matrix([*e.force, *e.xi]))
        expected = np.array([float(x) for x in exact])
        found = np.concatenate(zd.acceleration(bar, p, v, formulation=formulation))
        for rows in (slice(0, 3), slice(3, 5)):
            assert_close(found[rows], expected[rows], tol.EXACT)


# ---- where all coordinates are exactly zero, their size is that of a natural unit ----


def moved_from_zero():
    """A mass on a guide that moves from zero."""
    return zd.System(2, mass=np.diag([1.0, 2.0]), potential=0.0, p0=[0.0, 0.0], v0=[0.0, 0.3],
                     constraints=lambda p, t: np.array([p[1] - 0.3 * np.sin(t)]))


def test_a_start_at_zero_that_a_constraint_moves(formulation):
    sol = zd.simulate(moved_from_zero(), 1.0, step=0.01, formulation=formulation)
    assert_close(sol.p, np.stack([0 * sol.t, 0.3 * np.sin(sol.t)], axis=1), 1e-11)


@pytest.mark.parametrize("speed", [1e-9, 1e-5, 1.0])
def test_displacements_from_zero(speed, formulation):
    """A pendulum by its displacements: however small they are, Phi is summed from terms of the size of its length."""
    away = zd.System(2, mass=np.eye(2), potential=0.0, p0=[0.0, 0.0], v0=[0.0, speed],
                     constraints=lambda p: np.array([(1 + p[0]) ** 2 + p[1] ** 2 - 1]))
    sol = zd.simulate(away, 1.0, step=0.01, formulation=formulation)
    assert_close(sol.p, np.stack([np.cos(speed * sol.t) - 1, np.sin(speed * sol.t)], axis=1), 1e-9)


@pytest.mark.usefixtures("few_places")
def test_tools_take_a_start_at_zero():
    reference = zd.reference(moved_from_zero(), 0.2, error=1e-9)
    assert_close(reference.solution.p[-1], np.array([0.0, 0.3 * np.sin(0.2)]), 1e-9)
