"""Derivatives of rates that are written for compiled systems: of each kind of operation against mpmath, and of all of (8)."""

import mpmath
import numpy as np
import pytest
import sympy

import tolerances as tol
import zerodrift as zd
from random_symbolic import random_system
from support import along, assert_close, consistent_states, numbers, rate, refused, solved

t, k, s, w = sympy.symbols("t k s w", real=True)
u = s + sympy.Rational(3, 10) * s * w       # w is the rate of s
KINDS = {
    "sine": sympy.sin(u), "cosine": sympy.cos(2 * u), "tangent": sympy.tan(u / 2), "exponential": sympy.exp(-u),
    "logarithm": sympy.log(1 + u), "root": sympy.sqrt(2 + u), "square": (1 + u)**2, "product": sympy.sin(s) * sympy.exp(w),
    "quotient": (1 + s) / (2 + u), "inverse": 1 / (1 + u), "over a number": (s**2 + w) / k,
    "power": (1 + u)**sympy.Rational(7, 10), "negative power": (1 + u)**sympy.Rational(-5, 4), "power of a number": 2**u,
    "power of itself": (1 + u)**u, "parameter": sympy.sin(k) * s + sympy.exp(k * w), "arc sine": sympy.asin(u / 3),
    "arc cosine": sympy.acos(u / 3), "arc tangent": sympy.atan(u), "angle": sympy.atan2(1 + s, 2 - w**2),
    "angle from above": sympy.atan2(1, 1 + u), "angle from beside": sympy.atan2(u, 2), "sinh": sympy.sinh(u),
    "cosh": sympy.cosh(u), "tanh": sympy.tanh(u), "asinh": sympy.asinh(u), "acosh": sympy.acosh(2 + u),
    "atanh": sympy.atanh(u / 2), "sums": 3 - u + s * (1 - w) - k * t, "nested": sympy.sin(sympy.exp(sympy.sin(u)) / (1 + s)),
}


def jacobian_of(system, at, p, v):
    """Jacobian of (pdot, vdot), and of the power in a last row if the system has any, as passed to the core."""
    return system._with_jacobian(system._core).jacobian(at, p, v)


@pytest.fixture(scope="module")
def of_kinds():
    """One coordinate for each of them, whose acceleration that is; and its derivatives by s = 0.4 and w = 0.2."""
    q, v = sympy.symbols(f"q:{len(KINDS)}"), sympy.symbols(f"v:{len(KINDS)}")
    system = zd.symbolic([s, *q], speeds=[w, *v], kinetic=(w**2 + sum(each**2 for each in v)) / 2, force=[0, *KINDS.values()],
                         parameters={k: 0.7}, time=t, p0=np.zeros(len(q) + 1), v0=np.zeros(len(q) + 1))
    n = system.nq
    J = jacobian_of(system, 0.3, np.eye(n)[0] * 0.4, np.eye(n)[0] * 0.2)
    return dict(zip(KINDS, J[n + 1:2 * n, [0, n]], strict=True))


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_of_operation(of_kinds, kind):
    """Derivatives against mpmath's differences, which use more digits."""
    function = sympy.lambdify([s, w], KINDS[kind].subs({k: 0.7, t: 0.3}), "mpmath")
    with mpmath.workdps(30):
        exact = [mpmath.diff(function, (mpmath.mpf(0.4), mpmath.mpf(0.2)), by) for by in ((1, 0), (0, 1))]
    exact = np.array(exact, dtype=float)
    assert np.abs(of_kinds[kind] - exact).max() <= 1e-13 * np.abs(exact).max()
    assert np.abs(exact).max() > 0


def power(system, at, y):
    """Power of (28) without that of the potential: of forces, and of moving constraints, W."""
    p, v = np.split(y, [system.nq])
    e = numbers(system, at, p, v)
    _, multipliers = solved(e.M, e.C, e.force, e.xi)
    return e.power + multipliers @ e.Phi_t


