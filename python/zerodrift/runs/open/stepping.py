"""Steps of an open run: to a number of them or to a time, with the calls of controllers that are due."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from ..._private import checks, gateway
from ..._private.types import ArrayLike
from ...errors import InUse, WrongValue
from ..arguments.inputs import Drives, History, Jump
from ..samples import recording
from ..samples.solution import Solution
from .beginning import Prepared
from .control import Sampling, called
from .ending import Outcome, failure_of, solution_of, with_solution
from .present import Present

AT_ONE_INSTANT = 1e-9   # of the time that has passed: an event acts at most twice
SLICE = 0.03        # seconds that the core runs between two checks of keyboard and progress


class Stepping(Present):
    """An open run that makes steps."""

    def _begin(self, ready: Prepared, of: Any) -> None:
        """Create the core's run at the start of `ready`, without a record."""
        self._prepare(ready)
        self._controllers, self._is_controlled = of, False
        self._sampling = Sampling(of, ready.span[0], ready.settings["step"]) if of else None
        self._record: Any = None
        self._history: History | None = None
        self._c_record, self._seconds = gateway.NO_RECORD, 0.0
        self._drives = Drives(ready.declared) if ready.declared and ready.declared.follows.jumps else None
        self._actions = {i: each for i, each in enumerate(ready.events or ()) if each.then is not None}
        self._open(ready.created(gateway.OpenRun))

    def _open(self, core: gateway.OpenRun) -> None:
        super()._open(core)
        self._acted: dict[int, list[float]] = {i: [] for i in self._actions}     # times
        self.jump: Jump | Any = None
        self._jumps = core.jumps

    def step(self, steps: int = 1) -> None:
        """Make steps: fixed ones, or as many as the integrator chooses.

        Parameters
        ----------
        steps : int
            Their number, at least 0. A terminal event stops earlier, see `event`; the next call goes on from there, and the
            event is terminal again.

        Raises
        ------
        ZerodriftError
            As `simulate` does; the run is then at the start of the step that failed.

        Examples
        --------
        >>> import zerodrift as zd
        >>> run = zd.Run(zd.systems.oscillator(), step=0.01)
        >>> run.step(3)
        >>> run.t, run.steps
        (0.03, 3)
        """
        if self._sampling is not None:
            self._require_idle()
            self._sample(self._sampling, self.steps + checks.count("steps", steps, least=0), math.inf)
        elif self._record is not None or self._drives is not None or self._actions:
            self._go(checks.count("steps", steps, least=0), math.inf)
        elif status := gateway.STEP(self._c, steps, self._c_record):
            self._attend(status)

    def advance_to(self, t: float) -> None:
        """Advance to a time.

        With fixed steps, a time within rounding of a whole number of steps is reached by these alone. Otherwise the last step is
        shortened, and further steps are counted from there. Adaptive steps end at the time.

        Parameters
        ----------
        t : float
            In s, not before the present time.

        Raises
        ------
        ValueError
            If the time has passed.
        ZerodriftError
            As `step`.
        """
        t = checks.number("t", t, least=self.t)
        if self._sampling is not None:
            self._require_idle()
            self._sample(self._sampling, gateway.MAX_STEPS, t)
        else:
            self._go(gateway.MAX_STEPS, t)

    def _require_idle(self) -> None:
        """Raise an error if a controller of this run is being called."""
        if self._is_controlled:
            raise InUse("a controller must not step, advance, reset, restore or close the run that it is given: it sets inputs; "
                        "run.copy() is another run, which it may move")

    def _sample(self, sampling: Sampling, last: int, t: float) -> None:
        """Advance to a number of steps or to a time, with calls of the controllers that are due."""
        step = self.settings["step"]
        rounding = 0.0 if step is None else 1e-9 * step
        while self.steps < last and t - self.t > rounding:
            sampling.call(self)
            steps, instant = sampling.next(self)
            made = self.steps
            self._go(last - made if steps is None else min(steps, last - made), min(t, instant))
            if self.event is not None or self.steps == made:    # none is made to a time within rounding
                return

    def _go(self, steps: int, t: float) -> None:
        """Advance by a number of steps or to a time, whichever comes first."""
        self._require_idle()
        core, begin, last, goes_on = self._core, time.perf_counter(), self.steps + steps, True
        while goes_on:
            if self._history is not None:
                self._history.note(core.t, self.inputs)
            status = core.set_goal(last - core.steps, t) or core.advance(self._record, SLICE)
            self._note_jump()
            self._attend(status)
            goes_on = self._acts() and core.steps < last and core.t < t
        self._seconds += time.perf_counter() - begin

    def _acts(self) -> bool:
        """Act at the events of the present instant; false if there are none, or one of them ends the run."""
        if self.event not in self._actions:
            return False
        t, near, goes_on = self.t, AT_ONE_INSTANT * (self.t - self._ready.span[0]), True
        for i, event in self._actions.items():
            acted = self._acted[i]
            if self._core.found(i) == len(acted):
                continue
            acted.append(t)
            if len(acted) > 2 and max(np.diff(acted[-3:])) < near:
                raise WrongValue(f"{event.name} must not act again and again at one instant, t = {t:.9g}, as where a ball "
                                 "bounces ever less: what then stays needs a constraint", "out-of-range")
            goes_on = goes_on and len(acted) != event.terminal
            called(event.act, self)
        return goes_on

    def set_state(self, p: ArrayLike | None = None, v: ArrayLike | None = None) -> None:
        """Move to another state at the present time, as after an impact.

        Parameters
        ----------
        p, v : array_like (nq,), (nv,), optional
            Coordinates and velocities; left out: the present ones. They must satisfy the constraints.

        Raises
        ------
        InconsistentStart
            If they do not; the run stays as it was.

        Notes
        -----
        The energy balance counts from the new state on; `energy_input` has nothing of the change. Events that it passes do not
        occur.

        Examples
        --------
        >>> import zerodrift as zd
        >>> run = zd.Run(zd.systems.oscillator(), step=0.01)
        >>> run.set_state(v=[2.0])
        >>> run.v.tolist()
        [2.0]
        """
        core, before = self._core, (self.p, self.v)
        given = [checks.vector(name, old if new is None else new, old.size)
                 for name, new, old in zip("pv", (p, v), before, strict=True)]
        if status := core.set_state(*given):
            error = core.error(status)
            core.set_state(*before)
            raise error

    def _note_jump(self) -> None:
        """Note the jump of speeds in the first step of the last advance, if there was one."""
        core = self._core
        if self._drives is None or core.jumps == self._jumps:
            return
        self._jumps, self.jump = core.jumps, self._drives.jump(*core.jump())
        if self._history is not None:
            self._history.jumps.append(self.jump)

    def _attend(self, status: int) -> None:
        """Go on after a pause or with more memory; raise the error of a failure."""
        core, record = self._core, self._record
        while status in (gateway.PAUSED, gateway.FULL):
            if status == gateway.FULL:
                recording.check_memory(record.next_rows, record.row_bytes, stacklevel=4)
                record.grow()
                self._c_record = record.c
            status = core.advance(record, SLICE)
        if record is not None:
            record.keep()
        if status not in (gateway.DONE, gateway.EVENT):
            self._fail(status)

    def _fail(self, status: int) -> None:
        """Raise the error of a failed step; the core has returned to its start."""
        core = self._core
        if status == gateway.BAD_ARGUMENT:
            raise WrongValue("steps must be at least 0", "out-of-range")
        error, note = core.error(status), None
        if status != gateway.BAD_INPUT:
            error, note = failure_of(self._ready.of, core, status, self.settings, self._ready.span)
        core.forget_errors()
        if self._record is not None and self._ready.path is None and isinstance(error, Exception):
            with_solution(error, self._solution(Outcome(status, self._seconds, None)))
        if note:
            checks.tell(error, note)
        raise error

    def _solution(self, outcome: Outcome) -> Solution:
        record = self._record if self._ready.path else self._record.snapshot()
        span = self._ready.span[0], self.t
        return solution_of(self._ready, self._core, record, self._core.results(), outcome, span, self._history)

    def _control(self) -> None:
        """Call the controllers that are due, and aim at the next instant of one."""
        core, sampling = self._core, self._sampling
        if sampling is not None:
            sampling.call(self)
            steps, instant = sampling.next(self)
            core.set_goal(gateway.MAX_STEPS if steps is None else steps, instant)
        elif self.event is not None:
            core.set_goal(gateway.MAX_STEPS, math.inf)
        if self._history is not None:
            self._history.note(core.t, self.inputs)

    def _goes_on(self, status: int) -> bool:
        """True if a run with an end has reached an instant of a controller, or an event after which it goes on, not its end."""
        ready = self._ready
        if status != gateway.DONE:
            return status == gateway.EVENT and self._acts()
        requested = ready.settings.get("t_eval") if ready.events is None else None
        end = ready.span[1] if requested is None else requested[-1]
        return self._sampling is not None and self._core.t < end and self.event is None
