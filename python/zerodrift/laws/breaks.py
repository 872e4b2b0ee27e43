"""Breaks: times at which laws of t alone jump, or bend as the lines of a table do. Adaptive steps end there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..symbolics.graph.plain_functions import SPLINE
from .formula import FUNCTIONS, SIGNS, Evaluation, Formula, operands
from .table import Spline

MOST = 16               # lines that an operation may follow
SAMPLES = 256           # of a comparison over a period, between which it changes at most once; 16 times as many over a span
NEAREST = 32            # samples around which a comparison that nearly changes is examined
Break = tuple[float, tuple[float, ...]]     # s: a period, 0 for none, and times
Line = tuple[float, float, float]           # value at t = 0, slope, and the period with which the line begins anew; 0: none


def of_spline(table: Spline, line: Line = (0.0, 1.0, 0.0)) -> Iterable[Break]:
    """Breaks of a table whose argument is a line over time."""
    at, period = table.breaks()
    start, slope, _ = line
    if at.size and slope:
        yield abs(period / slope), tuple(np.sort((at - start) / slope).tolist())


def of_formula(formula: Formula, numbers: Mapping[str, float], span: tuple[float, float] | None = None) -> Iterable[Break]:
    """Breaks of a formula, from the values of its names but t: those of comparisons, remainders, roundings and tables.

    Found are those of what consists of lines over time, or has a period; and in a span those of other comparisons of t. Some may
    be where nothing happens.
    """
    lines, periods, timed = list[Sequence[Line]](), list[float | None](), list[bool]()
    for kind, content in formula.operations:
        given = operands(kind, content)
        timed.append(all(timed[each] for each in given) and (kind != "leaf" or content == "t" or not isinstance(content, str)
                                                             or content in numbers))
        lines.append(_lines(kind, content, lines, numbers))
        periods.append(_period(kind, content, [periods[each] for each in given], [lines[each] for each in given]))
        if kind == "comparison":
            left, right = (lines[each] for each in given)
            crossings = [_crossing(*pair) for pair in itertools.product(left, right)]
            yield from (each for each in crossings if each and each[1])
            if (crossings and None not in crossings) or not timed[-1]:
                continue
            period = periods[-1] or 0.0
            if (within := (period, 2 * period) if period else span) and (found := _changes(formula, content, numbers, *within)):
                yield period, found
        elif kind == "call" and content[0] == SPLINE.__name__:
            for line in lines[given[1]]:
                if not line[2]:
                    yield from of_spline(formula.operations[given[0]][1], line)
        elif kind == "call":
            for start, slope, period in lines[given[0]]:
                if slope and content[0] == "Abs":
                    yield period, ((-start / slope) % period if period else -start / slope,)
                if spacing := _spacing(content[0], slope, [lines[each] for each in given[1:]]):
                    yield spacing, ((-start / slope) % spacing,)


def _crossing(first: Line, second: Line) -> Break | None:
    """Meeting of two lines; without times if they are parallel; None if both vary, and one of them begins anew."""
    (a, slope, period), (b, other, another) = first, second
    shared = period or another
    if shared and slope and other:
        return None
    if slope == other:
        return 0.0, ()
    at = (b - a) / (slope - other)
    return shared, (at % shared if shared else at,)


def _lines(kind: str, content: Any, lines: Sequence[Sequence[Line]], numbers: Mapping[str, float]) -> Sequence[Line]:
    """The lines over time that an operation may follow; none for another function."""
    given: list[Sequence[Line]] = [lines[each] for each in operands(kind, content)]
    if kind == "leaf":
        is_number = isinstance(content, str) and content in numbers
        return [(0.0, 1.0, 0.0)] if content == "t" else [(numbers[content], 0.0, 0.0)] if is_number else []
    if kind == "number":
        return [(float(content), 0.0, 0.0)]
    if kind == "choice":
        values = [lines[each] for each in (*(value for _, value in content[0]), content[1])]
        return list(dict.fromkeys(itertools.chain(*values)))[:MOST] if all(values) else []
    if kind not in ("sum", "product", "call"):
        return []
    found = list[Line]()
    for each in itertools.islice(itertools.product(*given), MOST):
        among = {period for _, slope, period in each if slope}
        if len(among) > 1:
            return []
        period = max(among, default=0.0)
        if kind == "sum":
            start, slope = (sum(line[i] * float(factor) for line, (_, factor) in zip(each, content, strict=True)) for i in (0, 1))
            found.append((start, slope, period))
        elif kind == "product":
            found += _product([(line, float(exponent)) for line, (_, exponent) in zip(each, content, strict=True)], period)
        elif content[0] == "Abs":
            found += [each[0], (-each[0][0], -each[0][1], period)]
        elif content[0] == "fmod" and not period and (spacing := _spacing("fmod", each[0][1], [[each[1]]])):
            found.append((*each[0][:2], spacing))
        elif not among:
            found.append((float(FUNCTIONS[content[0]](*(value for value, *_ in each))), 0.0, 0.0))
    return found


def _product(factors: Sequence[tuple[Line, float]], period: float) -> list[Line]:
    """The product of powers of lines, at most one of which varies."""
    number, varying = 1.0, [line for line, _ in factors if line[1]]
    for (value, slope, _), exponent in factors:
        if (slope and exponent != 1) or len(varying) > 1:
            return []
        if not slope:
            number *= FUNCTIONS["Pow"](value, exponent)
    start, slope, _ = varying[0] if varying else (1.0, 0.0, 0.0)
    return [(number * start, number * slope, period)] if math.isfinite(number) else []


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
    if kind == "call" and lines[0] and (slope := lines[0][0][1]) and not lines[0][0][2]:
        if content[0] in ("sin", "cos", "tan"):
            return 2 * math.pi / abs(slope)
        return _spacing("fmod", slope, lines[1:]) or None if content[0] == "fmod" else None
    known = [0.0 if line and not any(slope for _, slope, _ in line) else period
             for period, line in zip(periods, lines, strict=True)]
    if None in known:
        return None
    lengths = [each for each in known if each]
    is_common = all(math.isclose(max(lengths) / each, round(max(lengths) / each), rel_tol=1e-12) for each in lengths)
    return max(lengths, default=0.0) if is_common else None


def _changes(formula: Formula, comparison: Any, numbers: Mapping[str, float], first: float, last: float) -> tuple[float, ...]:
    """Times from the first to the last at which a comparison changes: between samples, or where they come near to it."""
    sign, *sides = comparison

    def difference(t: float) -> float:
        value = Evaluation(formula.operations, {**numbers, "t": t})
        try:
            return float(value(sides[0]) - value(sides[1]))
        except (ArithmeticError, ValueError):
            return math.nan

    def holds(d: float) -> bool:
        return bool(SIGNS[sign](d, 0.0))

    samples = SAMPLES * (16 if first != last / 2 else 1)
    at = np.linspace(first, last, samples + 1).tolist()
    values = [difference(t) for t in at]
    near = [k for k in range(1, samples) if holds(values[k - 1]) == holds(values[k]) == holds(values[k + 1])
            and abs(values[k]) <= min(abs(values[k - 1]), abs(values[k + 1]))]
    for k in sorted(near, key=lambda k: abs(values[k]))[:NEAREST]:
        at[k], values[k] = _nearest(difference, at[k - 1], at[k], at[k + 1], holds)
    found = []
    for a, b, da, db in zip(at, at[1:], values, values[1:], strict=False):
        before, after = holds(da), holds(db)
        while before != after and a < (middle := (a + b) / 2) < b:
            a, b = (middle, b) if holds(difference(middle)) == before else (a, middle)
        found += [b] * (before != after)
    return tuple(found)


def _nearest(difference: Callable[[float], float], a: float, x: float, b: float,
             holds: Callable[[float], bool]) -> tuple[float, float]:
    """Time between a and b, and the difference there, at which it is least by golden sections from x, or has changed."""
    best, known = difference(x), holds(difference(x))
    for _ in range(60):
        t = x + 0.382 * ((b - x) if b - x > x - a else (a - x))
        d = difference(t)
        if holds(d) != known:
            return t, d
        if abs(d) < abs(best):
            a, x, b, best = (x, t, b, d) if t > x else (a, t, x, d)
        elif t > x:
            b = t
        else:
            a = t
    return x, best
