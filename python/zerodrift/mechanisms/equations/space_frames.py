"""Positions and rotations of bodies in space as nodes of a graph, from the links of a plan."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from ..._private.gateway.mechanisms.element_tables import Triple, three
from ..._private.gateway.mechanisms.space_plans import Link, Way
from ...symbolics.graph.graph import Graph, Node
from ...symbolics.graph.plain_functions import COS, SIN

Vector = Triple[Node]


class Vectors:
    """Operations on vectors whose components are nodes."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.none: Vector = graph.zero, graph.zero, graph.zero

    def plus(self, *vectors: Vector) -> Vector:
        return three(self.graph.plus(*components) for components in zip(*vectors, strict=True))

    def scaled(self, factor: Node, a: Vector) -> Vector:
        return three(self.graph.times(factor, each) for each in a)

    def minus(self, a: Vector, b: Vector) -> Vector:
        return self.plus(a, three(map(self.graph.minus, b)))

    def cross(self, a: Vector, b: Vector) -> Vector:
        times, plus, minus = self.graph.times, self.graph.plus, self.graph.minus
        return three(plus(times(a[i], b[k]), minus(times(a[k], b[i]))) for i, k in ((1, 2), (2, 0), (0, 1)))


HALF = Fraction(1, 2)


class Body(NamedTuple):
    """Position and rotation of a body; a body without orientation has no axes."""

    at: Vector
    axes: Triple[Vector] | None
    spin: Vector
    own_spin: Vector        # the same in its own axes


