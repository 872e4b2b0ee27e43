"""End of a run: its outcome, its solution, and the error or the warnings that it ends with."""

from __future__ import annotations

import contextlib
import functools
import itertools
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..._private import checks, gateway
from ...errors import CorrectionFailed, Interrupted
from ...systems.base import BaseSystem, core_of
from ..arguments import outputs as _outputs
from ..arguments.inputs import History
from ..arguments.methods import name_of
from ..arguments.settings import core_settings
from ..samples.saving import EVENTS, JUMPS, transitions
from ..samples.solution import Solution
from . import diagnosis
from .beginning import Prepared
from .keyboard import Keyboard

EVALUATIONS = 6.0       # of terms in a corrected step of "rk4"
EXPLICIT = "rk4"        # an integrator that uses closed-form functions wherever the formulation does
STEPS_AHEAD = 4         # steps of fixed size in which a dead point may be the cause of a failure
SHARE_AHEAD = 1e-3      # of the time span, with adaptive steps


class Outcome(NamedTuple):
    """Outcome of a run: status, duration, error."""

    status: int
    seconds: float
    error: BaseException | None     # exception in Python that stopped the run: memory, Ctrl-C, or from the callable for progress


def solution_of(ready: Prepared, run: gateway.Run, record: Any, results: gateway.Results, outcome: Outcome,
                span: tuple[float, float] | None = None, history: History | None = None) -> Solution:
    """Solution of a run that has ended, with its arrays made at first use."""
    record.join()
    found = events_found(ready.watcher)
    return Solution._of_run(
        functools.partial(_arrays_and_stats, record, results, outcome.seconds, ready.recorded, ready.system, ready.settings,
                          history),
        status=outcome.status, success=outcome.status in (gateway.DONE, gateway.EVENT), message=message_of(run, outcome),
        settings=ready.settings, system=ready.system, t_span=span or ready.span,
        jumps=jumps_of(run.jumped, ready.events, found.get("t_events")), transitions=transitions(run.transitions), **found)


def solution_of_rows(system: BaseSystem, span: tuple[float, float], chosen: dict[str, Any], record: gateway.Record,
                     results: gateway.Results, seconds: float, status: int, message: str,
                     events: tuple[tuple[np.ndarray, ...], ...] | None, changes: Sequence[Any]) -> Solution:
    """Solution of a completed run that the core made in a batch; `events` are the t, p and v of its events, `changes` of
    phase as in `gateway.Run.transitions`.
    """
    return Solution._of_run(functools.partial(_arrays_and_stats, record, results, seconds, None, system, chosen),
                            status=status, success=True, message=message, settings=chosen, system=system, t_span=span,
                            jumps=jumps_of((), (), ()), transitions=transitions(changes),
                            **({} if events is None else dict(zip(EVENTS, events, strict=True))))


def _arrays_and_stats(record: gateway.Record, results: gateway.Results, seconds: float,
                      recorded: _outputs.Recorded | None, system: BaseSystem, chosen: dict[str, Any],
                      history: History | None = None) -> dict[str, Any]:
    """Arrays, statistics and outputs of a run under the names of the fields of `Solution`."""
    arrays, stats = record.take(), results.as_stats() | {"seconds": seconds}
    outputs = recorded.columns(arrays["outputs"]) if recorded and recorded.core else {}
    if history is not None:
        outputs |= history.columns(chosen["inputs"], arrays["t"])
    return {
        "t": arrays["t"], "p": arrays["p"], "v": arrays["v"], "multipliers": arrays["multipliers"],
        "position_violation": arrays["position_violation"], "velocity_violation": arrays["velocity_violation"],
        "kinetic_energy": arrays["kinetic"], "potential_energy": arrays.get("potential"), "energy_input": arrays.get("input"),
        "energy_violation": arrays.get("energy_violation"), "iterations": arrays["iterations"],
        "energy_skipped": arrays["energy_skipped"], "position_size": results.sizes,
        "stats": with_reason(stats, system, chosen),
        "outputs": outputs}


def with_reason(stats: dict[str, Any], system: BaseSystem, chosen: dict[str, Any]) -> dict[str, Any]:
    """Statistics of a run with the reason why no step used the closed form, and why equations were interpreted."""
    return stats | {"matrix_path_reason": _matrix_path_reason(system, chosen, stats),
                    "interpreted": system._why_interpreted(stats["evaluations"] / EVALUATIONS)}


def _matrix_path_reason(system: BaseSystem, settings: dict[str, Any], stats: dict[str, Any]) -> str | None:
    """Reason why no step used the closed form; None if some did, or if systems of this kind have no closed form."""
    translated, core = core_settings((0.0, 0.0), settings), core_of(system)
    lacks = system._why_no_closed_form(gateway.takes_embeddings(translated))
    if stats["closed_form_steps"] or not stats["steps"] or lacks is None:
        return None
    if settings["closed_form"] is False:
        return "closed_form=False"
    if not gateway.takes_closed_form(core, translated):
        explicit = core_settings((0.0, 0.0), settings | {"integrator": EXPLICIT})
        table = "integrator" if gateway.takes_closed_form(core, explicit) else "formulation"
        return f"{table} {name_of(f'{table}s', settings[table])!r} has none" + " for such a system" * (table == "formulation")
    if lacks:
        return lacks
    return "some constraints are redundant" if stats["redundant"] else "the elimination order is unsuitable at every step"