@pytest.mark.parametrize("seed", range(6))
def test_of_random_systems_they_are_differences_of_rates_and_power(seed):
    """Driven ones, with nonholonomic rows and a kinematic matrix among them; the rates are those of (8) in NumPy."""
    system = random_system(seed)
    n = system.nq + system.nv
    for at, p, v in consistent_states(system, count=1):
        y, J = np.concatenate([p, v]), jacobian_of(system, at, p, v)

        def rates(y, at=at):
            return np.append(rate(system, at, y), power(system, at, y))

        by_differences = np.transpose([along(rates, (y, direction)) for direction in np.eye(n)])
        assert_close(J, by_differences, 10 * tol.DIFFERENCE)


x, y = sympy.symbols("x y", real=True)
RATES = sympy.symbols("xdot ydot")


def swinging(**more):
    """A particle on a circle."""
    return zd.symbolic([x, y], speeds=RATES, potential=9.81 * y, **{
        "kinetic": sum(each**2 for each in RATES) / 2, "constraints": [x**2 + y**2 - 1], "p0": [1.0, 0.0], "v0": [0.0, 0.5],
        **more})


def test_a_redundant_constraint():
    """The same circle twice: the motion is that of one of them, and so are its derivatives along it."""
    once, twice = swinging(), swinging(constraints=[x**2 + y**2 - 1, 2 * x**2 + 2 * y**2 - 2])
    of_once, of_twice = (jacobian_of(system, 0.0, once.p0, once.v0) for system in (once, twice))
    assert_close(of_twice, of_once, tol.SOLVED)


def test_a_mass_matrix_that_is_not_definite_has_none():
    """All mass in one direction, and a circle that holds the other one: (8) is regular, and its pivots would need an order."""
    system = swinging(kinetic=RATES[0]**2 / 2, v0=[0.0, 0.0], p0=[0.6, -0.8])
    with refused("mass-not-definite"):
        jacobian_of(system, 0.0, system.p0, system.v0)
    exact, found = (zd.simulate(system, 0.5, rtol=1e-8, atol=1e-8, integrator=method, formulation="augmented")
                    for method in ("dop853", "radau"))
    assert np.abs(found.p[-1] - exact.p[-1]).max() < 1e-6


@pytest.mark.parametrize(("force", "why"), [
    (sympy.Abs(y), "Abs"), (sympy.Piecewise((y, y > 0), (2 * y, True)), "choice"), (sympy.gamma(k), "gamma"),
], ids=["absolute", "cases", "gamma"])
def test_functions_without_derivatives_leave_it_to_differences(force, why):
    system = swinging(force=[force, 0], parameters={k: 2.0})
    assert system._with_jacobian(system._core) is system._core
    assert why in system._jacobian.why_none
    exact = zd.simulate(system, 0.5, rtol=1e-10, atol=1e-10, integrator="dop853").p[-1]
    assert np.abs(zd.simulate(system, 0.5, rtol=1e-8, atol=1e-8, integrator="radau").p[-1] - exact).max() < 1e-6


def test_what_would_be_too_long_is_not_written(monkeypatch):
    monkeypatch.setattr(zd.symbolics.emit.jacobian, "MAX_STATEMENTS", 3)
    assert "more than 3 statements" in swinging()._jacobian.why_none


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_of_a_mechanism_that_is_written_out(coordinates):
    """Differences of the rates of its interpreted tables, which share no code with it."""
    m = zd.Mechanism("four-bar", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0, 0.1), mass=0.5)
    rod = m.link("rod", (0, 0.1), (0.3, 0.2), mass=0.3)
    rocker = m.link("rocker", (0.3, 0.2), (0.3, 0), mass=0.4)
    for name, a, b in (("a", m.ground, crank.start), ("b", crank.end, rod.start), ("c", rod.end, rocker.start)):
        m.revolute(name, a, b)
    m.bushing("d", rocker.end, m.ground, stiffness=50.0, damping=2.0)
    written, tables = (m.system(coordinates, compiled=compiled) for compiled in (True, False))
    (at, p, v), = consistent_states(tables, count=1)
    n = tables.nq + tables.nv
    by_differences = np.transpose([along(lambda y: rate(tables, at, y), (np.concatenate([p, v]), e)) for e in np.eye(n)])
    assert_close(jacobian_of(written, at, p, v)[:n], by_differences, 10 * tol.DIFFERENCE)
