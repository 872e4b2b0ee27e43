"""Quantities, which replace floats while a function is recorded. They follow Python's operators and NumPy's protocols."""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from ..symbolics.graph.graph import Node
from ..symbolics.graph.plain_functions import NAMED, SPLINE, Plain
from .formula import FUNCTIONS, IN_NUMPY, SIGNS, leaf
from .table import Table, table

LARGEST = 1.7976931348623157e308


class Unrecorded(Exception):
    """Error by which a function cannot be recorded: its reason."""


class Sheet:
    """Graph in which a function is recorded; `decide` follows one side of a condition."""

    def __init__(self, decide: Callable[[Node], bool]) -> None:
        self.graph, self.decide = Plain().graph, decide

    def leaf(self, name: str) -> Quantity:
        """Quantity of a name."""
        return Quantity(self, leaf(self.graph, name))

    def node(self, x: Any) -> Node:
        """Node of a quantity or number; a condition counts as 1 or 0."""
        if not isinstance(x, Quantity):
            return self.graph.number(_number(x))
        return self.graph.choice(((x.node, self.graph.one),), self.graph.zero) if x.is_condition else x.node

    def call(self, name: str, *x: Any) -> Quantity:
        """Function of the graph."""
        nodes = [*map(self.node, x)]
        if all(node.kind == "number" for node in nodes):
            return Quantity(self, self.graph.number(_number(FUNCTIONS[name](*(float(node.content[0]) for node in nodes)))))
        return Quantity(self, self.graph.call(NAMED[name], *nodes))

    def choice(self, condition: Quantity, value: Any, otherwise: Any) -> Quantity:
        """`value` if the condition holds, `otherwise` if not."""
        return Quantity(self, self.graph.choice(((condition.as_condition().node, self.node(value)),), self.node(otherwise)))


def _number(x: Any) -> Any:
    if isinstance(x, np.ndarray) and x.ndim == 0:
        x = x[()]
    if isinstance(x, bool | int | np.integer | np.bool_):
        return int(x)
    if isinstance(x, float | np.floating | Fraction):
        if not math.isfinite(x):
            raise Unrecorded("computes with a number that is not finite")
        return x if isinstance(x, Fraction) else float(x)
    raise Unrecorded(f"computes with {type(x).__name__}")


def _is_scalar(x: Any) -> bool:
    return isinstance(x, Quantity | bool | int | float | np.number | np.bool_ | Fraction)


def _binary(combine: Callable[[Sheet, Node, Node], Node], *, swapped: bool = False) -> Callable[[Quantity, Any], Any]:
    def method(self: Quantity, other: Any) -> Any:
        if not _is_scalar(other):
            return NotImplemented
        a, b = map(self.sheet.node, (other, self) if swapped else (self, other))
        return Quantity(self.sheet, combine(self.sheet, a, b))
    return method


def _power(sheet: Sheet, base: Node, exponent: Node) -> Node:
    if base.kind == exponent.kind == "number":
        return sheet.call("Pow", base.content[0], exponent.content[0]).node
    return sheet.graph.power(base, exponent, NAMED["Pow"])


def _compared(sign: str) -> Callable[[Quantity, Any], Any]:
    def method(self: Quantity, other: Any) -> Any:
        if not _is_scalar(other):
            return NotImplemented
        if isinstance(other, float | np.floating) and not math.isfinite(other):        # quantities are finite
            return SIGNS[sign](0.0, float(other))
        a, b = map(self.sheet.node, (self, other))
        if a.kind == b.kind == "number":
            return SIGNS[sign](a.content[0], b.content[0])
        if sign in (">", ">="):     # one form of each
            return Quantity(self.sheet, self.sheet.graph.comparison("<=" if sign == ">=" else "<", b, a))
        return Quantity(self.sheet, self.sheet.graph.comparison(sign, a, b))
    return method


