"""`simulate`: from a system to its motion."""

from __future__ import annotations

import contextlib
import functools
import itertools
import time
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .. import _check, _gateway
from ..errors import CostWarning, Interrupted, SingularSystem
from ..systems.base import BaseSystem, core_of, direct_core_of
from . import diagnosis, evaluation_path, recording, settings
from . import events as _events
from . import outputs as _outputs
from .keyboard import Keyboard
from .progress import progress_of
from .saving import EVENTS
from .solution import Solution
from .start import start_of

SLICE = 0.03        # seconds that the core runs before Python looks at the keyboard and shows the progress again


def simulate(
    system: BaseSystem,
    t_span: float | tuple[float, float],
    p0: Any = None,
    v0: Any = None,
    *,
    step: float | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    first_step: float | None = None,
    max_step: float | None = None,
    max_move: float | None = None,
    max_steps: int | None = settings.MAX_STEPS,
    t_eval: Any = None,
    events: Any = None,
    formulation: str = settings.FORMULATION,
    integrator: str | None = None,
    stabilization: str | settings.Stabilization = settings.STABILIZATION,
    energy: bool | settings.EnergyCorrection | None = None,
    correction: Any = None,
    save_every: int = 1,
    progress: bool | Callable[[float], None] = False,
    outputs: Any = None,
    save_to: Any = None,
    on_singular: str = "stop",
    direct: bool | None = None,
    vector: str | None = None,
    on_failure: str = "raise",
) -> Solution:
    """Simulate the motion of a constrained multibody system.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Start; left out: the system's own. It must satisfy the constraints, see `assemble`. In place of p0 also what
        `equilibrium` returns.
    step : float, optional
        Step in s. If the span is no whole number of steps, a shorter one is added at the end. Left out: the integrator
        chooses its steps by its error estimate, with `rtol` and `atol`, if it has one.
    rtol, atol : float, optional
        Where steps are chosen: the error of each, root mean square over the state y, in units of ``atol + rtol * abs(y)``, is
        at most one. Left out: 1e-6 and 1e-9. `atol` has the units of y; no other tolerance depends on them. The error after
        many steps is larger: after half a second of any built-in system with ``rtol = atol``, tests find at most 3000 times
        these. `zerodrift.tune` finds settings for an error of the motion itself.
    first_step, max_step : float, optional
        Where steps are chosen: the first, and the largest, in s. Where something acts for a short time, steps may leap over
        it: a `max_step` of that time, or shorter, lets them see it.
    max_move : float, optional
        Where steps are chosen: the largest change of any coordinate in a step, in m and rad alike; of formulation 'independent',
        of the coordinates that it integrates. Where something acts in a narrow place, as a thin wall or a steep law, steps may
        leap over it, in silence: a `max_move` of a third of its width, or less, lets them see it.
    max_steps : int or None
        Where steps are chosen: after so many the run fails, and says where most of them lie. None: there is no bound. Steps of
        fixed size have none.
    t_eval : array_like (k,), optional
        Times to save, instead of every step, in increasing order. Values between steps have the error of the method, and are
        corrected: they come from shorter steps, or where steps are chosen from the polynomial of a method that has one.
    events : callable, Event or measure, or a list of these, optional
        Functions ``event(t, p, v) -> float`` whose zeros are located, to the rounding of t, wherever one changes its sign from
        the beginning of a step to its end, on the values that `t_eval` has there. What is reported is corrected, also with
        corrections at every k-th step only, and there the function is zero to that rounding; a function that leaps over zero is
        reported behind its leap. An attribute `direction` of 1 or -1 takes only those from below or from above; `terminal`, True
        or a number, ends the run when the event has happened once or that often: by a step made to there, at whose end the
        function is zero, as far from the zero of the polynomial as that errs. What is zero at the start is no event.
    formulation : str or settings
        One of `formulations()`: which equations of motion are solved. Its name, or ``formulations()[name].settings(...)``.
    integrator : str or settings
        One of `integrators()`, in the same way. Left out: "rk4" where `step` is given, and "dop853", which chooses its steps,
        where it is not: ``zd.simulate(m, 10.0)``.
    stabilization : None, "projection", "baumgarte", Projection or Baumgarte
        How constraint violations are kept down.
    energy : None, True or EnergyCorrection
        Whether energy errors are taken out of the velocities, (29).
    correction : str or settings, or several of them
        Others of `corrections()`: names, or ``corrections()[name].settings(...)``.
    save_every : int
        Steps between saved rows; start and end are always saved.
    progress : bool or callable
        True: a progress bar (needs tqdm). A callable is handed the part done, 0 ... 1, some thirty times a second.
    outputs : list of measures or names, optional
        Measures that are recorded in every saved row, such as ``["C.force", crank.angle]``, with the accelerations and
        multipliers of the run itself; ``sol[name]`` then reads the record, and `Solution.save` keeps it. Left out: ``sol[name]``
        evaluates measures when it is asked, and nothing is recorded or paid for. Where many measures are read, recording them is
        cheaper: bodies are placed once for all of a row.
    save_to : str or Path, optional
        A file that rows are written to as they come, instead of into memory, which may then be smaller than the record. The
        arrays of the solution, and of what `load` makes of the file, are in it: what is looked at is read. The suffix ``.zd`` is
        added where it is missing. A run that is killed leaves the rows that it had. An older file of the same name is replaced
        when the run starts, unless another run is writing it.
    on_singular : {"stop", "continue"}
        What to do when the motion reaches a bifurcation, at the end of a step or within it. A bifurcation is a position in
        which constraints that are independent elsewhere become dependent and no longer determine the motion, as in a
        parallelogram whose links lie on one line. "stop" ends the run with the error `Bifurcation`. "continue" follows the
        branch of least acceleration; while the mechanism moves, this is the branch along its velocity. A mechanism that comes
        within 1e-7 of its size of a bifurcation, or within 1e-4 where it moves nearly straight, is taken through it in the same
        way. Where no branch lies along the velocity, the formulations "mixed" and "independent" stop, and the others take the
        least acceleration. Constraints that are redundant in every position are no bifurcation, and need no choice. Among the
        rows of a declared structure with more than 40 of them, or more than 300 velocities, bifurcations are not looked for,
        neither at the end of a step nor within it, and "continue" is as "stop": a run goes on through one as its numbers lead
        it, and loses digits. Two things are told of them. A start at one is refused with that error. Later, where the mass
        matrix is definite, a warning and ``repr`` of the solution say where least was left of a row.
    direct : None or False
        None takes the direct functions of a system, where it has any and they serve: accelerations and corrections with the
        constraints eliminated in closed form, the same motion to rounding in a fraction of the time. They serve explicit
        integrators, where no constraint is redundant. A step at whose ends the elimination is not sound is made by the
        formulation's leading matrix, and of "mixed" and "independent" one at whose end other velocities are chosen to be
        independent, or for whose none was written: that is for four choices at most. "independent" takes them where ``pdot = v``
        and constraints are all holonomic or all nonholonomic; neither of the two where the system brings its own complement
        `D`. `repr` of the solution says how many steps were made otherwise, or why all. False makes all steps so.
    vector : {"baseline", "avx2", "avx512"}, optional
        The vector unit that direct functions may use. Left out: what the environment variable ZERODRIFT_VECTOR says, else the
        last that the processor has. With "baseline", all processors give the same bits; the units round less often, give the
        same bits among each other, and shorten whole runs of a four-bar by 13 to 21 %.
    on_failure : {"raise", "return"}
        Whether a run that fails or is interrupted raises an error that carries the partial solution as `.solution`,
        or returns that solution, whose `success` is then False.

    Returns
    -------
    Solution

    Raises
    ------
    ZerodriftError
        Or one of its subclasses, where the start is inconsistent, a correction or an implicit step fails, the motion diverges,
        the mass matrix is not symmetric (`SingularSystem`), or a Jacobian that was given is not that of the constraints
        (`InconsistentSystem`).
    Interrupted
        On Ctrl-C.
    ValueError, TypeError
        For a wrong argument.

    MemoryError
        If the record takes more than the memory that is free; how much, and what takes less, is in its message.
    OSError
        If rows cannot be written to the file.
    InUse
        If another run is writing to that file.

    Warns
    -----
    CostWarning
        Before anything runs, where the record takes more than half of the memory that is free, or where a mechanism has many
        joint coordinates, takes some ten seconds, and would take less than a tenth of that in absolute ones.
    AccuracyWarning
        Where the energy balance is off by more than 0.5 % of the largest kinetic energy, or was before a single correction by
        more than 2 %: what was computed satisfies the constraints, but is not the motion. It takes a system with a potential.
        Or where steps of fixed size do not resolve the motion of one part, however light it is; the part is named.
    StabilityWarning
        Where steps were longer than the integrator is stable for, or stability held chosen steps down.
    CorrectionWarning
        Where energy corrections were left out.
    LockedWarning
        Where joints in space leave no body any motion, as the axes of hinges are askew.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> sol = zd.simulate(bar, 8.0, step=0.05, formulation="augmented", stabilization=zd.Projection(), energy=True)
    >>> sol.p.shape
    (161, 3)
    >>> bool(abs(sol.position_violation).max() < 1e-12)
    True

    The run ends when the crank has come round to the horizontal twice; where the coupler is at rest is noted on the way:

    >>> import numpy as np
    >>> def round(t, p, v):
    ...     return np.sin(p[0])
    >>> round.direction, round.terminal = 1, 2
    >>> def rest(t, p, v):
    ...     return v[1]
    >>> sol = zd.simulate(bar, 8.0, step=0.01, events=[round, rest])
    >>> sol.message
    'at t = 2.16071475 (step 217 of 800): ended by event 0'
    >>> sol.t_events[1].round(4)
    array([0.1287, 0.6498, 1.4803, 2.0013])
    """
    span = _check.span(t_span)
    system, p0, v0 = start_of(system, p0, v0, span[0])
    core_of(system)
    plan = settings.plan(
        system, span, t_eval, save_every, step, rtol, atol, first_step, max_step, max_move, max_steps, formulation, integrator,
        stabilization, energy, correction, on_singular, direct, vector)
    core = direct_core_of(system, plan.chosen["vector"], plan.options)
    plan.chosen["vector"] = evaluation_path.unit(core, plan.options)
    _check.choice("on_failure", on_failure, ("raise", "return"))
    watched = _events.events(events, system)
    recorded = None
    if outputs is not None:
        plan.chosen["outputs"] = _outputs.names(outputs, system)
        recorded = _outputs.Recorded(plan.chosen["outputs"], system, core)
    p0, v0 = system._state_or_start(p0, v0, t=span[0])
    path = None if save_to is None else recording.file_of_samples().checked(save_to)
    watcher = _gateway.Watcher(core, watched, system._watching.core) if watched is not None else None
    if told := system._what_it_costs(plan.steps):
        warnings.warn(told, CostWarning, stacklevel=2)
    with recording.locked(path), Keyboard(*_gateway.CALLBACK_CODE, _show.__code__) as keyboard:
        more = recorded.core if recorded else None
        run = _created(system, core, plan.options, p0, v0, watcher, more)
        record = recording.record_of(core, more, plan.rows, path)
        if path:
            recording.begin_file(record, run, system, span, plan.chosen, recorded)
        outcome = _drive(run, record, progress, keyboard)
        results = run.results()
        solution = _solution(system, span, plan.chosen, run, record, results, watcher, outcome, recorded)
        if path:
            _finish_file(record, solution, outcome)
    return _finished(solution, run, results, outcome, on_failure, keyboard)


