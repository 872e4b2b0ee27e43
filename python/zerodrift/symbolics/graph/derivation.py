"""The terms of (1)-(6) from energies, forces and constraints. Nothing is solved or inverted on the way.

With coordinates p, their rates r = pdot = A v (1), kinetic energy T(p, r, t), potential V(p, t), generalized forces Q that
belong to v, and D for the derivative along the motion at constant v (t' = 1, p' = A v, r' = Adot v):

    M  = A^T T_rr A             d = A^T (D T_r - T_p)           f = Q - A^T V_p
    C  = Phi_p A                Phi_t                           xi = -D (C v + Phi_t)

Nonholonomic constraints are given as they are at velocity level, C v + Phi_t = 0. What T has that is not quadratic in r is
inertial force like the rest and part of d, but not of the kinetic energy v^T M v / 2. With T_0 for T at rest the power is

    Edot = Q^T v + V_t - (T - T_0)_t + (T_0)_p A v.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from ...errors import WrongValue
from .gradient import Gradient, Hessian, Slopes
from .graph import MOVING, Derivative, Graph, Node

Matrix = list[list[Node]]


@dataclass
class Given:
    """Definition of a system as nodes. If `A` is None, it is the identity, and pdot = v."""

    nq: int
    nv: int
    A: Matrix | None = None
    kinetic: Node | None = None             # in p, t and rates
    mass: Matrix | None = None              # M, with d in `bias`: given instead of `kinetic`
    bias: list[Node] | None = None
    force: list[Node] | None = None         # of what V does not describe
    potential: Node | None = None
    holonomic: list[Node] = field(default_factory=list)
    nonholonomic: list[Node] = field(default_factory=list)


class Derivation:
    """The terms of one system, each a flat list of nodes."""

    def __init__(self, graph: Graph, given: Given) -> None:
        self.graph, self.given = graph, given
        self.t = graph.leaf("t", 0)
        self.p = [graph.leaf("p", i) for i in range(given.nq)]
        self.v = [graph.leaf("v", i) for i in range(given.nv)]
        self.rate = self.v if given.A is None else [graph.leaf("rate", i) for i in range(given.nq)]
        self.pdot = self.v if given.A is None else [graph.dot(row, self.v) for row in given.A]
        self.by_position = Gradient(graph, self.p)
        self.moving = graph.derivative_along({self.t: graph.one, **dict(zip(self.p, self.pdot, strict=True))})

    def terms(self) -> dict[str, list[Node]]:
        """Nodes of A, M, d, f, Phi, C, Phi_t, xi, V and power, by name; without optional terms that vanish identically."""
        given, graph = self.given, self.graph
        kinetic = given.kinetic
        M, d = (given.mass or [], given.bias or []) if kinetic is None else self._of_kinetic_energy(kinetic)
        terms = {"A": _flat(given.A or []), "M": _flat(M), "d": d, "f": self._force(), **self._constraints()}
        if given.potential is not None:
            terms |= {"V": [given.potential], "power": [self._power(given.potential, M, d)]}
        always = ("M", "Phi", "C", "xi", "V")
        return {name: nodes for name, nodes in terms.items()
                if nodes and (name in always or any(node is not graph.zero for node in nodes))}

    def _of_kinetic_energy(self, kinetic: Node) -> tuple[Matrix, list[Node]]:
        graph, A = self.graph, self.given.A
        T = graph.multiplied_out(kinetic)
        by_rate = Gradient(graph, self.rate)
        momentum = self._listed(by_rate(T), self.rate)
        second = Hessian(graph, by_rate, T)
        T_rr = [[second[a, b] for b in self.rate] for a in self.rate]
        if any(node.stage >= MOVING for row in T_rr for node in row):
            raise WrongValue("kinetic must be quadratic in the velocities: its mass matrix depends on them", "expression")
        D = self._derivative_at_constant_v()
        slopes = self._listed(self.by_position(T), self.p)
        kind = self.rate[0].content[0]      # rates of differences of angles are multiplied out: most of their products cancel
        d = [graph.collected(graph.plus(D(moment), graph.minus(slope)), kind)
             for moment, slope in zip(momentum, slopes, strict=True)]
        if A is None:
            return T_rr, d
        at_v = graph.substitution(dict(zip(self.rate, self.pdot, strict=True)))
        columns = _transposed(A)
        rows = [[graph.dot(T_rr_row, column) for column in columns] for T_rr_row in T_rr]
        upper = {(i, j): graph.plus(*(graph.times(column[k], rows[k][j]) for k in range(self.given.nq)))
                 for i, column in enumerate(columns) for j in range(i, self.given.nv)}
        M = [[upper[min(i, j), max(i, j)] for j in range(self.given.nv)] for i in range(self.given.nv)]
        return M, [graph.dot(column, map(at_v, d)) for column in columns]

    def _derivative_at_constant_v(self) -> Derivative:
        """D of nodes that depend on rates: the derivative along the motion at constant v."""
        graph = self.graph
        direction = {self.t: graph.one, **dict(zip(self.p, self.rate, strict=True))}
        if self.given.A is not None:
            direction |= dict(zip(self.rate, map(self.moving, self.pdot), strict=True))
        return graph.derivative_along(direction)

    def _force(self) -> list[Node]:
        graph, given = self.graph, self.given
        force = given.force or [graph.zero] * given.nv
        if given.potential is None:
            return force
        V = graph.multiplied_out(given.potential)
        if V.stage >= MOVING:
            raise WrongValue("potential must not depend on velocities", "expression")
        gradient = self._by_velocity(V)
        return [graph.plus(q, graph.minus(slope)) for q, slope in zip(force, gradient, strict=True)]

    def _by_velocity(self, node: Node) -> list[Node]:
        """Derivatives with respect to the velocities: the gradient times A."""
        graph = self.graph
        gradient = self._listed(self.by_position(node), self.p)
        return gradient if self.given.A is None else [graph.dot(gradient, column) for column in _transposed(self.given.A)]

    def _constraints(self) -> dict[str, list[Node]]:
        graph, given = self.graph, self.given
        by_time, at_rest = graph.derivative_along({self.t: graph.one}), graph.substitution(dict.fromkeys(self.v, graph.zero))
        by_velocity = Gradient(graph, self.v)
        C, Phi_t, Psi = [], [], []
        for Phi in given.holonomic:
            C.append(self._by_velocity(Phi))
            Phi_t.append(by_time(Phi))
            Psi.append(self.moving(Phi))
        for row in given.nonholonomic:
            C.append(self._listed(by_velocity(row), self.v))
            Phi_t.append(at_rest(row))
            Psi.append(row)
        xi = [graph.minus(self.moving(row)) for row in Psi]         # (6)
        return {"Phi": given.holonomic, "C": _flat(C), "Phi_t": Phi_t, "xi": xi}

    def _listed(self, slopes: Slopes, leaves: list[Node]) -> list[Node]:
        """Gradient as a dense list."""
        return [slopes.get(leaf, self.graph.zero) for leaf in leaves]

    def _power(self, potential: Node, M: Matrix, d: Sequence[Node]) -> Node:
        graph, given = self.graph, self.given
        power = [graph.derivative_along({self.t: graph.one})(potential)]
        if given.force:
            power.append(graph.dot(given.force, self.v))
        if given.kinetic is not None:
            power.append(self._rheonomic_power(given.kinetic))
        else:       # v^T M v / 2 changes by what M does, and d need not be of the kind that balances it
            Mdot = [[self.moving(entry) for entry in row] for row in M]
            half = graph.dot(self.v, [graph.dot(row, self.v) for row in Mdot])
            power += [graph.sum([(half, 0.5)]), graph.minus(graph.dot(self.v, d)) if d else graph.zero]
        return graph.plus(*power)

    def _rheonomic_power(self, T: Node) -> Node:
        graph = self.graph
        at_rest = graph.substitution(dict.fromkeys(self.rate, graph.zero))(T)
        by_time = graph.derivative_along({self.t: graph.one})
        at_velocity = graph.substitution(dict(zip(self.rate, self.pdot, strict=True)))
        by_motion = graph.derivative_along(dict(zip(self.p, self.pdot, strict=True)))(at_rest)
        return graph.plus(graph.minus(at_velocity(by_time(T))), by_time(at_rest), by_motion)


def _flat(matrix: Matrix) -> list[Node]:
    return [node for row in matrix for node in row]


def _transposed(matrix: Matrix) -> Matrix:
    return [list(column) for column in zip(*matrix, strict=True)]
