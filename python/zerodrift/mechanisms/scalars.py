"""SymPy expressions as functions of single numbers, or of numbers with derivatives: cases choose by the value, as steps do."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..systems import jets


def _floor(x: Any) -> float:
    return float(math.floor(jets.value(x)))


def _ceiling(x: Any) -> float:
    return float(math.ceil(jets.value(x)))


def _remainder(x: Any, divisor: Any) -> Any:
    return x - divisor * _floor(x / divisor)


def _sign(x: Any) -> float:
    return float(np.sign(jets.value(x)))


# By SymPy's names, as its printer of plain Python code writes them.
FUNCTIONS: dict[str, Any] = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2,
    "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "asinh": np.arcsinh, "acosh": np.arccosh, "atanh": np.arctanh,
    "exp": np.exp, "log": np.log, "sqrt": np.sqrt, "abs": abs, "Abs": abs, "sign": _sign, "min": min, "max": max, "Min": min,
    "Max": max, "floor": _floor, "ceil": _ceiling, "ceiling": _ceiling, "Mod": _remainder, "pi": np.pi, "e": np.e}


@functools.cache
def _printer() -> Any:
    """SymPy's printer of plain Python code, with functions of ours for what Python has differently."""
    from sympy.printing.lambdarepr import LambdaPrinter

    class Printer(LambdaPrinter):
        def _print_sign(self, expression: Any) -> str:
            return f"sign({self._print(expression.args[0])})"

        def _print_Mod(self, expression: Any) -> str:
            return f"Mod({', '.join(map(self._print, expression.args))})"

    return Printer({"fully_qualified_modules": False, "inline": True, "allow_unknown_functions": True})


def function_of(names: Sequence[Any], expression: Any) -> Callable[..., Any]:
    """The expression as a function of these symbols, in their order."""
    import sympy as sp

    return sp.lambdify(names, expression, [FUNCTIONS, "numpy"], printer=_printer())
