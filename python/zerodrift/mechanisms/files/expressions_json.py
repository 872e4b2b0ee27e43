"""Formulas as JSON: numbers, names, and lists of an operation and its parts, ``["*", 0.5, ["sin", "t"]]``.

They are read without evaluating text as code, and only operations of the tables below.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import Any

from ...errors import WrongValue
from ...laws.formula import FUNCTIONS, Formula, leaf
from ...laws.table import spline_from_json
from ...symbolics.graph.graph import Graph, Node
from ...symbolics.graph.plain_functions import NAMED, SPLINE, Plain, sign

SIGNS = {"<": "<", "<=": "<=", ">": ">", ">=": ">=", "=": "==", "!=": "!="}
WORDS = {sign: word for word, sign in SIGNS.items()}
CALLED = tuple(name for name in FUNCTIONS if name != SPLINE.__name__)
TABLE = "table"     # its data, and its argument
DEEPEST = 100       # nested operations, at most, for Python's stack
MAX_WORDS = 100_000     # of a formula, in which parts that are used twice are written twice
LARGEST = int(1.7976931348623157e308)      # the largest double
MAX_BITS = 3000         # bits, at most, of powers of numbers, which are exact
CONSTANTS = {"pi": math.pi, "e": math.e, "true": True, "false": False}


def to_json(formula: Formula, what: str, leaves: Mapping[str, Any] = MappingProxyType({})) -> Any:
    """Formula as lists of words and numbers; `leaves` replace names, and errors name its owner `what`."""
    written = list[Any]()
    for kind, content in formula.operations:
        match kind:
            case "leaf":
                made = leaves.get(content, content) if isinstance(content, str) else content.to_json()
            case "number":
                made = _number(content)
            case "sum":
                made = ["+", *(written[each] if factor == 1 else ["*", _number(factor), written[each]]
                               for each, factor in content)]
            case "product":
                made = ["*", *(written[each] if exponent == 1 else ["^", written[each], _number(exponent)]
                               for each, exponent in content)]
            case "comparison":
                made = [WORDS[content[0]], written[content[1]], written[content[2]]]
            case "choice":
                made = ["cases", *([written[value], written[condition]] for condition, value in content[0]),
                        [written[content[1]], ["true"]]]
            case "call" if content[0] == SPLINE.__name__:
                made = [TABLE, *(written[each] for each in content[1][:2])]
            case _:
                made = [content[0], *(written[each] for each in content[1])]
        written.append(made[1] if isinstance(made, list) and len(made) == 2 and made[0] in ("+", "*") else made)
    if _size(written[-1], {}) > MAX_WORDS:
        raise WrongValue(f"{what} must have at most {MAX_WORDS} words, to be saved", "not-portable")
    return written[-1]


def _number(value: Any) -> Any:
    if isinstance(value, Fraction):
        return ["/", value.numerator, value.denominator]
    if not math.isfinite(value):    # where an expression has no value
        return ["nan"]
    return value


def _size(written: Any, sizes: dict[int, int]) -> int:
    """Number of words of an expression whose parts may be shared."""
    if not isinstance(written, list):
        return 1
    if id(written) not in sizes:
        sizes[id(written)] = sum(_size(part, sizes) for part in written)
    return sizes[id(written)]


def from_json(written: Any, what: str) -> Formula:
    """Formula from lists of words and numbers; errors name its owner `what` and the wrong part."""
    graph = Plain().graph
    found = _Reading(graph, what)(written, 0)
    if not isinstance(found, Node):
        raise WrongValue(f"{what} must be a number or an expression, not a condition", "unreadable-file")
    formula = Formula.of(found)
    for kind, content in formula.operations:
        for number in [content] if kind == "number" else [factor for _, factor in content] if kind == "sum" else []:
            if abs(number) > LARGEST:
                raise WrongValue(f"{what} must have numbers within the range of doubles", "unreadable-file")
    return formula


class _Reading:
    """Reading of one expression into a graph; conditions that are known are True and False."""

    def __init__(self, graph: Graph, what: str) -> None:
        self._graph, self._what = graph, what

    def __call__(self, written: Any, depth: int) -> Any:
        graph, what = self._graph, self._what
        if depth > DEEPEST:
            raise WrongValue(f"{what} must have at most {DEEPEST} operations within operations", "unreadable-file")
        if isinstance(written, str):
            return leaf(graph, written)
        if isinstance(written, int | float) and not isinstance(written, bool):
            return graph.number(written)
        if not isinstance(written, list):
            raise WrongValue(f"{what} has {written!r}, which is not part of an expression", "unreadable-file")
        word, *parts = written or [None]
        word = word if isinstance(word, str) else str(word)
        if word in CONSTANTS and not parts:
            constant = CONSTANTS[word]
            return constant if isinstance(constant, bool) else graph.number(constant)
        if word == "nan" and not parts:
            return graph.number(math.nan)
        if word == TABLE and len(parts) == 2:
            return self._table(parts[0], self(parts[1], depth + 1))
        if word == "/" and len(parts) == 2 and all(type(part) is int for part in parts) and parts[1]:
            return graph.number(Fraction(*parts))
        if word == "cases" and parts and all(isinstance(part, list) and len(part) == 2 for part in parts):
            return self._choice([tuple(self(each, depth + 1) for each in part) for part in parts])
        read = [self(part, depth + 1) for part in parts]
        if word in ("and", "or", "not"):
            return self._logic(word, read)
        if word not in OPERATIONS and word not in SIGNS and word not in CALLED:
            known = [*OPERATIONS, *SIGNS, *CALLED, TABLE, "cases", "and", "or", "not", *CONSTANTS, "/"]
            raise WrongValue(f"{what} has the operation {word!r}; there are {', '.join(known)}", "unreadable-file")
        if not all(isinstance(part, Node) and part.kind not in ("comparison", "logic") for part in read):
            raise self.refusal(word)
        return self._of(word, read)

    def _table(self, given: Any, x: Any) -> Node:
        try:
            table = spline_from_json(given)
        except (TypeError, ValueError):
            raise self.refusal(TABLE) from None
        if not isinstance(x, Node) or x.kind in ("comparison", "logic"):
            raise self.refusal(TABLE)
        return self._graph.call(SPLINE, leaf(self._graph, table), x, self._graph.zero)

    def refusal(self, word: str) -> WrongValue:
        return WrongValue(f"{self._what} has the operation {word!r} of parts that it cannot have", "unreadable-file")

    def _of(self, word: str, read: list[Node]) -> Node:
        graph = self._graph
        self._check_power(word, read)
        try:
            if word in SIGNS:
                a, b = read
                return graph.comparison(SIGNS[word], a, b)
            if word in OPERATIONS:
                return OPERATIONS[word](graph, *read)
            found = graph.call(NAMED[word], *read)
            graph.slope(NAMED[word], 0, tuple(read))        # which takes as many arguments
        except (TypeError, ValueError, OverflowError, ZeroDivisionError):
            raise self.refusal(word) from None
        return found

    def _check_power(self, word: str, read: list[Node]) -> None:
        """Check that a power of numbers does not fill the memory."""
        if word == "^" and len(read) == 2 and all(node.kind == "number" for node in read):
            base, exponent = (node.content[0] for node in read)
            bits = max(abs(base.numerator), base.denominator).bit_length() if isinstance(base, int | Fraction) else 0
            if bits > 1 and abs(exponent) * bits > MAX_BITS:
                raise WrongValue(f"{self._what} must not have the power {str(base)[:20]}^{str(exponent)[:20]}, whose digits "
                                 "would fill the memory", "unreadable-file")

    def _choice(self, cases: list[tuple[Any, Any]]) -> Any:
        otherwise: Any = self._graph.number(math.nan)
        read = []
        for value, condition in cases:
            if (isinstance(condition, Node) and condition.kind not in ("comparison", "logic")) or not isinstance(value, Node):
                raise self.refusal("cases")
            if condition is True:
                otherwise = value
                break
            read += [(condition, value)] if condition is not False else []
        return self._graph.choice(tuple(read), otherwise) if read else otherwise

    def _logic(self, word: str, read: list[Any]) -> Any:
        is_right = all(isinstance(part, bool) or part.kind in ("comparison", "logic") for part in read)
        if not read or not is_right or (word == "not") > (len(read) == 1):
            raise self.refusal(word)
        if word == "not":
            return not read[0] if isinstance(read[0], bool) else self._graph.logic(word, *read)
        if (word == "or") in read:
            return word == "or"
        open_parts = [part for part in read if not isinstance(part, bool)]
        return self._graph.logic(word, *open_parts) if len(open_parts) > 1 else open_parts[0] if open_parts else word == "and"


# ---- operations ----

def _extreme(word: str) -> Callable[..., Node]:
    def of(graph: Graph, best: Node, *others: Node) -> Node:
        for other in others:
            best = graph.choice(((graph.comparison(word, best, other), best),), other)
        return best
    return of


def _modulo(graph: Graph, x: Node, y: Node) -> Node:
    whole = graph.call(NAMED["floor"], graph.product([(x, 1), (y, -1)]))
    return graph.sum([(x, 1), (graph.times(y, whole), -1)])


def _step(graph: Graph, x: Node, middle: Node | None = None) -> Node:
    half = graph.number(Fraction(1, 2)) if middle is None else middle
    cases = (graph.comparison("<", x, graph.zero), graph.zero), (graph.comparison("==", x, graph.zero), half)
    return graph.choice(cases, graph.one)


OPERATIONS: dict[str, Callable[..., Node]] = {
    "+": Graph.plus, "*": Graph.times, "^": lambda graph, base, exponent: graph.power(base, exponent, NAMED["Pow"]), "sign": sign,
    "Min": _extreme("<"), "Max": _extreme(">"), "Mod": _modulo, "Heaviside": _step}
