"""Steps of an open run: to a number of them or to a time, with the calls of controllers that are due."""

from __future__ import annotations

import math
import time
from typing import Any

from ..._private import checks, gateway
from ..._private.types import ArrayLike
from ...errors import InUse, WrongValue
from ...systems.base import switches_of
from ..arguments.inputs import Drives, History, Jump
from ..samples import recording
from ..samples.solution import Solution
from .beginning import Prepared
from .control import Sampling, called
from .ending import Outcome, failure_of, solution_of, with_solution
from .present import Present

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
        self._open(ready.created(gateway.OpenRun))

    def _open(self, core: gateway.OpenRun) -> None:
        super()._open(core)
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
        elif self._record is not None or self._drives is not None or self._is_controlled:
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
        core, begin = self._core, time.perf_counter()
        if self._history is not None:
            self._history.note(core.t, self.inputs)
        self._attend(core.set_goal(steps, t) or core.advance(self._record, SLICE))
        self._seconds += time.perf_counter() - begin

    def _acts(self) -> bool:
        """Call the function of the event at which the core pauses; False: there is none."""
        acting = self._core.acting
        if acting >= 0:
            called(self._ready.events[acting].act, self)
        return acting >= 0

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
        The energy balance counts from the new state on; `energy_input` has nothing of the change, which `Solution.jumps` has.
        Events that it passes do not occur.

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
            core.note_jump("")
            raise error
        core.note_jump("set_state" if core.acting < 0 else self._ready.events[core.acting].name)

    def release(self, name: str) -> None:
        """Let a joint go that was made with `active`; what it held goes on from the present state.

        Parameters
        ----------
        name : str
            Name of the joint.

        Raises
        ------
        ValueError
            If there is no such joint.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("drop", gravity=(0, -9.81))
        >>> ball = m.particle("ball", 1.0, at=(0, 1))
        >>> hook = m.revolute("hook", m.ground, ball, active=True)
        >>> run = zd.Run(m, step=0.01)
        >>> run.step(10)
        >>> run.release("hook")
        >>> run.step(10)
        >>> round(run["ball.position.y"], 6)
        0.95095
        """
        self._switch(name, "release")

    def join(self, name: str, *, here: bool = False) -> None:
        """Join a joint that was made with `active`, with a plastic impact (25b), which `Solution.impacts` has.

        Parameters
        ----------
        name : str
            Name of the joint.
        here : bool
            True: it holds the bodies as they stand; False: it must be closed to 1e-9 of the characteristic length.

        Raises
        ------
        ValueError
            If there is no such joint.
        InconsistentStart
            If it is open, with its gap.
        """
        self._switch(name, "here" if checks.instance("here", here, bool, "True or False") else "join")

    def _switch(self, name: str, how: str) -> None:
        known = switches_of(self._ready.of)
        checks.choice("name", getattr(name, "name", name), known)
        if status := self._core.switch(gateway.SWITCHES - known[getattr(name, "name", name)], how):
            error = self._core.error(status)
            raise error
        self._core.note_jump("")

    def _note_jump(self) -> None:
        """Note the jump of speeds in the first step of the last advance, if there was one."""
        core = self._core
        if self._drives is None or core.jumps == self._jumps:
            return
        self._jumps, self.jump = core.jumps, self._drives.jump(*core.jump())
        core.jumped.append((self.jump.t, ", ".join(self.jump.impulses), self.jump.work))
        if self._history is not None:
            self._history.jumps.append(self.jump)

    def _attend(self, status: int) -> None:
        """Go on after a pause or with more memory; raise the error of a failure."""
        core, record = self._core, self._record
        while status in (gateway.PAUSED, gateway.FULL):
            self._note_jump()
            if not self._acts() and self._history is not None:
                self._history.note(core.t, self.inputs)
            if status == gateway.FULL:
                recording.check_memory(record.next_rows, record.row_bytes, stacklevel=4)
                record.grow()
                self._c_record = record.c
            status = core.advance(record, SLICE)
        self._note_jump()
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
        """Act at an event; or call the controllers that are due, and aim at the next instant of one."""
        core, sampling = self._core, self._sampling
        if self._acts():
            return
        if sampling is not None:
            sampling.call(self)
            steps, instant = sampling.next(self)
            core.set_goal(gateway.MAX_STEPS if steps is None else steps, instant)
        if self._history is not None:
            self._history.note(core.t, self.inputs)

    def _goes_on(self, status: int) -> bool:
        """True if a run with an end has reached an instant of a controller, not its end."""
        ready = self._ready
        if status != gateway.DONE:
            return False
        requested = ready.settings.get("t_eval") if ready.events is None else None
        end = ready.span[1] if requested is None else requested[-1]
        return self._sampling is not None and self._core.t < end and self.event is None