def message_of(run: gateway.Run, outcome: Outcome) -> str:
    """Message of a run: "done", or the reason for its end."""
    match outcome.status:
        case gateway.DONE:
            return "done"
        case gateway.INTERRUPTED if not isinstance(outcome.error, KeyboardInterrupt):
            return f"stopped by {_shown(outcome.error)}"
        case gateway.INTERRUPTED:
            return "interrupted from the keyboard"
        case gateway.CALLBACK if run.has_raised:
            return "; ".join([f"{run.message}: {_shown(run.error(outcome.status))}", *run.notes])
        case _:
            return run.message


def _shown(error: BaseException | None) -> str:
    """The `repr` of an error, or the name of its class if that fails."""
    try:
        return repr(error)
    except Exception:
        return type(error).__name__


def jumps_of(rows: Sequence[tuple[float, str, float]], events: Any, times: Any) -> np.ndarray:
    """Field `jumps`: these rows, and those of actions without a change of the energy."""
    known = {(t, name) for t, name, _ in rows}
    own = [event for event in events or () if event.is_own]
    acts = [(t, event.name, 0.0) for event, found in zip(own, times or (), strict=True) if event.then is not None
            for t in found.tolist() if (t, event.name) not in known]
    return np.array(sorted([*rows, *acts], key=lambda row: row[0]), JUMPS)


def events_found(watcher: gateway.Watcher | None) -> dict[str, tuple[np.ndarray, ...]]:
    """Fields `t_events`, `p_events` and `v_events`, each with one array per event; empty without events."""
    if watcher is None:
        return {}
    arrays = [watcher.arrays(i) for i, event in enumerate(watcher.events) if event.is_own]
    if not arrays and watcher.events:
        return {}
    for array in itertools.chain(*arrays):
        array.setflags(write=False)
    return dict(zip(EVENTS, tuple(zip(*arrays, strict=True)) or ((), (), ()), strict=True))


def finished(solution: Solution, run: gateway.Run, results: gateway.Results, outcome: Outcome, on_failure: str,
             keyboard: Keyboard) -> Solution:
    """Return the solution, with warnings where it is doubtful; or raise an error that has it as an attribute."""
    interrupted = isinstance(outcome.error, KeyboardInterrupt)
    if keyboard.pressed and not interrupted:    # Ctrl-C came after the last slice, or while something else failed
        raise Interrupted(f"interrupted from the keyboard, and: {solution.message}", solution) from outcome.error
    if outcome.error is not None and not interrupted:
        raise with_solution(outcome.error, solution)
    if on_failure == "raise" and not solution.success:
        if solution.status == gateway.INTERRUPTED:
            raise Interrupted(solution.message, solution) from None
        error, note = failure_of(solution.system, run, solution.status, solution.settings, solution.t_span, solution)
        raise with_solution(error, solution, note)
    if not diagnosis.is_beyond_doubt(results):
        diagnosis.warn(solution, stacklevel=3)      # at the line that calls `simulate`
    return solution


def failure_of(system: BaseSystem, run: gateway.Run, status: int, settings: dict[str, Any],
               span: tuple[float, float], solution: Solution | None = None) -> tuple[BaseException, str | None]:
    """Error of a failed run, and advice on it; beyond the reach of a drive it is one error for all methods and steps."""
    t, p, v = run.place()
    if status == gateway.CALLBACK:
        return run.error(status), run.message
    if said := beyond_reach(system, run, settings, span, solution):
        return CorrectionFailed(said), None
    if status == gateway.COLLAPSED:
        return run.error(status), system._advice_on_collapse(t, p, v, run.results().statistics.part)
    return run.error(status), system._advice_on_failure(t, p)


def beyond_reach(system: BaseSystem, run: gateway.Run, settings: dict[str, Any], span: tuple[float, float],
                 solution: Solution | None = None) -> str:
    """Sentence on drives that end a failed run at a dead point; "" if none does.

    They are checked at the state that could not be corrected, which may be far off, and at the last sample of a solution.
    """
    t, p, _ = run.place()
    ahead = STEPS_AHEAD * settings["step"] if settings.get("step") else SHARE_AHEAD * (span[1] - span[0])
    samples = zip(solution.t[-1:], solution.p[-1:], strict=True) if solution else ()
    found = (system._beyond_reach(float(of), np.array(at), t - of + ahead) for of, at in ((t, p), *samples))
    return next(filter(None, found), "")


def with_solution(error: Any, solution: Any, note: str | None = None) -> BaseException:
    """The error with the solution as an attribute, if its class allows attributes."""
    with contextlib.suppress(Exception):
        error.solution = solution
    if note:
        checks.tell(error, note)
    return error


def finish_file(record: Any, solution: Solution, outcome: Outcome | None) -> None:
    """Write the remaining fields of the solution to the file; a full disk is an error unless the run already has one."""
    try:
        record.finish(solution)
    except OSError as error:
        if outcome is None or outcome.error is None:
            raise with_solution(error, solution) from None
