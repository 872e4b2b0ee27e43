"""User functions given as expressions: compiled functions of time, measures, rates of measures, and parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ... import _gateway
from ..emit.writers import CWriter, indented, unwrapped
from ..graph.graph import Graph, Node
from ..graph.lowering import Lowering
from . import shared_library
from .scalar_function import HEADING, Program, computed

SYMBOL = "zd_symbolic_law"
TAKES = "const double *k, double t, const double *p, const double *v, double *out"     # as `zd_law_function`


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


class _LawWriter(CWriter):
    """Writer of C99 in which measures and rates are array elements."""

    state = "{kind}[{index}]"


def compiled(graph: Graph, said: Sequence[Node]) -> tuple[int, Any] | None:
    """Address of a compiled function that computes these terms, and its library; None without a compiler."""
    library = shared_library.library(_source(graph, said), symbols=(SYMBOL,))
    return None if library is None else (_gateway.address_of(library, SYMBOL), library)


def _source(graph: Graph, said: Sequence[Node]) -> str:
    lowering = Lowering(graph)
    results = [lowering.lower(node) for node in said]
    writer = _LawWriter(Program(lowering, results))
    lines = computed(writer)
    body = ["(void)k, (void)t, (void)p, (void)v;", *lines,
            *(f"out[{i}] = {unwrapped(writer.value(result))};" for i, result in enumerate(results))]
    return "\n".join([*HEADING, f"void {SYMBOL}({TAKES})", "{", *indented(body), "}", ""])