def _finish_file(record: Any, solution: Solution, outcome: _Outcome) -> None:
    """What it says of the run once that has ended, if there is room for it."""
    try:
        record.finish(solution)
    except OSError as error:
        if outcome.error is None:
            raise _with_solution(error, solution) from None


class _Outcome(NamedTuple):
    """How a run ended."""

    status: int
    seconds: float
    error: BaseException | None     # what Python stopped it with: short memory, Ctrl-C, what the callable for progress raised


def _drive(run: _gateway.Run, record: _gateway.Record, progress: Any, keyboard: Keyboard) -> _Outcome:
    """Let the core run in slices until it ends, fails or is interrupted."""
    show, close = progress_of(progress)
    start, status, error = time.perf_counter(), _gateway.PAUSED, None
    try:
        while status in (_gateway.PAUSED, _gateway.FULL):
            if keyboard.pressed:
                raise KeyboardInterrupt
            if status == _gateway.FULL:
                recording.check_memory(record.next_rows, record.row_bytes, stacklevel=4)
                record.grow()
            status = run.advance(record, SLICE)
            record.keep()
            _show(show, run.progress)
    except BaseException as caught:
        status, error = _gateway.INTERRUPTED, caught
    finally:
        close()
    if status == _gateway.CALLBACK and not isinstance(run.error(status), Exception):     # Ctrl-C, SystemExit and the like
        status, error = _gateway.INTERRUPTED, run.error(status)
    return _Outcome(status, time.perf_counter() - start, error)