def _joined(word: str) -> Callable[[Quantity, Any], Any]:
    def method(self: Quantity, other: Any) -> Any:
        if isinstance(other, bool | np.bool_):
            return self if other == (word == "and") else bool(other)
        if not isinstance(other, Quantity):
            return NotImplemented
        return Quantity(self.sheet, self.sheet.graph.logic(word, self.as_condition().node, other.as_condition().node))
    return method


def _converted(*_: Any) -> Any:
    raise Unrecorded("converts a value to a plain number")


class Quantity:
    """Node in place of a float; conditions are quantities, too."""

    __slots__ = ("node", "sheet")
    __hash__ = None     # type: ignore[assignment]

    def __init__(self, sheet: Sheet, node: Node) -> None:
        self.sheet, self.node = sheet, node

    @property
    def is_condition(self) -> bool:
        return self.node.kind in ("comparison", "logic")

    @property
    def is_leaf(self) -> bool:
        """True of t, measures and parameters, which are finite."""
        return self.node.kind == "leaf"

    def as_condition(self) -> Quantity:
        """The condition that it is, or that it is not zero."""
        return self if self.is_condition else self != 0

    def __bool__(self) -> bool:
        condition = self.as_condition()
        return self.sheet.decide(condition.node) if isinstance(condition, Quantity) else condition

    __add__ = __radd__ = _binary(lambda sheet, a, b: sheet.graph.plus(a, b))
    __mul__ = __rmul__ = _binary(lambda sheet, a, b: sheet.graph.times(a, b))
    __sub__, __rsub__ = (_binary(lambda sheet, a, b: sheet.graph.sum([(a, 1), (b, -1)]), swapped=swapped)
                         for swapped in (False, True))
    __truediv__, __rtruediv__ = (_binary(lambda sheet, a, b: sheet.graph.product([(a, 1), (b, -1)]), swapped=swapped)
                                 for swapped in (False, True))
    __pow__, __rpow__ = (_binary(_power, swapped=swapped) for swapped in (False, True))
    __lt__, __le__, __gt__, __ge__ = map(_compared, ("<", "<=", ">", ">="))
    __eq__, __ne__ = _compared("=="), _compared("!=")   # type: ignore[assignment]
    __and__ = __rand__ = _joined("and")
    __or__ = __ror__ = _joined("or")
    __float__ = __complex__ = __round__ = __iter__ = __len__ = _converted
    __str__ = __repr__ = __format__ = _converted

    def __index__(self) -> int:
        """1 or 0 of a condition, each on a path of its own."""
        return int(bool(self)) if self.is_condition else _converted()

    __int__ = __index__

    def __neg__(self) -> Any:
        return -1 * self

    def __pos__(self) -> Quantity:
        return self

    conjugate = __pos__
    real = property(__pos__)

    def __abs__(self) -> Quantity:
        return self.sheet.call("Abs", self)

    def __invert__(self) -> Quantity:
        return Quantity(self.sheet, self.sheet.graph.logic("not", self.as_condition().node))

    def __floor__(self) -> Quantity:
        return self.sheet.call("floor", self)

    def __ceil__(self) -> Quantity:
        return self.sheet.call("ceiling", self)

    def __trunc__(self) -> Quantity:
        return where(self < 0, math.ceil(self), math.floor(self))

    def __mod__(self, y: Any) -> Any:
        return remainder(self, y) if _is_scalar(y) else NotImplemented

    def __rmod__(self, x: Any) -> Any:
        return remainder(x, self) if _is_scalar(x) else NotImplemented

    def __floordiv__(self, y: Any) -> Any:
        return quotient(self, y) if _is_scalar(y) else NotImplemented

    def __rfloordiv__(self, x: Any) -> Any:
        return quotient(x, self) if _is_scalar(x) else NotImplemented

    def __divmod__(self, y: Any) -> Any:
        return self // y, self % y

    def read(self, table: Any) -> Quantity:
        """Value of a table."""
        graph = self.sheet.graph
        return Quantity(self.sheet, graph.call(SPLINE, leaf(graph, table), self.sheet.node(self), graph.zero))

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **more: Any) -> Any:
        return _applied(ufunc, method, inputs, more)

    def __array_function__(self, function: Any, types: Any, inputs: Any, more: Any) -> Any:
        return _called(function, inputs, more)


