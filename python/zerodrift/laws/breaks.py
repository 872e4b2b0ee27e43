"""Breaks: times at which laws of t alone jump, or bend as the lines of a table do. Adaptive steps end there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..symbolics.graph.plain_functions import SPLINE
from .formula import FUNCTIONS, SIGNS, Evaluation, Formula, operands
from .table import Spline

MOST = 16               # lines that an operation may follow
SAMPLES = 256           # of a comparison over a period, between which it changes at most once
Break = tuple[float, tuple[float, ...]]     # s: a period, 0 for none, and times
Line = tuple[float, float]                  # value at t = 0, and slope


def of_spline(table: Spline, line: Line = (0.0, 1.0)) -> Iterable[Break]:
    """Breaks of a table whose argument is a line over time."""
    at, period = table.breaks()
    start, slope = line
    if at.size and slope:
        yield abs(period / slope), tuple(np.sort((at - start) / slope).tolist())


def of_formula(formula: Formula, numbers: Mapping[str, float]) -> Iterable[Break]:
    """Breaks of a formula, from the values of its names but t: those of comparisons, remainders, roundings and tables.

    Found are those of what consists of lines over time, or has a period. Some may be where nothing happens.
    """
    lines, periods = list[Sequence[Line]](), list[float | None]()
    for kind, content in formula.operations:
        given = operands(kind, content)
        lines.append(_lines(kind, content, lines, numbers))
        periods.append(_period(kind, content, [periods[each] for each in given], [lines[each] for each in given]))
        if kind == "comparison":
            left, right = (lines[each] for each in given)
            for (a, slope), (b, other) in itertools.product(left, right):
                if slope != other:
                    yield 0.0, ((b - a) / (slope - other),)
            if (period := periods[-1]) and (found := _changes(formula, content, numbers, period)):
                yield period, found
        elif kind == "call" and content[0] == SPLINE.__name__:
            for line in lines[given[1]]:
                yield from of_spline(formula.operations[given[0]][1], line)
        elif kind == "call":
            for start, slope in lines[given[0]]:
                if period := _spacing(content[0], slope, [lines[each] for each in given[1:]]):
                    yield period, ((-start / slope) % period,)


def _lines(kind: str, content: Any, lines: Sequence[Sequence[Line]], numbers: Mapping[str, float]) -> Sequence[Line]:
    """The lines over time that an operation may follow; none for another function."""
    given: list[Sequence[Line]] = [lines[each] for each in operands(kind, content)]
    if kind == "leaf":
        is_number = isinstance(content, str) and content in numbers
        return [(0.0, 1.0)] if content == "t" else [(numbers[content], 0.0)] if is_number else []
    if kind == "number":
        return [(float(content), 0.0)]
    if kind == "choice":
        values = [lines[each] for each in (*(value for _, value in content[0]), content[1])]
        return list(dict.fromkeys(itertools.chain(*values)))[:MOST] if all(values) else []
    if kind not in ("sum", "product", "call"):
        return []
    found = []
    for each in itertools.islice(itertools.product(*given), MOST):
        if kind == "sum":
            found.append((sum(line[0] * float(factor) for line, (_, factor) in zip(each, content, strict=True)),
                          sum(line[1] * float(factor) for line, (_, factor) in zip(each, content, strict=True))))
        elif kind == "product":
            found += _product([(line, float(exponent)) for line, (_, exponent) in zip(each, content, strict=True)])
        elif content[0] == "Abs":
            found += [each[0], (-each[0][0], -each[0][1])]
        elif not any(slope for _, slope in each):
            found.append((float(FUNCTIONS[content[0]](*(value for value, _ in each))), 0.0))
    return found


def _product(factors: Sequence[tuple[Line, float]]) -> list[Line]:
    """The product of powers of lines, at most one of which varies."""
    number, varying = 1.0, [line for line, _ in factors if line[1]]
    for (value, slope), exponent in factors:
        if (slope and exponent != 1) or len(varying) > 1:
            return []
        if not slope:
            number *= FUNCTIONS["Pow"](value, exponent)
    start, slope = varying[0] if varying else (1.0, 0.0)
    return [(number * start, number * slope)] if math.isfinite(number) else []


def _spacing(name: str, slope: float, others: Sequence[Sequence[Line]]) -> float:
    """Time between jumps of a remainder or a rounding of a line; 0 for another function."""
    if not slope or name not in ("floor", "ceiling", "fmod"):
        return 0.0
    if name != "fmod":
        return 1 / abs(slope)
    divisor = others[0][0] if others[0] else (0.0, 0.0)
    return 0.0 if divisor[1] else abs(divisor[0] / slope)


def _period(kind: str, content: Any, periods: Sequence[float | None], lines: Sequence[Sequence[Line]]) -> float | None:
    """Period of an operation; 0 of a number, None if there is none."""
    if kind in ("leaf", "number"):
        return 0.0 if kind == "number" or not isinstance(content, str) else None
    if kind == "call" and lines[0] and (slope := lines[0][0][1]):
        if content[0] in ("sin", "cos", "tan"):
            return 2 * math.pi / abs(slope)
        return _spacing("fmod", slope, lines[1:]) or None if content[0] == "fmod" else None
    known = [0.0 if line and not any(slope for _, slope in line) else period for period, line in zip(periods, lines, strict=True)]
    if None in known:
        return None
    lengths = [each for each in known if each]
    is_common = all(math.isclose(max(lengths) / each, round(max(lengths) / each), rel_tol=1e-12) for each in lengths)
    return max(lengths, default=0.0) if is_common else None


def _changes(formula: Formula, comparison: Any, numbers: Mapping[str, float], period: float) -> tuple[float, ...]:
    """Times in the second period after t = 0 at which a comparison changes."""
    sign, left, right = comparison

    def holds(t: float) -> bool:
        value = Evaluation(formula.operations, {**numbers, "t": t})
        return bool(SIGNS[sign](value(left), value(right)))

    at = (period * (1 + np.arange(SAMPLES + 1) / SAMPLES)).tolist()
    found, known = [], [holds(t) for t in at]
    for a, b, before, after in zip(at, at[1:], known, known[1:], strict=False):
        while before != after and a < (middle := (a + b) / 2) < b:
            a, b = (middle, b) if holds(middle) == before else (a, middle)
        found += [b] * (before != after)
    return tuple(found)
