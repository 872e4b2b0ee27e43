"""Formulas: user functions as operations on t, parameters and measures, in order, each of which uses earlier ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..symbolics.graph.plain_functions import NAMED, SPLINE
from ..systems import autodiff

Operation = tuple[Any, ...]     # a code, and its arguments: numbers of operations, except of the codes below
WITH_NAME = ("call", "comparison", "logic", "spline")   # the first argument is a function, a sign, a word, or a table
SIGNS: dict[str, Callable[[Any, Any], bool]] = {
    "<": lambda a, b: a < b, "<=": lambda a, b: a <= b, "==": lambda a, b: a == b, "!=": lambda a, b: a != b}


def operands(operation: Operation) -> tuple[int, ...]:
    """Operations whose values an operation uses."""
    code, *arguments = operation
    if code in ("leaf", "number"):
        return ()
    return tuple(arguments[1:] if code in WITH_NAME else arguments)


class Formula:
    """Operations, and the one whose value is the result.

    Codes are "leaf" (a name), "number", "+", "-", "*", "/", "negative", "power", "call", "spline" (a table), "comparison",
    "logic", and "choice" (a condition, the value if it holds, the value if not).
    """

    def __init__(self, operations: Sequence[Operation], result: int) -> None:
        self.operations, self.result = tuple(operations), result

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Formula) and (self.operations, self.result) == (other.operations, other.result)

    __hash__ = None     # type: ignore[assignment]

    @property
    def tables(self) -> list[Any]:
        """Tables that it reads."""
        return list(dict.fromkeys(operation[1] for operation in self.operations if operation[0] == "spline"))

    @property
    def names(self) -> list[str]:
        """Names of its leaves."""
        return [operation[1] for operation in self.operations if operation[0] == "leaf"]

    def written(self, equations: Any, known: Mapping[str, Any]) -> Any:
        """Node of the result in the graph of equations, from the nodes of its names."""
        graph, nodes = equations.graph, list[Any]()
        for code, *arguments in self.operations:
            parts = [nodes[each] for each in operands((code, *arguments))]
            match code:
                case "leaf":
                    node = known[arguments[0]]
                case "number":
                    node = graph.number(arguments[0])
                case "call":
                    node = graph.call(NAMED[arguments[0]], *parts)
                case "spline":
                    node = graph.call(SPLINE, equations.spline(arguments[0]), *parts, graph.zero)
                case "comparison":
                    node = graph.comparison(arguments[0], *parts)
                case "logic":
                    node = graph.logic(arguments[0], *parts)
                case "choice":
                    node = graph.choice(((parts[0], parts[1]),), parts[2])
                case _:
                    node = _arithmetic(graph, code, *parts)
            nodes.append(node)
        return nodes[self.result]

    def value(self, known: Mapping[str, Any]) -> Any:
        """Value from the values of its names: floats, or with derivatives (`autodiff.Jet`). Only what is needed is computed."""
        return Evaluation(self.operations, known)(self.result)

    def is_plain(self, names: set[str]) -> bool:
        """True if the result is a polynomial of these names and of sines and cosines of them."""
        varies: list[bool] = []
        for operation in self.operations:
            code, *arguments = operation
            varies.append(arguments[0] in names if code == "leaf" else any(varies[each] for each in operands(operation)))
            if varies[-1] and not self._is_plain(code, arguments, varies):
                return False
        return True

    def _is_plain(self, code: str, arguments: list[Any], varies: list[bool]) -> bool:
        if code == "power":
            exponent = self.operations[arguments[1]]
            return exponent[0] == "number" and exponent[1] >= 0 and exponent[1] == int(exponent[1])
        if code == "/":
            return not varies[arguments[1]]
        return code in ("leaf", "+", "-", "*", "negative") or (code == "call" and arguments[0] in ("sin", "cos"))


def _arithmetic(graph: Any, code: str, a: Any, b: Any = None) -> Any:
    if code == "+":
        return graph.plus(a, b)
    if code == "-":
        return graph.plus(a, graph.minus(b))
    if code == "*":
        return graph.times(a, b)
    if code == "/":
        return graph.product([(a, 1), (b, -1)])
    if code == "negative":
        return graph.minus(a)
    if b.kind != "number":
        return graph.call(NAMED["Pow"], a, b)
    exponent = b.content[0]
    return graph.product([(a, int(exponent) if exponent == int(exponent) else exponent)])


class Evaluation:
    """Values of operations, each computed at first need.

    Attributes
    ----------
    values : dict
        Those computed so far.
    """

    def __init__(self, operations: Sequence[Operation], known: Mapping[str, Any]) -> None:
        self._operations, self._known, self.values = operations, known, dict[int, Any]()

    def __call__(self, wanted: int) -> Any:
        waiting = [wanted]
        while waiting:
            number = waiting[-1]
            needed = self._needed(self._operations[number])
            more = [each for each in needed if each not in self.values]
            if not more:
                self.values[waiting.pop()] = self._of(self._operations[number], [self.values[each] for each in needed])
            waiting += more
        return self.values[wanted]

    def _needed(self, operation: Operation) -> tuple[int, ...]:
        """Operands; of a choice the condition, and then the selected one, too."""
        if operation[0] != "choice":
            return operands(operation)
        condition, value, otherwise = operation[1:]
        if condition not in self.values:
            return (condition,)
        return condition, value if self.values[condition] else otherwise

    def _of(self, operation: Operation, values: list[Any]) -> Any:
        code, *arguments = operation
        if code == "leaf":
            return self._known[arguments[0]]
        if code == "number":
            return arguments[0]
        if code == "spline":
            return arguments[0](values[0])
        if code == "comparison":
            return SIGNS[arguments[0]](*values)
        if code == "logic":
            word = arguments[0]
            return not values[0] if word == "not" else all(values) if word == "and" else any(values)
        if code == "choice":        # which has two values once its condition is known
            return values[1] if len(values) > 1 else self(arguments[1] if values[0] else arguments[2])
        return FUNCTIONS[arguments[0] if code == "call" else code](*values)


def _power(base: Any, exponent: Any) -> Any:
    """Power as C has it: NaN where Python's is complex, infinite where it raises."""
    if isinstance(base, autodiff.Jet) or isinstance(exponent, autodiff.Jet):
        return base ** exponent
    with np.errstate(all="ignore"):
        return float(np.float64(base) ** np.float64(exponent))