class Frames:
    """Bodies by their numbers, and the vectors that turn with them.

    Parameters
    ----------
    links : sequence of Link
        Links whose numbers are nodes.
    graph : Graph
    nq, nv : int

    Attributes
    ----------
    bodies : dict of int to Body
    A : list of list of Node
        Rates of p in v, (nq, nv), without coordinates that depend on others.
    rate_of : Derivative
        Derivative along the motion at constant v.
    values : dict of Node to Node
        Expressions of the leaves of the graph.
    """

    def __init__(self, links: Sequence[Link[Node]], graph: Graph, nq: int, nv: int) -> None:
        self.graph, self.of, self._links = graph, Vectors(graph), links
        self.p, self.v = ([graph.leaf(kind, i) for i in range(size)] for kind, size in (("p", nq), ("v", nv)))
        self.values: dict[Node, Node] = {}
        self._with_rates: set[Node] = set()
        self.rate_of = graph.derivative_along({graph.leaf("t", 0): graph.one})
        self.A = [[graph.zero] * nv for _ in range(nq)]
        self._turned: dict[tuple[int, Vector], Vector] = {}
        still = self.of.none
        self.bodies = {0: Body(still, None, still, still)}
        for i in range(1, len(links) + 1):
            self._place(i)

    def rates(self, a: Vector) -> Vector:
        return three(map(self.rate_of, a))

    def point(self, body: int, local: Vector) -> Vector:
        """Position of a body's point, from the drawing's origin."""
        return self.of.plus(self.bodies[body].at, self.turned(body, local))

    # ---- leaves that stand for nodes ----

    def _part(self, value: Node) -> Node:
        """Leaf that stands for a node; leaves and numbers are returned unchanged."""
        if value.kind in ("leaf", "number"):
            return value
        leaf = self.graph.leaf("part", len(self.values))
        self.values[leaf] = value
        return leaf

    def _turn(self, parts: Vector, spin: Vector) -> None:
        """Set the rates of a vector of constant length, spin x itself; those of older leaves are known."""
        for leaf, rate in zip(parts, self.of.cross(spin, parts), strict=True):
            if leaf in self.values and leaf not in self._with_rates:
                self._with_rates.add(leaf)
                self.rate_of.know(leaf, rate)

    def turned(self, body: int, local: Vector) -> Vector:
        """Vector in the drawing's axes, from one in a body's axes."""
        of = self.bodies[body]
        if of.axes is None:
            return local
        if (body, local) not in self._turned:
            self._turned[body, local] = self._sum_along(of.axes, local, of.spin)
        return self._turned[body, local]

    def _sum_along(self, axes: Sequence[Vector], along: Vector, spin: Vector) -> Vector:
        """Linear combination of the axes; a multiple of one axis needs no leaves of its own."""
        zero = self.graph.zero
        found = [(axis, factor) for axis, factor in zip(axes, along, strict=True) if factor is not zero]
        if len(found) == 1:
            return self.of.scaled(found[0][1], found[0][0])
        vector = three(map(self._part, self._combined(found))) if found else self.of.none
        self._turn(vector, spin)
        return vector

    def _combined(self, found: Iterable[tuple[Vector, Node]]) -> Vector:
        """Linear combination of vectors."""
        return self.of.plus(*(self.of.scaled(factor, vector) for vector, factor in found))

    # ---- bodies ----

    def _place(self, i: int) -> None:
        if i in self.bodies:
            return
        link = self._links[i - 1]
        if link.ways is not None:
            self._place(link.inner)
        self.bodies[i] = self._free(link) if link.ways is None else self._hanging(i, link, link.ways)

    def _free(self, link: Link[Node]) -> Body:
        at = three(self.p[link.p:link.p + 3])
        for k in range(3):
            self._moves(link.p + k, link.v + k)
        if not link.turns:
            return Body(at, None, self.of.none, self.of.none)
        own = three(self.v[link.v + 3:link.v + 6])
        axes = three(three(map(self._part, axis)) for axis in self._attitude(link.p + 3, link.v + 3))
        spin = self._combined(zip(axes, own, strict=True))
        for axis in axes:
            self._turn(axis, spin)
        return Body(at, axes, spin, own)

    def _moves(self, p: int, v: int) -> None:
        """Add a coordinate whose rate is a velocity."""
        self.rate_of.know(self.p[p], self.v[v])
        self.A[p][v] = self.graph.one

    def _attitude(self, p: int, v: int) -> Triple[Vector]:
        """Axes rotated by a quaternion, and its rows of A: half of the product with its angular velocity."""
        graph, (w, x, y, z) = self.graph, self.p[p:p + 4]
        for i, row in enumerate(((x, y, z), (w, z, y), (z, w, x), (y, x, w))):
            signs = ((-1, -1, -1), (1, -1, 1), (1, 1, -1), (-1, 1, 1))[i]
            self.A[p + i][v:v + 3] = [graph.sum([(each, sign * HALF)]) for each, sign in zip(row, signs, strict=True)]
        size = self._part(graph.product([(graph.plus(*(graph.times(each, each) for each in (w, x, y, z))), -1)]))

        def entry(*terms: tuple[Node, Node, int]) -> Node:
            return graph.times(size, graph.sum((graph.times(a, b), sign) for a, b, sign in terms))

        return ((entry((w, w, 1), (x, x, 1), (y, y, -1), (z, z, -1)), entry((x, y, 2), (w, z, 2)), entry((x, z, 2), (w, y, -2))),
                (entry((x, y, 2), (w, z, -2)), entry((w, w, 1), (x, x, -1), (y, y, 1), (z, z, -1)), entry((y, z, 2), (w, x, 2))),
                (entry((x, z, 2), (w, y, 2)), entry((y, z, 2), (w, x, -2)), entry((w, w, 1), (x, x, -1), (y, y, -1), (z, z, 1))))

    def _hanging(self, i: int, link: Link[Node], ways: Iterable[Way[Node]]) -> Body:
        """Body beyond a joint: a frame moves along the joint's degrees of freedom, from the inner body's point to the outer's."""
        inner = self.bodies[link.inner]
        frame = [self.turned(link.inner, axis) for axis in link.near_axes]
        at, spin = self.of.plus(inner.at, self.turned(link.inner, link.near)), inner.spin
        for way in ways:
            at, spin = self._go(way, frame, at, spin)
        if not link.turns:
            return Body(self.of.minus(at, link.far), None, self.of.none, self.of.none)
        axes = three(self._sum_along(frame, own, spin) for own in zip(*link.far_axes, strict=True))
        own_spin = three(self.graph.dot(axis, spin) for axis in axes)
        body = self.bodies[i] = Body(at, axes, spin, own_spin)
        return body._replace(at=self.of.minus(at, self.turned(i, link.far)))

    def _go(self, way: Way[Node], frame: list[Vector], at: Vector, spin: Vector) -> tuple[Vector, Vector]:
        """Move the frame along one degree of freedom; returns its origin and its angular velocity."""
        graph, of, e = self.graph, self.of, self.of.scaled(self.graph.number(way.sign), frame[way.direction])
        if way.kind == "swings":
            return at, self._swing(way, frame, spin)
        self._moves(way.p, way.v)
        if way.kind in ("slides", "advances"):
            by = self.p[way.p] if way.kind == "slides" else graph.times(way.length, self.p[way.p])
            at = of.plus(at, of.scaled(graph.plus(way.zero, by), e))
        if way.kind in ("turns", "advances"):
            spin = of.plus(spin, of.scaled(self.v[way.v], e))
            self._turn_frame(way, frame, spin)
        return at, spin

    def _swing(self, way: Way[Node], frame: list[Vector], spin: Vector) -> Vector:
        """Rotate the frame by a quaternion; returns its angular velocity in the rotated axes."""
        turned = [three(map(self._part, axis)) for axis in self._attitude(way.p, way.v)]
        frame[:] = [three(map(self._part, self._combined(zip(frame, axis, strict=True)))) for axis in turned]
        spin = self.of.plus(spin, self._combined(zip(frame, self.v[way.v:way.v + 3], strict=True)))
        for axis in frame:
            self._turn(axis, spin)
        return spin

    def _turn_frame(self, way: Way[Node], frame: list[Vector], spin: Vector) -> None:
        """Rotate the frame about one of its directions."""
        graph, of, i, k = self.graph, self.of, (way.direction + 1) % 3, (way.direction + 2) % 3
        c, s = (graph.call(function, self.p[way.p]) for function in (COS, SIN))
        s, a, b = graph.sum([(s, way.sign)]), frame[i], frame[k]
        turned = of.plus(of.scaled(c, a), of.scaled(s, b)), of.minus(of.scaled(c, b), of.scaled(s, a))
        for place, value in zip((i, k), turned, strict=True):
            frame[place] = three(map(self._part, value))
            self._turn(frame[place], spin)
