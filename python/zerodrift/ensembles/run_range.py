"""Runs of a range of a plan, in batches of the core or one after the other: the interface between ensembles and runs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .._private import gateway
from ..errors import described
from ..runs.open import diagnosis
from ..runs.samples.solution import Solution
from .batch import Batch, batch_of, batch_range
from .part import Part, joined, nothing, single
from .plan import Plan


class Cancelled(Exception):
    """Raised in a run whose ensemble was cancelled."""


def never() -> bool:
    """Cancellation flag that is always false."""
    return False


def run_range(plan: Plan, first: int, last: int, is_cancelled: Callable[[], bool] = never) -> Part:
    """Make the runs first ... last - 1 in this thread.

    A run that fails is data. What is in a run's row does not depend on the others, nor on the range.

    Parameters
    ----------
    plan : Plan
    first, last : int
    is_cancelled : callable
        Asked now and then; once it is true, what was made is returned, and may be fewer runs.
    """
    batch = batch_of(plan)
    if batch is not None:
        return _in_batches(plan, batch, first, last, is_cancelled)
    made = []
    for run in range(first, last):
        try:
            made.append(_one_or_its_error(plan, run, is_cancelled))
        except Cancelled:
            break
    return joined(made) if made else nothing(0)


def _one_or_its_error(plan: Plan, run: int, is_cancelled: Callable[[], bool]) -> Part:
    try:
        return _one(plan, run, is_cancelled)
    except Cancelled:
        raise
    except Exception as error:      # it could not begin, or its own functions raised: the others go on
        return single(np.zeros(0), {}, described(error), failed=True)


def _in_batches(plan: Plan, batch: Batch, first: int, last: int, is_cancelled: Callable[[], bool]) -> Part:
    """Make runs in batches of the core whose memory is bounded."""
    stop, made = is_cancelled if isinstance(is_cancelled, gateway.Stop) else None, []
    try:
        while first < last and not is_cancelled():
            end = min(last, first + batch.runs_at_once)
            made += _parts(plan, batch, first, end, is_cancelled, stop)
            first = end
    except Cancelled:
        pass
    return joined([part for part in made if len(part.rows)] or [nothing(0)])


def _parts(plan: Plan, batch: Batch, first: int, last: int, is_cancelled: Callable[[], bool],
           stop: gateway.Stop | None) -> list[Part]:
    """Make the runs of one batch; those that the core leaves to `simulate` are inserted in order."""
    found = batch_range(plan, batch, first, last, stop)
    if found is None and last == first + 1:
        return [_one_or_its_error(plan, first, is_cancelled)]
    if found is None:       # one of them differs in more than numbers
        middle = (first + last) // 2
        before = _parts(plan, batch, first, middle, is_cancelled, stop)
        return before if is_cancelled() else before + _parts(plan, batch, middle, last, is_cancelled, stop)
    part, left = found
    made, begin = [], first
    for run in left:
        made += [part.between(begin - first, run - first), _one_or_its_error(plan, run, is_cancelled)]
        begin = run + 1
    return [*made, part.between(begin - first, len(part.rows))] if left else [part]


def _one(plan: Plan, run: int, is_cancelled: Callable[[], bool]) -> Part:
    """Part with one run, by `simulate`."""
    def look(part: float) -> None:
        if is_cancelled():
            raise Cancelled

    look(0.0)
    solution = plan.solution(run, on_failure="return", progress=look)
    rows = _rows(plan, solution)
    value = plan.reduce(solution) if plan.reduce is not None and solution.success else None
    return single(np.array(solution.t[:rows]), {name: np.array(solution[name][:rows]) for name in plan.names}, solution.message,
                  failed=not solution.success, value=value, t_events=solution.t_events,
                  solution=solution if plan.keeps else None, doubtful=any(True for _ in diagnosis.doubts(solution)))


def _rows(plan: Plan, solution: Solution) -> int:
    """Number of samples to keep: the last sample of a run that ended between two output times is not one of them."""
    wanted, rows = plan.t_eval, len(solution.t)
    if wanted is not None and rows and (rows > len(wanted) or solution.t[-1] != wanted[rows - 1]):
        return rows - 1
    return rows
