"""Every function that `symbolic` takes, compiled and by programs, against SymPy's own values: also where it has none."""

import copy
import math

import numpy as np
import pytest
import sympy as sp
from sympy.codegen import cfunctions as c

import zerodrift as zd
from support import refused
from zerodrift.symbolics.graph import sympy_functions
from zerodrift.symbolics.graph.plain_functions import NAMED

X, DX, Y, DY = sp.symbols("x dx y dy")
RANDOM = np.random.default_rng(1)
LARGEST = sp.Float(np.finfo(float).max)
ARGUMENTS = [0.0, 1.0, -1.0, 0.5, -0.5, 1.5, -1.5, 2.0, -2.0, -3.0, 1e-10, -1e-10, 1e-300, 25.0, -25.0, 170.25, -170.25, 171.5,
             710.0, -710.0, 1000.0, -1000.0, np.pi, np.pi / 2, 1e8, -1e8, np.nextafter(1.0, 2.0), np.nextafter(1.0, 0.0),
             *RANDOM.uniform(-4, 4, 20)]
PAIRS = [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (-8.0, 0.7), (-8.0, 3.0), (-8.0, -3.0), (0.0, 0.5), (0.0, -0.5),
         (2.0, -2.0), (2.0, 2.0), (1000.0, 200.0), (-1000.0, 201.0), (-7.5, 2.0), (7.5, -2.0), (1e-200, 1e-200), (1e200, 1e200),
         *map(tuple, RANDOM.uniform(-4, 4, (20, 2)))]
OWN = [getattr(sp, name, None) or getattr(c, name) for name in NAMED if name not in ("zd_spline_at", "fmod")]
ONE = [f for f in (*OWN, *sympy_functions.WITH_GAMMA, *sympy_functions.REWRITTEN)
       if f not in (sp.atan2, sp.Pow, sp.Mod, sp.erf2, sp.adjoint, sp.transpose, sp.exp_polar, c.hypot, c.fma)]


def fused(x, y):
    return c.fma(x, y, 1)


TWO = [sp.atan2, sp.Mod, sp.erf2, c.hypot, sp.Max, sp.Min, sp.Pow, sp.Heaviside, lambda x, y: sp.log(x, y), fused]
# SymPy's functions for code generation are not evaluated by it
MEANT = {c.expm1: lambda x: sp.exp(x) - 1, c.log1p: lambda x: sp.log(1 + x), c.exp2: lambda x: 2**x,
         c.log2: lambda x: sp.log(x, 2), sp.erf2: lambda x, y: sp.erf(y) - sp.erf(x), fused: lambda x, y: x * y + 1,
         c.log10: lambda x: sp.log(x, 10), c.hypot: lambda x, y: sp.sqrt(x**2 + y**2), c.Cbrt: sp.cbrt, c.Sqrt: sp.sqrt}


def expected(function, arguments):
    """A double; None where there is no real, finite value."""
    exact = [sp.Integer(int(x)) if x == int(x) and abs(x) <= 1000 else sp.Float(x, 40) for x in map(float, arguments)]
    try:
        value = sp.sympify(MEANT.get(function, function)(*exact)).evalf(30)
    except (TypeError, ValueError, ZeroDivisionError):      # such as "not comparable", "Modulo by zero"
        return None
    return float(value) if value.is_real and value.is_finite and abs(value) <= LARGEST else None


def forces(variables, rates, expressions):
    """Functions of coordinates that evaluate these: compiled, and by programs."""
    system = zd.symbolic(variables, speeds=rates, kinetic=sum(v**2 for v in rates) / 2, force=expressions, potential=None)
    assert system.compiled
    by_programs = copy.copy(system)
    by_programs._core = by_programs._program_core()
    return lambda p: system.evaluate(p).f, lambda p: by_programs.evaluate(p).f


@pytest.mark.parametrize(("many", "arguments"), [(ONE, [(x,) for x in ARGUMENTS]), (TWO, PAIRS)], ids=["one argument", "two"])
def test_values_are_those_of_sympy_and_none_where_it_has_none(many, arguments):
    n, size = len(many), len(arguments[0])
    variables = sp.symbols(f"p:{n * size}")
    rates = sp.symbols(f"v:{n * size}")
    expressions = [f(*variables[i * size:(i + 1) * size]) for i, f in enumerate(many)]
    wrong = []
    for where, evaluate in zip(("C", "programs"), forces(variables, rates, [*expressions, *[0] * (n * size - n)]), strict=True):
        for given in arguments:
            for function, got in zip(many, evaluate(np.array([*given] * n, dtype=float)), strict=False):
                value = expected(function, given)
                if value == 0 and math.isnan(got) and given == (-1.0, 0.0):     # log(-1) / log(0), of which neither is real
                    continue
                if function is sp.atan2 and given == (0.0, 0.0):
                    value = 0.0
                if function is sp.asech and 0 < 1 - given[0] < 1e-15:      # acosh(1/x) magnifies the rounding of 1/x there
                    continue
                fine = not math.isfinite(got) if value is None else abs(got - value) <= 4e-13 * max(abs(value), 1e-3)
                if not fine:
                    wrong.append((where, getattr(function, "__name__", "?"), given, got, value))
    assert not wrong, "\n".join(map(str, wrong))


LOST = [sp.Max(sp.log(X), 0), sp.Min(sp.sqrt(X), 3, X), sp.sign(sp.log(X)), sp.Heaviside(sp.sqrt(X)), sp.loggamma(X),
        sp.Abs(sp.sqrt(X)), sp.Piecewise((1, sp.sqrt(X) < 1), (2, True)), sp.Piecewise((X, X > 0)),
        sp.Piecewise((1, ~(sp.acos(X) < 1)), (2, True)),
        sp.Piecewise((1, (X < 5) & (X ** sp.Rational(1, 3) < 1)), (2, True)), sp.sinc(sp.log(X)), sp.floor(sp.sqrt(X)),
        sp.Mod(sp.sqrt(X), 2), sp.acot(sp.sqrt(X)), sp.Max(0, sp.Piecewise((X, X > 0)))]


