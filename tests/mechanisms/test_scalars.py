"""SymPy expressions as formulas, evaluated in Python: against SymPy's own numbers and differences of them."""

import numpy as np
import pytest
import sympy as sp

from zerodrift.laws.formula import of_expression
from zerodrift.systems.autodiff import Jet

x, y = sp.symbols("x y", real=True)
ONE = ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "Abs",
       "sign", "floor",
       "ceiling", "Heaviside")
TWO = ("atan2", "Min", "Max", "Mod")
CASES = sp.Piecewise((x**3, x < 0.3), (sp.pi * x - sp.E, (x < 2) & (y > 0) & sp.Ne(x, 1)), (1, True))
OTHERS = [CASES, sp.cot(x) + sp.Rational(1, 3) * sp.sqrt(x), sp.Piecewise((x, sp.Eq(x, y)), (-x, True))]


@pytest.mark.parametrize("expression",
                         [*(getattr(sp, name)(*((x, y) if name in TWO else (x,))) for name in (*ONE, *TWO)), *OTHERS],
                         ids=str)
@pytest.mark.parametrize("at", [(0.37, 0.61), (-1.7, 0.6), (1.21, -0.5)])
def test_values_and_derivatives(expression, at):
    formula, exact = of_expression("law", expression), sp.lambdify([x, y], expression, "mpmath")

    def function(x, y):
        return formula.value({"x": x, "y": y})
    try:
        expected = [float(exact(sp.Float(at[0] + k * 1e-3, 40), sp.Float(at[1], 40))) for k in (-1, 0, 1)]
    except TypeError:       # complex there
        pytest.skip("no real number there")
    jet = function(Jet(at[0], np.array([1.0, 0.0]), 2.0, 0.0), at[1])
    assert function(*at) == pytest.approx(expected[1], rel=1e-14)
    slope, bend = (expected[2] - expected[0]) / 2e-3, (expected[0] - 2 * expected[1] + expected[2]) / 1e-6
    jet = jet if isinstance(jet, Jet) else Jet(float(jet))
    assert jet.value == pytest.approx(expected[1], rel=1e-14)
    assert jet.first == pytest.approx(2 * slope, rel=1e-4, abs=1e-9)
    assert jet.second == pytest.approx(4 * bend, rel=1e-3, abs=1e-6)
