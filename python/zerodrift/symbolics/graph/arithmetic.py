"""Arithmetic with operations of a program: sums, products and small determinants."""

from __future__ import annotations

from collections.abc import Sequence

from .graph import FIXED
from .lowering import Lowering

LATENCY = {"leaf": 0, "number": 0, "negative": 1, "/": 14, "root": 18, "call": 50, "power": 100}    # of other operations 4

Vector = list[int]      # of operations, as is a
Matrix = list[Vector]


class Arithmetic:
    """Arithmetic operations with trivial ones (times 1, plus 0) left out."""

    def __init__(self, lowering: Lowering) -> None:
        self.lowering, self._depths = lowering, dict[int, int]()
        self.zero, self.one, self._minus_one = (lowering.emit("number", value) for value in (0.0, 1.0, -1.0))

    def depth(self, number: int) -> int:
        """Latency of a value, from the leaves on, in approximate processor cycles."""
        waiting = [number]
        while waiting:
            operation = self.lowering.operations[waiting[-1]]
            operands = self.lowering.operands(operation)
            unknown = [operand for operand in operands if operand not in self._depths]
            if not unknown:
                before = max((self._depths[operand] for operand in operands), default=0)
                self._depths[waiting.pop()] = before + (LATENCY.get(operation.code, 4) if operation.stage > FIXED else 0)
            waiting += unknown
        return self._depths[number]

    def _negated(self, a: int) -> int | None:
        """The operand of a negation; None for other operations."""
        operation = self.lowering.operations[a]
        return operation.arguments[0] if operation.code == "negative" else None

    def minus(self, a: int) -> int:
        if a == self.zero:
            return a
        inner = self._negated(a)
        if inner is not None:
            return inner
        return self.lowering.emit("number", -1.0) if a == self.one else self.one if a == self._minus_one else (
            self.lowering.emit("negative", a))

    def plus(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return a if b == self.zero else b
        if (inner := self._negated(b)) is not None:
            return self.difference(a, inner)
        if (inner := self._negated(a)) is not None:
            return self.difference(b, inner)
        return self.lowering.emit("+", a, b)

    def difference(self, a: int, b: int) -> int:
        if b == self.zero:
            return a
        if a == self.zero:
            return self.minus(b)
        if a == b:
            return self.zero
        if (inner := self._negated(b)) is not None:
            return self.plus(a, inner)
        if (inner := self._negated(a)) is not None:
            return self.minus(self.plus(inner, b))
        return self.lowering.emit("-", a, b)

    def times(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return self.zero
        for x, y in ((a, b), (b, a)):
            if x == self.one:
                return y
            if x == self._minus_one:
                return self.minus(y)
            if (inner := self._negated(x)) is not None:
                return self.minus(self.times(inner, y))
        return self.lowering.emit("*", a, b)

    def over(self, a: int, b: int) -> int:
        if a == self.zero or b == self.one:
            return a
        for x, value in ((a, lambda inner: self.over(inner, b)), (b, lambda inner: self.over(a, inner))):
            if (inner := self._negated(x)) is not None:
                return self.minus(value(inner))
        return self.lowering.emit("/", a, b)

    def sum(self, terms: Sequence[int]) -> int:
        total = self.zero
        for term in terms:
            total = self.plus(total, term)
        return total

    def dot(self, a: Sequence[int], b: Sequence[int]) -> int:
        return self.sum([self.times(x, y) for x, y in zip(a, b, strict=True)])


def adjugate(do: Arithmetic, B: Matrix) -> tuple[Matrix, int]:
    """The determinant of a matrix of up to three rows times its inverse, and the determinant."""
    if len(B) == 1:
        return [[do.one]], B[0][0]
    entries = [[_cofactor(do, B, i, j) for i in range(len(B))] for j in range(len(B))]
    return entries, do.dot(B[0], [row[0] for row in entries])


def _cofactor(do: Arithmetic, B: Matrix, i: int, j: int) -> int:
    rest = [[entry for b, entry in enumerate(row) if b != j] for a, row in enumerate(B) if a != i]
    minor = rest[0][0]
    if len(rest) == 2:
        minor = do.difference(do.times(rest[0][0], rest[1][1]), do.times(rest[0][1], rest[1][0]))
    return minor if (i + j) % 2 == 0 else do.minus(minor)
