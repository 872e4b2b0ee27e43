"""Some runs of a plan, one after the other: the seam between what studies many runs and what makes them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..runs.solution import Solution
from .part import Part, joined, nothing, single
from .plan import Plan


class Cancelled(Exception):
    """Raised in a run that nobody waits for any more."""


def never() -> bool:
    """For runs that nobody cancels."""
    return False


def run_range(plan: Plan, first: int, last: int, is_cancelled: Callable[[], bool] = never) -> Part:
    """The runs first ... last - 1, in this thread.

    A run that fails is data. What is in a run's row does not depend on the others, nor on the range.

    Parameters
    ----------
    plan : Plan
    first, last : int
    is_cancelled : callable
        Asked now and then; once it is true, what was made is returned, and may be fewer runs.
    """
    made = []
    for run in range(first, last):
        try:
            made.append(_one(plan, run, is_cancelled))
        except Cancelled:
            break
        except Exception as error:      # it could not begin, or its own functions raised: the others go on
            made.append(single(np.zeros(0), {}, f"{type(error).__name__}: {error}", failed=True))
    return joined(made) if made else nothing(0)


def _one(plan: Plan, run: int, is_cancelled: Callable[[], bool]) -> Part:
    """One run, on the ordinary road."""
    def look(part: float) -> None:
        if is_cancelled():
            raise Cancelled

    look(0.0)
    solution = plan.solution(run, on_failure="return", progress=look)
    rows = _rows(plan, solution)
    value = plan.reduce(solution) if plan.reduce is not None and solution.success else None
    return single(np.array(solution.t[:rows]), {name: np.array(solution[name][:rows]) for name in plan.names}, solution.message,
                  failed=not solution.success, value=value, t_events=solution.t_events,
                  solution=solution if plan.keeps else None)


def _rows(plan: Plan, solution: Solution) -> int:
    """How many are kept: of a run that ended between two times that are asked for, its last one is none of these."""
    wanted, rows = plan.t_eval, len(solution.t)
    if wanted is not None and rows and (rows > len(wanted) or solution.t[-1] != wanted[rows - 1]):
        return rows - 1
    return rows
