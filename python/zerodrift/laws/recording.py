"""Recording of user functions: what a function computes becomes a formula, which the core evaluates and code is written of.

The function runs on quantities, once for each of its paths: a branch on a value is followed on both sides. It is recorded twice,
and the formula is compared with the function at points of every path. A function that cannot be recorded stays a call.
"""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from .formula import Evaluation, Formula, Operation
from .outside import Outside
from .quantities import Quantity, Tape, Unrecorded, of_array

MAX_PATHS = 64
POINTS = 3          # of each path, at which the formula is compared with the function
ATTEMPTS = 2000     # points that are tried for these
ROUNDING = 1e-12    # of the largest operand


class Branch(NamedTuple):
    """Condition, and what follows where it holds and where not: branches, or at last the path's number."""

    condition: int
    yes: Branch | int
    no: Branch | int


def record(given: Callable[..., Any], names: Sequence[str], parameters: Mapping[str, float],
           last: Formula | None = None) -> tuple[Formula | None, str]:
    """Formula of a function of these arguments, some of which are parameters; or None, and the reason why it stays a call.

    `last` is its formula at an earlier time, which is compared already.
    """
    try:
        formula, tree, paths = _formula(given, names)
        if formula == last:
            return formula, ""
        if formula != _formula(given, names)[0]:
            raise Unrecorded("is different at each call")
        _compare(given, formula, tree, paths, names, parameters)
    except Unrecorded as error:
        return None, str(error)
    except Exception as error:      # of objects that are not as others
        return None, f"cannot be copied, which raises {type(error).__name__}"
    return formula, ""


# ---- paths ----

class _Paths:
    """Exploration of a function's paths."""

    def __init__(self, function: Callable[..., Any], names: Sequence[str]) -> None:
        self._function, self._names, self.count = function, names, 0
        self.tape = Tape(self._decide)
        self._forced: list[tuple[int, bool]] = []
        self._taken: list[tuple[int, bool]] = []

    def follow(self, forced: list[tuple[int, bool]]) -> tuple[int, Branch | int]:
        """Operation of the result after these decisions, and the tree of the paths."""
        number, self.count = self.count, self.count + 1
        if self.count > MAX_PATHS:
            raise Unrecorded(f"has more than {MAX_PATHS} paths")
        self._forced, self._taken = forced, []
        result = self.tape.operand(_scalar(self._run()))
        taken, tree = self._taken, number
        if taken[:len(forced)] != forced:
            raise Unrecorded("is different at each call")
        found: tuple[int, Branch | int] = result, tree
        for i in reversed(range(len(forced), len(taken))):
            condition, decision = taken[i]
            other = self.follow([*taken[:i], (condition, not decision)])
            value = self.tape.choice(Quantity(self.tape, condition), *(Quantity(self.tape, each) for each in (found[0], other[0])))
            found = value.number, Branch(condition, found[1], other[1])
        return found

    def _run(self) -> Any:
        leaves = {name: self.tape.add("leaf", name) for name in self._names}
        try:
            with np.errstate(all="ignore"):
                return self._function(*leaves.values()) if isinstance(self._function, np.ufunc) else self._function(**leaves)
        except Unrecorded:
            raise
        except RecursionError:
            raise Unrecorded("calls itself too often") from None
        except Exception as error:
            raise Unrecorded(f"raises {type(error).__name__} on one of its paths: {str(error)[:80]}") from None

    def _decide(self, condition: int) -> bool:
        known = self._known(condition)
        if known is not None:
            return known
        number = len(self._taken)
        decision = self._forced[number][1] if number < len(self._forced) else True
        if number > MAX_PATHS * 16:
            raise Unrecorded("has a loop whose length depends on a value")
        self._taken.append((condition, decision))
        return decision

    def _known(self, condition: int) -> bool | None:
        """Decision that follows from earlier ones; None if it is open."""
        for earlier, decision in self._taken:
            if earlier == condition:
                return decision
        bound = self._bound(condition)
        if bound is None:
            return None
        subject, sign, number, is_left = bound
        low, high, low_open, high_open, apart = -math.inf, math.inf, False, False, set[float]()
        for earlier, decision in self._taken:
            other = self._bound(earlier)
            if other is None or other[0] != subject:
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

    def _bound(self, condition: int) -> tuple[int, str, float, bool] | None:
        """Comparison with a number: the operation, sign, number, and whether the number is on the right; None for others."""
        operation = self.tape.operations[condition]
        if operation[0] != "comparison":
            return None
        sign, a, b = operation[1:]
        for subject, number, is_left in ((a, b, True), (b, a, False)):
            if self.tape.operations[number][0] == "number":
                return subject, sign, float(self.tape.operations[number][1]), is_left
        return None


