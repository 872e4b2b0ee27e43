"""`simulate`: from a system to its motion."""

from __future__ import annotations

import contextlib
import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from .. import _check, _gateway
from ..errors import AccuracyWarning, CorrectionWarning, Interrupted, StabilityWarning
from ..systems.base import BaseSystem, core_of
from . import events as _events
from . import settings
from .keyboard import Keyboard
from .solution import Solution

SLICE = 0.03        # seconds the core runs between looks at the keyboard and the progress bar
FIRST_BLOCK = 1024  # rows, where it is not known how many there will be
DEFAULT_CONTROL = {"rtol": 1e-6, "atol": 1e-9, "first_step": None, "max_step": None}
# Parts of the kinetic energy. With less of an error of (28), no run of those measured lost a turn of twenty. Corrections put more
# than that right, as long as no single step needs much of them.
ENERGY_ERROR, ENERGY_CORRECTION = 0.005, 0.02
ENERGY_ROUNDING = 1e-10     # of all the energy there is: such errors say nothing
TOO_COARSE = ("steps are too long for what happens in some of them; take shorter ones, a method of higher order, or rtol instead "
              "of step")
FINEST_RTOL = 100 * np.finfo(float).eps     # below, estimates are round-off


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
    t_eval: Any = None,
    events: Any = None,
    formulation: str = "schur",
    integrator: str = "rk4",
    stabilization: str | settings.Stabilization = "projection",
    energy: bool | settings.EnergyCorrection | None = None,
    save_every: int = 1,
    progress: bool | Callable[[float], None] = False,
    on_singular: str = "stop",
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
        Start; left out: the system's own. It must satisfy the constraints, see `assemble`.
    step : float, optional
        Step in s. If the span is no whole number of steps, a shorter one is added at the end. Left out: the integrator
        chooses its steps by its error estimate, if it has one.
    rtol, atol : float, optional
        Where steps are chosen: the error of each, root mean square over the state y, in units of ``atol + rtol * abs(y)``, is
        at most one. Left out: 1e-6 and 1e-9. `atol` has the units of y: of all tolerances it alone depends on them. What
        is left after many steps is more: after half a second of any built-in system with ``rtol = atol``, tests find at
        most 3000 times these. `zerodrift.tune` finds settings for an error of the motion itself.
    first_step, max_step : float, optional
        Where steps are chosen: the first, and the largest, in s.
    t_eval : array_like (k,), optional
        Times to save, instead of every step, in increasing order. Values between steps have the error of the method, and are
        corrected.
    events : callable or list of callables, optional
        Functions ``event(t, p, v) -> float`` whose zeros are located, to the rounding of t, wherever one changes its sign from
        the beginning of a step to its end. An attribute `direction` of 1 or -1 takes only those from below or from above;
        `terminal`, True or a number, ends the run when the event has happened once or that often. What is zero at the start
        is no event.
    formulation : str
        One of `formulations()`: which equations of motion are solved.
    integrator : str
        One of `integrators()`.
    stabilization : None, "projection", "baumgarte", Projection or Baumgarte
        How constraint violations are kept down.
    energy : None, True or EnergyCorrection
        Whether energy errors are taken out of the velocities, (29).
    save_every : int
        Steps between saved rows; start and end are always saved.
    progress : bool or callable
        True: a progress bar (needs tqdm). A callable is handed the part done, 0 ... 1, some thirty times a second.
    on_singular : {"stop", "continue"}
        What to do at a bifurcation, at a step's end or within one, where constraints that are independent elsewhere are not, and
        do not determine the motion: stop, or continue on the branch of least acceleration. In motion that is the one which
        the velocity is on, and mechanisms that come within 1e-7 of their size of a bifurcation, or nearly straight within
        1e-4, are taken through it. If there is no such branch, "mixed" and "independent" stop, the others take the least
        acceleration. Constraints that are redundant wherever the system goes need no choice.
    on_failure : {"raise", "return"}
        Whether a run that fails or is interrupted raises an error that carries the partial solution as `.solution`,
        or returns that solution, whose `success` is then False.

    Returns
    -------
    Solution

    Raises
    ------
    ZerodriftError
        Or one of its subclasses, where the start is inconsistent, a correction or an implicit step fails, the motion diverges.
    Interrupted
        On Ctrl-C.
    ValueError, TypeError
        For a wrong argument.

    Warns
    -----
    AccuracyWarning
        Where the energy balance is off by more than 0.5 % of the largest kinetic energy, or was before a single correction by
        more than 2 %: what was computed satisfies the constraints, but is not the motion. It takes a system with a potential.
    StabilityWarning
        Where steps were longer than the integrator is stable for, or stability held chosen steps down.
    CorrectionWarning
        Where energy corrections were left out.

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
    core, span = core_of(system), _check.span(t_span)
    control = {"rtol": rtol, "atol": atol, "first_step": first_step, "max_step": max_step}
    settings.on_singular_row(on_singular)
    chosen = {**_steps(span, step, integrator, control), **_chosen(system, formulation, integrator, stabilization, energy),
              **_saved(span, save_every, t_eval), "on_singular": on_singular}
    _check.choice("on_failure", on_failure, ("raise", "return"))
    watched = _events.events(events)
    p0, v0 = system._start(p0, v0)
    watcher = _gateway.Watcher(core, watched) if watched is not None else None
    options, rows = settings.core_settings(span, chosen), _rows(span, chosen)
    with Keyboard(*_gateway.CALLBACK_CODE, _show.__code__) as keyboard:
        run = _gateway.Run(core, options, p0, v0, watcher)
        record = _gateway.Record(core, rows)
        outcome = _drive(run, record, progress, keyboard)
        solution = _solution(system, span, chosen, run, record, watcher, outcome)
    return _finished(solution, run, outcome, on_failure, keyboard)


