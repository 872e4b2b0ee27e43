"""`simulate`: the motion of a system over time."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Sequence
from typing import Any, Literal, Unpack

from .._private import checks, gateway
from .._private.types import ArrayLike, Events, Inputs, Measures, PathLike, SimulateSettings, StateLike, SystemLike
from ..errors import CostWarning
from .arguments.inputs import Speeds
from .arguments.settings import known, with_names
from .open.beginning import prepared
from .open.control import Every, called, controls
from .open.ending import Outcome, finish_file, finished, solution_of
from .open.keyboard import Keyboard, progress_of
from .open.run import Run
from .open.stepping import SLICE
from .samples import recording
from .samples.solution import Solution
from .samples.summary import calls_in_words

LONG_CALLS = 3.0              # s in user functions that are called, above which a run warns once


@with_names(known)
def _read(step: Any, t_eval: Any, *, inputs: Inputs | None = None, hold: bool = False, ramp: float | None = None,
          control: Every | Sequence[Every] | None = None, save_to: PathLike | None = None,
          progress: bool | Callable[[float], object] = False, on_failure: Literal["raise", "return"] = "raise",
          **settings: Any) -> tuple[Any, ...]:
    """Settings of `simulate`: those of steps and methods, and its own, of which controllers and the last are checked."""
    checks.choice("on_failure", on_failure, ("raise", "return"))
    given = known("simulate", step, t_eval, **settings)
    return given, inputs, Speeds(hold, ramp), controls(control), save_to, progress, on_failure


@with_names(_read)
def simulate(
    system: SystemLike,
    t_span: float | tuple[float, float],
    p0: StateLike | None = None, v0: ArrayLike | None = None, *,
    step: float | None = None, t_eval: ArrayLike | None = None,
    events: Events | None = None,
    outputs: Measures | None = None,
    **settings: Unpack[SimulateSettings],
) -> Solution:
    """Simulate the motion of a constrained multibody system.

    Parameters
    ----------
    system : system
        A `Mechanism`, one of `zerodrift.systems`, a `zerodrift.System`, or a result of `zerodrift.symbolic`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Initial coordinates and velocities; by default those of the system. They must satisfy the constraints, see `assemble`.
        p0 may also be a result of `equilibrium`.
    step : float, optional
        Size of fixed steps in s. If the span is not a whole number of steps, the last one is shorter. Without it, steps are
        adaptive: the integrator chooses them by its error estimate with `rtol` and `atol`, and ends them where laws jump:
        at known times, and where a comparison in a law changes.
    t_eval : array_like (k,), optional
        Output times in s, increasing. Left out: the times of the steps; adaptive steps are long, and maxima of forces may lie
        between them. With adaptive steps, values at output times are from the method's dense output where it has one, otherwise
        from a shorter step. All values satisfy the constraints.
    events : callable, Event or measure, or a list of these, optional
        Functions ``event(t, p, v) -> float``. If one changes sign within a step, its zero is located to the rounding of t, and
        the state there is reported in `Solution.t_events`, `p_events` and `v_events`; it satisfies the constraints. At a
        discontinuity the state after the jump is reported. Zeros at the initial time are ignored. The attribute `direction` =
        1 or -1 selects zeros with increasing or decreasing values; `terminal` = True or a count ends the run at the first or
        at that occurrence, by a step that ends at the zero.
    outputs : list of measures or names, optional
        Measures to record with every sample, such as ``["C.force", crank.angle]``, from the accelerations and multipliers of
        the run. ``sol[name]`` then reads the record, and `Solution.save` includes it. Measures that are not recorded are
        evaluated by ``sol[name]`` at access; recording is cheaper if many are used.
    **settings
        Any of the following.

    Other Parameters
    ----------------
    rtol, atol : float, optional
        Adaptive steps keep the RMS local error of the state y below ``atol + rtol * abs(y)``; by default 1e-6 and 1e-9. `rtol`
        must be at most 1, `atol` has the units of y. The error of the motion accumulates over the steps and is larger than these;
        `zerodrift.tune` finds settings for a given error of the motion.
    first_step, max_step : float, optional
        Adaptive steps: size of the first step, and largest size, in s. An action shorter than a step may be missed, such as one
        of a function that Python calls, at whose jumps steps do not end; set `max_step` to its duration or less.
    max_move : float, optional
        Adaptive steps: largest change of any coordinate in a step, in m or rad; with formulation "independent", of the
        coordinates that it integrates. A force that acts in a narrow region, such as a thin wall, may be missed without
        notice; set `max_move` to a third of its width or less.
    max_steps : int or None
        Adaptive steps: number of steps after which the run fails, with a message that names the times at which most were taken.
        It fails after only 50 steps without progress, and where a law jumps back as soon as it has jumped, as friction by the
        sign of a speed does at rest: `StepFailed` with the code "step-collapse". None: unlimited. Fixed steps are not limited.
    formulation : str or settings, optional
        Equations of motion to solve: a name in `formulations()`, or ``formulations()[name].settings(...)``. By default "schur";
        "augmented" for a mechanism with bodies without mass or inertia whose mass matrix is singular at the start.
    integrator : str or settings
        A name in `integrators()`, or ``integrators()[name].settings(...)``. By default "rk4" with `step`, and "dop853" with
        adaptive steps.
    stabilization : None, "projection", "baumgarte", Projection or Baumgarte
        Method that removes (projection) or damps (Baumgarte) violations of the constraints; None for none.
    energy : None, True or EnergyCorrection
        True or settings: correct the velocities so that the energy balance holds, (29).
    correction : str or settings, or several of them
        Further corrections: names in `corrections()`, or ``corrections()[name].settings(...)``.
    save_every : int
        Number of steps from one sample to the next, at least 1; start and end are always saved.
    progress : bool or callable
        True: show a progress bar (needs tqdm). A callable receives the completed fraction, 0 ... 1, about 30 times a second.
    save_to : str or Path, optional
        File to which samples are written during the run, for records larger than memory: a structured array of NumPy with
        the suffix ``.npy``, which is added if it is missing, and its description with the suffix ``.json``. The arrays of
        the solution, and those of `load`, are then mapped from the file. A killed run leaves the samples written so far. An
        older file of the same name is replaced at the start, unless another run is writing it.
    on_singular : {"stop", "continue"}
        Behaviour when the motion reaches a bifurcation, at the end of a step or within it. A bifurcation is a position in
        which constraints that are independent elsewhere become dependent and no longer determine the motion, as in a
        parallelogram whose links lie on one line. "stop" ends the run with the error `Bifurcation`. "continue" follows the
        branch of least acceleration; while the mechanism moves, this is the branch along its velocity. A mechanism that comes
        within 1e-7 of its size of a bifurcation, or within 1e-4 if it moves nearly straight, passes it in the same way. If no
        branch lies along the velocity, the formulations "mixed" and "independent" stop, and the others take the least
        acceleration. Constraints that are redundant in every position are not a bifurcation.

        In systems with a declared sparse structure and more than 40 constraints or 300 velocities, bifurcations during the
        motion are not detected, and "continue" acts as "stop": the run passes through with a loss of digits. A start at a
        bifurcation raises the error. With a definite mass matrix, a warning and ``repr`` of the solution report the smallest
        relative pivot of a constraint.
    closed_form : None or False
        None: evaluate steps in closed form where the system has closed-form functions: constraints are eliminated in generated
        code, which gives the same motion to rounding in a fraction of the time. This requires an explicit integrator and
        constraints that are not redundant; with formulation "independent" also ``pdot = v`` and constraints that are all
        holonomic or all nonholonomic; with "mixed" and "independent" a system without its own complement `D`. A step whose
        elimination is inaccurate is repeated with the matrices of the formulation; so is, with "mixed" and "independent", a
        step after which the set of independent velocities changes, or has no generated code (at most four sets have it).
        `repr` of the solution gives the number of steps by matrices, or the reason if all were. False: matrices in all steps.
    vector : {"baseline", "avx2", "avx512"}, optional
        Vector unit for closed-form functions. By default the value of the environment variable ZERODRIFT_VECTOR, else the
        widest unit of the processor. With "baseline", results are bitwise the same on all processors; "avx2" and "avx512"
        agree bitwise with each other, round less often, and are faster.
    on_failure : {"raise", "return"}
        For a run that fails or is interrupted: "raise" raises an error with the partial solution as its attribute `solution`;
        "return" returns that solution, with `success` False.
    inputs : sequence of str or measures, or dict, optional
        Numbers that `control` sets, as in `Run`. The solution has their values over time by name.
    hold, ramp : bool, and float or None
        As in `Run`: True makes the jump of a speed an impulse; time in s over which a speed is followed in adaptive steps. The
        solution has the impulses since the previous sample, ``sol["drive.impulse"]`` in N m s or N s, and their work,
        ``sol["drive.impulse_work"]`` in J.
    control : Every, or list of these, optional
        Controllers, see `every`: each is called with the run at exact multiples of its period, and sets inputs.

    Returns
    -------
    Solution

    Raises
    ------
    ZerodriftError
        One of its subclasses: if the start is inconsistent, a correction or an implicit step fails, the motion diverges, the
        mass matrix is not symmetric (`SingularSystem`), or a given Jacobian is not that of the constraints
        (`InconsistentSystem`).
    Interrupted
        On Ctrl-C.
    ValueError, TypeError
        For a wrong argument.
    MemoryError
        If the record would exceed the free memory; the message gives its size and ways to reduce it.
    OSError
        If samples cannot be written to the file.
    InUse
        If another run is writing to that file.

    Warns
    -----
    CostWarning
        Before the run: if the record takes more than half of the free memory, or if a mechanism with many joint coordinates
        would take some ten seconds, and less than a tenth of that in absolute coordinates. During the run: if functions that
        are called because they cannot be recorded have taken 3 s.
    DrawingWarning
        Before the run: if a mechanism starts from its drawing, and a joint is drawn open by more than a hundredth of its size.
        Not for a sketch, where a dimension of a loop with that joint is given, such as ``length=`` of a link or a radius, or a
        coordinate of the loop is held, wished or driven. Also if the joints do not close at the drawn value of a driven
        coordinate.
    AccuracyWarning
        If the error of the energy balance exceeds 0.5 % of the largest kinetic energy, or a single correction removed more
        than 2 % of it: the result satisfies the constraints, but is not the motion. Only for systems with a potential.
        Also if fixed steps do not resolve the motion of one component, however small its inertia; the component is named.
    StabilityWarning
        If fixed steps exceeded the stability limit of the integrator, or if stability limited the adaptive steps.
    CorrectionWarning
        If energy corrections were skipped.
    LockedWarning
        If joints in space lock all bodies, as hinges with skew axes do.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> sol = zd.simulate(bar, 8.0, step=0.05, formulation="augmented", stabilization=zd.Projection(), energy=True)
    >>> sol.p.shape
    (161, 3)
    >>> bool(abs(sol.position_violation).max() < 1e-12)
    True

    The run ends when the crank has reached the horizontal twice; times at which the coupler is at rest are recorded, too:

    >>> import numpy as np
    >>> round = zd.Event(lambda p: np.sin(p[0]), direction=1, terminal=2)
    >>> sol = zd.simulate(bar, 8.0, step=0.01, events=[round, lambda t, p, v: v[1]])
    >>> sol.message
    'at t = 2.16071475 (step 217 of 800): ended by event 0'
    >>> sol.t_events[1].round(4)
    array([0.1287, 0.6498, 1.4803, 2.0013])
    """
    given, inputs, speeds, of, save_to, progress, on_failure = _read(step, t_eval, **settings)
    ready = prepared(system, checks.span(t_span), p0, v0, events, outputs, save_to, given, inputs=inputs, speeds=speeds)
    with recording.locked(ready.path), Keyboard(*gateway.CALLBACK_CODE, _show.__code__, called.__code__) as keyboard:
        acts = any(each.then is not None for each in ready.events or ())
        controlled = Run.of(ready, of) if of or inputs or acts else None
        run = controlled._core if controlled else ready.created()
        record = ready.record(run)
        outcome = _drive(run, record, progress, keyboard, controlled)
        results = run.results()
        solution = solution_of(ready, run, record, results, outcome, history=controlled._history if controlled else None)
        if ready.path:
            finish_file(record, solution, outcome)
    return finished(solution, run, results, outcome, on_failure, keyboard)


def _drive(run: gateway.Run, record: gateway.Record, progress: Any, keyboard: Keyboard, controlled: Run | None) -> Outcome:
    """Run the core in slices of time, and to the instants of controllers, until it ends, fails or is interrupted."""
    show, close = progress_of(progress)
    start, status, error, limit = time.perf_counter(), gateway.PAUSED, None, LONG_CALLS
    try:
        while status in (gateway.PAUSED, gateway.FULL):
            if keyboard.pressed:
                raise KeyboardInterrupt
            if controlled and status == gateway.PAUSED:
                controlled._control()
            if status == gateway.FULL:
                recording.check_memory(record.next_rows, record.row_bytes, stacklevel=4)
                record.grow()
            status = run.advance(record, SLICE)
            record.keep()
            if controlled:
                controlled._note_jump()
            if controlled and controlled._goes_on(status):
                status = gateway.PAUSED
            if sum(run.calls.values()) > limit:
                limit = math.inf
                warnings.warn(f"Python is called for {calls_in_words(run.calls)}, about a hundred times as slow as a function "
                              "that can be recorded: print(mechanism) says why it cannot", CostWarning, stacklevel=3)
            _show(show, run.progress)
    except BaseException as caught:
        status, error = gateway.INTERRUPTED, caught
    finally:
        close()
    if status == gateway.CALLBACK and not isinstance(run.error(status), Exception):     # Ctrl-C, SystemExit and the like
        status, error = gateway.INTERRUPTED, run.error(status)
    return Outcome(status, time.perf_counter() - start, error)


def _show(show: Callable[[float], None], part: float) -> None:
    """Show the progress. Ctrl-C may interrupt the user's callable; `Keyboard` recognizes it by the code of this function."""
    try:
        show(part)
    except BaseException as error:
        checks.tell(error, f"in progress, called with {part:g}")
        raise
