"""Vectorized evaluation of a program in NumPy, used to choose elimination orders before code is written."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .lowering import Lowering

ELSEWHERE = {"Abs": np.abs, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2, "asinh": np.arcsinh,
             "acosh": np.arccosh, "atanh": np.arctanh, "Pow": np.power, "Min": np.fmin, "Max": np.fmax}    # by SymPy's names
PLAIN: dict[str, np.ufunc] = {
    "+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "negative": np.negative, "root": np.sqrt, "power": np.power,
    "<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal, "==": np.equal, "!=": np.not_equal,
    "and": np.logical_and, "or": np.logical_or, "not": np.logical_not}


class Unknown(Exception):
    """Raised if a program has a function that NumPy does not have."""


def function_of(name: str) -> np.ufunc:
    """NumPy's function for SymPy's name.

    Raises
    ------
    Unknown
    """
    found = ELSEWHERE.get(name) or getattr(np, name, None)
    if not isinstance(found, np.ufunc):
        raise Unknown(name)
    return found


def evaluator(lowering: Lowering, outputs: dict[str, list[int]], parameters: np.ndarray) -> Callable[..., dict[str, np.ndarray]]:
    """A function of t (k,), p (k, nq) that gives (k, size) of each output; velocities are zero."""
    wanted = _needed(lowering, outputs)

    def evaluate(t: np.ndarray, p: np.ndarray) -> dict[str, np.ndarray]:
        leaves = {"parameter": lambda i: parameters[i], "t": lambda i: t, "p": lambda i: p[:, i]}
        values: dict[int, Any] = {}
        with np.errstate(all="ignore"):
            for number in wanted:
                code, arguments, _ = lowering.operations[number]
                if code == "leaf":
                    values[number] = leaves.get(arguments[0], lambda i: 0.0)(arguments[1])
                elif code == "number":
                    values[number] = arguments[0]
                elif code == "choice":
                    cases = [values[argument] for argument in arguments]
                    values[number] = np.select(np.broadcast_arrays(*cases[:-1:2]), np.broadcast_arrays(*cases[1:-1:2]), cases[-1])
                else:
                    of = [values[argument] for argument in lowering.operands(lowering.operations[number])]
                    name = arguments[0] if code in ("comparison", "logic") else code
                    function = function_of(arguments[0].__name__) if code == "call" else PLAIN[name]
                    values[number] = function.reduce(of) if code == "logic" and len(of) > 1 else function(*of)
        return {name: np.stack([np.broadcast_to(values[number], len(t)) for number in numbers], axis=1).astype(float)
                for name, numbers in outputs.items() if numbers}

    return evaluate


def _needed(lowering: Lowering, outputs: dict[str, list[int]]) -> list[int]:
    """Operations that the outputs depend on, in order."""
    found, waiting = set(), [number for numbers in outputs.values() for number in numbers]
    while waiting:
        number = waiting.pop()
        if number not in found:
            found.add(number)
            waiting += lowering.operands(lowering.operations[number])
    return sorted(found)