@pytest.mark.parametrize("expression", LOST, ids=str)
def test_what_is_not_a_number_is_not_lost_in_a_comparison(expression):
    """At -2, where a part of each is complex, or has no case."""
    for evaluate in forces([X], [DX], [expression]):
        assert not math.isfinite(evaluate([-2.0])[0])
        assert math.isfinite(evaluate([0.25])[0])


def test_without_a_value_there_is_no_derivative():
    """A potential of which a Piecewise has no case here does not let the system move on without force."""
    system = zd.symbolic([X], speeds=[DX], kinetic=DX**2 / 2, potential=sp.Piecewise((X**2, X < 1)))
    assert system.evaluate([0.5]).f == -1.0
    assert math.isnan(system.evaluate([2.0]).f[0])


def test_powers_of_numbers_have_derivatives():
    system = zd.symbolic([X], speeds=[DX], kinetic=DX**2 / 2, potential=2**X + sp.pi ** (2 * X) + sp.Float(0.5) ** X)
    exact = -(2**0.3 * math.log(2) + 2 * math.pi**0.6 * math.log(math.pi) - 0.5**0.3 * math.log(2))
    assert system.evaluate([0.3]).f == pytest.approx([exact], rel=1e-14)


@pytest.mark.parametrize("function", [sp.im, sp.arg, sp.beta, sp.gamma, sp.loggamma, sp.binomial, sp.fibonacci, sp.lucas,
                                      sp.catalan, sp.LambertW, sp.RisingFactorial, sp.Chi, sp.erfi, sp.erfinv, sp.digamma],
                         ids=lambda function: function.__name__)
def test_functions_that_are_not_there_are_refused_by_name(function):
    expression = function(*(X, Y)[:2 if function in (sp.beta, sp.binomial, sp.RisingFactorial) else 1])
    with refused("expression", r"has no counterpart in C|the imaginary unit"):
        zd.symbolic([X, Y], speeds=[DX, DY], kinetic=(DX**2 + DY**2) / 2, potential=expression)


# ---- symbols that look the same ----

REAL = sp.Symbol("x", real=True)
AGAIN = r"Symbol\('x', real=True\), which to SymPy is another than the x that was given, Symbol\('x'\): make it once"


@pytest.mark.parametrize(("given", "why"), [
    ({"potential": REAL**2}, f"potential has x, {AGAIN}"),
    ({"force": {REAL: 1}}, f"force must be given for velocities: x is not one, {AGAIN}"),
    ({"force": [sp.Symbol("dx", positive=True)]}, r"force has dx, Symbol\('dx', positive=True\), which to SymPy is another"),
    ({"constraints": [sp.Symbol("t", real=True) - X]}, r"constraints has t, Symbol\('t', real=True\), which to SymPy is another"),
])
def test_the_same_symbol_with_other_assumptions(given, why):
    with pytest.raises(ValueError, match=why):
        zd.symbolic([X], **({"speeds": [DX], "kinetic": DX**2 / 2} | given))


def test_the_same_function_of_another_time():
    t, q = sp.Symbol("t", real=True), sp.Function("q")
    with refused("expression", "'q'.*'t'"):
        zd.symbolic([q(sp.Symbol("t"))], speeds=[DX], kinetic=DX**2 / 2, potential=q(t), time=sp.Symbol("t"))


# ---- arguments of another kind ----


@pytest.mark.parametrize(("given", "code", "why"), [
    ({"parameters": [1, 2]}, "wrong-type", "parameters.*1, 2"),
    ({"parameters": "ab"}, "wrong-type", "parameters"),
    ({"parameters": {"a": "1"}}, "wrong-type", "'a'.*'1'"),
    ({"parameters": {"a": None}}, "wrong-type", "'a'"),
    ({"parameters": {"a": 1j}}, "wrong-type", "'a'.*not 1j"),
    ({"parameters": {"a": float("nan")}}, "not-finite", "'a'"),
    ({"force": 3.0}, "wrong-type", "force.*not 3.0"),
    ({"force": [None]}, "wrong-type", "force"),
    ({"force": [1j]}, "expression", None), ({"force": [sp.zoo]}, "expression", None),
    ({"force": [sp.nan]}, "expression", None),
    ({"force": [X < 1]}, "wrong-type", "force.*1"),
    ({"constraints": 3}, "wrong-type", "constraints"),
    ({"nonholonomic": 3}, "wrong-type", "nonholonomic"), ({"points": 3}, "wrong-type", "points"),
    ({"points": [X]}, "wrong-type", "point 0"), ({"kinetic": None, "mass": 3}, "shape", "^mass must"),
    ({"kinetic": None, "mass": [[1]], "bias": 3}, "wrong-type", "^bias must"),
    ({"kinematics": "ab"}, "shape", "kinematics"),
    ({"coordinates": None}, "wrong-type", "coordinates"), ({"speeds": 3}, "wrong-type", "speeds"),
    ({"units": 3}, "shape", "units.*be 1"), ({"potential": sp.MatrixSymbol("K", 2, 2)[0, 0]}, "expression", "0, 0"),
    ({"potential": sp.Sum(X, (Y, 0, 3))}, "expression", None),
])
def test_arguments_of_another_kind_are_named(given, code, why):
    given = {"coordinates": [X], "speeds": [DX], "kinetic": DX**2 / 2} | given
    with refused(code, why):
        zd.symbolic(given.pop("coordinates"), **given)
