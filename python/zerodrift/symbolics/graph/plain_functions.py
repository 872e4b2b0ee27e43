"""Elementary functions of mechanisms without user expressions, and their derivatives, independent of SymPy.

In a graph they replace SymPy's functions of the same names. `emit.writers` and `emit.closed_form` find both by name.
"""

from __future__ import annotations

from typing import Any

from ...errors import WrongType
from .graph import Graph, Node


class Function:
    """Function that a node calls; it has SymPy's name, or that of a function in C."""

    def __init__(self, name: str) -> None:
        self.__name__ = name

    def __repr__(self) -> str:
        return self.__name__


SIN, COS, FLOOR, ATAN2 = FUNCTIONS = Function("sin"), Function("cos"), Function("floor"), Function("atan2")
SPLINE = Function("zd_spline_at")       # of its address, the argument, and the order of the derivative
NAMED = {function.__name__: function for function in (*FUNCTIONS, SPLINE)}


def slope_of_spline(graph: Graph, k: int, arguments: tuple[Node, ...]) -> Node:
    """Partial derivative of a call of `SPLINE`."""
    spline, x, order = arguments
    return graph.call(SPLINE, spline, x, graph.plus(order, graph.one)) if k == 1 else graph.zero


class Plain:
    """Expression graph of sin, cos, floor and atan2 that works without SymPy, in place of a `Reader` of SymPy's expressions.

    Attributes
    ----------
    graph : Graph
    sin, cos, floor, atan2 : Function
    """

    sin, cos, floor, atan2 = FUNCTIONS

    def __init__(self) -> None:
        self.graph = Graph(self._slope)

    def read(self, what: str, expression: Any, known: Any) -> Node:
        """Raise TypeError: expressions of SymPy are read by `Reader` alone."""
        raise WrongType(f"{what} is an expression, which takes a Reader: {expression}", "expression")

    def _slope(self, function: Function, k: int, arguments: tuple[Node, ...]) -> Node:
        graph = self.graph
        if function is ATAN2:
            y, x = arguments
            size = graph.plus(graph.product([(x, 2)]), graph.product([(y, 2)]))
            return graph.product([(graph.minus(y) if k else x, 1), (size, -1)])
        if function is SPLINE:
            return slope_of_spline(graph, k, arguments)
        if function is SIN:
            return graph.call(COS, *arguments)
        return graph.minus(graph.call(SIN, *arguments)) if function is COS else graph.zero      # between jumps
