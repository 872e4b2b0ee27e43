"""A number of each of many mechanisms, in the place of one: what is computed from it is such a column again.

Whoever asks whether it is this or that gets an answer where that is the same for all of them, else `Varies` is raised.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np


class Varies(Exception):
    """Something is to be decided that is not the same for all."""


class Column:
    """The values (k,) of one number; arithmetic has the bits of plain numbers."""

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

    __hash__ = None


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
    """The length of a vector."""
    return _of(np.hypot, x, y)


def arctan2(y: Any, x: Any) -> Any:
    """The direction of a vector, in rad."""
    return _of(np.arctan2, y, x)


def plain(number: Any) -> Any:
    """A number as a float."""
    return number if isinstance(number, Column) else float(number)


def chosen(condition: Any, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """One vector where a condition holds, else the other."""
    if not isinstance(condition, Column):
        return one if condition else other
    return np.array([_of(np.where, condition, a, b) for a, b in zip(one, other, strict=True)])


def spread(number: Any, count: int) -> np.ndarray:
    """The values (count,) of a number."""
    return np.broadcast_to(number.values if isinstance(number, Column) else float(number), count)


def longest_side(places: Sequence[np.ndarray]) -> Any:
    """Longest side of the box around some points, in m."""
    columns = [each.values for place in places for each in place if isinstance(each, Column)]
    if not columns:
        return float(np.ptp(places, axis=0).max())
    values = np.array([[spread(each, len(columns[0])) for each in place] for place in places])
    return Column(np.ptp(values, axis=0).max(axis=0))
