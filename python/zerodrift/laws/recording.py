"""Recording of user functions: what a function computes becomes a formula, which the core evaluates and code is written of.

The function runs on quantities, once for each of its paths: a branch on a value is followed on both sides. It is recorded twice,
and the formula is compared with the function at points of every path. A function that cannot be recorded stays a call.
"""

from __future__ import annotations

import contextlib
import itertools
import math
import random
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..symbolics.graph.graph import Node
from .formula import Evaluation, Formula, Operation, operations
from .outside import Outside
from .quantities import Quantity, Sheet, Unrecorded, of_array

MAX_PATHS = 64
POINTS = 20         # of each path, at which the formula is compared with the function
ATTEMPTS = 500      # points that are tried for these: a path that none of them takes counts as one that is not reached
OPERAND_ROUNDING, NEARLY = 1e-12, 1e-9     # of the largest operand: rounding, and a change by rounding of the arguments


class Branch(NamedTuple):
    """Condition, and what follows where it holds and where not: branches, or at last the path's number."""

    condition: Node
    yes: Branch | int
    no: Branch | int


class Recorded(NamedTuple):
    """Formula of a function; or None, and the reason why it stays a call."""

    formula: Formula | None
    why_called: str = ""
    has_values: bool = False        # it reads numbers or objects from outside

    @property
    def has_state(self) -> bool:
        """True if the function is known to change what others may read."""
        return self.why_called.startswith(("sets", "changes"))


def record(given: Callable[..., Any], names: Sequence[str], parameters: Mapping[str, float],
           last: Formula | None = None) -> Recorded:
    """Record a function of these arguments, some of which are parameters.

    `last` is its formula at an earlier time, which is compared already.
    """
    try:
        paths = _Paths(given, names)
        result, tree = paths.follow([])
        formula = Formula.of(result)
        if formula != last:
            if formula != Formula.of(_Paths(given, names).follow([])[0]):
                raise Unrecorded("is different at each call")
            _compare(given, result, tree, paths.count, names, parameters)
    except Unrecorded as error:
        return Recorded(None, str(error))
    except Exception as error:      # raised by an object's own attribute access or hash
        return Recorded(None, f"raises {type(error).__name__} while it is copied")
    return Recorded(formula, has_values=paths.outside.has_values)


# ---- paths ----

class _Paths:
    """Exploration of a function's paths."""

    def __init__(self, given: Callable[..., Any], names: Sequence[str]) -> None:
        self.outside, self._names, self.count = Outside(), names, 0
        self._function = self.outside.of(given)
        self._sheet = Sheet(self._decide)
        self._forced: list[tuple[Node, bool]] = []
        self._taken: list[tuple[Node, bool]] = []

    def follow(self, forced: list[tuple[Node, bool]]) -> tuple[Node, Branch | int]:
        """Node of the result after these decisions, and the tree of the paths."""
        tree: Branch | int = self.count
        self.count += 1
        if self.count > MAX_PATHS:
            raise Unrecorded(f"has more than {MAX_PATHS} paths")
        self._forced, self._taken = forced, []
        result = self._sheet.node(_scalar(self._run()))
        taken = self._taken
        if taken[:len(forced)] != forced:
            raise Unrecorded("is different at each call")
        if changed := self.outside.changed():
            raise Unrecorded(f"changes a {changed}")
        for i in reversed(range(len(forced), len(taken))):
            condition = taken[i][0]
            other, branch = self.follow([*taken[:i], (condition, False)])
            result, tree = self._sheet.graph.choice(((condition, result),), other), Branch(condition, tree, branch)
        return result, tree

    def _run(self) -> Any:
        leaves = {name: self._sheet.leaf(name) for name in self._names}
        try:
            with np.errstate(all="ignore"):
                return self._function(*leaves.values()) if isinstance(self._function, np.ufunc) else self._function(**leaves)
        except Unrecorded:
            raise
        except RecursionError:
            raise Unrecorded("calls itself too often") from None
        except (Exception, SystemExit) as error:
            raise Unrecorded(f"raises {type(error).__name__} on one of its paths: {str(error)[:80]}") from None

    def _decide(self, condition: Node) -> bool:
        known = self._known(condition)
        if known is not None:
            return known
        number = len(self._taken)
        decision = self._forced[number][1] if number < len(self._forced) else True
        if number >= MAX_PATHS:     # each decision has a path of its own
            raise Unrecorded(f"has more than {MAX_PATHS} paths")
        self._taken.append((condition, decision))
        return decision

    def _known(self, condition: Node) -> bool | None:
        """Decision that follows from earlier ones; None if it is open."""
        for earlier, decision in self._taken:
            if earlier is condition:
                return decision
        bound = _bound(condition)
        if bound is None:
            return None
        subject, sign, number, is_left = bound
        low, high, low_open, high_open, apart = -math.inf, math.inf, False, False, set[float]()
        for earlier, decision in self._taken:
            other = _bound(earlier)
            if other is None or other[0] is not subject:
                continue
            _, of, at, left = other
            if of in ("==", "!="):
                if (of == "==") == decision:
                    low, high, low_open, high_open = max(low, at), min(high, at), False, False
                else:
                    apart.add(at)
                continue
            is_upper, is_open = left == decision, (of == "<") == decision
            if is_upper and (at < high or (at == high and is_open)):
                high, high_open = at, is_open
            if not is_upper and (at > low or (at == low and is_open)):
                low, low_open = at, is_open
        return _decided(sign, number, is_left, (low, high, low_open, high_open), apart)


