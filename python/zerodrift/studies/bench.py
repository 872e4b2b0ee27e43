"""Runs of one motion with many settings: their time, and their difference from a reference."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from .._private import gateway
from ..errors import WrongValue
from ..runs.arguments import methods, settings
from ..runs.open.diagnosis import instability, unwarned
from ..runs.open.threads import processors, side_by_side
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..systems.base import BaseSystem, closed_form_core_of, core_of
from ..systems.parameter_tables import NumberTables
from . import reference as certified
from .compare import states_of

TIMES = 200         # at which errors are measured, at most
TIMES_OF_STEPS = 4000       # the same, at the ends and the middles of steps
TOGETHER = 0.5      # s of runs whose errors are found together; at least as many runs as there are processors
PARTS = 4           # for each thread, so that all end at about the same time


class Setting(NamedTuple):
    """Settings of runs: methods with a fixed step in s, or with adaptive steps of ``rtol = atol = tolerance``, rtol at most 1."""

    formulation: str
    integrator: str
    step: float | None
    tolerance: float | None
    stabilization: settings.Stabilization = methods.Projection()
    energy: methods.EnergyCorrection | None = None

    @property
    def settings(self) -> dict[str, Any]:
        """Arguments of `simulate` for this setting."""
        steps = {"step": self.step} if self.tolerance is None else {"rtol": min(self.tolerance, 1.0), "atol": self.tolerance}
        return {"formulation": self.formulation, "integrator": self.integrator, **steps,
                "stabilization": self.stabilization, "energy": self.energy}

    @property
    def method(self) -> tuple[Any, ...]:
        """Key of the curve in a work-precision diagram: the setting without its step or tolerance."""
        return self._replace(step=None, tolerance=None), self.tolerance is not None


class Row(NamedTuple):
    """Measured cost and error of one setting; NaN where a value does not exist.

    Attributes
    ----------
    setting : Setting
    success : bool
        True if the end was reached.
    message : str
        "done", or the reason for the end of the run.
    seconds : float
        Minimum time over all rounds, in s.
    steps, evaluations : int
        Numbers of steps and of evaluations of the system.
    error : float
        ``max |p - p_ref|`` over all coordinates and up to 200 output times, which include the end and are the same for all
        runs.
    position_violation, velocity_violation, energy_violation : float
        Maxima over all samples.
    """

    setting: Setting
    success: bool
    message: str
    seconds: float
    steps: int
    evaluations: int
    error: float
    position_violation: float
    velocity_violation: float
    energy_violation: float

    def flat(self) -> dict[str, Any]:
        """Values by column of a table."""
        return {**self.setting._asdict(), **{name: value for name, value in self._asdict().items() if name != "setting"}}


class Outcome(NamedTuple):
    """Results of a run that are needed for a `Row`."""

    success: bool
    message: str
    seconds: float
    steps: int
    evaluations: int
    p: np.ndarray | None                        # (k, nq): coordinates at the output times
    violations: tuple[float, ...]               # maxima of position, velocity and energy violation; NaN if undefined


class Bench:
    """Bench: a motion and the reference to which its runs are compared."""

    def __init__(self, system: BaseSystem, span: tuple[float, float], p0: Any, v0: Any, reference: Any,
                 closed_form: Literal[False] | None = False) -> None:
        self.system, self.span, self.start, self.closed_form = system, span, (p0, v0), closed_form
        is_certified = isinstance(reference, certified.Reference)
        self.reference_error: float = reference.error_in_double if is_certified else np.nan
        self.caveats: tuple[str, ...] = reference.caveats if is_certified else ()
        self._reference = reference
        self._times = _times(reference, span)
        self._exact = states_of(reference, self._times, system.nq)[:, :system.nq]

    @property
    def needs_python(self) -> bool:
        """True if runs call Python functions, so that they cannot execute in parallel threads."""
        return core_of(self.system).for_run() is not core_of(self.system)

    def prepare(self, setting: Setting) -> None:
        """Compile the functions that runs with this setting need, before threads use them."""
        self._core(self._plan(setting))

    def rows(self, combinations: Sequence[Setting], stop: gateway.Stop | None = None) -> list[Row]:
        """Entries for runs with fixed steps, many in one call of the core; empty if stopped."""
        return self._rows(combinations, self._outcomes(combinations, stop), stop)

    def timed(self, combinations: Sequence[Setting]) -> Iterator[Row]:
        """Time each run while nothing else executes here; then, for groups of runs, compute errors in parallel."""
        while combinations:
            outcomes: list[Outcome] = []
            while len(outcomes) < len(combinations) and (len(outcomes) < processors() or _seconds_of(outcomes) < TOGETHER):
                outcomes.append(self.run(combinations[len(outcomes)]))
            yield from self._with_errors(combinations[:len(outcomes)], outcomes)
            combinations = combinations[len(outcomes):]

    def _with_errors(self, combinations: Sequence[Setting], outcomes: Sequence[Outcome]) -> list[Row]:
        """Entries of finished runs, whose errors are computed in threads."""
        parts, found = min(len(combinations), PARTS * processors()), {}

        def look(part: int, stop: gateway.Stop | None) -> None:
            found[part] = self._rows(combinations[part::parts], outcomes[part::parts], stop)

        side_by_side(look, range(parts), in_threads=not self.needs_python)
        return [found[place % parts][place // parts] for place in range(len(combinations))]

    def timed_again(self, row: Row) -> Row:
        """Entry with the smaller of its time and a second one."""
        return row._replace(seconds=min(row.seconds, self.run(row.setting).seconds))

    def verified(self, row: Row) -> Row:
        """Entry whose error includes that at the ends and in the middle of the run's own steps; for references with all steps."""
        with unwarned():
            own = simulate(self.system, self.span, *self.start, **row.setting.settings, closed_form=self.closed_form).t
        times = np.sort(np.concatenate([own, (own[1:] + own[:-1]) / 2]))
        times = times[np.unique(np.linspace(0, len(times) - 1, TIMES_OF_STEPS).round().astype(int))]
        exact = states_of(self._reference, times, self.system.nq)[:, :self.system.nq]
        return row._replace(error=max(row.error, _largest(self.run(row.setting, t_eval=times).p - exact)))

    def _rows(self, combinations: Sequence[Setting], outcomes: Sequence[Outcome], stop: gateway.Stop | None) -> list[Row]:
        """Entries of finished runs; successful runs are repeated with output at the times of the reference."""
        done = [place for place, outcome in enumerate(outcomes) if outcome.success]
        again = self._outcomes([combinations[place] for place in done], stop, t_eval=self._times)
        if len(again) < len(done) or len(outcomes) < len(combinations):
            return []
        at_times = dict(zip(done, again, strict=True))
        return [self._row(setting, outcome, at_times.get(place, outcome))
                for place, (setting, outcome) in enumerate(zip(combinations, outcomes, strict=True))]

    def _row(self, setting: Setting, outcome: Outcome, at_times: Outcome) -> Row:
        error = _largest(at_times.p - self._exact) if at_times.success else np.nan
        return Row(setting, at_times.success, at_times.message, outcome.seconds, outcome.steps, outcome.evaluations, error,
                   *outcome.violations)

    def run(self, setting: Setting, **saved: Any) -> Outcome:
        """Entry of one run."""
        with unwarned():        # errors are measured, the rest is the row's message
            return self._run(setting, **saved)

    def _run(self, setting: Setting, **saved: Any) -> Outcome:
        solution = simulate(self.system, self.span, *self.start, **(setting.settings | saved), closed_form=self.closed_form,
                            on_failure="return")
        if solution.status == gateway.INTERRUPTED:
            raise KeyboardInterrupt
        return _outcome(solution)

    # ---- many in one call of the core ----

    def _outcomes(self, combinations: Sequence[Setting], stop: gateway.Stop | None = None, **saved: Any) -> list[Outcome]:
        """Results of runs, bitwise those of individual runs; empty if stopped."""
        if self.needs_python:
            return [self.run(setting, **saved) for setting in combinations]
        plans = [self._plan(setting, **saved) for setting in combinations]
        cores: dict[gateway.CoreSystem, list[int]] = {}
        for place, plan in enumerate(plans):
            cores.setdefault(self._core(plan), []).append(place)
        found: dict[int, Outcome] = {}
        for core, places in cores.items():
            made = self._made(core, [plans[place] for place in places], stop)
            if (made.status == gateway.PAUSED).any():
                return []
            for run, place in enumerate(places):
                if made.way[run] == gateway.NOT_BEGUN:     # an error says why, as of any run
                    found[place] = self._run(combinations[place], **saved)
                else:
                    found[place] = _outcome_of(core, plans[place], made, run)
        return [found[place] for place in range(len(plans))]

    def _plan(self, setting: Setting, t_eval: Any = None) -> settings.CheckedSettings:
        return settings.plan(self.system, self.span, settings.Arguments(t_eval, closed_form=self.closed_form, **setting.settings))

    def _core(self, plan: settings.CheckedSettings) -> gateway.CoreSystem:
        return closed_form_core_of(self.system, plan.settings["vector"], plan.core_settings)

    def _made(self, core: gateway.CoreSystem, plans: Sequence[settings.CheckedSettings],
              stop: gateway.Stop | None) -> gateway.BatchResults:
        each, rows = [plan.core_settings for plan in plans], max(plan.rows or 0 for plan in plans)
        p0, v0 = (np.tile(x, (len(plans), 1)) for x in self.system._state_or_start(*self.start, t=self.span[0]))
        wanted = ("p",) if "t_eval" in plans[0].settings else ()
        return gateway.run_batch(NumberTables(core, None, 0, p0, v0, {}), each, len(plans), rows, wanted, stop=stop)


