"""Vectors of space whose components are nodes."""

from __future__ import annotations

from ..symbolics.graph import Graph, Node

Vector = tuple[Node, Node, Node]


class Vectors:
    """What is done with the vectors of a graph."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.none: Vector = (graph.zero,) * 3

    def plus(self, *vectors: Vector) -> Vector:
        return tuple(self.graph.plus(*components) for components in zip(*vectors, strict=True))

    def scaled(self, factor: Node, a: Vector) -> Vector:
        return tuple(self.graph.times(factor, each) for each in a)

    def minus(self, a: Vector, b: Vector) -> Vector:
        return self.plus(a, tuple(map(self.graph.minus, b)))

    def cross(self, a: Vector, b: Vector) -> Vector:
        times, plus, minus = self.graph.times, self.graph.plus, self.graph.minus
        return tuple(plus(times(a[i], b[k]), minus(times(a[k], b[i]))) for i, k in ((1, 2), (2, 0), (0, 1)))
