"""Terms of user functions of time, measures, rates of measures, and parameters, as nodes of a graph."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .graph import Graph, Node


class Leaves:
    """Leaves of the expression of a user function of k measures: the measures are p, their rates are v."""

    def __init__(self, graph: Graph, k: int) -> None:
        self.graph, self.t = graph, graph.leaf("t", 0)
        self.x, self.xdot = ([graph.leaf(kind, i) for i in range(k)] for kind in "pv")

    def holonomic(self, g: Node) -> list[Node]:
        """Terms of a constraint g(t, x) = 0: g, dg/dx_i, dg/dt, and what (6) has without second derivatives of measures."""
        along = self._along()
        return [g, *self._slopes(g, self.x), self.graph.derivative_along({self.t: self.graph.one})(g), along(along(g))]

    def nonholonomic(self, h: Node) -> list[Node]:
        """Terms of a constraint h = a_i(t, x) xdot_i + a_0(t, x) = 0: zero, a_i, a_0, and da_i/dt xdot_i + da_0/dt."""
        at_rest = self.graph.substitution(dict.fromkeys(self.xdot, self.graph.zero))
        return [self.graph.zero, *self._slopes(h, self.xdot), at_rest(h), self._along()(h)]

    def _along(self) -> Any:
        """Time derivative along the motion at constant rates."""
        return self.graph.derivative_along({self.t: self.graph.one, **dict(zip(self.x, self.xdot, strict=True))})

    def _slopes(self, node: Node, leaves: Sequence[Node]) -> list[Node]:
        return [self.graph.derivative_along({leaf: self.graph.one})(node) for leaf in leaves]