def _seconds_of(outcomes: Sequence[Outcome]) -> float:
    return sum(outcome.seconds for outcome in outcomes)


def _outcome(solution: Solution) -> Outcome:
    stats = solution.stats
    message = _message(solution.message, stats, solution.settings["integrator"], is_done=solution.success)
    return Outcome(solution.success, message, stats["seconds"], stats["steps"], stats["evaluations"], solution.p, tuple(
        map(_largest, (solution.position_violation, solution.velocity_violation, solution.energy_violation))))


def _outcome_of(core: gateway.CoreSystem, plan: settings.CheckedSettings, made: gateway.BatchResults, run: int) -> Outcome:
    """Outcome of a run in a batch."""
    rows, is_done = int(made.samples[run]), bool(made.status[run] == gateway.DONE)
    stats = dict(zip(made.statistics.dtype.names, made.statistics[run].item(), strict=True))
    measured = {name: float(values[run]) for name, values in made.measured.items()}
    energy = float(made.energy_error[run]) if core.has_energy and rows else np.nan
    return Outcome(
        is_done, _message(made.messages[run] or "done", stats | measured, plan.settings["integrator"], is_done=is_done),
        measured["seconds"], stats["steps"], stats["evaluations"], made.columns["p"][run, :rows] if made.columns else None,
        (measured["position_violation"], measured["velocity_violation"], energy))


def _message(ended: str, stats: Any, integrator: Any, *, is_done: bool) -> str:
    skipped = stats["energy_skipped"]
    doubtful: Iterator[str] = instability(stats, integrator) if is_done else iter(())
    return "; ".join([ended, *([f"{skipped} energy corrections left out"] if skipped else []), *doubtful])


def _largest(values: np.ndarray | None) -> float:
    return float(np.abs(values).max()) if values is not None and values.size else np.nan


def _times(reference: Any, span: tuple[float, float]) -> np.ndarray:
    """Sample times of the reference, if it has samples; it may be expensive or undefined between them."""
    solution = reference.solution if isinstance(reference, certified.Reference) else reference
    if not isinstance(solution, Solution):
        return np.linspace(*span, TIMES)
    times = solution.t[(solution.t >= span[0]) & (solution.t <= span[1])]
    if not len(times):
        raise WrongValue(f"the reference has no row from t = {span[0]:g} to {span[1]:g} s", "not-available")
    return times[np.unique(np.linspace(0, len(times) - 1, TIMES).round().astype(int))]
