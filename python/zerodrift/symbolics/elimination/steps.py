"""Accelerations and corrections in closed form: constraints eliminated along an order of pivots, operation by operation.

An order is a sequence of solves, each of one to three rows of C for as many velocities by Cramer's rule. With those before it
eliminated from each row (block LU), C x = rhs becomes x = x0 + D a, and with force - M x0 projected on D,

    vdot = x0 + D a,    D^T M D a = D^T (f - d) - (M D)^T x0,    C x0 = xi
    dp   = A (x0 + D a),    D^T M D a = -(M D)^T x0,    C x0 = [Phi; 0]         and dv likewise from Psi
    C_s^T lambda = (f - d - M vdot)_s                   s: the velocities that are solved for

Where all but s is given, as formulations in independent velocities have it, dp = A x0 and dv = x0: what is given stays.

Zeros and ones take no operations, and no operation is written twice.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..graph.arithmetic import Arithmetic, Matrix, Vector, adjugate
from ..graph.lowering import Lowering
from .reduced_mass import ReducedMass


class Solve(NamedTuple):
    """Rows of C that are solved together, and the equally many velocities that they are solved for."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]


Order = tuple[Solve, ...]


class Unwritten(Exception):
    """Raised, with the reason, if no elimination is worth writing."""


class Elimination:
    """The constraints eliminated along one order; `terms` are the operations of A, M, d, f, Phi, C, Phi_t, xi, power."""

    def __init__(self, lowering: Lowering, terms: dict[str, list[int]], sizes: tuple[int, int, int, int], order: Order) -> None:
        self.do = do = Arithmetic(lowering)
        self.nq, self.nv, self.mh, mn = sizes
        self.m, self.order, self.terms = self.mh + mn, order, terms
        self.M = self._matrix("M", self.nv, self.nv)
        self.C = self._matrix("C", self.m, self.nv)
        self._factor()
        solved = {j for solve in order for j in solve.columns}
        self.free = [j for j in range(self.nv) if j not in solved]
        self.D = self._complement()
        self.MD = [[do.dot(row, column) for column in _transposed(self.D, len(self.free))] for row in self.M]
        self.mass = self._reduced_mass()

    def _vector(self, name: str, size: int) -> Vector:
        return self.terms.get(name) or [self.do.zero] * size

    def _matrix(self, name: str, rows: int, columns: int) -> Matrix:
        entries = self._vector(name, rows * columns)
        return [entries[i * columns:(i + 1) * columns] for i in range(rows)]

    # ---- C ----

    def _factor(self) -> None:
        """Factor C: U, the rows after elimination; L, the multipliers of earlier rows; and the inverse of each solve's matrix."""
        do, U = self.do, [list(row) for row in self.C]
        self.L = [[do.zero] * self.m for _ in range(self.m)]
        self.inverses: list[Matrix] = []
        self.determinants: Vector = []
        done: set[int] = set()
        for solve in self.order:
            done.update(solve.rows)
            inverse, determinant = self._inverse([[U[k][j] for j in solve.columns] for k in solve.rows])
            self.inverses.append(inverse)
            self.determinants.append(determinant)
            columns = _transposed(inverse, len(solve.rows))
            for k in (k for k in range(self.m) if k not in done):
                here = [U[k][j] for j in solve.columns]
                for row, column in zip(solve.rows, columns, strict=True):
                    self.L[k][row] = do.dot(here, column)
                for j in range(self.nv):
                    taken = do.dot([self.L[k][row] for row in solve.rows], [U[row][j] for row in solve.rows])
                    U[k][j] = do.zero if j in solve.columns else do.difference(U[k][j], taken)
        self.U = U

    def _inverse(self, B: Matrix) -> tuple[Matrix, int]:
        """The inverse of a matrix of up to three rows, and its determinant."""
        do, (entries, determinant) = self.do, adjugate(self.do, B)
        share = do.over(do.one, determinant)
        return [[do.times(entry, share) for entry in row] for row in entries], determinant

    def _backwards(self, x: Vector, right: Vector) -> Vector:
        """Back substitution: x with U x = right and given free entries."""
        do = self.do
        for solve, inverse in reversed([*zip(self.order, self.inverses, strict=True)]):
            left = [do.difference(right[k], do.dot([u for j, u in enumerate(self.U[k]) if j not in solve.columns],
                                                   [value for j, value in enumerate(x) if j not in solve.columns]))
                    for k in solve.rows]
            for j, row in zip(solve.columns, inverse, strict=True):
                x[j] = do.dot(row, left)
        return x

    def _complement(self) -> Matrix:
        """D (nv, r) with C D = 0 and the identity where velocities are free."""
        do = self.do
        unit = [[do.one if i == j else do.zero for i in range(self.nv)] for j in self.free]
        columns = [self._backwards(each, [do.zero] * self.m) for each in unit]
        return [[column[i] for column in columns] for i in range(self.nv)]

    def particular(self, right: Vector) -> Vector:
        """Particular solution x0 of C x0 = right."""
        do, y = self.do, list(right)
        for solve in self.order:
            for k in range(self.m):
                if k not in solve.rows:
                    y[k] = do.difference(y[k], do.dot([self.L[k][row] for row in solve.rows], [y[row] for row in solve.rows]))
        return self._backwards([do.zero] * self.nv, y)

    def multipliers(self, force: Vector) -> Vector:
        """Lambda with C^T lambda = force, in the velocities that are solved for."""
        do, z = self.do, [self.do.zero] * self.m
        seen: list[int] = []
        for solve, inverse in zip(self.order, self.inverses, strict=True):
            left = [do.difference(force[j], do.dot([self.U[k][j] for k in seen], [z[k] for k in seen]))
                    for j in solve.columns]
            for k, column in zip(solve.rows, _transposed(inverse, len(left)), strict=True):
                z[k] = do.dot(column, left)
            seen += solve.rows
        later: list[int] = []
        for solve in reversed(self.order):
            for row in solve.rows:
                z[row] = do.difference(z[row], do.dot([self.L[k][row] for k in later], [z[k] for k in later]))
            later += solve.rows
        return z

    # ---- D^T M D ----

    def _reduced_mass(self) -> ReducedMass:
        columns, MD = (_transposed(matrix, len(self.free)) for matrix in (self.D, self.MD))
        return ReducedMass(self.do, [[self.do.dot(column, each) for each in MD] for column in columns], self._inverted)

    def _inverted(self, determinant: int) -> int:
        """1 / the determinant of a block of D^T M D."""
        return self.do.over(self.do.one, determinant)

    def solution(self, force: Vector | None, right: Vector) -> Vector:
        """X with M x + C^T lambda = force and C x = right."""
        do, x0, r = self.do, self.particular(right), len(self.free)
        along = [do.minus(do.dot(column, x0)) for column in _transposed(self.MD, r)]
        if force is not None:
            along = [do.plus(do.dot(column, force), value) for column, value in zip(_transposed(self.D, r), along, strict=True)]
        a = self.mass.solve(along)
        return [do.plus(x, do.dot(row, a)) for x, row in zip(x0, self.D, strict=True)]

    # ---- what is wanted ----

    def accelerations(self) -> dict[str, Vector]:
        """Outputs of the accelerations: vdot, lambda, power of forces and moving constraints, pivots, and pdot if there is A."""
        return self._accelerations(self._with_added())

    def _with_added(self) -> Vector:
        """Right side xi plus the added term of a formulation."""
        added = [self.do.lowering.emit("leaf", "added", k) for k in range(self.m)]
        return [self.do.plus(*each) for each in zip(self._vector("xi", self.m), added, strict=True)]

    def _accelerations(self, right: Vector) -> dict[str, Vector]:
        do = self.do
        v = self._leaves("v")
        force = [do.difference(f, d) for f, d in zip(self._vector("f", self.nv), self._vector("d", self.nv), strict=True)]
        vdot = self.solution(force, right)
        rest = [do.difference(f, do.dot(row, vdot)) for f, row in zip(force, self.M, strict=True)]
        multipliers = self.multipliers(rest)
        power = do.plus(self._vector("power", 1)[0], do.dot(multipliers, self._vector("Phi_t", self.m)))
        return {"pdot": self._rates(v) if "A" in self.terms else [], "vdot": vdot, "lambda": multipliers, "power": [power],
                "pivots": self.determinants + self.mass.shares}

    def corrections(self) -> dict[str, Vector]:
        """Outputs of the projection: Phi, and the corrections dp and dv of (25)."""
        return self._corrections(self._leaves("v"), self._projected)

    def landing(self) -> dict[str, Vector]:
        """Outputs of the end of a step: Phi, dp, dv of the velocities before the projection, accelerations for those after it."""
        return self._corrections(self._leaves("before"), self._projected) | self._accelerations(self._vector("xi", self.m))

    def embedding(self) -> dict[str, Vector]:
        """Outputs for independent velocities: corrections that leave the free velocities unchanged, accelerations with the added
        xi, and D, the derivative of the dependent velocities with respect to the free ones.
        """
        found = self._corrections(self._leaves("before"), self._kept) | self._accelerations(self._with_added())
        return found | {"D": [entry for solve in self.order for j in solve.columns for entry in self._share_of(j)]}

    def _projected(self, right: Vector) -> Vector:
        """The shortest x with C x = right in the metric of M."""
        return self.solution(None, right)

    def _kept(self, right: Vector) -> Vector:
        """The x with C x = right that is zero where velocities are free."""
        return self.particular(right)

    def _share_of(self, j: int) -> Vector:
        """Row of D of velocity j."""
        return self.D[j]

    def _leaves(self, kind: str) -> Vector:
        return [self.do.lowering.emit("leaf", kind, i) for i in range(self.nv)]

    def _corrections(self, v: Vector, step: Callable[[Vector], Vector]) -> dict[str, Vector]:
        do = self.do
        Phi = self._vector("Phi", self.mh)
        Psi = [do.plus(do.dot(row, v), by_time) for row, by_time in zip(self.C, self._vector("Phi_t", self.m), strict=True)]
        dp = step(Phi + [do.zero] * (self.m - self.mh)) if self.mh else [do.zero] * self.nv
        return {"Phi": Phi, "dp": self._rates(dp), "dv": step(Psi)}

    def _rates(self, x: Vector) -> Vector:
        """A x."""
        return [self.do.dot(row, x) for row in self._matrix("A", self.nq, self.nv)] if "A" in self.terms else x


def _transposed(matrix: Matrix, columns: int) -> Matrix:
    return [[row[j] for row in matrix] for j in range(columns)]
