"""`tune`: the settings that reach an error in the least time, or the least error in a given time, found by measurement."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from .. import _check
from ..errors import Interrupted, UnreachableTolerance
from ..runs.settings import FINEST_RTOL
from ..systems.base import BaseSystem
from . import reference as certified
from .work_precision import Bench, Row, Setting, WorkPrecision, work_precision

EXTENSIONS = 6      # finer steps than those of the first sweep, at most
REFINEMENTS = 3     # a step is found to within the eighth root of the factor between those of the first sweep
PROMISING = 8       # methods that are refined
FACTOR = {False: 0.5, True: 0.1}        # to the next finer step, and tolerance


@dataclass(frozen=True, eq=False, repr=False)
class Tuning:
    """Settings, and why these.

    Attributes
    ----------
    settings : dict
        For ``simulate(system, t_span, **settings)``.
    row : Row
        What they cost and give.
    evidence : WorkPrecision
        All that was measured.
    """

    settings: dict[str, Any]
    row: Row
    evidence: WorkPrecision

    def __repr__(self) -> str:
        return (f"Tuning of {self.evidence.system.name}: error {self.row.error:.2g} in {1e3 * self.row.seconds:.3g} ms, "
                f"best of {len(self.evidence.rows)}\n  {self.settings}")


def tune(
    system: BaseSystem,
    t_span: float | tuple[float, float],
    p0: Any = None,
    v0: Any = None,
    *,
    error: float | None = None,
    budget: float | None = None,
    formulations: Iterable[str] | None = None,
    integrators: Iterable[str] | None = None,
    progress: bool | Callable[[float], None] = False,
    rounds: int = 5,
) -> Tuning:
    """Find the cheapest settings that reach an error, or the most accurate within a time.

    A sweep over all methods comes first, then the step or tolerance of the best of each is refined, and the best of all are
    timed again, in turn. Errors and times are those of `work_precision`.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Start; left out: the system's own.
    error : float, optional
        Largest error of any coordinate at any time, each in its own unit; that of the reference is added to those measured.
    budget : float, optional
        Largest time of a run in s, of this machine. Either `error` or `budget` is given.
    formulations, integrators : iterable of str, optional
        Among which to choose; left out: all that can take the system.
    progress : bool or callable
        As in `simulate`; it shows the first sweep, which is most of the work.
    rounds : int
        How often the best are timed.

    Returns
    -------
    Tuning

    Raises
    ------
    UnreachableTolerance
        If `error` is below what double precision can give, or the methods allowed do not reach it.
    ValueError
        If no method keeps the budget.
    Interrupted
        On Ctrl-C; its `.solution` is the WorkPrecision of all that was measured.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> tuning = zd.tune(bar, 1.0, error=1e-6, formulations=["schur"])
    >>> bool(tuning.row.error <= 1e-6)
    True
    >>> sol = zd.simulate(bar, 1.0, **tuning.settings)
    """
    span, rounds = _check.span(t_span), _check.count("rounds", rounds)
    goal = _goal(error, budget)
    reference = certified.reference(system, span, p0, v0, error=None)
    goal.check(reference.error)
    sweep = work_precision(system, span, p0, v0, formulations=formulations, integrators=integrators, reference=reference,
                           progress=progress, rounds=1)
    search = _Search(goal, Bench(system, span, p0, v0, reference), sweep)
    try:
        search.extend()
        search.refine()
        best = search.best(rounds)
    except KeyboardInterrupt as interruption:
        raise search.interrupted(interruption, rounds) from None
    return Tuning(best.setting.settings, best, search.evidence(rounds))


# ---- the two questions ----


@dataclass(frozen=True)
class _ReachError:
    """In the least time. The coarsest step that does is sought."""

    error: float
    finer = False

    def check(self, known: float) -> None:
        if self.error <= known:
            raise UnreachableTolerance(f"error = {self.error:g} is below round-off as this motion multiplies it: no solution of "
                                       f"it is known to better than {known:.2g}")

    def met(self, row: Row, known: float) -> bool:
        return row.success and row.error + known <= self.error

    def cost(self, row: Row) -> float:
        return row.seconds

    def refusal(self, rows: list[Row]) -> Exception:
        least = min((row.error for row in rows if row.success), default=math.nan)
        return UnreachableTolerance(f"error = {self.error:g} is reached by none of {len(rows)} runs; the most accurate of them "
                                    f"has an error of {least:.2g}")


@dataclass(frozen=True)
class _KeepBudget:
    """With the least error. The finest step that does is sought."""

    budget: float
    finer = True

    def check(self, known: float) -> None:
        """Any budget makes sense."""

    def met(self, row: Row, known: float) -> bool:
        return row.success and row.seconds <= self.budget

    def cost(self, row: Row) -> float:
        return row.error

    def refusal(self, rows: list[Row]) -> Exception:
        least = min((row.seconds for row in rows if row.success), default=math.nan)
        return ValueError(f"budget = {self.budget:g} s is kept by none of {len(rows)} runs; the fastest of them "
                          f"takes {least:.2g} s")


def _goal(error: float | None, budget: float | None) -> _ReachError | _KeepBudget:
    if (error is None) == (budget is None):
        raise ValueError("either error or budget must be given, and not both")
    if budget is None:
        return _ReachError(_check.number("error", error, above=0))
    return _KeepBudget(_check.number("budget", budget, above=0))


# ---- the search ----


class _Search:
    """All rows measured so far, and where to measure next."""

    def __init__(self, goal: _ReachError | _KeepBudget, bench: Bench, sweep: WorkPrecision) -> None:
        self.goal, self.bench = goal, bench
        self.rows = {row.setting: row for row in sweep.rows}

    def extend(self) -> None:
        """As long as nothing meets the goal: the next step in the direction that is more likely to."""
        for _ in range(EXTENSIONS):
            if self._met():
                return
            ends = [_sorted(rows)[-1 if not self.goal.finer else 0] for rows in self._methods()]
            self._measure(_moved(row.setting, FACTOR[_chooses(row.setting)]**(-1 if self.goal.finer else 1)) for row in ends)

    def refine(self) -> None:
        """Of the promising methods: ever closer to the last step that meets the goal."""
        for _ in range(REFINEMENTS):
            candidates = [rows for rows in self._methods() if any(map(self._meets, rows))]
            candidates.sort(key=lambda rows: min(self.goal.cost(row) for row in rows if self._meets(row)))
            self._measure(self._between(rows) for rows in candidates[:PROMISING])

    def best(self, rounds: int) -> Row:
        """Of those timed again."""
        met = sorted(self._met(), key=self.goal.cost)
        if not met:
            raise self.goal.refusal(list(self.rows.values()))
        self._measure((row.setting for row in met[:PROMISING]), rounds)
        return min((self.rows[row.setting] for row in met[:PROMISING]), key=self.goal.cost)

    def evidence(self, rounds: int) -> WorkPrecision:
        rows = sorted(self.rows.values(), key=lambda row: (*map(str, row.setting.method), -_fineness(row.setting)))
        return WorkPrecision(self.bench.system, self.bench.span, tuple(rows), self.bench.known, rounds)

    def interrupted(self, interruption: KeyboardInterrupt, rounds: int) -> Interrupted:
        """The same with all rows, not only those being measured."""
        latest = getattr(interruption, "solution", None)
        self.rows |= {row.setting: row for row in latest.rows} if latest else {}
        return Interrupted(str(interruption), dataclasses.replace(self.evidence(rounds), complete=False))

    def _between(self, rows: list[Row]) -> Setting:
        """Between the last that meets the goal and its neighbour that does not; beyond, if there is none."""
        ordered = _sorted(rows) if self.goal.finer else _sorted(rows)[::-1]     # from those that meet it to the others
        last = max(place for place, row in enumerate(ordered) if self._meets(row))
        setting = ordered[last].setting
        if last + 1 < len(ordered):
            return _moved(setting, math.sqrt(_fineness(ordered[last + 1].setting) / _fineness(setting)))
        return _moved(setting, FACTOR[_chooses(setting)]**(1 if self.goal.finer else -1))

    def _measure(self, settings: Iterable[Setting], rounds: int = 1) -> None:
        self.rows |= {row.setting: row for row in self.bench.measure(list(settings), rounds).rows}

    def _methods(self) -> list[list[Row]]:
        methods: dict[Any, list[Row]] = {}
        for row in self.rows.values():
            methods.setdefault(row.setting.method, []).append(row)
        return list(methods.values())

    def _meets(self, row: Row) -> bool:
        return self.goal.met(row, self.bench.known)

    def _met(self) -> list[Row]:
        return [row for row in self.rows.values() if self._meets(row)]


def _chooses(setting: Setting) -> bool:
    return setting.tolerance is not None


def _fineness(setting: Setting) -> float:
    return setting.tolerance if _chooses(setting) else setting.step


def _moved(setting: Setting, factor: float) -> Setting:
    """The same method with another step or tolerance."""
    value = factor * _fineness(setting)
    return setting._replace(tolerance=max(value, FINEST_RTOL)) if _chooses(setting) else setting._replace(step=value)


def _sorted(rows: list[Row]) -> list[Row]:
    """From the coarsest to the finest."""
    return sorted(rows, key=lambda row: -_fineness(row.setting))
