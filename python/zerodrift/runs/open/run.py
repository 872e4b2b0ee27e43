"""`Run`: a run that stays open: it is stepped, read, and goes on."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Unpack

from ..._private import checks, gateway
from ..._private.types import ArrayLike, Events, Inputs, Measures, PathLike, Settings, StateLike, SystemLike
from ...errors import StateWarning, WrongState, WrongValue
from ..arguments.inputs import History, Speeds
from ..arguments.settings import known, with_names
from ..samples import recording
from ..samples.solution import Solution
from . import diagnosis
from .beginning import Prepared, nominal_span, prepared
from .control import Every, controls
from .ending import Outcome, finish_file
from .run_state import restored, saved, unpacked
from .stepping import Stepping


class Run(Stepping):
    """A run that stays open: advance it, read it, and go on.

    Parameters
    ----------
    system : system
        As in `simulate`.
    p0, v0 : array_like (nq,), (nv,), optional
        Start; by default that of the system.
    t0 : float
        Time of the start, in s.
    step : float, optional
        Size of fixed steps in s; left out: adaptive steps.
    inputs : sequence of str or measures, or dict, optional
        Numbers that are set between steps, by ``run[name] = value`` or ``run.inputs[:] = values``: torques, forces and speeds of
        motors, actuators and loads of a mechanism, such as "drive.torque"; declared symbols of `symbolic`; numbers and arrays
        among the parameters of a `System`, as "u", or entries of them, as "u[0]"; parameters of a `native` system, which are
        numbers. An array is set as a whole, ``run["u"] = [1.0, 2.0]``, or by entries. A dict has limits (lower, upper) for each,
        or None; no step is made with an input beyond them. Inputs begin with the values of the system. Forces are constant within
        a step, and their work is part of the energy balance. A speed changes linearly from its previous value: over one fixed
        step, or over the time `ramp` in adaptive steps.
    hold : bool
        True: speeds that are inputs are constant in a step, too, and jump at its start. A jump is an impulse: velocities are
        projected onto the constraints with the new speeds, orthogonally in the mass metric, (25b). Its work is part of the
        energy balance, and `jump` has both. A start whose velocities do not fit a speed jumps to it in the first step, too;
        without `hold`, it is an error that names the consistent value.
    ramp : float, optional
        Adaptive steps: time in s over which a speed changes linearly to its input, so that the motion does not depend on step
        sizes; one step ends with the ramp. If the input changes meanwhile, a new ramp begins at the present speed.
    control : Every, or list of these, optional
        Controllers, see `every`: each is called before the step that begins at one of its instants.
    record : bool
        True: every sample is kept in memory, for `solution`. A run without a record needs the same memory at any length.
    save_to : str or Path, optional
        File to which samples are written, as in `simulate`; includes `record`.
    **settings
        As in `simulate`: `rtol`, `atol`, `first_step`, `max_step`, `max_move`, `max_steps`, `events`, `formulation`,
        `integrator`, `stabilization`, `energy`, `correction`, `save_every`, `outputs`, `on_singular`, `closed_form`, `vector`.

    Attributes
    ----------
    system : system
    settings : dict
        Settings by name.
    inputs : ndarray (k,)
        Inputs in the order of their names, in N m, N, m/s or rad/s; writable. They hold from the next step on.
    jump : Jump or None
        With `hold`: the last jump of speeds; its time `t`, the dicts `impulses` (N m s, N s) and `works` (J) by the names of
        motors, and `work`, that of all motors (J). Samples have the state before it. A recorded solution has the sums since
        the previous sample, by ``sol["drive.impulse"]`` and ``sol["drive.impulse_work"]``.

    Raises
    ------
    ZerodriftError, ValueError, TypeError
        As `simulate`, for a wrong start or argument.

    See Also
    --------
    simulate : a run to a given end, with a record of all samples.
    ManyRuns : many runs of one system.

    Notes
    -----
    Successive advances give the bits of a single one: ``run.step(2); run.step(3)`` is ``run.step(5)``, and with fixed steps the
    k-th one ends at ``t0 + k * step``, whatever the calls.

    A step that fails raises the error that `simulate` raises, and leaves the run at the start of that step: it can be read and
    continued, for example after another input. The same holds for Ctrl-C, and for errors of events and controllers.

    Forces of a mechanism may read reactions and accelerations by name, see `Mechanism.motor`.

    Examples
    --------
    >>> import zerodrift as zd
    >>> run = zd.Run(zd.models.slider_crank(), step=0.001)
    >>> run.step(100)
    >>> run.advance_to(0.25)
    >>> round(run.t, 9), round(run["crank.angle"], 4)
    (0.25, 1.5548)

    A motor whose torque is set between steps:

    >>> m = zd.Mechanism("arm")
    >>> arm = m.link("arm", (0, 0), (1, 0), mass=3.0)
    >>> drive = m.motor("drive", m.revolute("pin", m.ground, arm.start), torque=0.0)
    >>> run = zd.Run(m, step=0.001, inputs=["drive.torque"])
    >>> run["drive.torque"] = 2.0
    >>> run.advance_to(0.5)
    >>> run["drive.torque"] = 0.0
    >>> run.advance_to(1.0)
    >>> round(run["pin.speed"], 6)
    1.0

    A motor whose speed jumps, for an arm with the moment of inertia 1 kg m^2:

    >>> m = zd.Mechanism("arm")
    >>> arm = m.link("arm", (0, 0), (1, 0), mass=3.0)
    >>> drive = m.motor("drive", m.revolute("pin", m.ground, arm.start), speed=2.0)
    >>> run = zd.Run(m, step=0.001, inputs=["drive.speed"], hold=True)
    >>> run["drive.speed"] = 5.0
    >>> run.step()
    >>> round(run.jump.impulses["drive"], 9), round(run.jump.work, 9)      # I dw, and I dw (w + dw / 2)
    (3.0, 10.5)
    """

    @with_names(known)
    def __init__(self, system: SystemLike, p0: StateLike | None = None, v0: ArrayLike | None = None, *, t0: float = 0.0,
                 step: float | None = None, inputs: Inputs | None = None, hold: bool = False, ramp: float | None = None,
                 control: Every | Sequence[Every] | None = None, record: bool = False, save_to: PathLike | None = None,
                 events: Events | None = None, outputs: Measures | None = None,
                 **settings: Unpack[Settings]) -> None:
        t0 = checks.number("t0", t0)
        ready = prepared(system, nominal_span(t0, step), p0, v0, events, outputs, save_to,
                         known("Run", step, None, **settings), inputs=inputs, speeds=Speeds(hold, ramp), is_open=True)
        self._begin(ready, controls(control))
        self._lock = recording.locked(ready.path)
        self._lock.__enter__()
        if checks.instance("record", record, bool, "True or False") or ready.path:
            self._begin_record()

    @classmethod
    def of(cls, ready: Prepared, controllers: Any) -> Run:
        """The run that controllers of `simulate` receive, which `simulate` advances and records."""
        run = object.__new__(cls)
        run._begin(ready, controllers)
        if ready.inputs:
            run._history = History(run.t, run.inputs, run._places)
        return run

    def _begin_record(self) -> None:
        ready = self._ready
        self._record = ready.record(self._core)
        self._c_record = self._record.c
        if ready.inputs:
            self._history = History(self.t, self.inputs, self._places)

    # ---- state ----

    def save(self) -> bytes:
        """The present state: everything that the further motion depends on.

        A run made with the same arguments continues from it with the same bits: here or in another process, with the same
        vector unit, in this version and others with the same layout of runs, whatever compiler built them (in closed form with
        other units than "baseline": to 1e-13). Controllers with the methods ``state()`` and ``restore(state)`` are included;
        others keep their state, and are named in a warning. Samples are not included.

        Returns
        -------
        bytes

        Warns
        -----
        StateWarning
            If a controller has no methods ``state()`` and ``restore(state)``.

        Examples
        --------
        >>> import zerodrift as zd
        >>> run = zd.Run(zd.systems.four_bar(), step=0.01)
        >>> run.step(10)
        >>> state = run.save()
        >>> run.step(5)
        >>> p = run.p
        >>> run.restore(state)
        >>> run.step(5)
        >>> bool((run.p == p).all())
        True
        """
        if others := [repr(each) for each in self._controllers if not _has_state(each.call)]:
            warnings.warn(f"a saved state has nothing of the control {', '.join(others)}: what it keeps between calls is "
                          "restored only if it has the methods state() and restore(state)", StateWarning, stacklevel=2)
        return self._saved()

    def _saved(self) -> bytes:
        return saved(self._ready, self._core, [each.state() for each in self._keeping()], self.system)

    def restore(self, state: bytes) -> None:
        """Go back, or on, to a saved state; a new record begins there, in memory or in its file.

        Parameters
        ----------
        state : bytes
            From `save` of this run, or of one made with the same arguments.

        Raises
        ------
        WrongState
            If it is damaged, or of another system, other settings or another version; the run stays as it was. Systems are
            compared by their names, parameters, geometry, tables, expressions and code of functions; functions in C are not.
        """
        self._require_idle()
        found, keeping = unpacked(state), self._keeping()
        if len(found.inputs) != len(self.inputs) or len(found.controllers) != len(keeping):
            raise WrongState("a state must be of a run with the same inputs and controllers")
        ready = self._ready.with_own()
        self._become(ready, restored(ready, found, self.system))
        for each, kept in zip(keeping, found.controllers, strict=True):
            each.restore(kept)

    def copy(self) -> Run:
        """Another run at the present state, which continues independently; controllers are shared.

        Returns
        -------
        Run
            Without a record.
        """
        twin = object.__new__(type(self))
        twin._begin(self._ready.with_own(), self._controllers)
        twin._lock = recording.locked(None)
        twin.restore(self._saved())
        return twin

    def reset(self, p0: ArrayLike | None = None, v0: ArrayLike | None = None) -> None:
        """Go back to the start at t0, with the first inputs; a new record begins, in memory or in its file.

        Parameters
        ----------
        p0, v0 : array_like (nq,), (nv,), optional
            Another start; left out: the one of this run.

        Raises
        ------
        InconsistentStart
            If the start violates the constraints.
        """
        self._require_idle()
        ready = self._ready.with_own()
        if p0 is not None or v0 is not None:
            p, v = self._ready.of._state_or_start(p0, v0, t=ready.span[0])
            ready = ready._replace(p0=p, v0=v)
        self._become(ready, ready.created(gateway.OpenRun))

    def _become(self, ready: Prepared, core: gateway.OpenRun) -> None:
        """Go on as another run of the core."""
        if ready.inputs:        # the array that the caller may hold stays the one that is read
            ready.inputs.adopt(self.inputs)
        self._ready = ready
        self._open(core)
        if self._sampling is not None:
            self._sampling.begin()
        if self._record is not None:
            if ready.path:
                self._record.close()
            self._begin_record()

    def _keeping(self) -> list[Any]:
        """Controllers with a state of their own."""
        return [each.call for each in self._controllers if _has_state(each.call)]

    # ---- record ----

    def solution(self) -> Solution:
        """The samples recorded so far, as `simulate` returns them.

        With `save_to`, the file is finished and closed, and further steps are not recorded.

        Returns
        -------
        Solution

        Raises
        ------
        ValueError
            If the run does not record.

        Warns
        -----
        AccuracyWarning, StabilityWarning, CorrectionWarning, LockedWarning
            As `simulate` does.

        Examples
        --------
        >>> import zerodrift as zd
        >>> run = zd.Run(zd.systems.four_bar(), step=0.05, record=True)
        >>> run.step(20)
        >>> run.solution().p.shape
        (21, 3)
        """
        if self._record is None:
            raise WrongValue("a solution needs samples: Run(..., record=True) keeps them, and save_to= writes them to a file",
                             "not-available")
        if self._ready.path:
            self._require_idle()
        outcome = Outcome(gateway.DONE if self.event is None else gateway.EVENT, self._seconds, None)
        solution = self._solution(outcome)
        if self._ready.path:
            finish_file(self._record, solution, outcome)
            self.close()
        diagnosis.warn(solution, stacklevel=2)
        return solution

    def close(self) -> None:
        """Stop recording, and close the file of `save_to`."""
        self._require_idle()
        self._record, self._c_record = None, gateway.NO_RECORD
        self._lock.__exit__(None, None, None)

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *exception: Any) -> None:
        self._require_idle()
        if self._record is not None and self._ready.path:
            finish_file(self._record, self._solution(Outcome(gateway.DONE, self._seconds, None)), None)
        self.close()


def _has_state(controller: Any) -> bool:
    """True if a state of the controller can be saved."""
    return hasattr(controller, "state") and hasattr(controller, "restore")
