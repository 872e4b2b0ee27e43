"""Switches: comparisons of the motion at which a law jumps. Adaptive steps end where one changes."""

from __future__ import annotations

import functools
import math
import random
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from .formula import SIGNS, Evaluation, Formula, Operation, operands, with_operands

CROSSINGS, TRIALS = 24, 96      # of the border of a comparison at which the law is examined; segments on which these are sought
POINTS = 9          # of a segment, whose largest value is the scale of a jump
SMALLEST_JUMP = 1e-9        # jump that counts, relative to it
ORDERED = ("<", "<=", ">", ">=")


class Held(NamedTuple):
    """A formula with a number for each switch: 0 where the comparison decides, else the sign that its difference has."""

    formula: Formula
    differences: dict[str, Formula]     # of the two sides, by the name of the number


@functools.lru_cache(maxsize=1024)
def held(formula: Formula, moving: frozenset[str], numbers: tuple[tuple[str, float], ...]) -> Held:
    """Formula with its switches, from the names of measures that may decide, and the numbers of other names but t."""
    found = {i for i in _candidates(formula, moving, {"t", *dict(numbers)}) if _jumps(formula, i, sorted(moving), dict(numbers))}
    places, at, differences = list[Operation](), list[int](), dict[tuple[int, int], str]()

    def add(kind: str, content: Any) -> int:
        places.append((kind, content))
        return len(places) - 1

    for i, (kind, content) in enumerate(formula.operations):
        if i in found:
            sign, left, right = content
            is_turned = (right, left) in differences
            name = differences.setdefault((right, left) if is_turned else (left, right), f"side {len(differences)}")
            side, zero = add("leaf", name), add("number", 0)
            is_held = add("comparison", ("!=", side, zero))
            content = sign, *(add("choice", (((is_held, value),), at[of])) for value, of in zip(
                (zero, side) if is_turned else (side, zero), (left, right), strict=True))
        else:
            content = with_operands(kind, content, at.__getitem__)
        at.append(add(kind, content))
    return Held(Formula(places), {name: _difference(formula, *sides) for sides, name in differences.items()})


def _difference(formula: Formula, left: int, right: int) -> Formula:
    """Formula of the difference of two of its operations."""
    needed, waiting = set[int](), [left, right]
    while waiting:
        if (each := waiting.pop()) not in needed:
            needed.add(each)
            waiting += operands(*formula.operations[each])
    at = {each: i for i, each in enumerate(sorted(needed))}
    kept = [(kind, with_operands(kind, content, at.__getitem__))
            for kind, content in (formula.operations[each] for each in sorted(needed))]
    return Formula([*kept, ("sum", ((at[left], 1), (at[right], -1)))])


def _candidates(formula: Formula, moving: frozenset[str], others: Iterable[str]) -> Iterable[int]:
    """Comparisons of measures, of which nothing else decides but t and numbers."""
    known, moves = list[bool](), list[bool]()
    for i, (kind, content) in enumerate(formula.operations):
        given = operands(kind, content)
        known.append(all(known[each] for each in given) and (kind != "leaf" or content in moving or content in others))
        moves.append(any(moves[each] for each in given) or (kind == "leaf" and content in moving))
        if kind == "comparison" and content[0] in ORDERED and known[-1] and moves[-1]:
            yield i


def _jumps(formula: Formula, comparison: int, moving: list[str], numbers: Mapping[str, float]) -> bool:
    """True if the law has different values at the border of a comparison with either of its results."""
    draw = random.Random(1)
    last = len(formula.operations) - 1
    sign, *sides = formula.operations[comparison][1]

    def point() -> dict[str, float]:
        return {name: draw.choice((-1, 1)) * 10 ** draw.uniform(-3, 3) for name in moving} | {"t": 10 ** draw.uniform(-2, 2)}

    def of(at: Mapping[str, float], wanted: int, result: bool | None = None) -> float:
        value = Evaluation(formula.operations, {**numbers, **at})
        value.values |= {} if result is None else {comparison: result}
        try:
            return float(value(wanted))
        except (ArithmeticError, ValueError):
            return math.nan

    def holds(at: Mapping[str, float]) -> bool:
        return bool(SIGNS[sign](of(at, sides[0]), of(at, sides[1])))

    crossings = 0
    for _ in range(TRIALS):
        ends = point(), point()
        before = holds(ends[0])
        if before == holds(ends[1]):
            continue
        crossings += 1
        low, high = 0.0, 1.0

        def between(share: float, ends: tuple[dict[str, float], dict[str, float]] = ends) -> dict[str, float]:
            return {name: (1 - share) * value + share * ends[1][name] for name, value in ends[0].items()}

        while low < (middle := (low + high) / 2) < high:
            low, high = (middle, high) if holds(between(middle)) == before else (low, middle)
        scale = max((abs(each) for k in range(POINTS) if math.isfinite(each := of(between(k / (POINTS - 1)), last))), default=0.0)
        for share in (low, high):
            values = [of(between(share), last, result) for result in (False, True)]
            if abs(values[1] - values[0]) > SMALLEST_JUMP * max(scale or 1.0, *map(abs, values)):
                return True
        if crossings == CROSSINGS:
            break
    return False