def _steps(span, step, integrator, control) -> dict[str, Any]:
    """How steps are made, checked."""
    settings.integrator_row(integrator)
    latest = max(map(abs, span))
    smallest = 16 * np.finfo(float).eps * latest
    if step is None:
        return {"step": None, **_control(integrator, control, smallest)}
    for name, value in control.items():
        if value is not None:
            raise ValueError(f"{name} is for steps that are chosen by their error: with it, leave out step")
    step = _check.number("step", step, above=0)
    if step < smallest:
        raise ValueError(f"step must be at least {smallest:.3g} for times up to {latest:g}, not {step:g}")
    return {"step": step}


def _control(integrator, control, smallest) -> dict[str, Any]:
    able = [name for name, card in settings.integrators().items() if card.error_order]
    if integrator not in able:
        raise ValueError(f"step is needed: {integrator!r} takes steps of fixed size; "
                         f"{', '.join(map(repr, able))} can choose theirs")
    values = DEFAULT_CONTROL | {name: value for name, value in control.items() if value is not None}
    least = {"rtol": FINEST_RTOL, "atol": 0.0, "first_step": smallest, "max_step": smallest}
    checked = {name: None if value is None else _check.number(name, value, least=least[name]) for name, value in values.items()}
    if checked["atol"] == 0:
        raise ValueError("atol must be greater than 0: parts of the state pass through zero")
    return checked


def _saved(span, save_every, t_eval) -> dict[str, Any]:
    """What is saved, checked."""
    save_every = _check.count("save_every", save_every)
    if t_eval is None:
        return {"save_every": save_every}
    if save_every != 1:
        raise ValueError("save_every counts steps, and t_eval names times: give one of them")
    times = _check.vector("t_eval", t_eval, np.size(t_eval))
    if not times.size or (np.diff(times) <= 0).any() or times[0] < span[0] or times[-1] > span[1]:
        raise ValueError(f"t_eval must increase from at least {span[0]:g} to at most {span[1]:g}, not {t_eval!r}")
    times.flags.writeable = False
    return {"save_every": 1, "t_eval": times}


def _chosen(system, formulation, integrator, stabilization, energy) -> dict[str, Any]:
    """Equations, method and corrections, checked."""
    settings.formulation_row(formulation)
    energy = settings.energy(energy)
    if energy and not system.has_energy:
        raise ValueError(f"energy correction needs a potential energy, and {system.name} declares none")
    return {"formulation": formulation, "integrator": integrator, "stabilization": settings.stabilization(stabilization),
            "energy": energy}


