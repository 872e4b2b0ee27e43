"""Integrators: observed against declared order, and each method against one written a second time."""

import numpy as np
import pytest
from scipy.optimize import fsolve

import tolerances as tol
import zerodrift as zd
from rotating_bodies import held_at_a_point
from support import assert_close, observed_order, rate
from zerodrift.runs.arguments.settings import STABILIZATIONS


@pytest.mark.pairs(stabilization=[None, *STABILIZATIONS])
def test_observed_order_is_the_declared_one(system, integrator, stabilization):
    order = observed_order(system, integrator=integrator, stabilization=stabilization)
    if order is None:
        pytest.skip("the motion is found to round-off")
    declared = zd.integrators()[integrator].order
    assert abs(order - declared) <= (tol.ORDER if declared <= 4 else tol.HIGH_ORDER)


def test_order_does_not_depend_on_the_formulation(system, formulation):
    order = observed_order(system, formulation=formulation)
    if order is None:
        pytest.skip("the motion is found to round-off")
    assert abs(order - zd.integrators()["rk4"].order) <= tol.ORDER


def steps_of(system, integrator, h=0.02, steps=3, **options):
    """A short run without anything but the integrator: t, and y = (p, v)."""
    sol = zd.simulate(system, steps * h, step=h, integrator=integrator, **{"stabilization": None} | options)
    return sol.t, np.hstack([sol.p, sol.v])


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.parametrize("gains", [None, zd.Baumgarte(), zd.Baumgarte(alpha=300.0, beta=2e4)], ids=str)
def test_rk4(system, gains):
    """The classical method in NumPy on (1), (8); with gains, (23) is what they add to xi."""
    t, y = steps_of(system, "rk4", stabilization=gains)
    alpha, beta = (gains.alpha, gains.beta) if gains else (0, 0)
    expected, h = y[0], t[1]
    for k in range(len(t) - 1):
        k1 = rate(system, t[k], expected, alpha, beta)
        k2 = rate(system, t[k] + h / 2, expected + h / 2 * k1, alpha, beta)
        k3 = rate(system, t[k] + h / 2, expected + h / 2 * k2, alpha, beta)
        k4 = rate(system, t[k] + h, expected + h * k3, alpha, beta)
        expected = expected + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        assert_close(y[k + 1], expected, tol.STEPPED)


def test_gains_matter(bar):
    """Or the test above would show nothing of (23)."""
    different = None, zd.Baumgarte(), zd.Baumgarte(10, 0), zd.Baumgarte(0, 25)
    runs = [steps_of(bar, "rk4", stabilization=gains)[1] for gains in different]
    for i, run in enumerate(runs):
        assert all(np.abs(run - other).max() > 1e-10 for other in runs[:i])


def test_trapezoidal_satisfies_its_equation(system):
    """The defect of y1 = y0 + h/2 (f(t0, y0) + f(t1, y1)), with f from NumPy."""
    t, y = steps_of(system, "trapezoidal")
    for k in range(len(t) - 1):
        change = (t[k + 1] - t[k]) / 2 * (rate(system, t[k], y[k]) + rate(system, t[k + 1], y[k + 1]))
        assert_close(y[k + 1] - y[k], change, tol.IMPLICIT, scale=np.abs(y[k]).max() + np.abs(change).max())


def test_trapezoidal_where_something_is_zero_up_to_rounding():
    """The rod starts without a turn about its axis, and none begins: what solves leave there has nothing to be compared with."""
    rod = held_at_a_point(0.8, (0.6, 0.6, 1e-3), (0.0, 0.0, -1.5), (0.9, 0.5, 0.0))
    for steps in (128, 216, 256):
        sol = zd.simulate(rod, 0.1, step=1 / steps, integrator="trapezoidal")
        assert np.abs(sol.v[:, 5]).max() < 1e-12


def test_trapezoidal_by_scipy(bar):
    t, y = steps_of(bar, "trapezoidal")
    h = t[1]
    f0 = rate(bar, 0.0, y[0])
    expected = fsolve(lambda y1: y1 - y[0] - h / 2 * (f0 + rate(bar, h, y1)), y[0] + h * f0, xtol=1e-13)
    assert_close(y[1], expected, tol.STEPPED)


def test_trapezoidal_on_the_oscillator_is_newmark():
    """In closed form: (I - h/2 A) y1 = (I + h/2 A) y0; it keeps the energy, as Newmark's method does here."""
    oscillator = zd.systems.oscillator(mass=2.0, stiffness=30.0, x0=0.3, v0=-0.2)
    A, h = np.array([[0, 1], [-15.0, 0]]), 0.05
    step = np.linalg.solve(np.eye(2) - h / 2 * A, np.eye(2) + h / 2 * A)
    sol = zd.simulate(oscillator, 100 * h, step=h, integrator="trapezoidal")
    expected = [np.linalg.matrix_power(step, k) @ (0.3, -0.2) for k in range(101)]
    assert_close(np.hstack([sol.p, sol.v]), expected, tol.STEPPED)
    assert np.abs(sol.energy_violation).max() <= tol.STEPPED * sol.kinetic_energy.max()


def test_trapezoidal_on_the_oscillator_knows_its_phase_error():
    """omega_h = 2/h atan(omega h / 2): the paper's period elongation of Newmark's method."""
    h, omega = 0.1, np.sqrt(10)
    sol = zd.simulate(zd.systems.oscillator(), 10.0, step=h, integrator="trapezoidal")
    assert_close(sol.p[:, 0], 0.1 * np.cos(2 / h * np.arctan(omega * h / 2) * sol.t), tol.STEPPED)


def test_rk4_on_the_oscillator_is_its_polynomial():
    """y1 = (1 + z + z^2/2 + z^3/6 + z^4/24) y0 with z = h A."""
    z = 0.1 * np.array([[0, 1], [-10.0, 0]])
    step = sum(np.linalg.matrix_power(z, k) / f for k, f in enumerate((1, 1, 2, 6, 24)))
    sol = zd.simulate(zd.systems.oscillator(), 10.0, step=0.1)
    assert_close(np.hstack([sol.p, sol.v]), [np.linalg.matrix_power(step, k) @ (0.1, 0) for k in range(101)], tol.STEPPED)


def test_extrapolation_is_nevilles_of_the_midpoint_rule(system):
    """The tableau of T_jk in NumPy, by the recurrence of Aitken and Neville, on (1), (8)."""
    t, y = steps_of(system, "extrapolation")
    expected, h, parts = y[0], t[1], (2, 4, 6, 8)
    for k in range(len(t) - 1):
        columns = []
        for n in parts:
            before, now = expected, expected + h / n * rate(system, t[k], expected)
            for j in range(1, n):
                before, now = now, before + 2 * h / n * rate(system, t[k] + j * h / n, now)
            columns.append(now)
        for level in range(1, len(parts)):
            columns = [columns[j + 1] + (columns[j + 1] - columns[j]) / ((parts[j + level] / parts[j])**2 - 1)
                       for j in range(len(columns) - 1)]
        expected = columns[0]
        assert_close(y[k + 1], expected, tol.STEPPED)