def _bound(condition: Node) -> tuple[Node, str, float, bool] | None:
    """Comparison with a number: the node, sign, number, and whether the number is on the right; None for others."""
    if condition.kind != "comparison":
        return None
    sign, a, b = condition.content
    for subject, number, is_left in ((a, b, True), (b, a, False)):
        if number.kind == "number":
            return subject, sign, float(number.content[0]), is_left
    return None


def _decided(sign: str, number: float, is_left: bool, interval: tuple[float, float, bool, bool],
             apart: set[float]) -> bool | None:
    """Truth of a comparison of a quantity within an interval, if it is known."""
    low, high, low_open, high_open = interval
    if sign in ("==", "!="):
        outside = number < low or number > high or (number == low and low_open) or (number == high and high_open)
        equal = False if outside or number in apart else True if low == high == number else None
        return None if equal is None else equal == (sign == "==")
    if is_left:         # x < number, x <= number
        if high < number or (high == number and (sign == "<=" or high_open)):
            return True
        return False if low > number or (low == number and (sign == "<" or low_open)) else None
    if low > number or (low == number and (sign == "<=" or low_open)):      # number < x, number <= x
        return True
    return False if high < number or (high == number and (sign == "<" or high_open)) else None


def _scalar(result: Any) -> Any:
    result = of_array(result)
    if isinstance(result, np.ndarray):
        if result.ndim:
            raise Unrecorded(f"returns shape {result.shape}")
        result = result[()]
    if result is None or isinstance(result, bool | np.bool_ | str | complex) or (
            isinstance(result, Quantity) and result.is_condition):
        raise Unrecorded(f"returns {'a condition' if isinstance(result, Quantity) else type(result).__name__}")
    return result


# ---- comparison with the function ----

def _compare(given: Callable[..., Any], result: Node, tree: Branch | int, paths: int, names: Sequence[str],
             parameters: Mapping[str, float]) -> None:
    """Check that the formula has the function's values at points of every path, and at borders."""
    conditions = [*_conditions(tree)]
    found, (last, *places) = operations([result, *conditions])
    numbers = dict(zip(conditions, places, strict=True))
    open_paths = dict.fromkeys(range(paths), POINTS)
    for attempt, point in enumerate(_points(found, names, parameters)):
        if not open_paths or attempt >= ATTEMPTS:
            break
        evaluation = Evaluation(found, point)
        try:
            path = tree
            while isinstance(path, Branch):
                path = path.yes if evaluation(numbers[path.condition]) else path.no
            if path not in open_paths:
                continue
            value = float(evaluation(last))
        except (ArithmeticError, ValueError):       # beyond a table, for example
            continue
        sizes = [abs(each) for each in evaluation.values.values() if isinstance(each, int | float)]
        largest = max(size for size in sizes if size == size)
        _check(given, point, value, OPERAND_ROUNDING * largest + _change(found, last, point, value, NEARLY * largest))
        if math.isfinite(value):
            open_paths[path] -= 1
            open_paths = {path: left for path, left in open_paths.items() if left}
    if paths == 1 and open_paths == {0: POINTS}:
        raise Unrecorded("has no value at the points that were tried")


