"""Contents of SymPy's expressions: functions with their derivatives, hostile names; and refusals, by name."""

import math

import mpmath
import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import tolerances as tol
import zerodrift as zd
from support import assert_close, refused

T = dynamicsymbols._t
Q, U = dynamicsymbols("q u")
A, B = sp.symbols("a b")
VALUES = {A: 1.7, B: -0.6}

# functions of q, with a and b for parameters
FUNCTIONS = [
    sp.sin(Q), sp.cos(A * Q), sp.tan(Q), sp.cot(Q), sp.sec(Q), sp.csc(Q), sp.asin(Q / 2), sp.acos(Q / 2), sp.atan(Q),
    sp.atan2(Q, A), sp.atan2(B, Q), sp.sinh(Q), sp.cosh(Q), sp.tanh(Q), sp.coth(Q), sp.sech(Q), sp.asinh(Q), sp.acosh(1 + Q),
    sp.atanh(Q / 2), sp.exp(B * Q), sp.log(Q), sp.log(Q, 10), sp.sqrt(A + Q), 1 / sp.sqrt(Q), Q ** sp.Rational(3, 2),
    Q ** sp.Rational(-5, 2), sp.cbrt(Q), Q**A, A**Q, Q**2.5, Q**7 / (1 + Q**2) ** 3, Q**-2, sp.Abs(Q), sp.Abs(Q - 1),
    sp.sign(Q) * Q,
    sp.Max(Q, 0.5), sp.Min(Q, A, Q**2), sp.floor(3 * Q) * Q, sp.Mod(5 * Q, A), sp.frac(3 * Q), sp.Heaviside(Q - 0.2) * Q**2,
    sp.erf(Q), sp.erfc(Q), sp.sinc(Q), sp.sqrt(Q**2 + A**2),
    sp.Piecewise((Q**2, Q < 0.5), (sp.sin(Q), (Q >= 0.5) & (Q < 1.2)), (A, True)),
    sp.Piecewise((Q**3, sp.Or(Q < 0.3, ~(Q < 1.1))), (2 * Q, sp.Ne(Q, 0))),
    sp.Piecewise((Q, A > 1), (Q**2, True)), sp.Piecewise((Q, sp.ITE(A > 1, Q > 0.5, Q < 0.5)), (Q**2, True)),
    sp.pi * Q + sp.E * Q**2 + sp.Rational(1, 3) * Q**3 + sp.sqrt(2) * Q + sp.GoldenRatio * Q, 1e-200 * Q * 10**200,
    sp.sin(sp.sin(sp.sin(Q) + A) * Q), (A + B * Q) * (A - B * Q) / (Q + A), sp.sin(Q) ** 2 * A + sp.cos(Q) ** 2 * A + Q,
    sp.sin(Q) ** 2 * A**2 + sp.cos(Q) ** 2 * A, sp.sin(3) * Q + sp.Integer(10) ** 20 * Q / 10**20,
]


def of(expression, name="symbolic"):
    """A point that moves along q in this potential."""
    return zd.symbolic([Q], kinetic=Q.diff(T) ** 2 / 2, potential=expression, parameters=VALUES, name=name)


@pytest.fixture(params=["compiled", "interpreted"])
def place(request, monkeypatch):
    if request.param == "compiled":
        yield lambda make: make()
        return
    monkeypatch.setenv("CC", "no-such-compiler")

    def make(function):
        with pytest.warns(zd.NoCompilerWarning, match="CC=no-such-compiler"):
            return function()
    yield make


