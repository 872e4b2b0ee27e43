"""Open runs of the core: advanced from goal to goal, one or many together, and read between them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core import ffi, lib
from .base import doubles
from .runs import Run, settings
from .systems import CoreSystem

STEP = lib.zd_run_step      # status of so many steps of a run, with a record or NULL: the call that controllers make
NO_RECORD = ffi.NULL
MAX_STEPS = 2**62


class OpenRun(Run):
    """A run of the core without an end.

    Attributes
    ----------
    c : pointer
        The run, as `STEP` takes it.
    """

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        if given[-1] is None:       # not from a saved state
            self.begin_saving(given[2], given[3])
        self.c, core = self._run, self._core
        self.sizes = core.nq, core.nv, core.m
        self.c_p, self.c_v = lib.zd_run_p(self.c), lib.zd_run_v(self.c)
        self._p, self._v = ffi.buffer(self.c_p, 8 * core.nq), ffi.buffer(self.c_v, 8 * core.nv)

    @property
    def t(self) -> float:
        """Time of the present state, in s."""
        return lib.zd_run_time(self.c)

    @property
    def p(self) -> np.ndarray:
        """Copy of the coordinates (nq,), read-only."""
        return np.frombuffer(self._p[:])

    @property
    def v(self) -> np.ndarray:
        """Copy of the velocities (nv,), read-only."""
        return np.frombuffer(self._v[:])

    @property
    def steps(self) -> int:
        """Number of steps made."""
        return lib.zd_run_step_number(self.c)

    @property
    def lane_numbers(self) -> Any:
        """Numbers of the system, as SIMD lanes read them; None: it has no closed-form functions."""
        return self._core.lane_numbers

    def set_goal(self, steps: int, t: float) -> int:
        """Set the goal, a number of steps or a time; return the status."""
        return lib.zd_run_set_goal(self.c, steps, t)

    def set_state(self, p: np.ndarray, v: np.ndarray) -> int:
        """Move to another state at this time; return the status."""
        status = lib.zd_run_set_state(self.c, doubles(p, self._core.nq), doubles(v, self._core.nv))
        self._note_changes()
        return status

    def switch(self, group: int, how: str) -> int:
        """Release or join a group of constraints: "release", "join", or "here" to join it as it stands; return the status."""
        ways = {"release": lib.ZD_RELEASED, "join": lib.ZD_JOINED, "here": lib.ZD_JOINED_HERE}
        status = lib.zd_run_switch(self.c, group, ways[how])
        self._note_changes()
        return status

    @property
    def acting(self) -> int:
        """Index of the event at which the caller is to act; -1: none."""
        return lib.zd_run_acting(self.c)

    @property
    def ended_by(self) -> int:
        """Index of the terminal event at which it stopped."""
        return lib.zd_run_ended_by(self.c)

    @property
    def jumps(self) -> int:
        """Number of jumps of speeds."""
        return lib.zd_run_jump(self.c).count

    def jump(self) -> tuple[float, np.ndarray, np.ndarray]:
        """Last jump of speeds: time in s, impulses (m,) of the constraints with the sign of (7), and their works (m,) in J."""
        last, m = lib.zd_run_jump(self.c), self.sizes[2]
        return last.t, *(np.array(ffi.unpack(each, m)) for each in (last.impulses, last.works))

    def accelerations(self) -> tuple[np.ndarray, np.ndarray]:
        """Accelerations (nv,) and multipliers (m,) at the present state."""
        _, nv, m = self.sizes
        vdot, multipliers = np.empty(nv), np.empty(m)
        if status := lib.zd_run_accelerations(self.c, doubles(vdot, nv, writable=True), doubles(multipliers, m, writable=True)):
            raise self.error(status)
        return vdot, multipliers

    def entry(self, group: int, column: int) -> Callable[[], float]:
        """Function that returns a coordinate (group 0) or velocity (1) at the present state."""
        pointer = (self.c_p, self.c_v)[group]
        return lambda: pointer[column]

    def reader(self, of: CoreSystem, number: int, component: int | None) -> Callable[[], Any]:
        """Function that returns a measure of a system with the equations of the run, or a component of it, at the present state.

        The value is a float, or an array (size,).
        """
        size, scratch = of.measure_size(number), ffi.new("double[]", of.c.measures.scratch + of.nv + of.m)
        value, place = np.empty(size), 0 if size == 1 else component
        memory, at = doubles(value, size, writable=True), (self.c_p, self.c_v)
        run, system = self.c, of.c

        def read() -> Any:
            if status := lib.zd_run_measure(run, system, number, lib.zd_run_time(run), *at, memory, scratch):
                raise of.error or self.error(status)
            return value.copy() if place is None else float(value[place])

        return read

    def forget_errors(self) -> None:
        """Clear stored exceptions of user functions once they have been raised, so that the run may continue."""
        owners = [self._core, self._watcher, self._outputs]
        for owner in (*owners, *(getattr(each, "_of", None) for each in owners)):
            for each in (owner, getattr(owner, "evaluator", None), getattr(owner, "_owner", None)):
                for name in {"error", "_error", "refusal"} & {*getattr(each, "__dict__", ())}:
                    setattr(each, name, None)


class ManyOpenRuns:
    """Open runs of systems of one shape, which do not call Python.

    Parameters
    ----------
    runs : sequence of OpenRun
    ready : sequence
        The attribute `measured` of each is the system that has its measures, which is needed when the first is read.
    parts : sequence of (int, int)
        Runs that one thread advances: the first one, and their number.

    Attributes
    ----------
    status : ndarray (runs,) of int
        Status of the last advance, one per run; a run that has failed has a negative one and is not advanced.
    t, p, v : ndarray (runs,), (runs, nq), (runs, nv)
        Present states.
    lanes : list
        SIMD lanes of each part; NULL: its runs are made one by one.
    """

    def __init__(self, runs: Sequence[OpenRun], ready: Sequence[Any], parts: Sequence[tuple[int, int]]) -> None:
        self._runs, (nq, nv, _) = list(runs), runs[0].sizes
        count = len(runs)
        self.status, self.t = np.zeros(count, dtype=np.intc), np.empty(count)
        self.p, self.v = np.empty((count, nq)), np.empty((count, nv))
        self._pointers = ffi.new("zd_run *[]", [run.c for run in runs])
        self._ready, self._measured = list(ready), list[Any]()
        self.c = ffi.new("zd_open_runs *", {
            "runs": count, "run": self._pointers, "status": ffi.from_buffer("int[]", self.status, require_writable=True),
            "t": doubles(self.t, count, writable=True), "p": doubles(self.p, self.p.size, writable=True),
            "v": doubles(self.v, self.v.size, writable=True)})
        self._numbers = ffi.new("double *[]", count)
        numbers = [run.lane_numbers for run in runs]
        if all(each is not None and len(each) == len(numbers[0]) for each in numbers):
            self._numbers[0:count] = numbers
            self.c.data, self.c.doubles = ffi.cast("const double *const *", self._numbers), len(numbers[0])
        self._parts, self._ends = list(parts), np.cumsum([k for _, k in parts])
        self.lanes = [ffi.gc(lanes, lib.zd_open_lanes_free) if lanes else lanes
                      for lanes in (lib.zd_open_lanes_create(self.c, *part) for part in parts)]
        lib.zd_open_runs_read(self.c, 0, count)

    def _lanes_of(self, i: int) -> Any:
        return self.lanes[np.searchsorted(self._ends, i, side="right")]

    def __getitem__(self, i: int) -> OpenRun:
        """A run, brought to its present state."""
        run, lanes = self._runs[i], self._lanes_of(i)
        if lanes and (status := lib.zd_open_lanes_update_run(lanes, i)):
            raise run.error(status)
        return run

    def replace(self, i: int, run: OpenRun, ready: Any) -> None:
        """Replace one of the runs, and store its present state."""
        self._ready[i] = ready
        if self._measured:
            self._measured[i] = ready.measured
            self._systems[i] = self._measured[i].c
        self._runs[i], self._pointers[i], self.status[i] = run, run.c, 0
        if lanes := self._lanes_of(i):
            self._numbers[i] = run.lane_numbers
            lib.zd_open_lanes_discard(lanes, i)
        lib.zd_open_runs_read(self.c, i, 1)

    def measure(self, number: int) -> np.ndarray | None:
        """A measure at the present states: (runs, size). None: one run cannot evaluate it, and says why if it is read alone."""
        if not self._measured:
            self._measured = [each.measured for each in self._ready]
            self._systems = ffi.new("const zd_system *[]", [each.c for each in self._measured])
        measures, (_, nv, m) = self._systems[0].measures, self._runs[0].sizes
        measure, scratch = measures.measure[number], ffi.new("double[]", measures.scratch + nv + m)
        if measure.depends == lib.ZD_OF_ACCELERATIONS:
            for i in range(len(self._runs)):
                self[i]
        values = np.empty((len(self._runs), measure.size))
        status = lib.zd_open_runs_measure(self.c, self._systems, number, doubles(values, values.size, writable=True), scratch)
        return None if status else values

    def advance(self, part: int, steps: int, t: float) -> None:
        """Advance the runs of one part; the interpreter lock is released meanwhile."""
        if lanes := self.lanes[part]:
            lib.zd_open_lanes_advance(lanes, steps, t)
        else:
            lib.zd_open_runs_advance(self.c, *self._parts[part], steps, t)


class Found(NamedTuple):
    """The phase that the core finds at a state, which an impact may have changed."""

    state: tuple[int, ...]      # (groups,) as `zd_transition` has it
    v: np.ndarray
    vdot: np.ndarray
    multipliers: np.ndarray     # of all constraints


def phase_at(core: CoreSystem, formulation: int, t: float, p: np.ndarray, v: np.ndarray) -> Found:
    """The phase that follows at a state, by its gaps, velocities and forces."""
    members = {"formulation": formulation, "t0": t, "t1": t + 1.0, "step": 1.0, "save_every": 1, "is_open": 1}
    run = OpenRun(core.for_run(), settings(members), p, v, None)
    vdot, multipliers = run.accelerations()
    return Found(tuple(run.transitions[0][1]), run.v, vdot, multipliers)
