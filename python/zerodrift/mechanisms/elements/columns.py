"""Columns: one number of each of many mechanisms, used as if it were a single number; results are columns again.

The truth of a comparison is defined if it is the same for all mechanisms; otherwise `Varies` is raised.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np


class Varies(Exception):
    """Raised if a comparison has different results for the mechanisms of a `Column`, so that they take different branches."""


class Column:
    """Values (k,) of one number; arithmetic is bitwise that of plain numbers."""

    __slots__ = ("values",)

    def __init__(self, values: np.ndarray) -> None:
        self.values = values

    def __bool__(self) -> bool:
        if self.values.all() or not self.values.any():
            return bool(self.values[0])
        raise Varies

    def __float__(self) -> float:
        raise Varies

    def __neg__(self) -> Column:
        return Column(-self.values)

    def __abs__(self) -> Column:
        return Column(np.abs(self.values))

    def __pow__(self, power: int) -> Column:
        return Column(np.array([value**power for value in self.values.tolist()]))       # NumPy's squares may differ by rounding


def _operation(name: str, *, swapped: bool = False) -> Callable[[Column, Any], Any]:
    function = getattr(operator, name)

    def both(self: Column, other: Any) -> Any:
        if isinstance(other, np.ndarray):
            return NotImplemented
        there = other.values if isinstance(other, Column) else other
        return Column(function(there, self.values) if swapped else function(self.values, there))
    return both


for _name in ("add", "sub", "mul", "truediv", "mod"):
    setattr(Column, f"__{_name}__", _operation(_name))
    setattr(Column, f"__r{_name}__", _operation(_name, swapped=True))
for _name in ("lt", "le", "gt", "ge", "eq", "ne"):
    setattr(Column, f"__{_name}__", _operation(_name))


def _of(function: Callable[..., Any], *given: Any) -> Any:
    """Apply a NumPy function to numbers, some of which may be columns."""
    found = function(*(each.values if isinstance(each, Column) else each for each in given))
    return Column(found) if any(isinstance(each, Column) for each in given) else float(found)


def hypot(x: Any, y: Any) -> Any:
    """Length of a vector."""
    return _of(np.hypot, x, y)


def arctan2(y: Any, x: Any) -> Any:
    """Direction of a vector, in rad."""
    return _of(np.arctan2, y, x)


def plain(number: Any) -> Any:
    """Number as a float; columns are returned unchanged."""
    return number if isinstance(number, Column) else float(number)


def chosen(condition: Any, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """First vector where a condition holds, otherwise the second."""
    if not isinstance(condition, Column):
        return one if condition else other
    return np.array([_of(np.where, condition, a, b) for a, b in zip(one, other, strict=True)])


def expand(number: Any, count: int) -> np.ndarray:
    """Values (count,) of a number."""
    return np.broadcast_to(number.values if isinstance(number, Column) else float(number), count)


def longest_side(places: Sequence[np.ndarray]) -> Any:
    """Longest side of the box around some points, in m."""
    columns = [each.values for place in places for each in place if isinstance(each, Column)]
    if not columns:
        return float(np.ptp(places, axis=0).max())
    values = np.array([[expand(each, len(columns[0])) for each in place] for place in places])
    return Column(np.ptp(values, axis=0).max(axis=0))
