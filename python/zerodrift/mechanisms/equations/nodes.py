"""Equations of a planar mechanism as nodes of a graph, from the plan that the core has made of its tables.

They are built from the tree of bodies and from marker quantities, as in `csrc/mechanisms`, without reference to kinds of joints.
`Derivation` derives all terms from kinetic and potential energy, forces and constraints.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import factorial
from typing import Any, NamedTuple

from ..._private.gateway.mechanisms import plans
from ..._private.gateway.mechanisms.element_tables import GeneralizedForce, Relation
from ..._private.gateway.mechanisms.plane import Quantity
from ..._private.gateway.mechanisms.plans import Link, PlanePlan
from ...symbolics.graph.derivation import Derivation, Given
from ...symbolics.graph.graph import Graph, Node
from ...symbolics.graph.plain_functions import COS, SIN
from .function_calls import Laws
from .node_relations import Relations

HALF = Fraction(1, 2)
Vector = tuple[Node, Node]


class Numbering:
    """Numbers as leaves of a graph, except zero and one.

    Numbers of one `place` that are equal or opposite share a leaf: a point of a body is the same in all elements, and terms
    cancel before code is generated.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.values: list[float] = []
        self._known: dict[tuple[Any, float], Node] = {}

    def __call__(self, value: float, *place: Any) -> Node:
        graph = self.graph
        if value in (-1.0, 0.0, 1.0):
            return graph.number(int(value))
        for sign in (1, -1) if place else ():
            if (known := self._known.get((place, sign * value))) is not None:
                return graph.sum([(known, sign)])
        leaf = self.new(value)
        if place:
            self._known[place, value] = leaf
        return leaf

    def new(self, value: float) -> Node:
        """New leaf, whatever the number is."""
        self.values.append(value)
        return self.graph.leaf("parameter", len(self.values) - 1)

    def pair(self, vector: Sequence[float], *place: Any) -> Vector:
        return self(vector[0], *place, "x"), self(vector[1], *place, "y")


def with_nodes(plan: PlanePlan, number: Numbering) -> PlanePlan[Node]:
    """Plan whose numbers are nodes."""
    links = tuple(Link(
        link.hang, link.inner, link.coordinate, number.pair(link.near, link.inner), number.pair(link.far, i),
        number.pair(link.axis, "axis", link.inner), number(link.along), number(link.angle), number(link.cosine),
        number(link.sine), number(link.mass), number(link.inertia)) for i, link in enumerate(plan.links, 1))
    quantities = tuple(Quantity(
        quantity.kind, quantity.first, quantity.second, number.pair(quantity.point1, quantity.first),
        number.pair(quantity.point2, quantity.second),
        number.pair(quantity.axis, "axis", 0 if quantity.kind == "shear" else quantity.first), number(quantity.zero))
        for quantity in plan.quantities)
    rows = tuple(row_with_nodes(row, number) for row in plan.rows)
    forces = tuple(force_with_nodes(force, number) for force in plan.forces)
    return PlanePlan(links, quantities, rows, forces, number.pair(plan.gravity))


def frames_of(plan: PlanePlan[Node]) -> list[Any]:
    """Frames of joints, as `space_nodes.frames_of` gives them: in the plane there are none."""
    return []


def row_with_nodes(row: Relation, number: Numbering) -> Relation[Node]:
    return Relation(row.quantities, [number(factor) for factor in row.coefficients], number(row.constant), number(row.slope),
                    *row[4:])


def force_with_nodes(force: GeneralizedForce, number: Numbering) -> GeneralizedForce[Node]:
    return GeneralizedForce(force.kind, force.quantity, number(force.stiffness), number(force.damping), number(force.value),
                            *force[5:])


