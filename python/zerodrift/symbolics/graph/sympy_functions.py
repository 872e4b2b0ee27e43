"""Supported functions of SymPy, and the expressions that replace some of them.

For real arguments, a function has SymPy's value if that is real, and NaN if it is complex or undefined; at poles it is not
finite. A NaN in a comparison makes the result NaN. One convention is C's: atan2(0, 0) is 0, where SymPy has no value.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy
from sympy.codegen import cfunctions

from .plain_functions import NAMED

TOTAL = [NAMED[name] for name in (
    "sin", "cos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "exp", "Abs", "erf", "erfc", "floor", "ceiling", "expm1",
    "hypot")]       # have a value wherever arguments have
WITH_GAMMA = sympy.gamma, sympy.loggamma
WITHIN: dict[Any, Callable[..., Any]] = {sympy.loggamma: lambda x: x > 0}       # C has another value elsewhere
IDENTICAL = (sympy.re, sympy.conjugate, sympy.adjoint, sympy.transpose)         # of real numbers
REWRITTEN: dict[Any, Callable[..., Any]] = {
    sympy.sec: lambda x: 1 / sympy.cos(x), sympy.csc: lambda x: 1 / sympy.sin(x), sympy.cot: lambda x: 1 / sympy.tan(x),
    sympy.sech: lambda x: 1 / sympy.cosh(x), sympy.csch: lambda x: 1 / sympy.sinh(x), sympy.coth: lambda x: 1 / sympy.tanh(x),
    sympy.acot: lambda x: sympy.Piecewise((sympy.atan(1 / x), sympy.Ne(x, 0)), (sympy.pi / 2, True)),
    sympy.asec: lambda x: sympy.acos(1 / x), sympy.acsc: lambda x: sympy.asin(1 / x), sympy.asech: lambda x: sympy.acosh(1 / x),
    sympy.acsch: lambda x: sympy.asinh(1 / x), sympy.acoth: lambda x: sympy.atanh(1 / x),
    sympy.Mod: lambda x, y: x - y * sympy.floor(x / y), sympy.frac: lambda x: x - sympy.floor(x),
    sympy.sign: lambda x: sympy.Piecewise((1, x > 0), (-1, x < 0), (0, True)),
    sympy.Heaviside: lambda x, middle: sympy.Piecewise((0, x < 0), (middle, sympy.Eq(x, 0)), (1, True)),
    sympy.sinc: lambda x: sympy.Piecewise((sympy.sin(x) / x, sympy.Ne(x, 0)), (1, True)),
    sympy.exp_polar: sympy.exp, sympy.factorial: lambda x: sympy.gamma(x + 1),
    sympy.erf2: lambda x, y: sympy.erf(y) - sympy.erf(x),
    cfunctions.exp2: lambda x: 2**x, cfunctions.Cbrt: lambda x: x ** sympy.Rational(1, 3), cfunctions.Sqrt: sympy.sqrt,
    cfunctions.fma: lambda x, y, z: x * y + z, **dict.fromkeys(IDENTICAL, lambda x: x),
}


def computable(function: Any) -> bool:
    """True if C has the function, or it has a method that prints C."""
    return named(function) is not function or function in WITH_GAMMA or hasattr(function, "_ccode")


def named(function: Any) -> Any:
    """The graph's own function of the name, if it is SymPy's; any other unchanged."""
    return NAMED.get(function.__name__, function) if function.__module__.startswith("sympy.") else function