class Quantities(np.ndarray[Any, Any]):
    """Array of quantities and numbers, of dtype object."""

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **more: Any) -> Any:
        return _applied(ufunc, method, inputs, more)

    def __array_function__(self, function: Any, types: Any, inputs: Any, more: Any) -> Any:
        return _called(function, inputs, more)


def of_array(x: Any) -> Any:
    """Array of objects as quantities, one without dimension as its entry; anything else unchanged."""
    if not isinstance(x, np.ndarray) or x.dtype != object:
        return x
    return x[()] if x.ndim == 0 else x.view(Quantities)


def _objects(x: Any) -> Any:
    """Quantities within arguments as arrays of objects without protocols."""
    if isinstance(x, Quantity):
        found = np.empty((), dtype=object)
        found[()] = x
        return found
    if isinstance(x, Quantities):
        return x.view(np.ndarray)
    return [_objects(each) if isinstance(each, list | tuple) else each for each in x] if type(x) in (list, tuple) else x


def _applied(ufunc: np.ufunc, method: str, inputs: tuple[Any, ...], more: dict[str, Any]) -> Any:
    """Result of a universal function."""
    if method != "__call__" or ufunc.signature is not None:
        return of_array(getattr(ufunc, method)(*map(_objects, inputs), **more))
    if [*more] == ["out"]:
        out, = more["out"]
        out[...] = _applied(ufunc, method, inputs, {})
        return out
    if more:
        raise Unrecorded(f"calls np.{ufunc.__name__} with {', '.join(more)}")
    function = functools.partial(_of_one, ufunc)
    if all(map(_is_scalar, inputs)):
        return function(*inputs)
    return of_array(np.frompyfunc(function, ufunc.nin, 1)(*map(_objects, inputs)))


def _of_one(ufunc: np.ufunc, *x: Any) -> Any:
    if not any(isinstance(each, Quantity) for each in x):
        return ufunc(*x)
    if ufunc.__name__ not in UFUNCS:
        raise Unrecorded(f"calls np.{ufunc.__name__}")
    return UFUNCS[ufunc.__name__](*(each.item() if isinstance(each, np.generic) else each for each in x))


def _called(function: Any, inputs: tuple[Any, ...], more: dict[str, Any]) -> Any:
    """Result of any other function of NumPy: its own code, which computes with objects."""
    if function.__name__ in CALLS:
        return CALLS[function.__name__](*inputs, **more)
    return of_array(function(*map(_objects, inputs), **{name: _objects(value) for name, value in more.items()}))


# ---- functions ----

def where(condition: Any, value: Any, otherwise: Any) -> Any:
    """`value` where the condition holds, `otherwise` elsewhere, entry by entry."""
    def one(condition: Any, value: Any, otherwise: Any) -> Any:
        return condition.sheet.choice(condition, value, otherwise) if isinstance(condition, Quantity) else (
            value if condition else otherwise)
    parts = condition, value, otherwise
    return one(*parts) if all(map(_is_scalar, parts)) else of_array(np.frompyfunc(one, 3, 1)(*map(_objects, parts)))


def largest(*x: Any) -> Any:
    """Maximum, as Python has it: the first of equal ones."""
    return functools.reduce(lambda best, other: where(other > best, other, best), x)


def smallest(*x: Any) -> Any:
    """Minimum, likewise."""
    return functools.reduce(lambda best, other: where(other < best, other, best), x)


def remainder(x: Any, y: Any) -> Any:
    """Remainder x % y, which has the sign of y."""
    rest = function("fmod", x, y)
    other_sign = (rest < 0) & (y > 0) | (rest > 0) & (y < 0) if isinstance(y, Quantity) else rest < 0 if y > 0 else rest > 0
    return where(other_sign, rest + y, rest)


def quotient(x: Any, y: Any) -> Any:
    """Quotient x // y: the whole number nearest to that of x less the remainder."""
    return function("floor", (x - remainder(x, y)) / y + 0.5)


