"""Conversion of a graph to elementary operations without duplicates.

A sum is written so that the factor most terms share is taken out first (Horner's scheme), parameters included. Products and sums
take what depends on parameters alone first, then what depends on t and p: so that the most can be computed once.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from .graph import FIXED, LEAVES, Graph, Node, Number

Signed = tuple[int, int]        # +1 or -1, and an operation
Term = tuple[int, dict[Any, Number]]    # a sign, and factors with their exponents


class Operation(NamedTuple):
    """One step of a program: `code` applied to the operations before it that `arguments` numbers."""

    code: str
    arguments: tuple[Any, ...]
    stage: int


LONGEST = 300       # terms of a sum in which shared factors are looked for, as that takes the square of it
SIMPLE = ("leaf", "number")     # their arguments are not operations


class Lowering:
    """The operations that compute nodes of a graph, in order; leaves among `values` stand for other nodes."""

    def __init__(self, graph: Graph, values: Mapping[Node, Node] | None = None) -> None:
        self.graph, self._values = graph, values or {}
        self.operations: list[Operation] = []
        self.exact: dict[str, str] = {}     # fractions by the doubles nearest to them
        self._numbers: dict[tuple[Any, ...], int] = {}
        self._lowered: dict[Node, int] = {}

    def lower(self, node: Node) -> int:
        """The operation whose value is the node's."""
        found = self._lowered.get(node)
        if found is None:
            found = self._lowered[node] = self._of(node)
        return found

    def emit(self, code: str, *arguments: Any) -> int:
        if code in "+*" and arguments[0] > arguments[1]:
            arguments = arguments[::-1]
        key = (code, *arguments)
        number = self._numbers.get(key)
        if number is None:
            number = self._numbers[key] = len(self.operations)
            self.operations.append(Operation(code, arguments, self._stage(code, arguments)))
        return number

    def _stage(self, code: str, arguments: tuple[Any, ...]) -> int:
        if code == "leaf":
            return LEAVES[arguments[0]]
        if code == "number":
            return FIXED
        return max(self.operations[argument].stage for argument in self.operands(Operation(code, arguments, 0)))

    @staticmethod
    def operands(operation: Operation) -> tuple[int, ...]:
        """Operands of an operation."""
        if operation.code in SIMPLE:
            return ()
        return operation.arguments[1:] if operation.code in ("call", "comparison", "logic") else operation.arguments

    def _number(self, value: Number) -> int:
        rounded = float(value)
        if isinstance(value, Fraction) and value != Fraction(rounded):
            self.exact.setdefault(repr(rounded), f"{value.numerator}/{value.denominator}")
        else:
            self.exact[repr(rounded)] = ""      # which a double is
        return self.emit("number", rounded)

    def _of(self, node: Node) -> int:
        content = node.content
        match node.kind:
            case "leaf":
                return self.lower(self._values[node]) if node in self._values else self.emit("leaf", *content)
            case "number":
                return self._number(content[0])
            case "sum":
                return self._signed(self._sum(self._terms(node)))
            case "product":
                return self._signed(self._product((1, dict(content))))
            case "call":
                return self.emit("call", content[0], *map(self.lower, content[1]))
            case "choice":
                cases = [self.lower(part) for case in content[0] for part in case]
                return self.emit("choice", *cases, self.lower(content[1]))
            case "comparison":
                return self.emit("comparison", content[0], *map(self.lower, content[1:]))
            case _:
                return self.emit("logic", content[0], *map(self.lower, content[1]))

    def _signed(self, value: Signed) -> int:
        return value[1] if value[0] > 0 else self.emit("negative", value[1])

    # ---- sums ----

    def _terms(self, node: Node) -> list[Term]:
        """Terms of a sum; terms that differ only by factors of parameters are merged, with a coefficient of parameters."""
        graph = self.graph
        groups: dict[Any, list[tuple[Node, Number]]] = {}
        if node.stage == FIXED:
            return [self._term(graph.number(number), term.content if term.kind == "product" else ((term, 1),))
                    for term, number in node.content]
        for term, number in node.content:
            factors = term.content if term.kind == "product" else ((term, 1),)
            varying = tuple(item for item in factors if item[0].stage > FIXED)
            fixed = graph.product(item for item in factors if item[0].stage == FIXED)
            groups.setdefault(varying, []).append((fixed, number))
        return [self._term(graph.sum(coefficients), varying) for varying, coefficients in groups.items()]

    def _term(self, coefficient: Node, varying: tuple[tuple[Node, Number], ...]) -> Term:
        factors: dict[Any, Number] = dict(varying)
        number: Number = 1
        if coefficient.kind == "number":
            number = coefficient.content[0]
        elif coefficient.kind == "sum" and len(coefficient.content) == 1:
            (coefficient, number), = coefficient.content
            factors[coefficient] = 1
        elif coefficient.kind == "sum" and coefficient.content[0][1] < 0:
            factors[self.graph.minus(coefficient)], number = 1, -1
        else:
            factors[coefficient] = 1
        if abs(number) != 1:
            factors[abs(number)] = 1
        return (-1 if number < 0 else 1), factors

    def _sum(self, terms: list[Term]) -> Signed:
        parts: list[Signed] = []
        while True:
            shared = self._most_shared(terms)
            if shared is None:
                break
            factor, exponent = shared
            inside = [(sign, _without(factors, factor, exponent)) for sign, factors in terms if _has(factors, factor, exponent)]
            terms = [term for term in terms if not _has(term[1], factor, exponent)]
            sign, value = self._sum(inside)
            parts.append(self._times(sign, {("lowered", value): 1, factor: exponent}))
        parts += [self._product(term) for term in terms]
        return self._added(parts)

    def _most_shared(self, terms: list[Term]) -> tuple[Any, Number] | None:
        if not 2 <= len(terms) <= LONGEST:
            return None
        counts = Counter((factor, _unit(exponent)) for _, factors in terms for factor, exponent in factors.items())
        best = max(counts, key=lambda item: (counts[item], _stage(item[0]), -_rank(item[0])), default=None)
        return best if best is not None and counts[best] > 1 else None

    def _added(self, parts: Iterable[Signed]) -> Signed:
        parts = sorted(parts, key=lambda part: (self.operations[part[1]].stage, part[1]))
        sign, total = parts[0]
        for other, value in parts[1:]:
            if sign == other:
                total = self.emit("+", total, value)
            elif sign > 0:
                total = self.emit("-", total, value)
            else:
                sign, total = 1, self.emit("-", value, total)
        return sign, total

    # ---- products ----

    def _product(self, term: Term) -> Signed:
        return self._times(*term)

    def _times(self, sign: int, factors: dict[Any, Number]) -> Signed:
        powers = [(exponent < 0, self._power(factor, -exponent if exponent < 0 else exponent))
                  for factor, exponent in factors.items()]
        one = self._number(1)
        above, below = ([value for is_below, value in powers if is_below == side and value != one] for side in (False, True))
        if not below:
            return sign, self._multiplied(above, one)
        fixed = [value for value in below if self.operations[value].stage == FIXED]
        moving = [value for value in below if self.operations[value].stage > FIXED]
        if fixed:       # as one factor of parameters
            first = [value for value in above if self.operations[value].stage == FIXED]
            rest = [value for value in above if self.operations[value].stage > FIXED]
            above = [self.emit("/", self._multiplied(first, one), self._multiplied(fixed, one)), *rest]
        top = self._multiplied(above, one)
        return sign, self.emit("/", top, self._multiplied(moving, one)) if moving else top

    def _multiplied(self, values: list[int], one: int) -> int:
        values = sorted(values, key=lambda value: (self.operations[value].stage, value))
        total = values[0] if values else one
        for value in values[1:]:
            total = self.emit("*", total, value)
        return total

    def _power(self, factor: Any, exponent: Number) -> int:
        if isinstance(factor, tuple):
            base = factor[1]
        else:
            base = self.lower(factor) if isinstance(factor, Node) else self._number(factor)
        integer, rest = int(exponent), exponent - int(exponent)
        if rest == 0 and integer <= 64:
            return self._integer_power(base, integer)
        if rest == 0.5 and integer <= 64:
            root = self.emit("root", base)
            return root if integer == 0 else self.emit("*", self._integer_power(base, integer), root)
        return self.emit("power", base, self._number(exponent))

    def _integer_power(self, base: int, exponent: int) -> int:
        if exponent == 1:
            return base
        half = self._integer_power(base, exponent // 2)
        square = self.emit("*", half, half)
        return self.emit("*", square, base) if exponent % 2 else square


def _has(factors: dict[Any, Number], factor: Any, exponent: Number) -> bool:
    return factor in factors and _unit(factors[factor]) == exponent


def _without(factors: dict[Any, Number], factor: Any, exponent: Number) -> dict[Any, Number]:
    left = {**factors, factor: factors[factor] - exponent}
    return {key: value for key, value in left.items() if value}


def _unit(exponent: Number) -> Number:
    """The part of an exponent that can be taken out: one factor of an integer power, or all of another power."""
    if exponent == int(exponent):
        return 1 if exponent > 0 else -1
    return exponent


def _stage(factor: Any) -> int:
    return factor.stage if isinstance(factor, Node) else FIXED


def _rank(factor: Any) -> int:
    return factor.number if isinstance(factor, Node) else -1