def _conditions(tree: Branch | int) -> dict[Node, None]:
    return {tree.condition: None, **_conditions(tree.yes), **_conditions(tree.no)} if isinstance(tree, Branch) else {}


def _change(found: Sequence[Operation], last: int, point: Mapping[str, float], value: float, most: float) -> float:
    """Change of a formula's value by the rounding of its arguments; 0 if it is large, as at a jump."""
    changes = [0.0]
    for factor in (1 - 2.0**-50, 1 + 2.0**-50):
        with contextlib.suppress(ArithmeticError, ValueError):
            changes.append(abs(float(Evaluation(found, {name: x * factor for name, x in point.items()})(last)) - value))
    return max(change for change in changes if change < most or not change)


def _check(given: Callable[..., Any], point: Mapping[str, float], value: float, allowed: float) -> None:
    """Check the formula's value at a point; where it is not finite, the function's must not be either.

    Python's division by zero raises where the quotient is infinite, and what follows may be finite.
    """
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            expected = given(*point.values()) if isinstance(given, np.ufunc) else given(**point)
        expected = float(expected)
    except (ZeroDivisionError, OverflowError):
        return
    except Exception as error:
        if not math.isfinite(value):
            return
        raise Unrecorded(f"raises {type(error).__name__} where its formula has a value") from None
    is_same = abs(value - expected) <= max(allowed, OPERAND_ROUNDING * abs(expected))
    if not (is_same if math.isfinite(value) else not math.isfinite(expected)):
        raise Unrecorded("has other values with numbers than while it is recorded")


def _points(operations: Sequence[Operation], names: Sequence[str],
            parameters: Mapping[str, float]) -> Iterator[dict[str, float]]:
    """Points of random numbers of several sizes, of borders of the names, and of the formula's numbers, near and between them."""
    chance = random.Random(0)
    numbers = sorted({float(number) for number in _numbers(operations)} | {0.0, 1.0})
    between = [(a + b) / 2 for a, b in itertools.pairwise(numbers)]
    near = [factor * number for number in numbers for factor in (-1.0, 0.9, 1.1, -0.9, -1.1)]
    pool = [*numbers, *between, *near, numbers[0] - 1.0, numbers[-1] + 1.0]
    for table in Formula(operations).tables:
        pool += np.linspace(table.x[0], table.x[-1], 7).tolist()
    borders = _borders(operations)

    def number(name: str) -> float:
        if name in borders and chance.random() < 0.4:
            return chance.choice(borders[name]) + chance.choice([0.0, 0.0, 1e-9, -1e-9])
        if chance.random() < 0.5:
            return chance.choice(pool)
        return chance.choice([-1, 1]) * 10 ** chance.uniform(-2, 1.5 if chance.random() < 0.8 else 4)

    while True:
        yield {name: float(parameters[name]) if name in parameters else number(name) for name in names}


def _numbers(operations: Sequence[Operation]) -> Iterator[Any]:
    for kind, content in operations:
        if kind == "number":
            yield content
        elif kind == "sum":
            yield from (number for each, number in content)


def _borders(operations: Sequence[Operation]) -> dict[str, list[float]]:
    """Values at which a comparison that depends on one name changes its truth."""
    found: dict[str, list[float]] = {}
    forms = list[tuple[str, float, float] | None]()     # a name times a number, plus another, or None
    for kind, content in operations:
        form = None
        if kind == "leaf" and isinstance(content, str):
            form = content, 1.0, 0.0
        elif kind == "number":
            form = "", 0.0, float(content)
        elif kind == "sum" and all(forms[each] for each, _ in content):
            parts = [(*forms[each], float(number)) for each, number in content]     # type: ignore[misc]
            if len({name for name, *_ in parts} - {""}) == 1:
                form = (max(name for name, *_ in parts), *(sum(part[k] * part[3] for part in parts) for k in (1, 2)))
        elif kind == "comparison" and (a := forms[content[1]]) and (b := forms[content[2]]) and len({a[0], b[0]} - {""}) == 1:
            slope = a[1] - b[1]
            if slope:
                found.setdefault(a[0] or b[0], []).append((b[2] - a[2]) / slope)
        forms.append(form)
    return found
