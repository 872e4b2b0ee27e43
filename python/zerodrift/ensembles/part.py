"""`Part`: outputs and messages of consecutive runs, concatenated."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from . import memory

PATHS = "by Python", "in vector lanes", "by the core alone"       # how a run was made; index: entry of `Part.paths`
BY_PYTHON, IN_LANES, BY_CORE = range(len(PATHS))
NOT_STARTED = "it was not started, as the ensemble was interrupted"


class Part(NamedTuple):
    """Results of consecutive runs.

    Attributes
    ----------
    rows : ndarray (n,) of int64
        Number of samples of each run.
    t : ndarray (k,) or (sum of rows,)
        Times of the longest run if the others have the same times up to their end; else the times of all runs, concatenated.
    arrays : mapping of str to ndarray (sum of rows, ...)
        Samples of each output, concatenated over the runs.
    failed : ndarray (n,) of bool
    messages : list of str (n,)
    paths : ndarray (n,) of uint8
        Evaluation path of each run: index into `PATHS`.
    doubtful : ndarray (n,) of bool
        True for runs of which `simulate` would warn.
    values, t_events, solutions : list (n,)
        Return value of `reduce`, times of events, and solution of each run, None where it is not kept.
    """

    rows: np.ndarray
    t: np.ndarray
    arrays: Mapping[str, np.ndarray]
    failed: np.ndarray
    messages: list[str]
    paths: np.ndarray
    doubtful: np.ndarray
    values: list[Any]
    t_events: list[Any]
    solutions: list[Any]

    @property
    def is_shared(self) -> bool:
        """True if all runs have the times of the longest one up to their end."""
        return len(self.t) == self.rows.max(initial=0)

    def times(self) -> Iterator[np.ndarray]:
        """Times of each run."""
        if self.is_shared:
            return (self.t[:rows] for rows in self.rows)
        return iter(np.split(self.t, np.cumsum(self.rows)[:-1]))

    def between(self, begin: int, end: int) -> Part:
        """Part with the runs begin ... end - 1."""
        ends = np.cumsum([0, *self.rows])
        rows, first, last = self.rows[begin:end], int(ends[begin]), int(ends[end])
        t = self.t[:rows.max(initial=0)] if self.is_shared else self.t[first:last]
        return Part(rows, t, memory.some(self.arrays, first, last), self.failed[begin:end],
                    self.messages[begin:end], self.paths[begin:end], self.doubtful[begin:end], self.values[begin:end],
                    self.t_events[begin:end], self.solutions[begin:end])

    def behind(self, count: int) -> Part:
        """Part without the first `count` runs."""
        return self.between(count, len(self.rows))


def single(t: np.ndarray, arrays: dict[str, np.ndarray], message: str, *, failed: bool, value: Any = None,
           t_events: Any = None, solution: Any = None, path: int = 0, doubtful: bool = False) -> Part:
    """Part with one run."""
    return Part(np.array([len(t)]), t, arrays, np.array([failed]), [message], np.array([path], np.uint8),
                np.array([doubtful]), [value], [t_events], [solution])


def nothing(count: int, message: str = NOT_STARTED) -> Part:
    """Part of `count` runs without samples."""
    none = [None] * count
    return Part(np.zeros(count, int), np.zeros(0), {}, np.ones(count, bool), [message] * count, np.zeros(count, np.uint8),
                np.zeros(count, bool), none, none, none)


def joined(parts: Sequence[Part], *, release: bool = False) -> Part:
    """Concatenate consecutive parts. With `release`, outputs are removed from the parts, so that they are in memory once."""
    if len(parts) == 1:
        return parts[0]
    names = next((list(part.arrays) for part in parts if part.arrays), [])
    arrays = [part.arrays for part in parts if part.arrays]
    rows = _concatenated(part.rows for part in parts)
    lists = (_chained(each) for each in zip(*((part.values, part.t_events, part.solutions) for part in parts), strict=True))
    return Part(
        rows, _times(parts), memory.together(names, arrays, int(rows.sum()), release=release),
        _concatenated(part.failed for part in parts), _chained(part.messages for part in parts),
        _concatenated(part.paths for part in parts), _concatenated(part.doubtful for part in parts), *lists)


def filled(parts: dict[int, Part], count: int) -> Part:
    """Part of all runs, from parts by their first run, whose outputs are released; missing runs count as not started."""
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
    """Times of joined parts: those of the longest run if all share them, else all, concatenated."""
    longest = max((part.t for part in parts), key=len)
    if all(part.is_shared and np.array_equal(part.t, longest[:len(part.t)]) for part in parts):
        return longest
    return np.concatenate([t for part in parts for t in part.times()])


def _concatenated(arrays: Iterable[np.ndarray]) -> np.ndarray:
    return np.concatenate(list(arrays))


def _chained(lists: Iterable[Sequence[Any]]) -> list[Any]:
    return list(itertools.chain.from_iterable(lists))
