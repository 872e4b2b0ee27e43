"""Elementary functions that nodes call, and their derivatives: one text for laws, mechanisms and expressions of SymPy."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from ...errors import WrongType
from .graph import Graph, Node

HALF = Fraction(1, 2)
Slopes = Callable[..., tuple[Node, ...]]        # of a graph and the arguments: the partial derivatives


class Function:
    """Function that a node calls: SymPy's name, the name in C, and derivatives."""

    def __init__(self, name: str, slopes: Slopes, in_c: str = "") -> None:
        self.__name__, self.slopes, self.in_c = name, slopes, in_c or name

    def __repr__(self) -> str:
        return self.__name__


def _power(graph: Graph, node: Node, exponent: Any) -> Node:
    return graph.product([(node, exponent)])


def _plus_square(graph: Graph, sign: int, x: Node, constant: int = 1) -> Node:
    """Constant plus or minus x^2."""
    return graph.sum([(graph.one, constant), (_power(graph, x, 2), sign)])


def _constant(slope: Callable[[Graph], Node] = lambda graph: graph.zero) -> Slopes:
    return lambda graph, x: (slope(graph),)


def _times(graph: Graph, node: Node, factor: float) -> tuple[Node]:
    return (graph.sum([(node, factor)]),)


def _of_erf(graph: Graph, x: Node, factor: float) -> tuple[Node]:
    return _times(graph, graph.call(NAMED["exp"], _plus_square(graph, -1, x, 0)), factor / math.sqrt(math.pi))


def _of_atan2(graph: Graph, y: Node, x: Node) -> tuple[Node, Node]:
    size = graph.plus(_power(graph, x, 2), _power(graph, y, 2))
    return graph.product([(x, 1), (size, -1)]), graph.product([(graph.minus(y), 1), (size, -1)])


def _of_hypot(graph: Graph, x: Node, y: Node) -> tuple[Node, ...]:
    size = graph.call(NAMED["hypot"], x, y)
    return tuple(graph.product([(side, 1), (size, -1)]) for side in (x, y))


def _of_power(graph: Graph, base: Node, exponent: Node) -> tuple[Node, Node]:
    less = graph.call(NAMED["Pow"], base, graph.plus(exponent, graph.minus(graph.one)))
    return graph.times(exponent, less), graph.times(graph.call(NAMED["Pow"], base, exponent), graph.call(NAMED["log"], base))


def _of_remainder(graph: Graph, x: Node, y: Node) -> tuple[Node, Node]:
    """Derivatives of x less so many times y, towards zero."""
    ratio = graph.product([(x, 1), (y, -1)])
    down, up = (graph.call(NAMED[name], ratio) for name in ("floor", "ceiling"))
    return graph.one, graph.minus(graph.choice(((graph.comparison("<", ratio, graph.zero), up),), down))


def sign(graph: Graph, x: Node) -> Node:
    """Node of the sign of x, 0 at 0."""
    cases = (graph.comparison(">", x, graph.zero), graph.one), (graph.comparison("<", x, graph.zero), graph.minus(graph.one))
    return graph.choice(cases, graph.zero)


SIN: Function = Function("sin", lambda graph, x: (graph.call(COS, x),))
COS: Function = Function("cos", lambda graph, x: (graph.minus(graph.call(SIN, x)),))
ATAN2 = Function("atan2", _of_atan2)
FLOOR = Function("floor", _constant())      # between jumps
# Of the address of a table, the argument, and the order of the derivative
SPLINE: Function = Function("zd_spline_at", lambda graph, spline, x, order: (
    graph.zero, graph.call(SPLINE, spline, x, graph.plus(order, graph.one)), graph.zero))

NAMED: dict[str, Function] = {function.__name__: function for function in (
    SIN, COS, ATAN2, FLOOR, SPLINE, Function("ceiling", _constant(), "ceil"),
    Function("tan", lambda graph, x: (_plus_square(graph, 1, graph.call(NAMED["tan"], x)),)),
    Function("asin", lambda graph, x: (_power(graph, _plus_square(graph, -1, x), -HALF),)),
    Function("acos", lambda graph, x: (graph.minus(_power(graph, _plus_square(graph, -1, x), -HALF)),)),
    Function("atan", lambda graph, x: (_power(graph, _plus_square(graph, 1, x), -1),)),
    Function("sinh", lambda graph, x: (graph.call(NAMED["cosh"], x),)),
    Function("cosh", lambda graph, x: (graph.call(NAMED["sinh"], x),)),
    Function("tanh", lambda graph, x: (_plus_square(graph, -1, graph.call(NAMED["tanh"], x)),)),
    Function("asinh", lambda graph, x: (_power(graph, _plus_square(graph, 1, x), -HALF),)),
    Function("acosh", lambda graph, x: (graph.product((graph.plus(x, graph.number(by)), -HALF) for by in (-1, 1)),)),
    Function("atanh", lambda graph, x: (_power(graph, _plus_square(graph, -1, x), -1),)),
    Function("exp", lambda graph, x: (graph.call(NAMED["exp"], x),)),
    Function("expm1", lambda graph, x: (graph.call(NAMED["exp"], x),)),
    Function("log", lambda graph, x: (_power(graph, x, -1),)),
    Function("log1p", lambda graph, x: (_power(graph, graph.plus(x, graph.one), -1),)),
    Function("log2", lambda graph, x: _times(graph, _power(graph, x, -1), 1 / math.log(2))),
    Function("log10", lambda graph, x: _times(graph, _power(graph, x, -1), 1 / math.log(10))),
    Function("erf", lambda graph, x: _of_erf(graph, x, 2.0)), Function("erfc", lambda graph, x: _of_erf(graph, x, -2.0)),
    Function("Abs", lambda graph, x: (sign(graph, x),), "fabs"), Function("hypot", _of_hypot),
    Function("Pow", _of_power, "pow"), Function("fmod", _of_remainder))}


def slope(graph: Graph, function: Function, k: int, arguments: tuple[Node, ...]) -> Node:
    """Partial derivative of function(*arguments) with respect to its k-th argument."""
    return function.slopes(graph, *arguments)[k]


class Plain:
    """Expression graph that works without SymPy, in place of a `Reader` of SymPy's expressions.

    Attributes
    ----------
    graph : Graph
    """

    def __init__(self) -> None:
        self.graph = Graph(self._slope)

    def read(self, what: str, expression: Any, known: Any) -> Node:
        """Raise TypeError: expressions of SymPy are read by `Reader` alone."""
        raise WrongType(f"{what} is an expression, which takes a Reader: {expression}", "expression")

    def _slope(self, function: Function, k: int, arguments: tuple[Node, ...]) -> Node:
        return slope(self.graph, function, k, arguments)