def angle_by_sine(graph: Graph, cosine: Node) -> Node:
    """Angle over its sine, theta / sin theta, from cos theta: smooth for -pi < theta < pi, without a case for theta = 0.

    The angle is halved six times: sin theta is 64 sin(theta / 64) times the cosines of theta / 2 to theta / 64. For the rest
    theta / sin theta = sum of (2 s)^2k k!^2 / (2 k + 1)! with s = sin(theta / 2), at most 0.025: ten terms are exact to 2e-33.
    """
    cosines = []
    for _ in range(6):
        cosine = graph.product([(graph.sum([(cosine, HALF), (graph.one, HALF)]), HALF)])
        cosines.append(cosine)
    square = graph.sum([(graph.one, HALF), (cosine, -HALF)])
    found = graph.zero
    for k in reversed(range(10)):
        found = graph.sum([(graph.times(square, found), 1), (graph.one, Fraction(4**k * factorial(k)**2, factorial(2 * k + 1)))])
    return graph.product([(found, 1), *((each, -1) for each in cosines)])


class Frame(NamedTuple):
    """Position of a body: mass centre, angle, and the angle's cosine and sine."""

    at: Vector
    angle: Node
    cosine: Node
    sine: Node


class Reading(NamedTuple):
    """Value and rate of a marker quantity; the value is zero where only a rate exists."""

    value: Node
    rate: Node


