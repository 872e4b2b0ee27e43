"""An order of one solve: all rows of C at once, by Cramer's rule.

Divisions are the slowest operations of a processor. Quotients by the determinant, delta, are therefore postponed, and 1 / delta
and 1 / (D'^T M D') are computed from the reciprocal of their product:

    D' = delta D,    x0' = delta x0,    D'^T M D' a = delta D'^T force - (M D')^T x0',    x = (x0' + D' a) / delta
"""

from __future__ import annotations

from ..graph.arithmetic import Matrix, Vector, adjugate
from ..graph.graph import FIXED
from ..graph.lowering import Lowering
from .reduced_mass import ReducedMass
from .steps import Elimination, Order


class Joint(Elimination):
    """`Elimination` of all constraints in one solve, with divisions postponed as derived above."""

    def _inverse(self, B: Matrix) -> tuple[Matrix, int]:
        entries, self.delta = adjugate(self.do, B)
        return entries, self.delta

    def _complement(self) -> Matrix:
        """D'"""
        do, D = self.do, super()._complement()
        for k, i in enumerate(self.free):
            D[i] = [self.delta if k == column else do.zero for column in range(len(self.free))]
        return D

    def _reduced_mass(self) -> ReducedMass:
        """D'^T M D'"""
        self.share = -1     # not yet known
        mass = super()._reduced_mass()
        if self.share < 0:      # nothing is free
            self.share = self.do.over(self.do.one, self.delta)
        return mass

    def _inverted(self, determinant: int) -> int:
        """That of a block of D'^T M D', and with the first of them 1 / delta."""
        do = self.do
        if self.share >= 0:
            return super()._inverted(determinant)
        self.both = both = do.over(do.one, do.times(self.delta, determinant))
        self.share = do.times(both, determinant)
        return do.times(both, self.delta)

    def _free_of(self, along: Vector) -> Vector:
        """The free velocities. Where there is one, what is known before the quotient is multiplied before it is."""
        do = self.do
        if len(self.free) == 1 and do.depth(along[0]) <= do.depth(self.both):
            return [do.times(self.both, do.times(self.delta, along[0]))]
        return self.mass.solve(along)

    def solution(self, force: Vector | None, right: Vector) -> Vector:
        do, x0 = self.do, self.particular(right)
        along = [do.minus(do.dot(column, x0)) for column in zip(*self.MD, strict=True)]
        if force is not None:
            along = [do.plus(do.times(self.delta, do.dot(column, force)), value)
                     for column, value in zip(zip(*self.D, strict=True), along, strict=True)]
        a = self._free_of(along)
        x = [do.plus(do.times(x, self.share), do.dot([do.times(entry, self.share) for entry in row], a))
             for x, row in zip(x0, self.D, strict=True)]
        for i, value in zip(self.free, a, strict=True):
            x[i] = value
        return x

    def _kept(self, right: Vector) -> Vector:
        return [self.do.times(value, self.share) for value in super()._kept(right)]

    def _share_of(self, j: int) -> Vector:
        return [self.do.times(entry, self.share) for entry in super()._share_of(j)]

    def multipliers(self, force: Vector) -> Vector:
        return [self.do.times(value, self.share) for value in super().multipliers(force)]


def elimination(lowering: Lowering, terms: dict[str, list[int]], sizes: tuple[int, int, int, int], order: Order) -> Elimination:
    """Along an order, jointly where that saves something."""
    usual = Elimination(lowering, terms, sizes, order)
    is_joint = len(order) == 1 and lowering.operations[usual.determinants[0]].stage > FIXED
    return Joint(lowering, terms, sizes, order) if is_joint else usual