def _decided(sign: str, number: float, is_left: bool, interval: tuple[float, float, bool, bool], apart: set[float]) -> bool | None:
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


def _formula(given: Callable[..., Any], names: Sequence[str]) -> tuple[Formula, Branch | int, int]:
    """Formula, tree of paths, and their number."""
    outside = Outside()
    paths = _Paths(outside.of(given), names)
    result, tree = paths.follow([])
    if changed := outside.changed():
        raise Unrecorded(f"changes a {changed}")
    return Formula(paths.tape.operations, result), tree, paths.count


# ---- comparison with the function ----

def _compare(given: Callable[..., Any], formula: Formula, tree: Branch | int, paths: int, names: Sequence[str],
             parameters: Mapping[str, float]) -> None:
    """Check that the formula has the function's values at points of every path, and at borders."""
    open_paths = dict.fromkeys(range(paths), POINTS)
    for attempt, point in enumerate(_points(formula.operations, names, parameters)):
        if not open_paths or attempt >= ATTEMPTS:
            break
        evaluation = Evaluation(formula.operations, point)
        try:
            path = tree
            while isinstance(path, Branch):
                path = path.yes if evaluation(path.condition) else path.no
            if path not in open_paths and attempt > POINTS * 16:
                continue
            value = float(evaluation(formula.result))
        except (ArithmeticError, ValueError):       # beyond a table, for example
            continue
        if not math.isfinite(value):
            continue
        _check(given, point, value, max(abs(float(each)) for each in evaluation.values.values()))
        if open_paths.get(path, 0) > 1:
            open_paths[path] -= 1
        else:
            open_paths.pop(path, None)
    if len(open_paths) == paths and paths == 1 and open_paths[0] == POINTS:
        raise Unrecorded("has no value at the points that were tried")
    if paths > 1 and any(left == POINTS for left in open_paths.values()):
        raise Unrecorded("has a path that no point was found for")


def _check(given: Callable[..., Any], point: Mapping[str, float], value: float, largest: float) -> None:
    try:
        with np.errstate(all="ignore"):
            expected = given(*point.values()) if isinstance(given, np.ufunc) else given(**point)
        expected = float(expected)
    except Exception as error:
        raise Unrecorded(f"raises {type(error).__name__} where its formula has a value") from None
    if not abs(value - expected) <= ROUNDING * max(largest, abs(expected)):
        raise Unrecorded("has other values with numbers than while it is recorded")


def _points(operations: Sequence[Operation], names: Sequence[str], parameters: Mapping[str, float]) -> Any:
    """Points: random ones of several sizes, and such whose coordinates are the formula's own numbers, or near them or between."""
    chance = random.Random(0)
    numbers = sorted({float(operation[1]) for operation in operations if operation[0] == "number"} | {0.0, 1.0})
    between = [(a + b) / 2 for a, b in itertools.pairwise(numbers)]
    near = [factor * number for number in numbers for factor in (-1.0, 0.9, 1.1, -0.9, -1.1)]
    pool = [*numbers, *between, *near, numbers[0] - 1.0, numbers[-1] + 1.0]
    for table in {operation[1] for operation in operations if operation[0] == "spline"}:
        pool += [float(x) for x in np.linspace(table.x[0], table.x[-1], 7)]
    measured = [name for name in names if name not in parameters]

    def random_number() -> float:
        if chance.random() < 0.5:
            return chance.choice(pool)
        return chance.choice([-1, 1]) * 10 ** chance.uniform(-2, 1.5 if chance.random() < 0.8 else 4)

    while True:
        yield {**{name: float(parameters[name]) for name in names if name in parameters},
               **{name: random_number() for name in measured}}


