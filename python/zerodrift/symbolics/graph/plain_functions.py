"""Elementary functions of mechanisms without user expressions, and their derivatives, independent of SymPy.

In a graph they replace SymPy's functions of the same names. `emit.writers` and `emit.closed_form` find both by name.
"""

from __future__ import annotations

from typing import Any

from ...errors import WrongType
from .graph import Graph, Node


class Function:
    """Function that a node calls; it has SymPy's name."""

    def __init__(self, name: str) -> None:
        self.__name__ = name

    def __repr__(self) -> str:
        return self.__name__


SIN, COS, FLOOR, ATAN2 = FUNCTIONS = Function("sin"), Function("cos"), Function("floor"), Function("atan2")
NAMED = {function.__name__: function for function in FUNCTIONS}


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
        if function is SIN:
            return graph.call(COS, *arguments)
        return graph.minus(graph.call(SIN, *arguments)) if function is COS else graph.zero      # between jumps
