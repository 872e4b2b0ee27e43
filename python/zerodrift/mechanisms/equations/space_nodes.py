"""Equations of a mechanism in space as nodes of a graph, from the plan that the core has made of its tables.

A point or a direction of a body is a linear combination of the body's rotating axes, of which only the rate is needed, omega x
the vector. So each is a leaf of the graph with a known expression and rate; positions, marker quantities and constraints are sums
and products of leaves. All else follows from these and the positions of mass centres: rates, C as derivatives of rates with
respect to v, and xi by a second derivative along the motion (1) at constant v.

    M = sum of m J^T J + W^T I W        d = sum of m J^T a + W^T (I alpha + omega x I omega)        f = sum of m J^T g + others

with J and W the Jacobians with respect to v of mass centres' velocities and of angular velocities in body axes, and a and alpha
their accelerations at constant v.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import pi
from typing import Any, NamedTuple

from ..._private.gateway.mechanisms.element_tables import three
from ..._private.gateway.mechanisms.space import Quantity
from ..._private.gateway.mechanisms.space_plans import Angle, Link, SpacePlan, Way
from ...symbolics.graph.gradient import Gradient
from ...symbolics.graph.graph import Node
from ...symbolics.graph.plain_functions import ATAN2, FLOOR
from . import nodes
from .function_calls import Laws
from .node_relations import Relations
from .space_frames import Frames, Vector

XYZ = "x", "y", "z"
HALF = nodes.HALF      # type: ignore[has-type]


def with_nodes(plan: SpacePlan, number: nodes.Numbering) -> SpacePlan[Node]:
    """Plan whose numbers are nodes."""
    def point(vector: Sequence[float], body: int) -> Vector:
        return three(number(each, "point", body, axis) for each, axis in zip(vector, XYZ, strict=True))

    def direction(vector: Sequence[float], body: int) -> Vector:
        return three(number(each, "direction", body) for each in vector)

    def hung(link: Link, i: int) -> Link[Node]:
        place = link.inner, link.turns, link.p, link.v, number(link.mass), three(map(number, link.inertia))
        if link.ways is None:
            return Link(*place, None)
        ways = tuple(Way(*way[:3], number(way.zero), number(way.length), way.p, way.v) for way in link.ways)
        return Link(*place, ways, point(link.near, link.inner), point(link.far, i),
                    three(direction(each, link.inner) for each in link.near_axes),
                    three(direction(each, i) for each in link.far_axes))

    def read(quantity: Quantity) -> Quantity[Node]:
        first, second, axes = quantity.first, quantity.second, 0 if quantity.kind == "shear" else quantity.first
        shape = three(three(number(each, "shape", second) for each in row) for row in quantity.shape)
        return Quantity(quantity.kind, first, second, point(quantity.point1, first), point(quantity.point2, second),
                        direction(quantity.a, axes), direction(quantity.o, first), direction(quantity.b, second), shape,
                        number(quantity.zero), quantity.counted)

    return SpacePlan(
        tuple(hung(link, i) for i, link in enumerate(plan.links, 1)), tuple(map(read, plan.quantities)),
        tuple(nodes.row_with_nodes(row, number) for row in plan.rows),
        tuple(nodes.force_with_nodes(force, number) for force in plan.forces),
        tuple(Angle(read(of), direction(axis, of.first), place) for of, axis, place in plan.angles),
        plan.followers, three(map(number, plan.gravity)), plan.has_rates)


def frames_of(plan: SpacePlan[Node]) -> list[list[list[tuple[int, int]]]]:
    """Frames (3, 3) of the joints of the tree whose numbers are nodes: of each entry the parameter and its sign, or -1 and the
    entry.
    """
    return [[[_entry(node) for node in row] for row in frame]
            for link in plan.links if link.ways is not None for frame in (link.near_axes, link.far_axes)]


def _entry(node: Node) -> tuple[int, int]:
    if node.kind == "number":
        return -1, int(node.content[0])
    (leaf, sign), = node.content if node.kind == "sum" else ((node, 1),)
    return leaf.content[1], sign


class Equations(Relations):
    """The terms of a plan whose numbers are nodes; arguments are those of `nodes.Equations`.

    Attributes
    ----------
    values : dict of Node to Node
        Nodes that replace leaves of the graph.
    """

    def __init__(self, plan: SpacePlan[Node], reader: Any, sizes: tuple[int, int, int, int], laws: Laws,
                 parameters: Mapping[str, Node]) -> None:
        self.plan, self.graph, self.read, self.laws, self.parameters = plan, reader.graph, reader.read, laws, parameters
        self.nq, self.nv, self.mh, _ = sizes
        self.t = self.graph.leaf("t", 0)
        self.frames = frames = Frames(plan.links, self.graph, self.nq, self.nv)
        self.of, self.p, self.v, self.A, self.bodies = frames.of, frames.p, frames.v, frames.A, frames.bodies
        self.rate_of, self.values, self._rates = frames.rate_of, frames.values, frames.rates
        self._by_velocity = Gradient(self.graph, self.v)
        self.readings = [self._reading(quantity) for quantity in plan.quantities]
        self._follow()

    # ---- marker quantities ----

    def _follow(self) -> None:
        """Set the rows of A of dependent angles."""
        for angle in self.plan.angles:
            if angle.place < self.nq - self.plan.followers:
                continue
            relative = self.of.minus(*(self.bodies[body].spin for body in (angle.quantity.second, angle.quantity.first)))
            rate = self.graph.dot(self.frames.turned(angle.quantity.first, angle.axis), relative)
            if angle.axis == self.of.none:      # of a skew universal joint
                rate = self._reading(angle.quantity._replace(counted=0)).rate
            self.A[angle.place] = self._row_of(rate)

    def _row_of(self, rate: Node) -> list[Node]:
        """Coefficients of v in a rate, (nv,)."""
        slopes = self._by_velocity(rate)
        return [slopes.get(v, self.graph.zero) for v in self.v]

    def _reading(self, quantity: Quantity[Node]) -> nodes.Reading:
        graph, of, first, second = self.graph, self.of, self.bodies[quantity.first], self.bodies[quantity.second]
        Q = self.frames.point(quantity.second, quantity.point2)
        a = self.frames.turned(quantity.first, quantity.a)
        if quantity.kind == "glide":
            return nodes.Reading(graph.zero, graph.dot(a, self._rates(Q)))
        if quantity.kind == "shear":
            way = of.minus(Q, first.at)
            return nodes.Reading(graph.zero, graph.dot(quantity.a, of.plus(self._rates(way), of.cross(way, first.spin))))
        if quantity.kind in ("spin", "turn"):
            spin = second.spin if quantity.kind == "spin" else of.minus(second.spin, first.spin)
            return nodes.Reading(graph.zero, graph.dot(a, spin))
        if quantity.kind == "rotation":
            return self._read(self._rotation(quantity, a), quantity.zero)
        apart = of.minus(Q, self.frames.point(quantity.first, quantity.point1))
        if quantity.kind in ("clearance", "slip"):
            return self._contact(quantity, a, apart)
        if quantity.kind in XYZ:
            value = apart[XYZ.index(quantity.kind)]
        elif quantity.kind == "along":
            value = graph.dot(a, apart)
        elif quantity.kind == "distance":
            value = graph.product([(graph.dot(apart, apart), HALF)])
        elif quantity.kind == "cosine":
            value = graph.dot(a, self.frames.turned(quantity.second, quantity.b))
        else:
            return self._angle(quantity, a)
        return self._read(value, quantity.zero)

    def _read(self, value: Node, zero: Node) -> nodes.Reading:
        return nodes.Reading(self.difference(value, zero), self.rate_of(value))

    def _angle(self, quantity: Quantity[Node], a: Vector) -> nodes.Reading:
        """Angle of a joint, with the number of turns that brings it nearest to the coordinate that counts them."""
        graph = self.graph
        counter = self.plan.angles[quantity.counted - 1].place if quantity.counted else None
        if counter is not None and counter < self.nq - self.plan.followers:
            return self._read(self.p[counter], quantity.zero)
        b = self.frames.turned(quantity.second, quantity.b)
        value = graph.call(ATAN2, graph.dot(self.frames.turned(quantity.first, quantity.o), b), graph.dot(a, b))
        reading = self._read(value, quantity.zero)
        if counter is None:
            return reading
        away = self.difference(self.p[counter], value)
        turns = graph.call(FLOOR, graph.sum([(away, 1 / (2 * pi)), (graph.one, HALF)]))
        return reading._replace(value=graph.sum([(reading.value, 1), (turns, 2 * pi)]))

    def _rotation(self, quantity: Quantity[Node], a: Vector) -> Node:
        """Component of the rotation vector theta u / sin theta, with u the axial vector of the rotation matrix."""
        graph, of, one, zero = self.graph, self.of, self.graph.one, self.graph.zero
        axes = [self.frames.turned(quantity.first, e) for e in ((one, zero, zero), (zero, one, zero), (zero, zero, one))]
        moved = [self.frames.turned(quantity.second, row) for row in quantity.shape]
        u = of.plus(*map(of.cross, axes, moved))        # twice the axial vector
        cosine = graph.sum([*((graph.dot(*pair), HALF) for pair in zip(axes, moved, strict=True)), (one, -HALF)])
        return graph.sum([(graph.times(nodes.angle_by_sine(graph, cosine), graph.dot(a, u)), HALF)])

    def _contact(self, quantity: Quantity[Node], a: Vector, apart: Vector) -> nodes.Reading:
        """Contact point: opposite to o from Q by S o over the root of o . S o, with S the shape in the second body's axes."""
        graph, of, first, second = self.graph, self.of, self.bodies[quantity.first], self.bodies[quantity.second]
        o = self.frames.turned(quantity.first, quantity.o)
        own = o if second.axes is None else three(graph.dot(axis, o) for axis in second.axes)
        S = three(graph.dot(row, own) for row in quantity.shape)
        shaped = S if second.axes is None else of.plus(*(of.scaled(x, axis) for x, axis in zip(S, second.axes, strict=True)))
        reach = graph.product([(graph.dot(own, S), HALF)])
        way = of.scaled(graph.minus(graph.product([(reach, -1)])), shaped)
        if quantity.kind == "clearance":
            return self._read(graph.dot(o, of.plus(apart, way)), quantity.zero)
        arm = self.frames.turned(quantity.first, quantity.point1)
        point2 = of.plus(second.at, self.frames.turned(quantity.second, quantity.point2))
        there = of.minus(self._rates(point2), self._rates(first.at))
        there = of.plus(there, of.cross(second.spin, way), of.cross(of.plus(arm, apart, way), first.spin))
        return nodes.Reading(graph.zero, graph.dot(a, there))

    # ---- terms ----

    def terms(self) -> dict[str, list[Node]]:
        """Nodes of A, M, d, f, Phi, C, Phi_t, xi, V and power; terms that are zero are omitted where the interface allows it."""
        M, d = self._inertia()
        A = [node for row in self.A for node in row] if self.plan.has_rates else []
        terms = {"A": A, "M": M, "d": d, **self._forces(), **self._constraints()}
        always = ("M", "Phi", "C", "xi", "V")
        return {name: entries for name, entries in terms.items()
                if entries and (name in always or any(node is not self.graph.zero for node in entries))}

    def _inertia(self) -> tuple[list[Node], list[Node]]:
        """M and d, as sums over the velocities of the bodies."""
        graph, n = self.graph, self.nv
        mass: dict[tuple[int, int], list[Node]] = {}
        bias: list[list[Node]] = [[] for _ in range(n)]
        for weight, moving in self._moving():
            slopes = {v.content[1]: slope for v, slope in self._by_velocity(moving.rate).items()}
            for i, a in slopes.items():
                bias[i].append(graph.times(moving.force, a))
                for j, b in slopes.items():
                    if i <= j:
                        mass.setdefault((i, j), []).append(graph.times(weight, a, b))
        upper = {place: graph.plus(*terms) for place, terms in mass.items()}
        M = [upper.get((min(i, j), max(i, j)), graph.zero) for i in range(n) for j in range(n)]
        return M, [graph.plus(*terms) for terms in bias]

    def _moving(self) -> Iterable[tuple[Node, Moving]]:
        """Inertia of each velocity of a mass centre or about an own axis, with the generalized force needed for vdot = 0."""
        graph = self.graph
        for i, link in enumerate(self.plan.links, 1):
            body = self.bodies[i]
            for speed in self._rates(body.at):
                yield link.mass, Moving(speed, graph.times(link.mass, self.rate_of(speed)))
            if body.axes is None:
                continue
            changes = self._rates(body.spin) if link.ways is not None else self.of.none
            momentum = three(map(graph.times, link.inertia, body.own_spin))
            gyroscopic = self.of.cross(body.own_spin, momentum)
            for k in range(3):
                change = graph.dot(body.axes[k], changes)
                yield link.inertia[k], Moving(body.own_spin[k], graph.plus(graph.times(link.inertia[k], change), gyroscopic[k]))

    def _forces(self) -> dict[str, list[Node]]:
        """f, V and the power of forces without a potential."""
        graph = self.graph
        f: list[list[Node]] = [[] for _ in self.v]
        V, power = [], []
        for i, link in enumerate(self.plan.links, 1):
            at = self.bodies[i].at
            V.append(graph.minus(graph.times(link.mass, graph.dot(self.plan.gravity, at))))
            for speed, g in zip(self._rates(at), self.plan.gravity, strict=True):
                self._push(f, graph.times(link.mass, g), speed)
        for force in self.plan.forces:
            value, rate = self.readings[force.quantity]
            said = self._law(force.law, force.inputs) if force.kind == "law" else force.value
            said = self.difference(said, graph.times(force.damping, rate))
            other = self.readings[force.inputs[0]].value if force.kind == "spring" and force.inputs else value
            self._push(f, self.difference(said, graph.times(force.stiffness, other)), rate)
            x = [(value, 2)] if other is value else [(value, 1), (other, 1)]
            V.append(graph.sum([(graph.product([(force.stiffness, 1), *x]), HALF)]))
            power.append(graph.times(said, rate))
        return {"f": [graph.plus(*terms) for terms in f], "V": [graph.plus(*V)], "power": [graph.plus(*power)]}

    def _push(self, f: list[list[Node]], force: Node, rate: Node) -> None:
        if force is not self.graph.zero:
            for v, slope in self._by_velocity(rate).items():
                f[v.content[1]].append(self.graph.times(force, slope))

    def _constraints(self) -> dict[str, list[Node]]:
        """Phi, C, Phi_t and xi of (3), (5) and (6)."""
        graph, rows = self.graph, [self._row(row) for row in self.plan.rows]
        Psi = [*map(self.rate_of, rows[:self.mh]), *rows[self.mh:]]
        at_rest = graph.substitution(dict.fromkeys(self.v, graph.zero))
        return {"Phi": rows[:self.mh], "C": [entry for row in Psi for entry in self._row_of(row)],
                "Phi_t": [at_rest(row) for row in Psi], "xi": [graph.minus(self.rate_of(row)) for row in Psi]}


class Moving(NamedTuple):
    """Velocity, and the force that it requires at constant velocities of the mechanism."""

    rate: Node
    force: Node
