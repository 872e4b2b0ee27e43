"""Constraints and forces along marker quantities as nodes of a graph, in the plane and in space."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ..._private.gateway.mechanisms.element_tables import Relation
from ...symbolics.graph.graph import Graph, Node
from .function_calls import Laws


class Relations:
    """Constraints and forces as functions of marker quantities.

    Attributes
    ----------
    graph : Graph
    readings : sequence
        Value and rate of each marker quantity.
    laws : Laws
    t : Node
        Time.
    parameters : dict of Node
        By name, and numbers that stand for tables.
    """

    graph: Graph
    readings: Sequence[Any]
    laws: Laws
    t: Node
    parameters: Mapping[Any, Node]

    def spline(self, table: Any) -> Node:
        """Node of the number that stands for a table."""
        return self.parameters[table]

    def difference(self, a: Node, b: Node) -> Node:
        return self.graph.plus(a, self.graph.minus(b))

    def _of(self, quantities: Iterable[int]) -> tuple[list[Node], list[Node]]:
        """Values and rates of marker quantities."""
        readings = [self.readings[quantity] for quantity in quantities]
        return [reading.value for reading in readings], [reading.rate for reading in readings]

    def _row(self, row: Relation[Node]) -> Node:
        graph = self.graph
        if row.law >= 0:
            return self._law(row.law, row.quantities)
        values, rates = self._of(row.quantities)
        sum_of = graph.dot(row.coefficients, rates if row.nonholonomic else values)
        return graph.plus(sum_of, graph.minus(row.constant), graph.minus(graph.times(row.slope, self.t)))

    def _law(self, law: int, quantities: Iterable[int]) -> Node:
        values, rates = self._of(quantities)
        return self.laws.rows[law].written(self, values, rates)