def _quotient(a: Any, b: Any) -> Any:
    if isinstance(a, autodiff.Jet) or isinstance(b, autodiff.Jet):
        return a / b
    with np.errstate(all="ignore"):
        return float(np.float64(a) / np.float64(b))


def _of_numpy(name: str) -> Callable[..., Any]:
    function = getattr(np, name)

    def of(*x: Any) -> Any:
        if any(isinstance(each, autodiff.Jet) for each in x):
            return function(*x)
        with np.errstate(all="ignore"):
            return float(function(*x))
    return of


def _remainder(x: Any, y: Any) -> Any:
    """fmod, whose derivative is that of x less so many times y."""
    if isinstance(x, autodiff.Jet) or isinstance(y, autodiff.Jet):
        return x - y * math.trunc(autodiff.value(x) / autodiff.value(y))
    with np.errstate(all="ignore"):
        return float(np.fmod(x, y))


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b, "/": _quotient, "negative": lambda a: -a,
    "power": _power, "Pow": _power, "Abs": abs, "floor": lambda x: float(math.floor(autodiff.value(x))),
    "ceiling": lambda x: float(math.ceil(autodiff.value(x))), "fmod": _remainder,
    "erf": lambda x: math.erf(x), "erfc": lambda x: math.erfc(x),
    **{name: _of_numpy(of or name) for name, of in {
        "sin": "", "cos": "", "tan": "", "asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "sinh": "",
        "cosh": "", "tanh": "", "asinh": "arcsinh", "acosh": "arccosh", "atanh": "arctanh", "exp": "", "expm1": "", "log": "",
        "log1p": "", "log2": "", "log10": "", "hypot": ""}.items()}}