def test_functions_and_their_derivatives_are_those_of_mpmath(place):
    """All in one system, each along a coordinate of its own; mpmath evaluates and differentiates them in forty digits."""
    n = len(FUNCTIONS)
    q = dynamicsymbols(f"q:{n}")
    V = sum(function.subs(Q, each) for function, each in zip(FUNCTIONS, q, strict=True))
    system = place(lambda: zd.symbolic(q, kinetic=sum(each.diff(T) ** 2 for each in q) / 2, potential=V, parameters=VALUES))
    x = sp.Symbol("x", real=True)
    exact = [sp.lambdify(x, function.subs(Q, x).subs(VALUES), "mpmath") for function in FUNCTIONS]
    for value in (0.3712, 0.9, 1.618):
        terms = system.evaluate([value] * n)
        with mpmath.workdps(40):
            for f, function, name in zip(terms.f, exact, FUNCTIONS, strict=True):
                assert_close(f, -float(mpmath.diff(function, mpmath.mpf(value))), tol.EXACT, scale=1.0, what=str(name))
            assert_close(terms.V, float(sum(function(mpmath.mpf(value)) for function in exact)), tol.EXACT)


def test_what_is_not_finite_is_so_without_a_compiler_too(place):
    system = place(lambda: of(1 / Q + sp.log(Q) + sp.asin(Q) + sp.sqrt(Q) + Q**A))
    assert math.isnan(system.evaluate([-2.0]).V)


@pytest.mark.parametrize("signal", [
    sp.sin(A * T), sp.Piecewise((0, T < 0.2), ((T - 0.2) ** 3, T < 0.5), (0.027 + (T - 0.5), True)), sp.exp(-T) * T**2])
def test_functions_of_time(signal):
    system = zd.symbolic([Q, U], kinetic=Q.diff(T) ** 2 + U.diff(T) ** 2, constraints=[Q - U * signal - signal], p0=[0.1, 0.2],
                         parameters=VALUES)
    for t in (0.1, 0.35, 0.7):
        assert zd.check(system, t=t), zd.check(system, t=t)


HOSTILE = ["lambda", "gamma", "y0", "I", "E", "pi", "k", "s", "p", "v", "t0", "want", "out", "data", "M", "ZD_M", "double",
           "int main()", "p[0]", "x*/y", "/*", "//", "ä", "λ", "速度", "a b", "a\nb", "a\\", "%s", "\"", "'", "{0}", "x12",
           "def", "None", "??/", "return;"]


def test_hostile_names_are_only_names(place):
    """Names of coordinates and of parameters do not appear in the C source."""
    n = len(HOSTILE)
    p, v = [sp.Symbol(name) for name in HOSTILE], [sp.Symbol(f"{name}'") for name in HOSTILE]
    k = [sp.Symbol(f"{name} ") for name in HOSTILE]
    values, V = {x: i + 1.0 for i, x in enumerate(k)}, sum(a * sp.sin(b) for a, b in zip(k, p, strict=True))
    system = place(lambda: zd.symbolic(p, speeds=v, kinetic=sum(x**2 for x in v) / 2, potential=V, parameters=values,
                                       p0=np.ones(n), name="*/ \n"))
    assert_close(system.evaluate().f, -np.cos(1.0) * np.arange(1.0, n + 1), tol.SAME)
    assert [x.name for x in system.coordinates] == HOSTILE
    assert_close(system.with_parameters({"lambda ": 100.0}).evaluate().f[0], -100 * np.cos(1.0), tol.SAME)
    assert system.c_source.isascii()


def test_parameters_named_like_arguments():
    self_, name = sp.symbols("self name")
    system = zd.symbolic([Q], kinetic=Q.diff(T) ** 2 / 2, potential=self_ * name * Q, parameters={self_: 2.0, "name": 3.0})
    assert system.with_parameters(**{"self": 4.0, "name": 5.0}).evaluate([0.0]).f == -20.0


def test_dummies_of_one_name_are_different():
    p, v = [sp.Dummy("x"), sp.Dummy("x")], [sp.Dummy("x"), sp.Dummy("x")]
    system = zd.symbolic(p, speeds=v, kinetic=v[0] ** 2 + v[1] ** 2 * p[0] ** 2)
    assert_close(system.evaluate([3.0, 5.0]).M, np.diag([2.0, 18.0]), tol.SAME)
    other = zd.symbolic(p, speeds=v, kinetic=v[0] ** 2 + v[1] ** 2 * p[1] ** 2)
    assert_close(other.evaluate([3.0, 5.0]).M, np.diag([2.0, 50.0]), tol.SAME)


