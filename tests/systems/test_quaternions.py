"""More coordinates than velocities: a spinning body whose attitude is a quaternion, against its closed form."""

import numpy as np
import pytest

import zerodrift as zd
from spinning_body import INERTIA, SPIN, body
from support import FORMULATIONS, assert_close


def precession(t):
    """The angular velocity of a symmetric body turns about its axis, in the body, at a constant rate."""
    rate = (INERTIA[2] - INERTIA[0]) / INERTIA[0] * SPIN[2]
    return np.stack([SPIN[0] * np.cos(rate * t), SPIN[0] * np.sin(rate * t), np.full_like(t, SPIN[2])], axis=1)


SUITED = [name for name in FORMULATIONS if name != "independent"]


@pytest.mark.parametrize("name", SUITED)
def test_a_free_body_precesses(name):
    sol = zd.simulate(body(), 5.0, step=0.01, formulation=name, integrator="dop853", energy=True)
    assert_close(sol.v, precession(sol.t), 1e-12)
    assert np.abs(np.linalg.norm(sol.p, axis=1) - 1).max() < 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-14


@pytest.mark.parametrize("name", SUITED)
def test_a_body_held_to_turn_about_one_axis(name):
    """Its own z axis stays upright: two holonomic constraints on four coordinates, and a rotation at a constant rate."""
    def upright(p):
        w, x, y, z = p
        return np.array([2 * (x * z + w * y), 2 * (y * z - w * x)])

    system = body(constraints=upright, v0=[0.0, 0.0, 2.0])
    assert zd.check(system, system.p0, system.v0, samples=0)
    sol = zd.simulate(system, 2.0, step=0.01, formulation=name)
    assert_close(sol.p, np.stack([np.cos(sol.t), 0 * sol.t, 0 * sol.t, np.sin(sol.t)], axis=1), 1e-9)
    assert np.abs(sol.position_violation).max() <= 1e-12


# ---- tools that choose formulations themselves ----


def test_the_core_says_which_formulations_suit():
    assert list(zd.formulations(body())) == SUITED
    assert list(zd.formulations(zd.systems.rolling_disc())) == FORMULATIONS


def test_a_reference_of_a_body():
    ref = zd.reference(body(), 2.0)
    assert np.abs(ref.solution.v - precession(ref.solution.t)).max() <= ref.velocity_error < 1e-12


def test_work_precision_takes_what_suits():
    found = zd.work_precision(body(), 0.5, integrators=["rk4"], steps=[0.1], rounds=1)
    assert [row.setting.formulation for row in found.rows] == SUITED
    assert all(row.success and row.error < 1e-4 for row in found.rows)


@pytest.mark.parametrize("chosen", [None, ["schur"]])
def test_tuning_a_body(chosen):
    tuning = zd.tune(body(), 0.5, error=1e-6, formulations=chosen, integrators=["rk4"], rounds=1)
    sol = zd.simulate(body(), 0.5, **tuning.settings)
    assert np.abs(sol.v[-1] - precession(sol.t)[-1]).max() < 1e-5


def test_the_stability_of_a_body():
    found = zd.stability_map(body(), 0.5, steps=[0.05], values=[1.0])
    assert all(found.survived(way).all() and found.error(way).max() < 1e-4 for way in found.rows)


def test_a_singular_mass_matrix_suits_those_that_do_not_invert_it():
    """The second coordinate has no mass, and the first decides where it is: x = cos t."""
    def force(p):
        return np.array([-p[0], 0.0])

    system = zd.System(["x", "y"], mass=np.diag([1.0, 0.0]), force=force, constraints=lambda p: np.array([p[1] - p[0]**2]),
                       p0=[1.0, 1.0])
    found = zd.work_precision(system, 0.5, integrators=["rk4"], steps=[0.1], rounds=1)
    assert [row.setting.formulation for row in found.rows] == [name for name in FORMULATIONS if name != "schur"]
    assert all(row.error < 1e-4 for row in found.rows)
    with pytest.raises(zd.SingularSystem, match="'schur' inverts it"):
        zd.work_precision(system, 0.5, formulations=["schur"], integrators=["rk4"], steps=[0.1], rounds=1)


def test_independent_coordinates_say_what_they_need():
    with pytest.raises(zd.UnsuitedFormulation, match="needs as many coordinates as velocities, and there are 4 and 3"):
        zd.simulate(body(), 1.0, step=0.1, formulation="independent")
