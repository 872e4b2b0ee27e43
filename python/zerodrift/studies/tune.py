"""`tune`: settings that reach a given error in the shortest time, or the smallest error in a given time, by measurement."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from .._private import checks
from .._private.types import ArrayLike, Formulation, Integrator, SystemLike
from ..errors import Interrupted, UnreachableTolerance, WrongValue
from ..runs.arguments.settings import FINEST_RTOL
from ..systems.base import system_of
from . import reference as certified
from .bench import Bench, Row, Setting
from .work_precision import WorkPrecision, found, measured, not_excluded, work_precision

EXTENSIONS = 6      # the largest number of steps beyond those of the first sweep
REFINEMENTS = 3     # each halves the logarithm of the factor between two neighbouring steps
PROMISING = 8       # methods that are refined
FACTOR = {False: 0.5, True: 0.1}        # to the next finer step, and tolerance


@dataclass(frozen=True, eq=False, repr=False)
class Tuning:
    """Best settings found, and the measurements behind them.

    Attributes
    ----------
    settings : dict
        Arguments for ``simulate(system, t_span, **settings)``.
    row : Row
        Measured cost and error of these settings.
    evidence : WorkPrecision
        All measurements.
    """

    settings: dict[str, Any]
    row: Row
    evidence: WorkPrecision

    def __repr__(self) -> str:
        title = (f"Tuning of {self.evidence.system.name}: error {self.row.error:.2g} in {1e3 * self.row.seconds:.3g} ms, "
                 f"best of {len(self.evidence.rows)}")
        return "\n".join([title, f"  {self.settings}", *not_excluded(self.evidence.reference_caveats)])


def tune(
    system: SystemLike,
    t_span: float | tuple[float, float],
    p0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    *,
    error: float | None = None,
    budget: float | None = None,
    formulations: Iterable[Formulation] | None = None,
    integrators: Iterable[Integrator] | None = None,
    progress: bool | Callable[[float], None] = False,
    rounds: int = 5,
) -> Tuning:
    """Find the fastest settings that reach an error, or the most accurate ones within a time.

    All methods are swept first; then the step or tolerance of the promising ones is refined, and the best are timed again.
    Errors and times are measured as in `work_precision`, and those of the best also at the ends and in the middle of their steps.

    Parameters
    ----------
    system : system
        System or Mechanism, as in `simulate`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Initial state; by default that of the system.
    error : float, optional
        Largest allowed error of any coordinate at any time, in its own unit. The error of the reference is added to measured
        errors.
    budget : float, optional
        Largest allowed time of a run on this machine, in s. Exactly one of `error` and `budget` must be given.
    formulations, integrators : iterable of str, optional
        Candidates; by default all that suit the system.
    progress : bool or callable
        As in `simulate`; it shows the first sweep, which is most of the work.
    rounds : int
        Number of timings of the best settings.

    Returns
    -------
    Tuning

    Raises
    ------
    UnreachableTolerance
        If `error` is below the limit of double precision for this motion, or none of the methods reaches it.
    ValueError
        If no method is fast enough.
    Interrupted
        On Ctrl-C; its attribute `solution` is the WorkPrecision of the measurements so far.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> tuning = zd.tune(bar, 1.0, error=1e-6, formulations=["schur"])
    >>> bool(tuning.row.error <= 1e-6)
    True
    >>> sol = zd.simulate(bar, 1.0, **tuning.settings)
    """
    system = system_of(system, p0, v0)
    span, rounds = checks.span(t_span), checks.count("rounds", rounds)
    goal = _goal(error, budget)
    reference = certified.reference(system, span, p0, v0, error=None)
    goal.check(reference.error)
    sweep = work_precision(system, span, p0, v0, formulations=formulations, integrators=integrators, reference=reference,
                           closed_form=None, progress=progress, rounds=1)
    search = _Search(goal, Bench(system, span, p0, v0, reference, closed_form=None), sweep)
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
    """Goal: a given error in the shortest time; searches the coarsest step that reaches the error."""

    error: float
    seeks_finest = False

    def check(self, reference_error: float) -> None:
        if self.error <= reference_error:
            raise UnreachableTolerance(f"error = {self.error:g} is below round-off as this motion multiplies it: no solution of "
                                       f"it is known to better than {reference_error:.2g}")

    def met(self, row: Row, reference_error: float) -> bool:
        return row.success and row.error + reference_error <= self.error

    def cost(self, row: Row) -> float:
        return row.seconds

    def refusal(self, rows: list[Row]) -> Exception:
        least = min((row.error for row in rows if row.success), default=math.nan)
        return UnreachableTolerance(f"error = {self.error:g} is reached by none of {len(rows)} runs; the most accurate of them "
                                    f"has an error of {least:.2g}, to which double precision limits these methods on this motion")


@dataclass(frozen=True)
class _KeepBudget:
    """Goal: the smallest error within a given time; searches the finest step that is fast enough."""

    budget: float
    seeks_finest = True

    def check(self, reference_error: float) -> None:
        """Accept any time budget."""

    def met(self, row: Row, reference_error: float) -> bool:
        return row.success and row.seconds <= self.budget

    def cost(self, row: Row) -> float:
        return row.error

    def refusal(self, rows: list[Row]) -> Exception:
        least = min((row.seconds for row in rows if row.success), default=math.nan)
        return WrongValue(f"budget = {self.budget:g} s is kept by none of {len(rows)} runs; the fastest of them "
                          f"takes {least:.2g} s", "out-of-range")


def _goal(error: float | None, budget: float | None) -> _ReachError | _KeepBudget:
    if (error is None) == (budget is None):
        raise WrongValue("either error or budget must be given, and not both", "conflicting-arguments")
    if budget is None:
        return _ReachError(checks.number("error", error, above=0))
    return _KeepBudget(checks.number("budget", budget, above=0))


# ---- the search ----


class _Search:
    """Search: entries measured so far, and the choice of the next ones."""

    def __init__(self, goal: _ReachError | _KeepBudget, bench: Bench, sweep: WorkPrecision) -> None:
        self.goal, self.bench = goal, bench
        self.rows = {row.setting: row for row in sweep.rows}

    def extend(self) -> None:
        """While no entry meets the goal: next step in the direction that is more likely to meet it."""
        for _ in range(EXTENSIONS):
            if self._rows_meeting_goal():
                return
            ends = [_from_coarse_to_fine(rows)[0 if self.goal.seeks_finest else -1] for rows in self._methods()]
            sign = -1 if self.goal.seeks_finest else 1
            self._measure(_scaled(row.setting, FACTOR[_chooses_steps(row.setting)]**sign) for row in ends)

    def refine(self) -> None:
        """Refine the step or tolerance of the promising methods towards the last value that meets the goal."""
        for _ in range(REFINEMENTS):
            candidates = [rows for rows in self._methods() if any(map(self._meets_goal, rows))]
            candidates.sort(key=lambda rows: min(self.goal.cost(row) for row in rows if self._meets_goal(row)))
            self._measure(self._closer_to_goal(rows) for rows in candidates[:PROMISING])

    def best(self, rounds: int) -> Row:
        """Best setting, after the leading ones were timed again and their errors measured at their own steps."""
        met = sorted(self._rows_meeting_goal(), key=self.goal.cost)
        while met:
            leading, met = [row.setting for row in met[:PROMISING]], met[PROMISING:]
            self._measure(leading, rounds)
            self.rows |= {setting: self.bench.verified(self.rows[setting]) for setting in leading}
            verified = [self.rows[setting] for setting in leading if self._meets_goal(self.rows[setting])]
            if verified:
                return min(verified, key=self.goal.cost)
        raise self.goal.refusal(list(self.rows.values()))

    def evidence(self, rounds: int) -> WorkPrecision:
        rows = sorted(self.rows.values(), key=lambda row: (*map(str, row.setting.method), -_fineness(row.setting)))
        return found(self.bench, rows, rounds)

    def interrupted(self, interruption: KeyboardInterrupt, rounds: int) -> Interrupted:
        """Interrupted result with all entries, those being measured included; a run that verifies an entry adds none."""
        latest = getattr(interruption, "solution", None)
        self.rows |= {row.setting: row for row in latest.rows} if isinstance(latest, WorkPrecision) else {}
        evidence = dataclasses.replace(self.evidence(rounds), complete=False)
        return Interrupted(f"interrupted from the keyboard after {len(self.rows)} rows", evidence)

    def _closer_to_goal(self, rows: list[Row]) -> Setting:
        """A step between the last that meets the goal and the next that does not; if all meet it, one beyond the last."""
        ordered = _from_coarse_to_fine(rows)        # or the other way: what meets the goal comes first
        ordered = ordered if self.goal.seeks_finest else ordered[::-1]
        last = max(place for place, row in enumerate(ordered) if self._meets_goal(row))
        setting = ordered[last].setting
        if last + 1 < len(ordered):
            return _scaled(setting, math.sqrt(_fineness(ordered[last + 1].setting) / _fineness(setting)))
        return _scaled(setting, FACTOR[_chooses_steps(setting)]**(1 if self.goal.seeks_finest else -1))

    def _measure(self, settings: Iterable[Setting], rounds: int = 1) -> None:
        self.rows |= {row.setting: row for row in measured(self.bench, list(settings), rounds).rows}

    def _methods(self) -> list[list[Row]]:
        methods: dict[Any, list[Row]] = {}
        for row in self.rows.values():
            methods.setdefault(row.setting.method, []).append(row)
        return list(methods.values())

    def _meets_goal(self, row: Row) -> bool:
        return self.goal.met(row, self.bench.reference_error)

    def _rows_meeting_goal(self) -> list[Row]:
        return [row for row in self.rows.values() if self._meets_goal(row)]


def _chooses_steps(setting: Setting) -> bool:
    return setting.tolerance is not None


def _fineness(setting: Setting) -> float:
    found = setting.step if setting.tolerance is None else setting.tolerance
    assert found is not None        # as a setting has one of them
    return found


def _scaled(setting: Setting, factor: float) -> Setting:
    """Setting of the same method with another step or tolerance."""
    value = factor * _fineness(setting)
    return setting._replace(tolerance=max(value, FINEST_RTOL)) if _chooses_steps(setting) else setting._replace(step=value)


def _from_coarse_to_fine(rows: list[Row]) -> list[Row]:
    """Entries from the coarsest to the finest setting."""
    return sorted(rows, key=lambda row: -_fineness(row.setting))