class _Outcome(NamedTuple):
    status: int
    seconds: float
    error: BaseException | None     # what stopped it that is not the core's: memory, the keyboard, the callable for progress


def _drive(run: _gateway.Run, record: _gateway.Record, progress: Any, keyboard: Keyboard) -> _Outcome:
    """Run slice by slice to the end."""
    show, close = progress_of(progress)
    start, status, error = time.perf_counter(), _gateway.PAUSED, None
    try:
        while status in (_gateway.PAUSED, _gateway.FULL):
            if keyboard.pressed:
                raise KeyboardInterrupt
            if status == _gateway.FULL:
                record.grow()
            status = run.advance(record, SLICE)
            _show(show, run.progress)
    except BaseException as caught:
        status, error = _gateway.INTERRUPTED, caught
    finally:
        close()
    if status == _gateway.CALLBACK and isinstance(run.error(status), KeyboardInterrupt):
        status, error = _gateway.INTERRUPTED, run.error(status)
    return _Outcome(status, time.perf_counter() - start, error)


def _show(show: Callable[[float], None], part: float) -> None:
    """What may be a user's, and then may be broken into."""
    show(part)


def _message(run: _gateway.Run, outcome: _Outcome) -> str:
    match outcome.status:
        case _gateway.DONE:
            return "done"
        case _gateway.INTERRUPTED if not isinstance(outcome.error, KeyboardInterrupt):
            return f"stopped by {outcome.error!r}"
        case _gateway.INTERRUPTED:
            return "interrupted from the keyboard"
        case _gateway.CALLBACK:
            return f"{run.message}: {run.error(outcome.status)!r}"
        case _:
            return run.message


def _solution(system, span, chosen, run, record, watcher, outcome) -> Solution:
    arrays = record.take()
    t_events, p_events, v_events = _where(watcher)
    return Solution(
        t=arrays["t"], p=arrays["p"], v=arrays["v"], multipliers=arrays["multipliers"],
        position_violation=arrays["position_violation"], velocity_violation=arrays["velocity_violation"],
        kinetic_energy=arrays["kinetic"], potential_energy=arrays.get("potential"), energy_input=arrays.get("input"),
        energy_violation=arrays.get("energy_violation"), iterations=arrays["iterations"],
        energy_skipped=arrays["energy_skipped"], position_size=run.sizes,
        stats=run.statistics | {"redundant": run.redundant, "seconds": outcome.seconds}, status=outcome.status,
        success=outcome.status in (_gateway.DONE, _gateway.EVENT), message=_message(run, outcome), settings=chosen,
        system=system, t_span=span, t_events=t_events, p_events=p_events, v_events=v_events)


def _finished(solution: Solution, run, outcome, on_failure, keyboard) -> Solution:
    """The solution, or the error that carries it."""
    heard = isinstance(outcome.error, KeyboardInterrupt)
    if keyboard.pressed and not heard:      # after the last look, or as something else failed
        raise Interrupted(f"interrupted from the keyboard, and: {solution.message}", solution) from outcome.error
    if outcome.error is not None and not heard:
        raise _carrying(outcome.error, solution)
    if on_failure == "raise" and not solution.success:
        _raise(run, solution)
    _warn(solution)
    return solution


def _warn(solution: Solution) -> None:
    """Of what was off but stopped nothing."""
    for category, sentence in doubts(solution):
        warnings.warn(sentence, category, stacklevel=4)


@contextlib.contextmanager
def unwarned() -> Iterator[None]:
    """For those who measure what `simulate` warns of, or show it."""
    with warnings.catch_warnings():
        for category in (AccuracyWarning, CorrectionWarning, StabilityWarning):
            warnings.simplefilter("ignore", category)
        yield