def _show(show: Callable[[float], None], part: float) -> None:
    """Show the progress. The callable may be the user's, so that Ctrl-C may break into it: this function marks the place."""
    try:
        show(part)
    except BaseException as error:
        _check.tell(error, f"in progress, called with {part:g}")
        raise


def _solution(system, span, chosen, run, record, results, watcher, outcome, recorded) -> Solution:
    """Everything that a run left behind."""
    record.join()
    return Solution._of_run(
        functools.partial(_arrays_and_stats, record, results, outcome.seconds, recorded, system, chosen), status=outcome.status,
        success=outcome.status in (_gateway.DONE, _gateway.EVENT), message=_message(run, outcome), settings=chosen,
        system=system, t_span=span, **_events_found(watcher))


def solution_of_rows(system: BaseSystem, span: tuple[float, float], chosen: dict[str, Any], record: _gateway.Record,
                     results: _gateway.Results, seconds: float, status: int, message: str,
                     events: tuple[tuple[np.ndarray, ...], ...] | None) -> Solution:
    """That of a run which was not driven here, and has reached its end; t, p and v of its events."""
    return Solution._of_run(functools.partial(_arrays_and_stats, record, results, seconds, None, system, chosen),
                            status=status, success=True, message=message, settings=chosen, system=system, t_span=span,
                            **({} if events is None else dict(zip(EVENTS, events, strict=True))))


