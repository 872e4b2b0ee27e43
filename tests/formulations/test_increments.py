"""Independent coordinates of systems with unit quaternions; and that every formulation keeps the order of an integrator."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import tolerances as tol
import zerodrift as zd
from rotating_bodies import SPIN, TURN, gyroscopic, held_at_a_point, turning
from spinning_body import attitude, body, precession
from support import assert_close, observed_order, refused

ROD = (0.8, (0.6, 0.6, 1e-3), (0.0, 0.0, -1.5), (0.9, 0.5, 0.0))    # mass, inertia, from end to middle, angular velocity
FAST = (*ROD[:3], (6.0, 2.0, 0.5))      # goes over the top: its kinetic energy is never small


@pytest.fixture(scope="module")
def spinning():
    """The body of closed form, compiled."""
    inertia = (1.0, 1.0, 0.4)
    return zd.symbolic(TURN, speeds=SPIN, kinematics=turning(TURN, SPIN), mass=sp.diag(*inertia), bias=gyroscopic(inertia),
                       potential=0, quaternions=[0], p0=[1, 0, 0, 0], v0=[0.3, 0.0, 2.0], progress=False)


def suited(integrator, system):
    if integrator not in zd.integrators(system):
        pytest.skip("does not take systems with a kinematic matrix")


def declared(integrator):
    order = zd.integrators()[integrator].order
    return order, tol.ORDER if order <= 4 else tol.HIGH_ORDER


def test_order_against_the_closed_form(spinning, formulation, integrator):
    suited(integrator, spinning)
    order, margin = declared(integrator)
    errors = []
    for k in range(12):
        sol = zd.simulate(spinning, 4.0, step=2.0 ** -k / 2, formulation=formulation, integrator=integrator)
        errors.append(max(np.abs(sol.p[-1] - attitude(sol.t)[-1]).max(), np.abs(sol.v[-1] - precession(sol.t)[-1]).max()))
        if errors[-1] < tol.MEASURABLE:
            break
    clear = [error for error in errors if error > tol.MEASURABLE]
    assert abs(np.log2(clear[-2] / clear[-1]) - order) <= margin, errors


@pytest.mark.each_value
def test_order_with_constraints(formulation, integrator):
    rod = held_at_a_point(*ROD)
    suited(integrator, rod)
    order, margin = declared(integrator)
    assert abs(observed_order(rod, t_end=4.0, coarsest=16, formulation=formulation, integrator=integrator) - order) <= margin


@pytest.mark.parametrize("options", [{"stabilization": None}, {"stabilization": "baumgarte"}, {"energy": True},
                                     {"stabilization": zd.Projection(every=3)}], ids=str)
def test_corrections_keep_the_order(formulation, options):
    order, margin = declared("rk4")
    found = observed_order(held_at_a_point(*FAST), t_end=1.0, coarsest=20, formulation=formulation, **options)
    assert abs(found - order) <= margin


# ---- motions that are known from elsewhere ----


def direction(t, mass, inertia, arm, omega, gravity=9.81):
    """Direction of a slender rod with one end fixed, a spherical pendulum, integrated by SciPy."""
    length = np.linalg.norm(arm)
    pull = mass * gravity * length / (inertia[0] + mass * length**2)
    start = np.array(arm) / length

    def rate(t, y):
        n, w = y[:3], y[3:]
        return np.r_[w, np.array([0, 0, -pull]) + pull * n[2] * n - (w @ w) * n]

    found = solve_ivp(rate, (0, t[-1]), np.r_[start, np.cross(omega, start)], t_eval=t, method="DOP853", rtol=1e-12, atol=1e-13)
    return found.y[:3].T


def test_a_rod_held_at_its_end(formulation):
    """Three holonomic constraints, and no turn about its own axis, as it starts without one."""
    rod, length = held_at_a_point(*ROD), np.linalg.norm(ROD[2])
    sol = zd.simulate(rod, 5.0, step=5e-3, formulation=formulation, integrator="dop853", energy=True)
    assert_close(sol.p[:, :3] / length, direction(sol.t, *ROD), 1e-10)
    assert np.abs(sol.position_violation).max() <= 4e-12 * length
    assert np.abs(sol.v[:, 5]).max() < 1e-9


@pytest.mark.parametrize("method", ["dormand_prince", "dop853"])
def test_adaptive_steps(spinning, formulation, method):
    """As many as with any other formulation, and errors of the size asked for."""
    sol = zd.simulate(spinning, 10.0, rtol=1e-8, atol=1e-8, formulation=formulation, integrator=method)
    usual = zd.simulate(spinning, 10.0, rtol=1e-8, atol=1e-8, integrator=method)
    assert np.abs(sol.p - attitude(sol.t)).max() < 1e-6
    assert 0.8 < len(sol.t) / len(usual.t) < 1.25


def test_the_error_estimate_does_not_see_what_is_normalised():
    """Steps are the same in number whether it is said that the coordinates are a quaternion, or not."""
    options = {"rtol": 1e-7, "atol": 1e-7, "integrator": "dormand_prince"}
    said, not_said = (zd.simulate(body(quaternions=which), 5.0, **options) for which in ([0], []))
    assert abs(len(said.t) - len(not_said.t)) <= 1
    assert_close(said.t[:10], not_said.t[:10], 1e-4)


def test_between_steps(spinning, formulation):
    times = np.linspace(0, 3, 37)
    sol = zd.simulate(spinning, 3.0, step=0.02, formulation=formulation, integrator="dop853", t_eval=times)
    assert_close(sol.p, attitude(times), 1e-12)
    p, v = zd.simulate(spinning, 3.0, step=0.02, formulation=formulation, integrator="dop853")(times)
    assert_close(p, attitude(times), 1e-12)
    assert_close(v, precession(times), 1e-12)


def test_events(spinning, formulation):
    """Zero of the quaternion's scalar part, compared with the closed form."""
    sol = zd.simulate(spinning, 3.0, step=0.05, formulation=formulation, integrator="dop853", events=lambda t, p, v: p[0])
    assert len(sol.t_events[0]) == 1
    assert abs(attitude(sol.t_events[0])[0, 0]) < 1e-11


# ---- long steps ----


@pytest.mark.parametrize("turn", [0.5, 1.5, 2.5, 4.0, 12.0])
def test_steps_that_turn_far_are_made_in_parts(turn):
    """By `turn` radians each, at a constant rate; beyond 120 degrees increments hardly tell where it is."""
    system = body(quaternions=[0], v0=[0.0, 0.0, turn / 0.1])
    sol = zd.simulate(system, 2.0, step=0.1, formulation="independent", integrator="dop853")
    half = turn / 0.1 * sol.t / 2
    assert_close(sol.p, np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1), 1e-4)
    assert sol.stats["subdivided"] == (20 if turn > 2 * np.pi / 3 else 0)


def test_steps_that_turn_too_far_say_so():
    with refused("dependent-coordinates", "or the step turns a body by more than 120 degrees"):
        zd.simulate(body(quaternions=[0], v0=[0, 0, 1000.0]), 1.0, step=0.1, formulation="independent")


def test_adaptive_steps_stay_within_reach():
    sol = zd.simulate(body(quaternions=[0], v0=[0, 0, 50.0]), 2.0, rtol=1e-3, atol=1e-3, formulation="independent",
                      integrator="dop853", first_step=1.0)
    assert sol.stats["rejected"] > 0
    assert np.abs(sol.p - np.stack([np.cos(25 * sol.t), 0 * sol.t, 0 * sol.t, np.sin(25 * sol.t)], axis=1)).max() < 0.05
