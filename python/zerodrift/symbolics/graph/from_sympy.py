"""From SymPy's expressions to a `Graph`. What C cannot compute is refused by name."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

import sympy
from sympy.core.function import Application, AppliedUndef
from sympy.logic.boolalg import BooleanFunction

from ...errors import WrongType, WrongValue
from .graph import Graph, Node
from .plain_functions import NAMED, Function, slope
from .sympy_functions import REWRITTEN, TOTAL, WITHIN, computable, named

SIGNS = {sympy.StrictLessThan: "<", sympy.LessThan: "<=", sympy.StrictGreaterThan: ">", sympy.GreaterThan: ">=",
         sympy.Equality: "==", sympy.Unequality: "!="}
LOGIC = {sympy.And: "and", sympy.Or: "or", sympy.Not: "not"}
LARGEST = int(1.7976931348623157e308)       # the largest double
UNDEFINED = math.nan         # one object, so that there is one node of it


def namesake(e: Any, others: Iterable[Any]) -> str:
    """End of an error message that names a different symbol with the same text; empty if there is none."""
    other = next((x for x in others if str(x) == str(e) and x != e), None)
    return "" if other is None else (
        f", {sympy.srepr(e)}, which to SymPy is another than the {other} that was given, {sympy.srepr(other)}: make it once, "
        "with the assumptions it shall have, and use it everywhere")


class Reader:
    """Reads expressions of one system; `known` says what leaf or expression each of its symbols is."""

    def __init__(self) -> None:
        self.graph = Graph(self._slope)
        self._partial: dict[Node, bool] = {}
        self._slopes: dict[tuple[Any, int, int], tuple[sympy.Expr, list[sympy.Dummy]]] = {}

    def read(self, what: str, expression: Any, known: Mapping[Any, Node]) -> Node:
        """Node of an expression; `what` names it in error messages."""
        try:
            given = sympy.sympify(expression, strict=True)      # strings would be evaluated
        except sympy.SympifyError as error:
            raise WrongType(f"{what} must be a SymPy expression, not {expression!r}") from error
        if isinstance(given, sympy.Equality):
            given = given.lhs - given.rhs
        if not isinstance(given, sympy.Expr) or given.is_Matrix:
            raise WrongType(f"{what} must be a scalar SymPy expression, not {expression!r}")
        return _Reading(self, what, known)(given)

    def _slope(self, function: Any, k: int, arguments: tuple[Node, ...]) -> Node:
        """The partial derivative of function(*arguments) by its k-th argument."""
        if isinstance(function, Function):
            return slope(self.graph, function, k, arguments)
        key = function, k, len(arguments)
        if key not in self._slopes:
            dummies = [sympy.Dummy(f"argument {i}", real=True) for i in range(len(arguments))]
            self._slopes[key] = function(*dummies).diff(dummies[k]), dummies
        found, dummies = self._slopes[key]
        return _Reading(self, f"the derivative of {function.__name__}", dict(zip(dummies, arguments, strict=True)))(found)

    def compared(self, condition: Node) -> list[Node]:
        """Nodes that a condition compares."""
        if condition.kind == "logic":
            return [operand for part in condition.content[1] for operand in self.compared(part)]
        if condition.kind == "choice":
            cases, otherwise = condition.content
            parts = (*(node for case in cases for node in case), otherwise)
            return [operand for part in parts for operand in self.compared(part)]
        return list(condition.content[1:]) if condition.kind == "comparison" else []

    def partial(self, node: Node) -> bool:
        """True if a node may be NaN for finite leaves, as with roots, quotients and logarithms."""
        if node not in self._partial:
            self._partial[node] = self._is_partial(node)
        return self._partial[node]

    def _is_partial(self, node: Node) -> bool:
        match node.kind:
            case "sum":
                return any(self.partial(term) for term, _ in node.content)
            case "product":
                return any(exponent < 0 or exponent != int(exponent) or self.partial(base) for base, exponent in node.content)
            case "call":
                function, arguments = node.content
                return function not in TOTAL or any(map(self.partial, arguments))
            case "choice":
                cases, otherwise = node.content
                return any(self.partial(value) for value in (*(value for _, value in cases), otherwise))
            case "number":
                return node.content[0] is UNDEFINED
            case _:
                return False


def _exact(node: Node) -> sympy.Expr:
    value = node.content[0]
    return sympy.Float(value) if isinstance(value, float) else sympy.Rational(value.numerator, value.denominator)


class _Reading:
    """Conversion of one expression; common subexpressions are read once."""

    def __init__(self, reader: Reader, what: str, known: Mapping[Any, Node]) -> None:
        self._reader, self._graph, self._what, self._known = reader, reader.graph, what, dict(known)

    def __call__(self, expression: Any) -> Node:
        node = self._known.get(expression)
        if node is None:
            node = self._known[expression] = self._of(expression)
        return node

    def refusal(self, expression: Any, why: str) -> ValueError:
        return WrongValue(f"{self._what} has {expression}, {why}", "expression")

    def _of(self, e: Any) -> Node:
        if e.is_Number or isinstance(e, sympy.NumberSymbol):
            return self._number(e)
        if e.is_Add:
            return self._graph.plus(*map(self, e.args))
        if e.is_Mul:
            return self._graph.times(*map(self, e.args))
        if e.is_Pow:
            return self._power(e)
        if isinstance(e, sympy.Piecewise):
            return self._choice([(condition, value) for value, condition in e.args])
        if isinstance(e, sympy.ITE):
            return self._choice([(e.args[0], e.args[1]), (sympy.true, e.args[2])])
        if isinstance(e, sympy.Max | sympy.Min):
            return self._extreme(e)
        if type(e) in SIGNS:
            return self._graph.comparison(SIGNS[type(e)], *map(self, e.args))
        if type(e) in LOGIC:
            return self._graph.logic(LOGIC[type(e)], *map(self, e.args))
        if type(e) in REWRITTEN:
            return self(REWRITTEN[type(e)](*e.args))
        if isinstance(e, Application) and not isinstance(e, AppliedUndef | BooleanFunction):
            return self._call(e)
        return self._other(e)

    def _number(self, e: Any) -> Node:
        if not e.is_finite:
            raise self.refusal(e, "which is no finite number")
        value: Any = Fraction(int(e.p), int(e.q)) if e.is_Rational else float(e)
        if not abs(value) <= LARGEST:
            raise self.refusal(f"{str(e)[:20]}...", "a number beyond the range of doubles")
        return self._graph.number(value)

    def _power(self, e: Any) -> Node:
        base, exponent = map(self, e.args)
        if base.kind == exponent.kind == "number":
            return self._constant(e)
        return self._graph.power(base, exponent, NAMED["Pow"])

    def _call(self, e: Any) -> Node:
        if not computable(type(e)):
            raise self.refusal(e, f"and {type(e).__name__} has no counterpart in C")
        arguments = [self(argument) for argument in e.args]
        if all(argument.kind == "number" for argument in arguments):
            return self._constant(e)
        value = self._graph.call(named(type(e)), *arguments)
        if type(e) in WITHIN:
            return self._choice([(WITHIN[type(e)](*e.args), value)])
        return value

    def _constant(self, e: Any) -> Node:
        """Value of an expression of numbers; derivatives of functions have placeholder symbols in their place."""
        if e.free_symbols:
            e = e.func(*(_exact(self(part)) for part in e.args))
        value = e.evalf(20)
        if not value.is_Float and not value.is_Rational:
            raise self.refusal(e, "which is no real number")
        return self._number(value)

    def _choice(self, cases: list[tuple[Any, Any]]) -> Node:
        read, otherwise = [], self._graph.number(UNDEFINED)
        for condition, value in cases:
            if condition == sympy.true:
                otherwise = self(value)
                break
            if condition != sympy.false:
                read.append((self(condition), value if isinstance(value, Node) else self(value)))
        return self._graph.choice((*self._without_value(read), *read), otherwise) if read else otherwise

    def _without_value(self, cases: list[tuple[Node, Node]]) -> list[tuple[Node, Node]]:
        """Additional case that is NaN if a compared quantity is NaN, as all comparisons with NaN are false."""
        operands = dict.fromkeys(operand for condition, _ in cases for operand in self._reader.compared(condition))
        wrong = [self._graph.comparison("!=", x, x) for x in operands if self._reader.partial(x)]
        if not wrong:
            return []
        return [(self._graph.logic("or", *wrong) if len(wrong) > 1 else wrong[0], self._graph.number(UNDEFINED))]

    def _extreme(self, e: Any) -> Node:
        """Max and Min that are NaN if one argument is NaN; C's fmax and fmin ignore a NaN."""
        best, *others = map(self, e.args)
        for other in others:
            case = self._graph.comparison(">" if isinstance(e, sympy.Max) else "<", best, other), best
            best = self._graph.choice((*self._without_value([case]), case), other)
        return best

    def _other(self, e: Any) -> Node:
        if e is sympy.S.ImaginaryUnit:
            raise self.refusal("I", "the imaginary unit; a symbol of that name is sympy.Symbol('I')")
        if isinstance(e, sympy.Derivative):
            done = e.doit()
            if done != e:
                return self(done)
            raise self.refusal(e, f"a derivative that is not the rate of a coordinate{self._namesake(e)}")
        if isinstance(e, AppliedUndef):
            missing = "a function that is neither a coordinate nor a speed: put its expression in its place"
            raise self.refusal(e, self._namesake(e)[2:] or missing)
        if isinstance(e, sympy.Symbol):
            raise self.refusal(e, self._namesake(e)[2:] or "to which parameters gives no value")
        raise self.refusal(e, f"and {type(e).__name__} has no counterpart in C")

    def _namesake(self, e: Any) -> str:
        return namesake(e, self._known)