def _arrays_and_stats(record: _gateway.Record, results: _gateway.Results, seconds: float,
                      recorded: _outputs.Recorded | None, system: BaseSystem, chosen: dict[str, Any]) -> dict[str, Any]:
    """What a solution has of them, under its own names."""
    arrays, stats = record.take(), results.as_stats() | {"seconds": seconds}
    return {
        "t": arrays["t"], "p": arrays["p"], "v": arrays["v"], "multipliers": arrays["multipliers"],
        "position_violation": arrays["position_violation"], "velocity_violation": arrays["velocity_violation"],
        "kinetic_energy": arrays["kinetic"], "potential_energy": arrays.get("potential"), "energy_input": arrays.get("input"),
        "energy_violation": arrays.get("energy_violation"), "iterations": arrays["iterations"],
        "energy_skipped": arrays["energy_skipped"], "position_size": results.sizes,
        "stats": stats | {"matrix_path_reason": evaluation_path.matrix_path_reason(system, chosen, stats)},
        "outputs": recorded.columns(arrays["outputs"]) if recorded and recorded.core else {}}


def _created(system: BaseSystem, *given: Any) -> _gateway.Run:
    """The core's run; where masses or the pose forbid it, the error says what the system knows of them."""
    try:
        return _gateway.Run(*given)
    except SingularSystem as error:
        advice = system._advice(error)
        if advice is None:
            raise
        raise type(error)(f"{error}; {advice}") from None


def _message(run: _gateway.Run, outcome: _Outcome) -> str:
    """What happened, in a sentence."""
    match outcome.status:
        case _gateway.DONE:
            return "done"
        case _gateway.INTERRUPTED if not isinstance(outcome.error, KeyboardInterrupt):
            return f"stopped by {_shown(outcome.error)}"
        case _gateway.INTERRUPTED:
            return "interrupted from the keyboard"
        case _gateway.CALLBACK if run.has_raised:
            return "; ".join([f"{run.message}: {_shown(run.error(outcome.status))}", *run.notes])
        case _:
            return run.message


def _shown(error: BaseException) -> str:
    """An error as Python writes it; its name, if it is of a kind that cannot be written."""
    try:
        return repr(error)
    except Exception:
        return type(error).__name__


def _events_found(watcher: _gateway.Watcher | None) -> dict[str, tuple[np.ndarray, ...]]:
    """The times t, the p and the v of all events, each with one array per event; nothing where no events were asked for."""
    if watcher is None:
        return {}
    arrays = [watcher.arrays(event) for event in range(len(watcher.events))]
    for array in itertools.chain(*arrays):
        array.setflags(write=False)
    return dict(zip(EVENTS, tuple(zip(*arrays, strict=True)) or ((), (), ()), strict=True))


def _finished(solution: Solution, run, results, outcome, on_failure, keyboard) -> Solution:
    """The solution, with warnings where it is doubtful; or an error that carries it."""
    interrupted = isinstance(outcome.error, KeyboardInterrupt)
    if keyboard.pressed and not interrupted:    # Ctrl-C came after the last slice, or while something else failed
        raise Interrupted(f"interrupted from the keyboard, and: {solution.message}", solution) from outcome.error
    if outcome.error is not None and not interrupted:
        raise _with_solution(outcome.error, solution)
    if on_failure == "raise" and not solution.success:
        _raise_failure(run, solution)
    if not diagnosis.is_beyond_doubt(results):
        diagnosis.warn(solution, stacklevel=3)      # at the line that calls `simulate`
    return solution


def _raise_failure(run: _gateway.Run, solution: Solution) -> None:
    if solution.status == _gateway.INTERRUPTED:
        raise Interrupted(solution.message, solution) from None
    note = run.message if solution.status == _gateway.CALLBACK else _advice(solution)
    raise _with_solution(run.error(solution.status), solution, note)


def _advice(solution: Solution) -> str | None:
    """What the system knows of the place where its run failed."""
    if not len(solution.t):
        return None
    return solution.system._advice_on_failure(float(solution.t[-1]), np.ascontiguousarray(solution.p[-1]))


def _with_solution(error: BaseException, solution: Solution, note: str | None = None) -> BaseException:
    """The error, which carries the solution unless it is of a kind that takes no attributes."""
    with contextlib.suppress(Exception):
        error.solution = solution
    if note:
        _check.tell(error, note)
    return error
