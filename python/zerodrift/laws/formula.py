"""Formulas: laws as operations on t, parameters and measures. Functions, expressions of SymPy and files become these."""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import WrongValue
from ..symbolics.graph.graph import Graph, Node
from ..symbolics.graph.plain_functions import NAMED, SPLINE
from ..systems import autodiff

EXACT = {"sin", "cos", "Abs", "floor", "ceiling", "fmod", SPLINE.__name__}      # functions of the same bits everywhere
Operation = tuple[str, Any]     # a kind of node and its content, with numbers of earlier operations in place of nodes
SIGNS: dict[str, Callable[[Any, Any], bool]] = {
    "<": lambda a, b: a < b, "<=": lambda a, b: a <= b, ">": lambda a, b: a > b, ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b, "!=": lambda a, b: a != b}


def operands(kind: str, content: Any) -> tuple[Any, ...]:
    """Nodes, or operations, whose values one uses."""
    if kind in ("sum", "product"):
        return tuple(each for each, _ in content)
    if kind in ("call", "logic"):
        return tuple(content[1])
    if kind == "comparison":
        return tuple(content[1:])
    if kind == "choice":
        return (*(each for case in content[0] for each in case), content[1])
    return ()


def with_operands(kind: str, content: Any, of: Callable[[Any], Any]) -> Any:
    """Content with other operands."""
    if kind in ("sum", "product"):
        return tuple((of(each), number) for each, number in content)
    if kind in ("call", "logic"):
        return content[0], tuple(map(of, content[1]))
    if kind == "comparison":
        return content[0], of(content[1]), of(content[2])
    if kind == "choice":
        return tuple((of(condition), of(value)) for condition, value in content[0]), of(content[1])
    return content


def leaf(graph: Graph, name: Any) -> Node:
    """Leaf of a graph for the name of a quantity, or for a table."""
    return graph.leaf("p", name)


def operations(roots: Iterable[Node]) -> tuple[list[Operation], list[int]]:
    """Operations of nodes whose leaves are from `leaf`, operands first, and those whose values the nodes are."""
    roots, found = list(roots), set[Node]()
    waiting = list(roots)
    while waiting:
        node = waiting.pop()
        if node not in found:
            found.add(node)
            waiting += operands(node.kind, node.content)
    ordered = sorted(found, key=lambda node: node.number)
    numbers = {node: i for i, node in enumerate(ordered)}
    return [(node.kind, node.content[1] if node.kind == "leaf" else node.content[0] if node.kind == "number" else
             _named(with_operands(node.kind, node.content, numbers.__getitem__), node.kind)) for node in ordered], [
                 numbers[root] for root in roots]


def _named(content: Any, kind: str) -> Any:
    return (content[0].__name__, content[1]) if kind == "call" else content


class Formula:
    """Operations, the last of which is the result: a leaf (a name, or a table), a number, or of the kinds of a graph's nodes."""

    def __init__(self, operations: Sequence[Operation]) -> None:
        self.operations = tuple(operations)

    @classmethod
    def of(cls, node: Node) -> Formula:
        """Formula of a node whose leaves are from `leaf`."""
        return cls(operations([node])[0])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Formula) and self.operations == other.operations

    def __hash__(self) -> int:
        return hash(self.operations)

    def _leaves(self, kind: type) -> list[Any]:
        return [content for kind_, content in self.operations if kind_ == "leaf" and isinstance(content, kind)]

    @property
    def names(self) -> list[str]:
        """Names of the quantities that it depends on."""
        return self._leaves(str)

    @property
    def tables(self) -> list[Any]:
        """Tables that it reads."""
        return [table for table in self._leaves(object) if not isinstance(table, str)]

    @property
    def of_library(self) -> list[str]:
        """Functions of the C library that it calls: their last bits differ between machines."""
        called = {content[0] for kind, content in self.operations if kind == "call"} - EXACT
        has_powers = any(2 * exponent % 1 for kind, content in self.operations if kind == "product" for _, exponent in content)
        return sorted(called | {"Pow"} if has_powers else called)

    def renamed(self, names: Mapping[str, str]) -> Formula:
        """The same formula of other quantities."""
        return Formula([(kind, names.get(content, content) if kind == "leaf" and isinstance(content, str) else content)
                        for kind, content in self.operations])

    def written(self, equations: Any, known: Mapping[str, Any]) -> Any:
        """Node in the graph of equations, from the nodes of its names."""
        graph, nodes = equations.graph, list[Any]()
        for kind, content in self.operations:
            given = with_operands(kind, content, nodes.__getitem__)
            match kind:
                case "leaf":
                    node = known[content] if isinstance(content, str) else equations.spline(content)
                case "number" | "sum" | "product":
                    node = getattr(graph, kind)(given)
                case "call":
                    node = graph.call(NAMED[given[0]], *given[1])
                case "logic":
                    node = graph.logic(given[0], *given[1])
                case _:
                    node = getattr(graph, kind)(*given)
            nodes.append(node)
        return nodes[-1]

    def value(self, known: Mapping[str, Any]) -> Any:
        """Value from the values of its names: floats, or with derivatives (`autodiff.Jet`). Only what is needed is computed."""
        return Evaluation(self.operations, known)(len(self.operations) - 1)

    def is_plain(self, names: set[str]) -> bool:
        """True if the result is a polynomial of these names and of sines and cosines of them."""
        varies: list[bool] = []
        for kind, content in self.operations:
            varies.append(content in names if kind == "leaf" else any(varies[each] for each in operands(kind, content)))
            if varies[-1] and not _is_plain(kind, content, varies):
                return False
        return True


