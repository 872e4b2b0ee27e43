"""What is kept of some runs, side by side: a run's rows of numbers, one behind another, and what became of it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from . import memory

ROADS = "by Python", "in vector lanes", "by the core alone"       # how a run was made, by the number that `Part.roads` has
BY_PYTHON, IN_LANES, BY_CORE = range(len(ROADS))
NOT_STARTED = "it was not started, as the ensemble was interrupted"


class Part(NamedTuple):
    """Runs that follow each other.

    Attributes
    ----------
    rows : ndarray (n,) of int64
        How many rows each run has.
    t : ndarray (k,) or (sum of rows,)
        The times of the longest run, where all others have the first of them; else those of each run, one run behind another.
    arrays : mapping of str to ndarray (sum of rows, ...)
        Of each output all rows of the first run, then all of the second, and so on.
    failed : ndarray (n,) of bool
    messages : list of str (n,)
    roads : ndarray (n,) of uint8
        How each was made: its place in `ROADS`.
    doubtful : ndarray (n,) of bool
        Whether `simulate` would warn of it.
    values, t_events, solutions : list (n,)
        What `reduce` returned of each, the times of its events, and it itself where it is kept; else None.
    """

    rows: np.ndarray
    t: np.ndarray
    arrays: dict[str, np.ndarray]
    failed: np.ndarray
    messages: list[str]
    roads: np.ndarray
    doubtful: np.ndarray
    values: list[Any]
    t_events: list[Any]
    solutions: list[Any]

    @property
    def is_shared(self) -> bool:
        """Whether all runs have the times of the longest one, as far as they go."""
        return len(self.t) == self.rows.max(initial=0)

    def times(self) -> Iterator[np.ndarray]:
        """Those of each run."""
        if self.is_shared:
            return (self.t[:rows] for rows in self.rows)
        return iter(np.split(self.t, np.cumsum(self.rows)[:-1]))

    def between(self, begin: int, end: int) -> Part:
        """The same of some of the runs."""
        ends = np.cumsum([0, *self.rows])
        rows, first, last = self.rows[begin:end], int(ends[begin]), int(ends[end])
        t = self.t[:rows.max(initial=0)] if self.is_shared else self.t[first:last]
        return Part(rows, t, memory.some(self.arrays, first, last), self.failed[begin:end],
                    self.messages[begin:end], self.roads[begin:end], self.doubtful[begin:end], self.values[begin:end],
                    self.t_events[begin:end], self.solutions[begin:end])

    def behind(self, count: int) -> Part:
        """The same without the first runs."""
        return self.between(count, len(self.rows))


def single(t: np.ndarray, arrays: dict[str, np.ndarray], message: str, *, failed: bool, value: Any = None,
           t_events: Any = None, solution: Any = None, road: int = 0, doubtful: bool = False) -> Part:
    """A run by itself."""
    return Part(np.array([len(t)]), t, arrays, np.array([failed]), [message], np.array([road], np.uint8),
                np.array([doubtful]), [value], [t_events], [solution])


def nothing(count: int, message: str = NOT_STARTED) -> Part:
    """So many runs of which nothing is there."""
    none = [None] * count
    return Part(np.zeros(count, int), np.zeros(0), {}, np.ones(count, bool), [message] * count, np.zeros(count, np.uint8),
                np.zeros(count, bool), none, none, none)


def joined(parts: Sequence[Part], *, release: bool = False) -> Part:
    """Parts that follow each other, as one. With `release` the parts lose their outputs, which memory then has once."""
    if len(parts) == 1:
        return parts[0]
    names = next((list(part.arrays) for part in parts if part.arrays), [])
    arrays = [part.arrays for part in parts if part.arrays]
    rows = _concatenated(part.rows for part in parts)
    lists = (_chained(each) for each in zip(*((part.values, part.t_events, part.solutions) for part in parts), strict=True))
    return Part(
        rows, _times(parts), memory.together(names, arrays, int(rows.sum()), release=release),
        _concatenated(part.failed for part in parts), _chained(part.messages for part in parts),
        _concatenated(part.roads for part in parts), _concatenated(part.doubtful for part in parts), *lists)


def filled(parts: dict[int, Part], count: int) -> Part:
    """All runs, from parts by their first runs, which lose their outputs; what is missing was not started."""
    found, end = [], 0
    for first in sorted(parts):
        if first > end:
            found.append(nothing(first - end))
        found.append(parts[first])
        end = first + len(parts[first].rows)
    if end < count:
        found.append(nothing(count - end))
    return joined(found, release=True)


def _times(parts: Sequence[Part]) -> np.ndarray:
    """Those of the longest run where all share them; else all of them."""
    longest = max((part.t for part in parts), key=len)
    if all(part.is_shared and np.array_equal(part.t, longest[:len(part.t)]) for part in parts):
        return longest
    return np.concatenate([t for part in parts for t in part.times()])


def _concatenated(arrays: Iterable[np.ndarray]) -> np.ndarray:
    return np.concatenate(list(arrays))


def _chained(lists: Iterable[Sequence[Any]]) -> list[Any]:
    return list(itertools.chain.from_iterable(lists))
