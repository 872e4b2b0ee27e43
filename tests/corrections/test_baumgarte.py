"""Baumgarte's stabilization (23), also with the integral; integrators/ compares its steps with NumPy."""

import numpy as np

import tolerances as tol
import zerodrift as zd
from support import assert_close, motion, numbers, solved


def test_baumgarte_bounds_what_drifts(bar):
    """The paper's case (b): better than nothing, worse than projection."""
    drift = {name: np.abs(motion(bar, 2.0, 200, stabilization=name).position_violation).max()
             for name in (None, "baumgarte", "projection")}
    assert drift["projection"] < drift["baumgarte"] < drift[None]


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
