"""First and second derivatives of nodes with respect to many leaves at once.

Only non-zero entries are visited: a sum over n bodies with a few coordinates each takes n steps, not n^2. The second
derivatives of a kinetic energy, a sum of squares of what is linear in the rates, are sums of products of first derivatives, so
that no square is differentiated.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from fractions import Fraction

from .graph import Graph, Node, Number

Slopes = dict[Node, Node]       # of leaves, the derivatives with respect to them that are not zero
Terms = list[tuple[Node, Number]]
Form = dict[Node, tuple[Node, Number]]      # of leaves, node and coefficient: what is linear in the leaves


class Gradient:
    """A function that gives the derivatives of any node with respect to these leaves; all other leaves are constant."""

    def __init__(self, graph: Graph, leaves: Iterable[Node]) -> None:
        self._graph = graph
        self._known: dict[Node, Slopes] = {leaf: {leaf: graph.one} for leaf in leaves}
        self._lowest = min((leaf.stage for leaf in self._known), default=0)

    def __call__(self, node: Node) -> Slopes:
        if node.stage < self._lowest:
            return {}
        found = self._known.get(node)
        if found is None:
            found = self._known[node] = self._of(node)
        return found

    def _of(self, node: Node) -> Slopes:
        graph = self._graph
        if node.kind == "choice":
            return self._of_choice(node)
        parts: dict[Node, Terms] = defaultdict(list)
        if node.kind == "sum":
            for term, factor in node.content:
                for leaf, slope in self(term).items():
                    parts[leaf].append((slope, factor))
        elif node.kind == "product":
            for base, exponent in node.content:
                if slopes := self(base):
                    _add(parts, slopes, exponent, graph, graph.product([*node.content, (base, -1)]))
        elif node.kind == "call":
            function, arguments = node.content
            for k, argument in enumerate(arguments):
                if slopes := self(argument):
                    _add(parts, slopes, 1, graph, graph.slope(function, k, arguments))
        slopes = {leaf: graph.sum(terms) for leaf, terms in parts.items()}
        return {leaf: slope for leaf, slope in slopes.items() if slope is not graph.zero}

    def _of_choice(self, node: Node) -> Slopes:
        """Slopes of a piecewise node; the derivative is NaN in cases whose value is NaN."""
        graph, (cases, otherwise) = self._graph, node.content
        leaves = dict.fromkeys(leaf for value in (*(value for _, value in cases), otherwise) for leaf in self(value))

        def of_case(value: Node, leaf: Node) -> Node:
            undefined = value.kind == "number" and value.content[0] != value.content[0]
            return value if undefined else self(value).get(leaf, graph.zero)

        return {leaf: graph.choice(tuple((condition, of_case(value, leaf)) for condition, value in cases),
                                   of_case(otherwise, leaf)) for leaf in leaves}


def _add(parts: dict[Node, Terms], slopes: Slopes, factor: Number, graph: Graph, outer: Node) -> None:
    """Add the derivatives of an inner node times the outer derivative, by the chain rule."""
    for leaf, slope in slopes.items():
        parts[leaf].append((graph.chained([(outer, 1)], slope), factor))


class Hessian:
    """Second derivatives of a node; `self[a, b]` is the one with respect to leaves a and b."""

    def __init__(self, graph: Graph, gradient: Gradient, node: Node) -> None:
        self._graph, self._gradient = graph, gradient
        self._products: dict[tuple[Node, Node], tuple[Node, Number]] = {}
        self._collected: dict[tuple[Node, Node], dict[Node, list[Number]]] = defaultdict(lambda: defaultdict(list))
        self._add(node, 1)
        self._entries = {pair: graph.sum((node, _total(numbers)) for node, numbers in terms.items())
                         for pair, terms in self._collected.items()}

    def __getitem__(self, pair: tuple[Node, Node]) -> Node:
        return self._entries.get(_ordered(*pair), self._graph.zero)

    def _add(self, node: Node, factor: Number) -> None:
        if node.kind == "sum":
            for term, coefficient in node.content:
                self._add(term, factor * coefficient)
            return
        moving = [item for item in node.content if self._gradient(item[0])] if node.kind == "product" else []
        if moving and sum(exponent for _, exponent in moving) == 2 and all(
                exponent > 0 and self._is_linear(base) for base, exponent in moving):
            rest = self._graph.product(item for item in node.content if item not in moving)
            self._add_product(rest, moving[0][0], moving[-1][0], factor)
            return
        for leaf, slope in self._gradient(node).items():
            for other, second in self._gradient(slope).items():
                if leaf.number <= other.number:
                    self._collect(leaf, other, _scaled(second), factor)

    def _is_linear(self, node: Node) -> bool:
        return not any(self._gradient(slope) for slope in self._gradient(node).values())

    def _add_product(self, rest: Node, a: Node, b: Node, factor: Number) -> None:
        """Add the second derivatives of rest * a * b, where a and b are linear forms."""
        of_a, of_b = self._form(a), self._form(b)
        for leaf, (slope, coefficient) in of_a.items():
            front, number = _scaled(self._graph.times(rest, slope))
            number = _plain(number * coefficient * factor * (2 if a is b else 1))
            for other, (second, more) in of_b.items():
                if a is not b:
                    self._collect(leaf, other, self._times(front, second), number * more * (2 if leaf is other else 1))
                elif leaf.number <= other.number:
                    self._collect(leaf, other, self._times(front, second), number * more if more != 1 else number)

    def _form(self, node: Node) -> Form:
        return {leaf: _scaled(slope) for leaf, slope in self._gradient(node).items()}

    def _times(self, a: Node, b: Node) -> tuple[Node, Number]:
        found = self._products.get((a, b))
        if found is None:
            found = self._products[a, b] = _scaled(self._graph.times(a, b))
        return found

    def _collect(self, a: Node, b: Node, entry: tuple[Node, Number], factor: Number) -> None:
        node, number = entry
        self._collected[_ordered(a, b)][node].append(factor if number == 1 else number * factor)


def _ordered(a: Node, b: Node) -> tuple[Node, Node]:
    return (a, b) if a.number <= b.number else (b, a)


def _scaled(node: Node) -> tuple[Node, Number]:
    """A node split into its base and its numeric coefficient."""
    return node.content[0] if node.kind == "sum" and len(node.content) == 1 else (node, 1)


def _total(numbers: list[Number]) -> Number:
    """Sum of coefficients; integers are added first, which is faster."""
    integers = sum(number for number in numbers if type(number) is int)
    return sum((number for number in numbers if type(number) is not int), integers)


def _plain(number: Number) -> Number:
    """Coefficient as int if it is an integer, which is faster."""
    return number.numerator if isinstance(number, Fraction) and number.denominator == 1 else number
