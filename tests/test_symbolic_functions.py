"""Every function that `symbolic` takes, compiled and in Python, against SymPy's own values: also where it has none."""

import math

import numpy as np
import pytest
import sympy as sp
from sympy.codegen import cfunctions as c

import zerodrift as zd
from zerodrift.symbolics import functions
from zerodrift.symbolics.system import _compiled

X, DX, Y, DY = sp.symbols("x dx y dy")
RANDOM = np.random.default_rng(1)
LARGEST = sp.Float(np.finfo(float).max)
ARGUMENTS = [0.0, 1.0, -1.0, 0.5, -0.5, 1.5, -1.5, 2.0, -2.0, -3.0, 1e-10, -1e-10, 1e-300, 25.0, -25.0, 170.25, -170.25, 171.5, 710.0,
             -710.0, 1000.0, -1000.0, np.pi, np.pi / 2, 1e8, -1e8, np.nextafter(1.0, 2.0), np.nextafter(1.0, 0.0),
             *RANDOM.uniform(-4, 4, 20)]
PAIRS = [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (-8.0, 1 / 3), (-8.0, 3.0), (-8.0, -3.0), (0.0, 0.5), (0.0, -0.5), (2.0, -2.0),
         (2.0, 2.0), (1000.0, 200.0), (-1000.0, 201.0), (-7.5, 2.0), (7.5, -2.0), (1e-200, 1e-200), (1e200, 1e200),
         *RANDOM.uniform(-4, 4, (20, 2))]
ONE = [f for f in (*functions.TOTAL, *functions.PARTIAL, *functions.REWRITTEN)
       if f not in (sp.atan2, sp.Mod, sp.erf2, sp.adjoint, sp.transpose, sp.exp_polar, c.hypot, c.fma)]
TWO = [sp.atan2, sp.Mod, sp.erf2, c.hypot, sp.Max, sp.Min, sp.Pow, sp.Heaviside, lambda x, y: sp.log(x, y),
       lambda x, y: c.fma(x, y, 1)]
# SymPy's functions for code generation are not evaluated by it
MEANT = {c.expm1: lambda x: sp.exp(x) - 1, c.log1p: lambda x: sp.log(1 + x), c.exp2: lambda x: 2**x, c.log2: lambda x: sp.log(x, 2),
         c.log10: lambda x: sp.log(x, 10), c.hypot: lambda x, y: sp.sqrt(x**2 + y**2), c.Cbrt: sp.cbrt, c.Sqrt: sp.sqrt}


def expected(function, arguments):
    """A double; None where there is no real, finite value."""
    exact = [sp.Rational(*x.as_integer_ratio()) for x in map(float, arguments)]
    try:
        value = sp.sympify(MEANT.get(function, function)(*exact)).evalf(30)
    except (TypeError, ValueError):     # "not comparable"
        return None
    return float(value) if value.is_real and value.is_finite and abs(value) <= LARGEST else None


def forces(variables, rates, expressions):
    """Functions of coordinates that evaluate these: compiled, and in Python."""
    system = zd.symbolic(variables, speeds=rates, kinetic=sum(v**2 for v in rates) / 2, force=expressions, potential=None)
    assert system.compiled
    in_python = _compiled(system._code.python_source)

    def slow(p):
        out = {"f": np.zeros(system.nv)}
        in_python({"f"}, 0.0, list(p), [0.0] * system.nv, [], out)
        return out["f"]

    return lambda p: system.evaluate(p).f, slow


@pytest.mark.parametrize(("many", "arguments"), [(ONE, [(x,) for x in ARGUMENTS]), (TWO, PAIRS)], ids=["one argument", "two"])
def test_values_are_those_of_sympy_and_none_where_it_has_none(many, arguments):
    n, size = len(many), len(arguments[0])
    variables = sp.symbols(f"p:{n * size}")
    rates = sp.symbols(f"v:{n * size}")
    expressions = [f(*variables[i * size:(i + 1) * size]) for i, f in enumerate(many)]
    wrong = []
    for where, evaluate in zip(("C", "Python"), forces(variables, rates, [*expressions, *[0] * (n * size - n)]), strict=True):
        for given in arguments:
            for function, got in zip(many, evaluate(np.array([*given] * n, dtype=float)), strict=False):
                value = expected(function, given)
                if function is sp.atan2 and given == (0.0, 0.0):
                    value = 0.0
                fine = not math.isfinite(got) if value is None else abs(got - value) <= 4e-13 * max(abs(value), 1e-3)
                if not fine:
                    wrong.append((where, getattr(function, "__name__", "?"), given, got, value))
    assert not wrong, "\n".join(map(str, wrong))
