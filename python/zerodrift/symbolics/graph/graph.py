"""Expressions as a graph in which equal parts are one node, and their derivatives.

Derivatives are taken node by node by the chain rule, so that they grow with the graph and not with the expressions written out.
Sums and products are kept collected: a sum is {node: number}, a product {node: exponent}, and products are never expanded.
That is enough for the terms of Lagrange's equations that cancel to do so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

Number = int | float | Fraction
FIXED, PLACED, MOVING = 0, 1, 2     # stages: depends on parameters alone, on t and p too, on v too
LEAVES = {"parameter": FIXED, "t": PLACED, "p": PLACED, "part": PLACED, "v": MOVING, "rate": MOVING, "added": MOVING,
          "before": MOVING}     # "part": stands for another node, and is known by its rate


class Node:
    """A part of an expression: leaf, number, sum, product, call, choice, comparison or logic."""

    __slots__ = ("content", "kind", "number", "stage")

    def __init__(self, kind: str, content: Any, number: int, stage: int) -> None:
        self.kind, self.content, self.number, self.stage = kind, content, number, stage

    def __repr__(self) -> str:
        return f"<{self.kind} {self.content}>"


class Graph:
    """All nodes of a system; `slope(function, k, arguments)` is the partial derivative of a call, as a node."""

    def __init__(self, slope: Callable[[Any, int, tuple[Node, ...]], Node]) -> None:
        self._nodes: dict[tuple[str, Any], Node] = {}
        self.slope = slope
        self.zero, self.one = self.number(0), self.number(1)

    def _node(self, kind: str, content: Any, stage: int) -> Node:
        node = self._nodes.get((kind, content))
        if node is None:
            node = self._nodes[kind, content] = Node(kind, content, len(self._nodes), stage)
        return node

    def leaf(self, kind: str, index: int) -> Node:
        return self._node("leaf", (kind, index), LEAVES[kind])

    def number(self, value: Number) -> Node:
        if isinstance(value, Fraction) and value.denominator == 1:
            value = value.numerator
        return self._node("number", (value, isinstance(value, float)), FIXED)

    # ---- sums and products ----

    def sum(self, terms: Iterable[tuple[Node, Number]]) -> Node:
        """Node of a sum of terms (node, coefficient); sums within it are merged."""
        collected: dict[Node, Number] = {}
        for node, factor in terms:
            if node.kind == "sum":
                for inner, coefficient in node.content:
                    collected[inner] = collected.get(inner, 0) + factor * coefficient
            elif node.kind == "number":
                collected[self.one] = collected.get(self.one, 0) + factor * node.content[0]
            else:
                collected[node] = collected.get(node, 0) + factor
        collected = self._join_squares({node: factor for node, factor in collected.items() if factor != 0})
        if not collected:
            return self.zero
        if len(collected) == 1:
            (node, factor), = collected.items()
            if node is self.one:
                return self.number(factor)
            if factor == 1:
                return node
        content = tuple(sorted(collected.items(), key=lambda item: item[0].number))
        return self._node("sum", content, max(node.stage for node in collected))

    def _join_squares(self, terms: dict[Node, Number]) -> dict[Node, Number]:
        """sin^2 + cos^2 = 1, where the rest of both terms is the same."""
        seen: dict[Any, tuple[Node, str]] = {}
        for node, factor in list(terms.items()):
            for base, exponent in node.content if node.kind == "product" else ():
                if exponent != 2 or base.kind != "call" or base.content[0].__name__ not in ("sin", "cos"):
                    continue
                rest = tuple(item for item in node.content if item[0] is not base)
                key, name = (rest, base.content[1], factor), base.content[0].__name__
                partner = seen.setdefault(key, (node, name))
                if partner[1] != name and partner[0] in terms and node in terms:
                    del terms[partner[0]], terms[node], seen[key]
                    joined = self.sum([*terms.items(), (self.product(rest), factor)])
                    return dict(joined.content) if joined.kind == "sum" else {joined: 1} if joined.kind != "number" else (
                        {self.one: joined.content[0]} if joined.content[0] else {})
        return terms

    def product(self, factors: Iterable[tuple[Node, Number]]) -> Node:
        """Node of a product of factors (node, exponent)."""
        coefficient, collected = self._factors(factors)
        if coefficient == 0:
            return self.zero
        if not collected:
            return self.number(coefficient)
        items = tuple(sorted(collected.items(), key=lambda item: item[0].number))
        node = items[0][0] if len(items) == 1 and items[0][1] == 1 else self._node(
            "product", items, max(base.stage for base, _ in items))
        return node if coefficient == 1 else self.sum([(node, coefficient)])

    def _factors(self, factors: Iterable[tuple[Node, Number]]) -> tuple[Number, dict[Node, Number]]:
        coefficient: Number = 1
        collected: dict[Node, Number] = {}
        for node, exponent in factors:
            is_integer = exponent == int(exponent)
            if node.kind == "number" and (is_integer or node.content[0] >= 0) and not (node.content[0] == 0 and exponent < 0):
                coefficient = coefficient * power(node.content[0], exponent)
                continue
            if node.kind == "sum" and len(node.content) == 1 and is_integer:
                (node, factor), = node.content
                coefficient = coefficient * power(factor, exponent)
            for base, inner in node.content if node.kind == "product" and is_integer else ((node, 1),):
                total = collected.get(base, 0) + inner * exponent
                collected[base] = total
                if total == 0:
                    del collected[base]
        if any(base.kind == "product" and exponent == int(exponent) for base, exponent in collected.items()):
            more, collected = self._factors(collected.items())      # such as the square of the root of a product
            coefficient = coefficient * more
        return coefficient, collected

    def times(self, *nodes: Node) -> Node:
        return self.product((node, 1) for node in nodes)

    def plus(self, *nodes: Node) -> Node:
        return self.sum((node, 1) for node in nodes)

    def minus(self, node: Node) -> Node:
        return self.sum([(node, -1)])

    def dot(self, a: Iterable[Node], b: Iterable[Node]) -> Node:
        zero = self.zero
        return self.plus(*(self.times(x, y) for x, y in zip(a, b, strict=True) if x is not zero and y is not zero))

    def power(self, base: Node, exponent: Node, call: Any) -> Node:
        """A node to the power of another: a number as exponent is part of a product, any other an argument of the call."""
        if exponent.kind != "number":
            return self.call(call, base, exponent)
        number = exponent.content[0]
        return self.product([(base, int(number) if number == int(number) else number)])

    def chained(self, factors: Sequence[tuple[Node, Number]], rate: Node) -> Node:
        """Product of an outer derivative and a rate; zero in cases of the rate that are, where the outer one may be infinite."""
        if not _has_pole(factors):
            return self.product([*factors, (rate, 1)])
        if rate.kind == "sum" and len(rate.content) == 1:
            (rate, number), = rate.content
            return self.sum([(self.chained(factors, rate), number)])
        for choice, exponent in rate.content if rate.kind == "product" else ((rate, 1),):
            if choice.kind == "choice" and exponent == 1:
                cases, otherwise = choice.content
                if self.zero in (otherwise, *(value for _, value in cases)):
                    more = [*factors, (rate, 1), (choice, -1)]
                    return self.choice(tuple((condition, self.chained(more, value)) for condition, value in cases),
                                       self.chained(more, otherwise))
        return self.product([*factors, (rate, 1)])

    # ---- all other kinds ----

    def call(self, function: Any, *arguments: Node) -> Node:
        return self._node("call", (function, arguments), max(argument.stage for argument in arguments))

    def choice(self, cases: tuple[tuple[Node, Node], ...], otherwise: Node) -> Node:
        """The value of the first (condition, value) that holds."""
        if all(value is otherwise for _, value in cases):
            return otherwise
        parts = [node for case in cases for node in case] + [otherwise]
        return self._node("choice", (cases, otherwise), max(node.stage for node in parts))

    def comparison(self, sign: str, a: Node, b: Node) -> Node:
        return self._node("comparison", (sign, a, b), max(a.stage, b.stage))

    def logic(self, word: str, *parts: Node) -> Node:
        return self._node("logic", (word, parts), max(part.stage for part in parts))

    # ---- rewriting ----

    def derivative_along(self, direction: Mapping[Node, Node]) -> Derivative:
        """The derivative in a direction, which gives the rates of some leaves; all other leaves are constant."""
        return Derivative(self, direction)

    def substitution(self, values: Mapping[Node, Node]) -> Callable[[Node], Node]:
        """A function that puts values in place of leaves."""
        return Replacement(self, values)

    def multiplied_out(self, node: Node) -> Node:
        """The node with factors of parameters multiplied into sums, so that like terms of different sums are collected."""
        if node.kind == "sum":
            return self.sum((self.multiplied_out(term), factor) for term, factor in node.content)
        if node.kind == "product" and node.stage > FIXED:
            fixed = [item for item in node.content if item[0].stage == FIXED]
            others = [item for item in node.content if item[0].stage > FIXED]
            if len(others) == 1 and others[0][1] == 1 and others[0][0].kind == "sum":
                terms = others[0][0].content
                return self.sum((self.multiplied_out(self.product([*fixed, (term, 1)])), factor) for term, factor in terms)
        return node

    def collected(self, node: Node, kind: str) -> Node:
        """The node with sums of leaves of a kind multiplied out, where that leaves fewer terms, as like ones are collected."""
        if node.kind != "sum":
            return node
        found = self.sum((self._spread(term, kind), factor) for term, factor in node.content)
        return found if found.kind != "sum" or len(found.content) < len(node.content) else node

    def _spread(self, term: Node, kind: str) -> Node:
        """Product expanded over its sums of such leaves, one after the other."""
        for base, exponent in term.content if term.kind == "product" else ():
            are_leaves = base.kind == "sum" and all(each.kind == "leaf" and each.content[0] == kind for each, _ in base.content)
            if exponent == 1 and are_leaves:
                rest = [*term.content, (base, -1)]
                return self.sum((self._spread(self.product([*rest, (leaf, 1)]), kind), factor) for leaf, factor in base.content)
        return term


def _has_pole(factors: Iterable[tuple[Node, Number]]) -> bool:
    """True of factors that may be infinite: negative powers, and powers and logarithms that are calls."""
    return any(exponent < 0 or (base.kind == "call" and base.content[0].__name__ in ("Pow", "log"))
               or (base.kind == "product" and _has_pole(base.content))
               or (base.kind == "sum" and len(base.content) == 1 and _has_pole([(base.content[0][0], 1)]))
               for base, exponent in factors)


def power(base: Number, exponent: Number) -> Number:
    """A number to an exponent, exact where it can be."""
    if isinstance(base, int) and exponent == int(exponent):
        base = Fraction(base)
    result = base ** (int(exponent) if exponent == int(exponent) else float(exponent))
    return int(result) if isinstance(result, Fraction) and result.denominator == 1 else result


class _NodeFunction:
    """A function of nodes defined by its values at leaves; each value is computed once and cached."""

    _of: Any                # value at a node
    _of_unaffected: Any     # and at one below the stages of the leaves

    def __init__(self, graph: Graph, leaves: Mapping[Node, Node]) -> None:
        self._graph, self._known = graph, dict(leaves)
        self._lowest = min((leaf.stage for leaf in leaves), default=MOVING + 1)

    def know(self, leaf: Node, value: Node) -> None:
        """Set the value at one more leaf. Its stage must not be below those of the others, and no node evaluated so far may
        depend on it.
        """
        self._known[leaf] = value

    def __call__(self, node: Node) -> Node:
        if node.stage < self._lowest:
            return self._of_unaffected(node)
        found = self._known.get(node)
        if found is None:
            found = self._known[node] = self._of(node)
        return found


class Derivative(_NodeFunction):
    """The derivative of any node in the direction that leaves are given."""

    def _of_unaffected(self, node: Node) -> Node:
        return self._graph.zero

    def _of(self, node: Node) -> Node:
        graph = self._graph
        match node.kind:
            case "sum":
                return graph.sum((self(term), factor) for term, factor in node.content)
            case "product":
                return graph.sum((self._of_factor(node, base, exponent), exponent) for base, exponent in node.content)
            case "call":
                function, arguments = node.content
                rates = [(k, self(argument)) for k, argument in enumerate(arguments)]
                return graph.plus(*(graph.chained([(graph.slope(function, k, arguments), 1)], rate)
                                    for k, rate in rates if rate is not graph.zero))
            case "choice":
                cases, otherwise = node.content
                of = self._of_case
                return graph.choice(tuple((condition, of(value)) for condition, value in cases), of(otherwise))
            case _:
                return graph.zero

    def _of_case(self, value: Node) -> Node:
        """Derivative of one case of a piecewise node; NaN if the value is NaN."""
        undefined = value.kind == "number" and value.content[0] != value.content[0]
        return value if undefined else self(value)

    def _of_factor(self, node: Node, base: Node, exponent: Number) -> Node:
        rate = self(base)
        if rate is self._graph.zero:
            return rate
        return self._graph.chained([*node.content, (base, -1)], rate)


class Replacement(_NodeFunction):
    """Substitution: any node with values in place of leaves."""

    def _of_unaffected(self, node: Node) -> Node:
        return node

    def _of(self, node: Node) -> Node:
        graph = self._graph
        match node.kind:
            case "sum":
                return graph.sum((self(term), factor) for term, factor in node.content)
            case "product":
                return graph.product((self(base), exponent) for base, exponent in node.content)
            case "call":
                function, arguments = node.content
                return graph.call(function, *map(self, arguments))
            case "choice":
                cases, otherwise = node.content
                return graph.choice(tuple((self(condition), self(value)) for condition, value in cases), self(otherwise))
            case "comparison":
                sign, a, b = node.content
                return graph.comparison(sign, self(a), self(b))
            case "logic":
                word, parts = node.content
                return graph.logic(word, *map(self, parts))
            case _:
                return node