# ---- refusals ----

X, DX = sp.Symbol("x"), sp.Symbol("dx")
OTHER = sp.Function("other")
ENERGY = Q.diff(T) ** 2 / 2


class Unknown(sp.Function):
    """A function that nothing is known of."""

    nargs = 1

    def fdiff(self, argindex=1):
        return sp.cos(self.args[0])


REFUSED = [
    ({"potential": sp.besselj(0, Q)}, "potential has besselj\\(0, q\\(t\\)\\), and besselj has no counterpart in C"),
    ({"potential": sp.zeta(Q)}, "zeta has no counterpart in C"),
    ({"potential": sp.gamma(Q)}, "the derivative of gamma has polygamma\\(0, .*\\), and polygamma has no counterpart in C"),
    ({"potential": Unknown(Q)}, "Unknown has no counterpart in C"),
    ({"potential": OTHER(T)}, "potential has other\\(t\\), a function that is neither a coordinate nor a speed"),
    ({"potential": OTHER(Q)}, "other\\(q\\(t\\)\\), a function that is neither"),
    ({"potential": sp.Symbol("stiffness") * Q}, "potential has stiffness, to which parameters gives no value"),
    ({"potential": sp.I * Q}, "potential has I, the imaginary unit; a symbol of that name is sympy.Symbol\\('I'\\)"),
    ({"potential": sp.asin(2) * Q}, "asin\\(2\\), which is no real number"),
    ({"potential": sp.oo * Q}, "no finite number|counterpart"),
    ({"potential": sp.Integer(10) ** 400 * Q}, "1000.*, a number beyond the range of doubles"),
    ({"potential": sp.Derivative(OTHER(Q), Q)}, "Derivative"),
    ({"potential": sp.Integral(sp.exp(-X**2), (X, 0, Q))}, "Integral has no counterpart in C"),
    ({"potential": Q.diff(T)}, "potential must not depend on velocities"),
    ({"potential": Q.diff(T, 2)}, "a derivative that is not the rate of a coordinate"),
    ({"potential": "q + (("}, "potential must be a SymPy expression, not 'q \\+ \\(\\('"),
    ({"potential": sp.Matrix([Q])}, "potential must be a scalar"),
    ({"potential": Q < 1}, "potential must be a scalar"),
    ({"kinetic": Q.diff(T) ** 4}, "kinetic must be quadratic in the velocities"),
    ({"kinetic": None}, "either kinetic or mass is needed"),
    ({"mass": [[1]]}, "either kinetic or mass is needed"),
    ({"bias": [1]}, "bias must be left out with kinetic"),
    ({"kinetic": None, "mass": [[1, 2]]}, "mass must have shape \\(1, 1\\)"),
    ({"kinetic": None, "mass": [[Q.diff(T)]]}, "mass must not depend on velocities"),
    ({"kinetic": None, "mass": [[1]], "bias": [1, 2]}, "bias must have 1 entries, not 2"),
    ({"force": [1, 2]}, "force must have 1 entries, one for each velocity, not 2"),
    ({"force": {U: 1}}, "force must be given for velocities: u\\(t\\) is not one"),
    ({"constraints": {"stop": Q.diff(T)}}, "constraint 'stop' must not depend on velocities: take nonholonomic"),
    ({"nonholonomic": {"slip": Q.diff(T) ** 2}}, "constraint 'slip' must be linear in the velocities"),
    ({"parameters": {A: 1.0, "a": 2.0}}, "there are two parameters named 'a'"),
    ({"parameters": {A: "heavy"}}, "parameter 'a' must be a real number, not 'heavy'"),
    ({"parameters": {Q: 1.0}}, "parameters must be symbols or names, not q\\(t\\)"),
    ({"parameters": {T: 1.0}}, "parameter t is a coordinate, a velocity or time"),
    ({"potential": A * sp.Symbol("a", real=True) * Q, "parameters": {"a": 1.0}}, "two different symbols named 'a'"),
    ({"speeds": [U, DX]}, "there are 2 speeds for 1 coordinates: then kinematics is needed"),
    ({"kinematics": [U]}, "kinematics must be given with speeds"),
    ({"speeds": [U], "kinematics": [U**2]}, "kinematics 0 must be linear in the speeds"),
    ({"speeds": [U], "kinematics": [U + 1]}, "kinematics 0 must be linear in the speeds, pdot = A v, with nothing added"),
    ({"speeds": [U], "kinematics": [U, U]}, "kinematics must have one expression for each of 1 coordinates"),
    ({"speeds": [U], "kinematics": {}}, "kinematics has nothing for Derivative\\(q\\(t\\), t\\)"),
    ({"speeds": [U], "kinematics": [U], "kinetic": U**2}, "kinetic has speed u\\(t\\), and there are kinematics: write it with"),
    ({"points": [(Q, Q), (Q,)]}, "points must all have two or three coordinates"),
    ({"points": [(Q.diff(T), Q)]}, "point 0 has Derivative"),
    ({"time": 1.0}, "time must be a symbol, not 1.0"),
    ({"time": sp.Symbol("tau")}, "coordinate q\\(t\\) must be a function of tau alone"),
    ({"p0": [1.0, 2.0]}, "p0 must have shape \\(1,\\)"),
]