def _is_plain(kind: str, content: Any, varies: list[bool]) -> bool:
    if kind == "product":
        return all(not varies[base] or (exponent > 0 and exponent == int(exponent)) for base, exponent in content)
    return kind in ("leaf", "sum") or (kind == "call" and content[0] in ("sin", "cos"))


class Evaluation:
    """Values of operations, each computed at first need."""

    def __init__(self, operations: Sequence[Operation], known: Mapping[str, Any]) -> None:
        self._operations, self._known, self.values = operations, known, dict[int, Any]()

    def __call__(self, wanted: int) -> Any:
        waiting = [wanted]
        while waiting:
            number = waiting[-1]
            kind, content = self._operations[number]
            needed = self._selected(content) if kind == "choice" else operands(kind, content)
            more = [each for each in needed if each not in self.values]
            if not more:
                self.values[waiting.pop()] = self.values[needed[-1]] if kind == "choice" else self._of(kind, content)
            waiting += more
        return self.values[wanted]

    def _selected(self, content: Any) -> tuple[int, ...]:
        """Conditions up to the first that holds or is not known yet, and in the first case its value."""
        cases, otherwise = content
        for condition, value in cases:
            if condition not in self.values:
                return (condition,)
            if self.values[condition]:
                return (value,)
        return (otherwise,)

    def _of(self, kind: str, content: Any) -> Any:
        values = self.values
        match kind:
            case "leaf":
                return self._known[content] if isinstance(content, str) else content
            case "number":
                return content if isinstance(content, int) else float(content)
            case "sum":
                return functools.reduce(operator.add, (values[each] if number == 1 else values[each] * float(number)
                                                       for each, number in content))       # -0.0 alone stays so
            case "product":
                return math.prod(_power(values[each], exponent) for each, exponent in content)
            case "call":
                return FUNCTIONS[content[0]](*(values[each] for each in content[1]))
            case "comparison":
                return SIGNS[content[0]](values[content[1]], values[content[2]])
            case _:
                parts = [values[each] for each in content[1]]
                return not parts[0] if content[0] == "not" else all(parts) if content[0] == "and" else any(parts)


# ---- values in Python ----

def _power(base: Any, exponent: Any) -> Any:
    """Power as C has it: NaN where Python's is complex, infinite where it raises."""
    if exponent == 1 or isinstance(base, autodiff.Jet) or isinstance(exponent, autodiff.Jet):
        return base if exponent == 1 else base ** (exponent if isinstance(exponent, autodiff.Jet | int) else float(exponent))
    with np.errstate(all="ignore"):
        return float(np.float64(base) ** float(exponent))


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


IN_NUMPY = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "asinh": "arcsinh", "acosh": "arccosh",
            "atanh": "arctanh"} | {name: name for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "expm1", "log",
                                                           "log1p", "log2", "log10", "hypot")}
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "Pow": _power, "Abs": abs, "fmod": _remainder, "erf": math.erf, "erfc": math.erfc,
    SPLINE.__name__: lambda table, x, _: table(x),
    "floor": lambda x: float(np.floor(autodiff.value(x))), "ceiling": lambda x: float(np.ceil(autodiff.value(x))),
    **{name: _of_numpy(of) for name, of in IN_NUMPY.items()}}


# ---- expressions of SymPy ----

def of_expression(what: str, expression: Any) -> Formula:
    """Formula of an expression of SymPy; ValueError names a function that the core lacks."""
    from ..symbolics.graph.from_sympy import Reader  # slow to import, as it imports SymPy

    reader = Reader()
    known = {symbol: leaf(reader.graph, str(symbol)) for symbol in sorted(expression.free_symbols, key=str)}
    found, _ = operations([reader.read(what, expression, known)])
    lacking = [content[0] for kind, content in found if kind == "call" and content[0] not in NAMED]
    if lacking:
        raise WrongValue(f"{what} has {lacking[0]}, of which the core knows no derivative", "expression")
    return Formula(found)