class Equations(Relations):
    """Energies, forces and constraints of a plan whose numbers are nodes.

    Parameters
    ----------
    reader : Reader or Plain
        Whose graph they are in; where laws are expressions, it has to be a Reader.
    sizes : tuple of int
        nq, nv, mh, mn.
    parameters : dict of str to Node
        The mechanism's own.

    Attributes
    ----------
    values : dict of Node to Node
        Nodes that replace leaves of the graph; none here.
    """

    def __init__(self, plan: PlanePlan[Node], reader: Any, sizes: tuple[int, int, int, int], laws: Laws,
                 parameters: Mapping[str, Node]) -> None:
        self.plan, self.graph, self.read, self.laws, self.parameters = plan, reader.graph, reader.read, laws, parameters
        self.values: dict[Node, Node] = {}
        self.nq, _, self.mh, _ = sizes
        graph = self.graph
        self.t = graph.leaf("t", 0)
        self.p, self.v = ([graph.leaf(kind, i) for i in range(self.nq)] for kind in "pv")
        self.rate_of = graph.derivative_along({self.t: graph.one, **dict(zip(self.p, self.v, strict=True))})
        self.frames = [Frame((graph.zero, graph.zero), graph.zero, graph.one, graph.zero)]
        for link in plan.links:
            self.frames.append(self._frame(link))
        self.readings = [self._reading(quantity) for quantity in plan.quantities]

    def terms(self) -> dict[str, list[Node]]:
        """Nodes of A, M, d, f, Phi, C, Phi_t, xi, V and power, as far as the mechanism has them."""
        return Derivation(self.graph, self._given()).terms()

    def _given(self) -> Given:
        rows = [self._row(row) for row in self.plan.rows]
        return Given(self.nq, self.nq, kinetic=self._kinetic(), force=self._force(), potential=self._potential(),
                     holonomic=rows[:self.mh], nonholonomic=rows[self.mh:])

    # ---- vectors ----

    def _plus(self, a: Vector, b: Vector) -> Vector:
        return self.graph.plus(a[0], b[0]), self.graph.plus(a[1], b[1])

    def _minus(self, a: Vector, b: Vector) -> Vector:
        return self.difference(a[0], b[0]), self.difference(a[1], b[1])

    def _rotated(self, cosine: Node, sine: Node, a: Vector) -> Vector:
        times = self.graph.times
        return (self.difference(times(cosine, a[0]), times(sine, a[1])),
                self.graph.plus(times(sine, a[0]), times(cosine, a[1])))

    def _turned(self, frame: Frame, a: Vector) -> Vector:
        """Vector in the drawing's axes, from one in a body's axes."""
        return self._rotated(frame.cosine, frame.sine, a)

    def _rates(self, a: Vector) -> Vector:
        return self.rate_of(a[0]), self.rate_of(a[1])

    # ---- the tree ----

    def _frame(self, link: Link[Node]) -> Frame:
        graph, k, inner = self.graph, link.coordinate, self.frames[link.inner]
        turn = graph.zero, graph.one, graph.zero        # of particles
        if link.hang in (plans.FREE, plans.TURNING):
            angle = self.p[k + 2 if link.hang == plans.FREE else k]
            turn = angle, graph.call(COS, angle), graph.call(SIN, angle)
        elif link.hang in (plans.SLIDING, plans.FIXED):
            cosine, sine = self._rotated(link.cosine, link.sine, (inner.cosine, inner.sine))
            turn = graph.plus(inner.angle, link.angle), cosine, sine
        if link.hang in (plans.FREE, plans.FREE_POINT):
            return Frame((self.p[k], self.p[k + 1]), *turn)
        near = link.near
        if link.hang == plans.SLIDING:
            way = graph.plus(self.p[k], link.along)
            near = self._plus(near, (graph.times(way, link.axis[0]), graph.times(way, link.axis[1])))
        at = self._plus(inner.at, self._turned(inner, near))
        return Frame(self._plus(at, self._rotated(turn[1], turn[2], link.far)), *turn)

    # ---- marker quantities ----

    def _reading(self, quantity: Quantity[Node]) -> Reading:
        graph, first, second = self.graph, self.frames[quantity.first], self.frames[quantity.second]
        if quantity.kind == "angle":
            return self._read(self.difference(second.angle, first.angle), quantity.zero)
        axis = (graph.minus(quantity.axis[1]), quantity.axis[0]) if quantity.kind in ("across", "skid") else quantity.axis
        there = self._plus(second.at, self._turned(second, quantity.point2))
        if quantity.kind in ("glide", "skid"):
            return Reading(graph.zero, graph.dot(self._turned(first, axis), self._rates(there)))
        if quantity.kind == "shear":
            apart, turn = self._minus(there, first.at), self.rate_of(first.angle)
            rate = self._rates(apart)
            return Reading(graph.zero, graph.dot(axis, (graph.plus(rate[0], graph.times(turn, apart[1])),
                                                        self.difference(rate[1], graph.times(turn, apart[0])))))
        if quantity.kind in ("along", "across"):       # the first body's own point is at rest in its axes
            value = graph.dot(self._turned(first, axis), self._minus(there, first.at))
            return self._read(value, graph.plus(graph.dot(axis, quantity.point1), quantity.zero))
        apart = self._minus(there, self._plus(first.at, self._turned(first, quantity.point1)))
        if quantity.kind == "distance":
            return self._read(graph.product([(graph.dot(apart, apart), HALF)]), quantity.zero)
        return self._read(apart["xy".index(quantity.kind)], quantity.zero)

    def _read(self, value: Node, zero: Node) -> Reading:
        value = self.difference(value, zero)
        return Reading(value, self.rate_of(value))

    # ---- energies, forces, constraints ----

    def _kinetic(self) -> Node:
        graph, terms = self.graph, []
        for link, frame in zip(self.plan.links, self.frames[1:], strict=True):
            terms += [graph.product([(link.mass, 1), (speed, 2)]) for speed in self._rates(frame.at)]
            terms.append(graph.product([(link.inertia, 1), (self.rate_of(frame.angle), 2)]))
        return graph.sum((term, HALF) for term in terms)

    def _potential(self) -> Node:
        graph = self.graph
        weights = [(graph.times(link.mass, graph.dot(self.plan.gravity, frame.at)), -1)
                   for link, frame in zip(self.plan.links, self.frames[1:], strict=True)]
        springs = [(graph.product([(force.stiffness, 1), (self.readings[force.quantity].value, 2)]), HALF)
                   for force in self.plan.forces]
        return graph.sum([*weights, *springs])

    def _force(self) -> list[Node]:
        """Generalized forces without a potential."""
        graph, forces = self.graph, []
        for force in self.plan.forces:
            rate = self.readings[force.quantity].rate
            said = self._law(force.law, force.inputs) if force.kind == "law" else force.value
            forces.append((self.difference(said, graph.times(force.damping, rate)), rate))
        along = [graph.derivative_along({v: graph.one}) for v in self.v]
        return [graph.plus(*(graph.times(value, of(rate)) for value, rate in forces if value is not graph.zero)) for of in along]