def doubts(solution: Solution) -> Iterator[tuple[type[Warning], str]]:
    """What was off in a run but did not stop it: warnings and their sentences."""
    stats, integrator = solution.stats, solution.settings["integrator"]
    steps = stats["steps"]
    if skipped := stats["energy_skipped"]:
        yield CorrectionWarning, (f"{skipped} of {steps} energy corrections were left out: near a turning point the kinetic "
                                  "energy is too small for them; sol.energy_skipped says where")
    if not solution.success:
        return
    if too_long := stats["too_long"]:
        stable = settings.integrators()[integrator].stability
        what = f"is stable for ({stable:g})" if stable else "resolves: what moves so fast is stable, but wrong"
        yield StabilityWarning, (f"{too_long} of {steps} steps, with an omega h of up to {stats['omega_h']:.3g}, were longer "
                                 f"than {integrator!r} {what}; take shorter ones{', or an implicit method' if stable else ''}")
    if stats["stiff"]:
        yield StabilityWarning, (f"the problem is stiff for {integrator!r}: stability, not the error asked for, held down many "
                                 f"of its {steps} steps; an implicit method takes longer ones")
    off, corrected = _numerical_energy(solution)
    if off > ENERGY_ERROR:
        yield AccuracyWarning, f"the energy balance is off by {off:.2g} of the largest kinetic energy: {TOO_COARSE}"
    if corrected > ENERGY_CORRECTION:
        yield AccuracyWarning, f"energy corrections were up to {corrected:.2g} of the largest kinetic energy: {TOO_COARSE}"


def _numerical_energy(solution: Solution) -> tuple[float, float]:
    """The largest error of the energy balance, and the largest correction of it, of the largest kinetic energy; 0 if rounding."""
    violation = solution.energy_violation
    if violation is None or not len(violation):
        return 0.0, 0.0
    errors = max(violation.max(), -violation.min()), solution.stats["energy_corrected"]
    kinetic = max(solution.kinetic_energy.max(), solution.stats["largest_kinetic"])     # the rows may all be at turning points
    if max(errors) <= ENERGY_ERROR * kinetic:
        return 0.0, 0.0
    if not np.isfinite(kinetic + errors[0]) or not kinetic:
        return np.inf, 0.0
    rounding = ENERGY_ROUNDING * (kinetic + np.abs(solution.potential_energy).max())
    return tuple(float(error / kinetic) if error > rounding else 0.0 for error in errors)


def _where(watcher: _gateway.Watcher | None) -> tuple[tuple[np.ndarray, ...] | None, ...]:
    """The t, p and v of all events, one array for each event."""
    if watcher is None:
        return None, None, None
    arrays = [watcher.arrays(event) for event in range(len(watcher.events))]
    return tuple(zip(*arrays, strict=True)) or ((), (), ())


def _raise(run: _gateway.Run, solution: Solution) -> None:
    if solution.status == _gateway.INTERRUPTED:
        raise Interrupted(solution.message, solution) from None
    raise _carrying(run.error(solution.status), solution, run.message if solution.status == _gateway.CALLBACK else None)


def _carrying(error: BaseException, solution: Solution, note: str | None = None) -> BaseException:
    """The error with the solution, unless it is of a kind that cannot be changed."""
    with contextlib.suppress(Exception):
        error.solution = solution
        if note:
            error.add_note(note)
    return error


def _rows(span: tuple[float, float], chosen: dict[str, Any]) -> int:
    """Rows of the record, with the start; where steps are chosen, as many as a first block has."""
    if "t_eval" in chosen:
        return len(chosen["t_eval"]) + 1    # an event may end it in between
    if chosen["step"] is None:
        return FIRST_BLOCK
    steps = _gateway.count_steps(*span, chosen["step"])
    return steps // chosen["save_every"] + 1 + (steps % chosen["save_every"] != 0)


def progress_of(progress: Any) -> tuple[Callable[[float], None], Callable[[], None]]:
    """How to show progress, and how to end that."""
    if progress is False or progress is None:
        return (lambda part: None), (lambda: None)
    if callable(progress):
        return progress, (lambda: None)
    if progress is not True:
        raise TypeError(f"progress must be True, False or a callable, not {progress!r}")
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise ImportError("progress=True shows a bar with tqdm, which is not installed: pip install tqdm") from None
    bar = tqdm(total=1.0, bar_format="{percentage:3.0f}%|{bar}| {elapsed}<{remaining}")

    def show(part: float) -> None:
        bar.n = part
        bar.refresh()

    return show, bar.close