@pytest.mark.parametrize(("given", "why"), REFUSED, ids=[why[:40] for _, why in REFUSED])
def test_what_cannot_be_is_refused_by_name(given, why):
    with pytest.raises((ValueError, TypeError), match=why):
        zd.symbolic([Q], **({"kinetic": ENERGY} | given))


@pytest.mark.parametrize(("coordinates", "code", "why"), [
    ([X], "missing-argument", None), ([], "duplicate-name", "coordinates"),
    ([Q, Q], "duplicate-name", "coordinates"), ([Q + 1], "wrong-type", "coordinates"),
    ("x", "wrong-type", "coordinates.*'x'")])
def test_coordinates_are_symbols(coordinates, code, why):
    with refused(code, why):
        zd.symbolic(coordinates, kinetic=ENERGY)


def test_time_may_have_another_name():
    tau = sp.Symbol("tau")
    q = sp.Function("q")(tau)
    system = zd.symbolic([q], kinetic=q.diff(tau) ** 2 / 2, potential=q * sp.sin(tau), time=tau)
    assert_close(system.evaluate([0.0], t=0.5).f, np.array([-np.sin(0.5)]), tol.SAME)


# ---- what the compiler says ----


class Misspelt(sp.Function):
    """A function whose C is wrong."""

    nargs = 1

    def fdiff(self, argindex=1):
        return sp.S.One

    def _ccode(self, printer):
        return f"mispelt({printer._print(self.args[0])})"


class Cube(sp.Function):
    """A function that says what it is in C."""

    nargs = 1

    def fdiff(self, argindex=1):
        return 3 * self.args[0] ** 2

    def _ccode(self, printer):
        x = printer._print(self.args[0])
        return f"(({x}) * ({x}) * ({x}))"


def test_a_compiler_error_shows_the_line():
    with pytest.raises(zd.CompilationFailed, match=r"refused the C source: .*mispelt.*\n  line \d+: V\[0\] = mispelt\(q0|"
                                                   r"refused the C source: .*mispelt.*\n  line \d+: V\[0\] = mispelt\(p0\);"):
        of(Misspelt(Q))


def test_functions_that_bring_their_c():
    system = of(Cube(A * Q))
    assert_close(system.evaluate([0.5]).V, np.array(0.85**3), tol.SAME)
    assert_close(system.evaluate([0.5]).f, np.array([-3 * 0.85**2 * 1.7]), tol.SAME)


def test_functions_that_bring_their_c_need_a_compiler(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.warns(zd.NoCompilerWarning), refused("needs-compiler", "the core has no function Cube"):
        of(Cube(Q))