def function(name: str, *x: Any) -> Any:
    """Function of the graph."""
    return next(each.sheet for each in x if isinstance(each, Quantity)).call(name, *x)


def _clip(x: Any, low: Any = None, high: Any = None, **more: Any) -> Any:
    """Value of x within limits, as np.clip has it."""
    low, high = (more.pop(name, limit) for name, limit in (("min", low), ("max", high)))
    low, high = more.pop("a_min", low), more.pop("a_max", high)
    if more:
        raise Unrecorded(f"calls np.clip with {', '.join(more)}")
    x = x if low is None else UFUNCS["maximum"](x, low) if _is_scalar(x) else np.maximum(x, low)
    return x if high is None else UFUNCS["minimum"](x, high) if _is_scalar(x) else np.minimum(x, high)


@functools.cache
def _curve(x: tuple[float, ...], y: tuple[float, ...]) -> Table:
    return table(np.array(x), y, kind="linear", beyond="hold")


def _interpolated(x: Any, known: Any, values: Any) -> Any:
    """Value at x between known ones, as np.interp has it."""
    return _curve(tuple(map(float, known)), tuple(map(float, values)))(x)


def _select(conditions: Any, values: Any, default: Any = 0) -> Any:
    return functools.reduce(lambda rest, case: where(case[0], case[1], rest),
                            reversed(list(zip(conditions, values, strict=True))), default)


def _cube_root(x: Any) -> Any:
    return where(x < 0, -((-x) ** (1 / 3)), x ** (1 / 3))


def _named(name: str) -> Callable[..., Any]:
    return lambda *x: function(name, *x)


# by NumPy's names
UFUNCS: dict[str, Callable[..., Any]] = {
    "add": operator.add, "subtract": operator.sub, "multiply": operator.mul, "divide": operator.truediv,
    "true_divide": operator.truediv, "negative": operator.neg, "positive": operator.pos, "power": operator.pow,
    "float_power": operator.pow, "absolute": abs, "fabs": abs, "square": lambda x: x * x, "reciprocal": lambda x: 1 / x,
    "sqrt": lambda x: x ** 0.5, "cbrt": _cube_root, "remainder": remainder, "floor_divide": quotient, "fmod": _named("fmod"),
    "floor": math.floor, "ceil": math.ceil, "trunc": math.trunc, "maximum": lambda a, b: where(a >= b, a, b), "minimum":
    lambda a, b: where(a <= b, a, b), "sign": lambda x: where(x > 0, 1, where(x < 0, -1, 0)), "heaviside":
    lambda x, middle: where(x < 0, 0, where(x > 0, 1, middle)), "less": operator.lt, "less_equal": operator.le,
    "greater": operator.gt, "greater_equal": operator.ge, "equal": operator.eq, "not_equal": operator.ne,
    "logical_and": operator.and_, "logical_or": operator.or_, "logical_not": operator.invert, "bitwise_and": operator.and_,
    "bitwise_or": operator.or_, "invert": operator.invert, "exp2": lambda x: 2 ** x, "deg2rad": lambda x: x * (math.pi / 180),
    "radians": lambda x: x * (math.pi / 180), "rad2deg": lambda x: x * (180 / math.pi), "degrees": lambda x: x * (180 / math.pi),
    "copysign": lambda x, y: where(y < 0, -abs(x), abs(x)), "conjugate": lambda x: x,
    "erf": _named("erf"), "erfc": _named("erfc"),
    "isnan": lambda x: False if x.is_leaf else x != x, "isfinite": lambda x: True if x.is_leaf else abs(x) <= LARGEST,
    "isinf": lambda x: False if x.is_leaf else abs(x) > LARGEST,
    **{of: _named(name) for name, of in IN_NUMPY.items()}}
UFUNCS |= {"fmax": UFUNCS["maximum"], "fmin": UFUNCS["minimum"]}
CALLS: dict[str, Callable[..., Any]] = {"where": where, "clip": _clip, "select": _select, "interp": _interpolated}
