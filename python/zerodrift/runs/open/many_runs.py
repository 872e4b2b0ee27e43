"""Many open runs of one system that are advanced together, as learning needs them."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, Unpack

import numpy as np

from ..._private import checks, gateway
from ..._private.types import ArrayLike, Inputs, MeasureLike, Settings, SystemLike, Values
from ...errors import WrongType, WrongValue
from ...symbolics.emit import program_writer
from ...systems.base import closed_form_core_of
from ...systems.measure_values import Place
from ..arguments.inputs import Speeds, refuse_unknown
from ..arguments.settings import known, with_names
from ..states.reading import Reading
from .beginning import Prepared, nominal_span, prepared
from .ending import beyond_reach
from .many_starts import assembled
from .run_state import restored, saved, unpacked
from .threads import processors

SMALLEST_PART = 64      # minimum number of runs in a thread
FEWEST_IN_LANES = 16    # minimum number of runs for which functions in SIMD lanes are compiled
MAX_LANES = 8          # of a vector unit: parts begin at multiples


class ManyRuns:
    """Many open runs of one system, advanced together.

    Results are bitwise those of single runs, except the last bits of the built-in pendulum and knife edge in lanes. Runs
    execute in one thread per available processor if the system does not call Python; and in SIMD lanes, as many at once as a
    vector of the processor has numbers, with fixed steps of a Runge-Kutta method if the system has closed-form functions: those
    of ``zd.systems``, symbolic ones, and small mechanisms. Steps that lanes cannot make, those near a singularity or so long
    that constraints reverse, are made individually.

    Parameters
    ----------
    system : system
        As in `Run`; fastest from ``mechanism.system(compiled=True)``.
    p0, v0 : array_like (nq,), (nv,), or of each run (runs, nq), (runs, nv), optional
        Starts; by default that of the system.
    runs : int
        Number of runs.
    parameters : dict of str to float or array_like (runs,), optional
        Parameters of the system in each run.
    t0, step, inputs, hold, ramp, **settings
        As in `Run`, except `events`, `outputs`, `control`, `record` and `save_to`, which are not available: a controller is a
        loop that sets ``runs[name]`` between calls of `step`.

    Attributes
    ----------
    system : system
    settings : dict
        Settings by name.
    inputs : ndarray (runs, k)
        Inputs in the order of their names; writable. They hold from the next step on.

    See Also
    --------
    Run : a single run, with all arguments.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("arm")
    >>> arm = m.link("arm", (0, 0), (1, 0), mass=3.0)
    >>> drive = m.motor("drive", m.revolute("pin", m.ground, arm.start), torque=0.0)
    >>> runs = zd.ManyRuns(m, runs=4, step=0.01, inputs=["drive.torque"])
    >>> runs["drive.torque"] = [0.0, 1.0, 2.0, 3.0]
    >>> runs.step(100)
    >>> runs["pin.speed"].round(6)
    array([0., 1., 2., 3.])
    >>> runs.reset(where=runs["pin.speed"] > 1.5)
    >>> runs.t
    array([1., 1., 0., 0.])

    Some of them continue from the state of another one:

    >>> states = runs.save()
    >>> runs.restore(states[1], where=runs.t == 0.0)
    >>> runs.t, runs["drive.torque"]
    (array([1., 1., 1., 1.]), array([0., 1., 1., 1.]))
    """

    @with_names(known)
    def __init__(self, system: SystemLike, p0: ArrayLike | None = None, v0: ArrayLike | None = None, *, runs: int,
                 parameters: Mapping[str, ArrayLike] | None = None, t0: float = 0.0, step: float | None = None,
                 inputs: Inputs | None = None, hold: bool = False, ramp: float | None = None,
                 **settings: Unpack[Settings]) -> None:
        t0, count = checks.number("t0", t0), checks.count("runs", runs)
        first = _first("p0", p0, count), _first("v0", v0, count)
        ready = prepared(system, nominal_span(t0, step), *first, None, None, None, known("ManyRuns", step, None, **settings),
                         inputs=inputs, speeds=Speeds(hold, ramp), is_open=True)
        if count >= FEWEST_IN_LANES:
            ready = _in_lanes(ready)
        self.system, self.settings = ready.system, ready.settings
        self.inputs = np.zeros((count, len(ready.declared.names) if ready.declared else 0))
        self._places = ready.declared.places() if ready.declared else {}
        self._ready = _of_each(ready, count, _tables(parameters, count), _check_states(ready, p0, v0, count), self.inputs)
        self._parts = _parts(count, 1 if ready.core.calls_python else processors())
        self._pool: ThreadPoolExecutor | None = None
        self._core = gateway.ManyOpenRuns([each.created(gateway.OpenRun) for each in self._ready], self._ready, self._parts)
        self._readings: dict[int, Reading] = {}
        self._readers: dict[Any, Callable[[], np.ndarray]] = {}

    def __len__(self) -> int:
        return len(self._ready)

    # ---- advance ----

    def step(self, steps: int = 1) -> None:
        """Make steps in every run that has not failed.

        A run that fails stays at the start of the step that failed, and is not advanced until it is reset; see `failed` and
        `messages`.

        Parameters
        ----------
        steps : int
            Number of steps, at least 0.
        """
        self._advance(checks.count("steps", steps, least=0), math.inf)

    def advance_to(self, t: float) -> None:
        """Advance every run that has not failed to a time in s, as `Run.advance_to`; later ones fail."""
        self._advance(gateway.MAX_STEPS, checks.number("t", t))

    def _advance(self, steps: int, t: float) -> None:
        core, others = self._core, range(1, len(self._parts))
        if not others:
            core.advance(0, steps, t)
            return
        if self._pool is None:
            self._pool = ThreadPoolExecutor(len(others))
        waiting = [self._pool.submit(core.advance, part, steps, t) for part in others]
        core.advance(0, steps, t)
        for each in waiting:
            each.result()

    # ---- read ----

    @property
    def t(self) -> np.ndarray:
        """Present times (runs,), in s; a copy."""
        return self._core.t.copy()

    @property
    def p(self) -> np.ndarray:
        """Coordinates (runs, nq); a copy."""
        return self._core.p.copy()

    @property
    def v(self) -> np.ndarray:
        """Velocities (runs, nv); a copy."""
        return self._core.v.copy()

    @property
    def failed(self) -> np.ndarray:
        """True for each run (runs,) that has failed."""
        return self._core.status < 0

    @property
    def messages(self) -> list[str]:
        """Message of each run that has failed, and "" of the others."""
        return [self._message(i) if failed else "" for i, failed in enumerate(self.failed.tolist())]

    def _message(self, i: int) -> str:
        run, ready = self._core[i], self._ready[i]
        is_by_others = self._core.status[i] in (gateway.BAD_INPUT, gateway.CALLBACK)
        return (not is_by_others and beyond_reach(ready.of, run, self.settings, ready.span)) or run.message

    def __getitem__(self, measure: MeasureLike) -> np.ndarray:
        """Value in every run (runs,), or of a vector (runs, 2) or (runs, 3), by name, as of `Run`.

        Measures of positions and velocities may differ from its values by rounding, where the equations are in closed form.
        """
        read = self._readers.get(measure)
        if read is None:
            read = self._readers[measure] = self._reader(getattr(measure, "name", measure))
        return read()

    def _reader(self, name: Any) -> Callable[[], np.ndarray]:
        """Function that returns the values of that name."""
        core = self._core
        if name in self._places:
            return lambda: self.inputs[:, self._places[name]].copy()
        if place := self._ready[0].of._watching.view(name):
            return self._by_program(place) or partial(self._part, name, place)
        found = self.system._columns_of.get(name, ())
        if len(found) == 1 and found[0][0] < 2:
            group, column = found[0]
            return lambda: (core.v if group else core.p)[:, column].copy()
        return partial(self._by_each, name)

    def _by_each(self, name: Any) -> np.ndarray:
        return np.array([self._reading(i)(name) for i in range(len(self))])

    def _part(self, name: Any, place: Place) -> np.ndarray:
        """The part of the values of a measure that has that name."""
        if (found := self._core.measure(place.number)) is None:
            return self._by_each(name)
        if place.form in (None, np.asarray):
            return place.pick(found)
        return np.concatenate([place.pick(each) for each in found[:, None]])      # an orientation follows the sample before

    def _by_program(self, place: Place) -> Callable[[], np.ndarray] | None:
        """Function that returns a measure by a program; None: it has none, or runs differ, or are not in closed form."""
        ready, core = self._ready[0], self._core
        if place.form not in (None, np.asarray) or not ready.source.has_closed_form or (
                any(each.of is not ready.of for each in self._ready)):
            return None
        measure = ready.of._watching.core.measures[place.number]
        if not (found := ready.of._program_of(measure.name)):
            return None
        read = program_writer.reader(*found, core.t, core.p, core.v)
        return read if read is None or (place[1:] == (None, None) and measure.size > 1) else lambda: place.pick(read())

    def _reading(self, i: int) -> Reading:
        run = self._core[i]         # which brings it to its present state
        if i not in self._readings:
            ready = self._ready[i]
            self._readings[i] = Reading(ready.of, run, ready)
        return self._readings[i]

    def __setitem__(self, measure: MeasureLike, values: ArrayLike) -> None:
        """Set an input in every run, from the next step on: a number, or an array (runs,); of an array, (runs, ...)."""
        name: Any = getattr(measure, "name", measure)
        if name not in self._places:
            refuse_unknown(self.system, name, self._places)
        self.inputs[:, self._places[name]] = values

    def __repr__(self) -> str:
        core, failed = self._core, int(self.failed.sum())
        return (f"{len(self)} runs of {self.system.name}: t = {core.t.min():.9g} ... {core.t.max():.9g} s, "
                f"{failed or 'none'} failed")

    # ---- save, restore, reset ----

    def save(self) -> list[bytes]:
        """State of each run, as `Run.save` returns it."""
        return [saved(ready, self._core[i], [], self.system) for i, ready in enumerate(self._ready)]

    def restore(self, states: bytes | Sequence[bytes], *, where: ArrayLike | None = None) -> None:
        """Restore saved states, from which runs continue with the same bits.

        Parameters
        ----------
        states : bytes, or sequence of bytes (k,)
            One for all, or one for each of the k runs.
        where : array_like (runs,) of bool, optional
            True for the k runs to restore; left out: all.

        Raises
        ------
        WrongState
            If one is damaged, or of another system, other parameters or other settings.
        """
        places = np.flatnonzero(_mask(where, len(self))).tolist()
        each = [states] * len(places) if isinstance(states, bytes) else list(states)
        if len(each) != len(places):
            raise WrongValue(f"states must be {len(places)}, one for each run, not {len(each)}", "shape")
        for i, state in zip(places, each, strict=True):
            found, ready = unpacked(state), self._ready[i]
            if ready.inputs:        # a state that is refused leaves those of the run as they are
                ready = ready.with_own()
            self._become(i, ready, restored(ready, found, self.system))

    def _become(self, i: int, ready: Prepared, run: gateway.OpenRun) -> None:
        """Put another run of the core in the place of one."""
        if ready.inputs:
            ready.inputs.adopt(self.inputs[i])
        self._ready[i] = ready
        self._core.replace(i, run, ready)
        self._readings.pop(i, None)

    def reset(self, p0: ArrayLike | None = None, v0: ArrayLike | None = None, *, start: Values | None = None,
              where: ArrayLike | None = None) -> None:
        """Reset runs to t0, with their first inputs.

        Parameters
        ----------
        p0, v0 : array_like (nq,), (nv,), or of each run that is reset (k, nq), (k, nv)
            Other starts; left out: the first ones. They must satisfy the constraints.
        start : dict of measure to value, optional
            Instead, for mechanisms: values of measures, as in `Mechanism.start`, in addition to the mechanism's own; one for all
            runs, or an array of values (k, ...).
        where : array_like (runs,) of bool, optional
            True for the k runs to reset; left out: all.
        """
        places = np.flatnonzero(_mask(where, len(self)))
        if start is not None and not (p0 is None and v0 is None):
            raise WrongType("start must be left out where p0 or v0 is given", "conflicting-arguments")
        states = (_check_states(self._ready[0], p0, v0, len(places)) if start is None else
                  assembled([self._ready[i] for i in places.tolist()], start))
        for i, (p, v) in zip(places.tolist(), states, strict=True):
            ready = self._ready[i]
            start = ready._replace(p0=ready.p0 if p is None else p, v0=ready.v0 if v is None else v)
            with ready.inputs.initially() if ready.inputs else contextlib.nullcontext():
                self._become(i, ready, start.created(gateway.OpenRun))


def _parts(count: int, threads: int) -> list[tuple[int, int]]:
    """Runs of each thread: the first one, and their number."""
    parts = max(1, min(threads, count // SMALLEST_PART))
    ends = [*(count * i // parts // MAX_LANES * MAX_LANES for i in range(parts)), count]
    return [(begin, end - begin) for begin, end in itertools.pairwise(ends)]


def _first(name: str, given: Any, count: int) -> Any:
    """The start of the first run, where starts differ."""
    if given is None or not isinstance(given, np.ndarray | list | tuple) or np.ndim(given) != 2:
        return given
    if len(given) != count:
        raise WrongValue(f"{name} must have {count} rows, one for each run, not {len(given)}", "shape")
    return given[0]


def _check_states(ready: Prepared, p0: Any, v0: Any, count: int) -> list[tuple[Any, Any]]:
    """Starts (p, v) of each run; None where they are not given."""
    columns = []
    for name, given, size in (("p0", p0, len(ready.p0)), ("v0", v0, len(ready.v0))):
        if given is None or not isinstance(given, np.ndarray | list | tuple):
            columns.append([None] * count)
            continue
        array = checks.real(f"{name} must hold", given).astype(float)
        if array.shape not in ((size,), (count, size)):
            raise WrongValue(f"{name} must have shape ({size},) or ({count}, {size}), not {array.shape}", "shape")
        columns.append(list(np.broadcast_to(array, (count, size)).copy()))
    return list(zip(*columns, strict=True))


def _tables(parameters: Any, count: int) -> list[dict[str, Any]]:
    """Parameters of each run, by name."""
    given = checks.parameters(parameters)
    for name, values in given.items():
        if np.ndim(values) and len(values) != count:
            raise WrongValue(f"parameter {name!r} must be a number or have {count} values, one for each run, not {len(values)}",
                             "shape")
    return [{name: values[i] if np.ndim(values) else values for name, values in given.items()} for i in range(count)]


def _mask(where: Any, count: int) -> np.ndarray:
    if where is None:
        return np.ones(count, dtype=bool)
    mask = np.asarray(where)
    if mask.shape != (count,) or mask.dtype != bool:
        raise WrongValue(f"where must be {count} values True or False, not {checks.shown(where)}", "shape")
    return mask


def _of_each(ready: Prepared, count: int, tables: list[dict[str, Any]], states: list[tuple[Any, Any]],
             values: np.ndarray) -> list[Prepared]:
    """Arguments of each run, with its own parameters, start and inputs."""
    found = []
    for i in range(count):
        mine, (p, v) = _with_parameters(ready, tables[i]) if tables[i] else ready, states[i]
        mine = mine._replace(p0=mine.p0 if p is None else p, v0=mine.v0 if v is None else v)
        found.append(mine.with_own(values[i] if mine.declared else None))
    return found


def _in_lanes(ready: Prepared) -> Prepared:
    """Arguments with functions for SIMD lanes, if the system has them and the settings admit lanes."""
    vector = ready.settings["vector"]
    if vector is None or not ready.source.has_closed_form or not gateway.lanes_serve(ready.source, ready.core_settings):
        return ready
    return ready._replace(source=ready.of._core_in_lanes(vector))


def _with_parameters(ready: Prepared, parameters: dict[str, Any]) -> Prepared:
    system = ready.system.with_parameters(parameters)
    declared = ready.declared and ready.declared._replace(of=system._with_inputs(ready.declared.names))
    of = declared.of.system if declared else system
    core = closed_form_core_of(of, ready.settings["vector"] or "baseline", ready.core_settings)
    if ready.source.has_lanes:
        core = of._core_in_lanes(ready.settings["vector"])
    p0, v0 = of._state_or_start(None, None, t=ready.span[0]) if system.p0 is not None else (ready.p0, ready.v0)
    return ready._replace(system=system, source=core, declared=declared, p0=p0, v0=v0)
