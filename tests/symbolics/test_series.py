"""Taylor series that are written for compiled systems: of each kind of operation against mpmath."""

import mpmath
import numpy as np
import pytest
import sympy

import zerodrift as zd

t, k = sympy.symbols("t k", real=True)
u = t + sympy.Rational(3, 10) * t**2        # of which all sums are needed that there are
KINDS = {
    "sine": sympy.sin(u), "cosine": sympy.cos(2 * u), "tangent": sympy.tan(u / 2), "exponential": sympy.exp(-u),
    "logarithm": sympy.log(1 + u), "root": sympy.sqrt(2 + u), "square": (1 + u)**2, "product": sympy.sin(t) * sympy.exp(u),
    "quotient": (1 + t) / (2 + u), "inverse": 1 / (1 + u), "over a number": (t**2 + t) / k,
    "power": (1 + u)**sympy.Rational(7, 10), "negative power": (1 + u)**sympy.Rational(-5, 4), "power of a number": 2**u,
    "power of itself": (1 + u)**u, "parameter": sympy.sin(k) * t + sympy.exp(k * t), "arc sine": sympy.asin(u / 3),
    "arc cosine": sympy.acos(u / 3), "arc tangent": sympy.atan(u), "angle": sympy.atan2(1 + t, 2 - t**2),
    "angle from above": sympy.atan2(1, 1 + u), "angle from beside": sympy.atan2(u, 2), "sinh": sympy.sinh(u),
    "cosh": sympy.cosh(u), "tanh": sympy.tanh(u), "asinh": sympy.asinh(u), "acosh": sympy.acosh(2 + u),
    "atanh": sympy.atanh(u / 2), "sums": 3 - u + t * (1 - t) - k, "nested": sympy.sin(sympy.exp(sympy.sin(u)) / (1 + t)),
}


@pytest.fixture(scope="module")
def of_kinds():
    """One coordinate for each of them, whose acceleration that is; and the coefficients of these at t = 0.4."""
    q, v = sympy.symbols(f"q:{len(KINDS)}"), sympy.symbols(f"v:{len(KINDS)}")
    system = zd.symbolic(q, speeds=v, kinetic=sum(rate**2 for rate in v) / 2, force=list(KINDS.values()),
                         parameters={k: 0.7}, time=t, p0=np.zeros(len(q)), v0=np.zeros(len(q)))
    order = 14
    _, found, _ = system._with_series(system._core).series(order, 0.4, system.p0, system.v0)
    return dict(zip(KINDS, (found[1:] * np.arange(1, order + 1)[:, None]).T, strict=True))


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_of_operation(of_kinds, kind):
    """Taylor coefficients against mpmath's differences, which use more digits."""
    found = of_kinds[kind]
    with mpmath.workdps(30):
        exact = mpmath.taylor(sympy.lambdify(t, KINDS[kind].subs(k, 0.7), "mpmath"), mpmath.mpf(0.4), len(found) - 1)
    exact = np.array(exact, dtype=float)
    assert np.abs(found - exact).max() <= 1e-13 * np.abs(exact).max()
    assert np.abs(exact).max() > 0
