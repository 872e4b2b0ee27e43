"""From SymPy's expressions to a `Graph`. What C cannot compute is refused by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import sympy
from sympy.core.function import Application, AppliedUndef
from sympy.logic.boolalg import BooleanFunction

from .graph import Graph, Node

STEPS = (sympy.floor, sympy.ceiling)      # their derivative is zero but for jumps
SIGNS = {sympy.StrictLessThan: "<", sympy.LessThan: "<=", sympy.StrictGreaterThan: ">", sympy.GreaterThan: ">=",
         sympy.Equality: "==", sympy.Unequality: "!="}
LOGIC = {sympy.And: "and", sympy.Or: "or", sympy.Not: "not"}
REWRITTEN: dict[Any, Callable[..., sympy.Expr]] = {
    sympy.sec: lambda x: 1 / sympy.cos(x), sympy.csc: lambda x: 1 / sympy.sin(x), sympy.cot: lambda x: 1 / sympy.tan(x),
    sympy.sech: lambda x: 1 / sympy.cosh(x), sympy.csch: lambda x: 1 / sympy.sinh(x), sympy.coth: lambda x: 1 / sympy.tanh(x),
    sympy.Mod: lambda x, y: x - y * sympy.floor(x / y), sympy.frac: lambda x: x - sympy.floor(x),
    sympy.sign: lambda x: sympy.Piecewise((1, x > 0), (-1, x < 0), (0, True)),
    sympy.Heaviside: lambda x, middle: sympy.Piecewise((0, x < 0), (middle, sympy.Eq(x, 0)), (1, True)),
    sympy.sinc: lambda x: sympy.Piecewise((sympy.sin(x) / x, sympy.Ne(x, 0)), (1, True)),
    sympy.exp_polar: sympy.exp,
}


class Reader:
    """Reads expressions of one system; `known` says what leaf or expression each of its symbols is."""

    def __init__(self, computable: Callable[[Any], bool]) -> None:
        self.graph = Graph(self._slope)
        self._computable = computable
        self._slopes: dict[tuple[Any, int, int], tuple[sympy.Expr, list[sympy.Dummy]]] = {}

    def read(self, what: str, expression: Any, known: Mapping[Any, Node]) -> Node:
        """The node of an expression; `what` it is, for errors."""
        try:
            given = sympy.sympify(expression, strict=True)      # strings would be evaluated
        except sympy.SympifyError as error:
            raise TypeError(f"{what} must be a SymPy expression, not {expression!r}") from error
        if isinstance(given, sympy.Equality):
            given = given.lhs - given.rhs
        if not isinstance(given, sympy.Expr) or given.is_Matrix:
            raise TypeError(f"{what} must be a scalar SymPy expression, not {expression!r}")
        return _Reading(self, what, known)(given)

    def _slope(self, function: Any, k: int, arguments: tuple[Node, ...]) -> Node:
        """The partial derivative of function(*arguments) by its k-th argument."""
        key = function, k, len(arguments)
        if key not in self._slopes:
            dummies = [sympy.Dummy(f"argument {i}", real=True) for i in range(len(arguments))]
            slope = sympy.S.Zero if function in STEPS else function(*dummies).diff(dummies[k])
            self._slopes[key] = slope.replace(sympy.DiracDelta, lambda *_: sympy.S.Zero), dummies
        slope, dummies = self._slopes[key]
        return _Reading(self, f"the derivative of {function.__name__}", dict(zip(dummies, arguments, strict=True)))(slope)


class _Reading:
    """One expression, its parts read once each."""

    def __init__(self, reader: Reader, what: str, known: Mapping[Any, Node]) -> None:
        self._reader, self._graph, self._what, self._known = reader, reader.graph, what, dict(known)

    def __call__(self, expression: Any) -> Node:
        node = self._known.get(expression)
        if node is None:
            node = self._known[expression] = self._of(expression)
        return node

    def refusal(self, expression: Any, why: str) -> ValueError:
        return ValueError(f"{self._what} has {expression}, {why}")

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
        value = Fraction(int(e.p), int(e.q)) if e.is_Rational else float(e)
        try:
            float(value)
        except OverflowError:
            raise self.refusal(f"{str(e)[:20]}...", "a number beyond the range of doubles") from None
        return self._graph.number(value)

    def _power(self, e: Any) -> Node:
        base, exponent = map(self, e.args)
        if exponent.kind == "number":
            if base.kind == "number":
                return self._constant(e)
            value = exponent.content[0]
            return self._graph.product([(base, int(value) if value == int(value) else value)])
        return self._graph.call(sympy.Pow, base, exponent)

    def _call(self, e: Any) -> Node:
        if not self._reader._computable(type(e)):
            raise self.refusal(e, f"and {type(e).__name__} has no counterpart in C")
        arguments = [self(argument) for argument in e.args]
        if all(argument.kind == "number" for argument in arguments):
            return self._constant(e)
        return self._graph.call(type(e), *arguments)

    def _constant(self, e: Any) -> Node:
        value = e.evalf(20)
        if not value.is_Float and not value.is_Rational:
            raise self.refusal(e, "which is no real number")
        return self._number(value)

    def _choice(self, cases: list[tuple[Any, Any]]) -> Node:
        read = []
        for condition, value in cases:
            if condition == sympy.true:
                return self._graph.choice(tuple(read), self(value)) if read else self(value)
            if condition != sympy.false:
                read.append((self(condition), self(value)))
        return self._graph.choice(tuple(read), self._graph.number(float("nan")))

    def _other(self, e: Any) -> Node:
        if e is sympy.S.ImaginaryUnit:
            raise self.refusal("I", "the imaginary unit; a symbol of that name is sympy.Symbol('I')")
        if isinstance(e, sympy.Derivative):
            done = e.doit()
            if done != e:
                return self(done)
            raise self.refusal(e, "a derivative that is not the rate of a coordinate")
        if isinstance(e, AppliedUndef):
            raise self.refusal(e, "a function that is neither a coordinate nor a speed: put its expression in its place")
        if isinstance(e, sympy.Symbol):
            raise self.refusal(e, "to which parameters gives no value")
        raise self.refusal(e, f"and {type(e).__name__} has no counterpart in C")
