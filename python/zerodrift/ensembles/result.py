"""What an ensemble of runs leaves: arrays over all runs, and what failed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .. import _check
from ..runs.solution import Solution


class Outcome(NamedTuple):
    """What is kept of a run."""

    t: np.ndarray
    outputs: dict[str, np.ndarray]
    value: Any
    t_events: tuple[np.ndarray, ...] | None
    solution: Solution | None
    message: str
    success: bool


NOTHING = Outcome(np.zeros(0), {}, None, None, None, "it was not started, as the ensemble was interrupted", False)


class Ensemble:
    """Many runs; ``ens["crank.angle"]`` has an output of all of them, and ``ens[17]`` is one run by itself.

    Attributes
    ----------
    parameters : dict of str to ndarray (n,) or (n, size)
        Of every run.
    shape : tuple of int
        (n,), or that of the grid: ``ens["x"].reshape(*ens.shape, -1)``.
    t : ndarray (k,) or None
        The times of all rows; None where runs have different ones.
    failed : ndarray (n,)
        Which runs did not reach their end, nor a terminal event.
    messages : tuple of str
        What happened to each.
    values : ndarray (n, ...) or list
        What `reduce` returned of each; NaN, or None in a list, where it failed.
    t_events : list of tuple of ndarray
        Of each run; None where no events were asked for, or nothing came of it.
    seconds : float
        How long all of them took together.
    """

    def __init__(self, runs: Any, names: Sequence[str], outcomes: Sequence[Outcome], again: Any, seconds: float,
                 threads: int) -> None:
        self.parameters, self.shape, self.seconds, self._threads = runs.parameters, runs.shape, seconds, threads
        self._again, self._names, self._outcomes = again, tuple(names), outcomes
        self.failed = np.array([not each.success for each in outcomes], dtype=bool)
        self.messages = tuple(each.message for each in outcomes)
        self.t_events = [each.t_events for each in outcomes]
        longest = max((each.t for each in outcomes), key=len)
        shared = all(np.array_equal(each.t, longest[: len(each.t)]) for each in outcomes)
        self.t = _check.frozen(longest.copy()) if shared else None
        self.values = _together([each.value for each in outcomes])

    def __len__(self) -> int:
        return len(self._outcomes)

    def __getitem__(self, key: Any) -> Any:
        """An output of all runs, or one run.

        Parameters
        ----------
        key : str, measure or int
            An output by its name; or the number of a run, which is made again by itself, with the same bits, unless solutions
            were kept.

        Returns
        -------
        ndarray (n, k) or (n, k, size), list of ndarray, or Solution
            NaN where a run has no such row any more; a list where runs have different times.

        Raises
        ------
        KeyError
            If nothing of that name was kept.
        IndexError
            If there is no such run.
        ZerodriftError
            If that run fails.
        """
        name = getattr(key, "name", key)
        if isinstance(name, str):
            if name not in self._names:
                raise KeyError(f"no output is called {name!r}; {_check.closest(name, self._names) if self._names else 'none'}")
            return self._stacked(name)
        if isinstance(key, bool | np.bool_) or not isinstance(key, int | np.integer):
            raise TypeError(f"an ensemble takes the name of an output or the number of a run, not {_check.shown(key)}")
        if not -len(self) <= key < len(self):
            raise IndexError(f"there are {len(self)} runs, and none of number {key}")
        return self._outcomes[key].solution or self._again(int(key) % len(self))

    def _stacked(self, name: str) -> Any:
        found = [each.outputs.get(name) for each in self._outcomes]
        if self.t is None:
            return [np.zeros(0) if each is None else each for each in found]
        known = next((each for each in found if each is not None), np.zeros(0))
        stacked = np.full((len(self), len(self.t), *known.shape[1:]), np.nan)
        for row, each in zip(stacked, found, strict=True):
            if each is not None:
                row[: len(each)] = each
        return stacked

    def __iter__(self) -> Any:
        raise TypeError("an ensemble is not gone through, as that would make all runs again: take ens['name'], or ens[i]")

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._names)

    def __repr__(self) -> str:
        count = " x ".join(map(str, self.shape))
        varied = f" over {', '.join(self.parameters)}" if self.parameters else ""
        rows = f"{len(self.t)} rows each" if self.t is not None else "rows of their own"
        failed = f"{int(self.failed.sum())} failed" if self.failed.any() else "none failed"
        first = f", the first because {self.messages[int(self.failed.argmax())]}" if self.failed.any() else ""
        return (f"<ensemble of {count} runs{varied}: {rows}, {failed}{first}\n"
                f" in {self.seconds:.3g} s on {self._threads} threads; run by run, on the ordinary road\n"
                f" outputs {', '.join(self._names) or 'none'}>")


def _together(values: list[Any]) -> Any:
    """An array where the values are numbers or arrays of one shape, with NaN for what is missing; else a list."""
    known = [each for each in values if each is not None]
    if not known:
        return [None] * len(values)
    try:
        arrays = [np.asarray(each, dtype=float) for each in known]
    except (TypeError, ValueError):
        return values
    if any(each.shape != arrays[0].shape for each in arrays):
        return values
    return np.array([np.full(arrays[0].shape, np.nan) if each is None else np.asarray(each, dtype=float) for each in values])
