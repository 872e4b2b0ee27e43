"""Systems and events that are written in Python: how the core calls them, and what becomes of their errors."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from .._core import ffi, lib
from .base import CALLBACK, DONE, TERMS, Variable, lengths
from .systems import CoreSystem


class Evaluator:
    """Calls the callables of a system when the core evaluates it, in one run.

    The core hands the same memory to all calls of a run, so NumPy's arrays over it are made once. An error that `write` raises is
    kept, and the run stops.
    """

    def __init__(self, core: PythonCore, bridge: Any) -> None:
        self.core, self.bridge, self.error, self.arrays = core, bridge, None, {}

    def write(self, want: int, t: float, memory_moved: int) -> int:
        """The function that the core calls; `memory_moved` says that its arrays are not where they were at the last call."""
        try:
            if memory_moved:
                self.arrays = self._arrays_over(self.bridge)
            self.core.write(want, t, self.arrays)
        except BaseException as error:      # raised again where the run was started
            self.error = error
            return CALLBACK
        return DONE

    def _arrays_over(self, memory: Any) -> dict[str, np.ndarray]:
        core = self.core
        arrays = {"p": _array_over(memory.p, (core.nq,)), "v": _array_over(memory.v, (core.nv,))}
        arrays["p"].flags.writeable = arrays["v"].flags.writeable = False
        for name, (bit, shape) in TERMS.items():
            if core.provides & bit:
                arrays[name] = _array_over(getattr(memory.terms, name), [getattr(core, size) for size in shape])
        if "C" in arrays:
            arrays["C_H"], arrays["C_NH"] = arrays["C"][: core.mh], arrays["C"][core.mh :]
        return arrays

    def failure(self) -> BaseException | None:
        """What a callable raised, or the error for a term that was not finite."""
        bit = self.bridge.not_finite
        if self.error is None and bit:
            name = next(name for name, (term, _) in TERMS.items() if term == bit)
            self.error = self.core.write.not_finite(name, self.bridge.t, self.arrays[name])
        return self.error


def _array_over(pointer: Any, shape: Any) -> np.ndarray:
    size = int(np.prod(shape))
    if size == 0:
        return np.empty(shape)
    return np.frombuffer(ffi.buffer(pointer, size * 8), dtype=np.float64).reshape(shape)


def _keep_error(kind: Any, error: BaseException, traceback: Any) -> None:
    """Keeps what a callback raised, Ctrl-C included; it is raised again where the run was started."""
    ffi.from_handle(traceback.tb_frame.f_locals["owner"]).error = error.with_traceback(traceback)


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_write_in_python(owner, want, t, memory_moved):
    return ffi.from_handle(owner).write(want, t, memory_moved)


class Watcher:
    """Calls the events of one run for the core, and keeps the states at which they were found.

    An event is a row with `value(t, p, v)`, `direction` and `terminal`, as the core's `zd_events` has them.
    """

    def __init__(self, core: CoreSystem, events: Sequence[Any]) -> None:
        self.events, self.error = events, None
        self.found: tuple[list[tuple[float, np.ndarray, np.ndarray]], ...] = tuple([] for _ in events)
        self._shapes = (core.nq,), (core.nv,)
        self._kept = (ffi.new_handle(self), ffi.new("int[]", [event.direction for event in events]),
                      ffi.new("int[]", [event.terminal for event in events]))
        data, direction, terminal = self._kept
        self.c = ffi.new("zd_events *", {
            "count": len(events), "direction": direction, "terminal": terminal, "data": data,
            "evaluate": lib.zd_event_in_python, "found": lib.zd_found_in_python})

    def value(self, event: int, t: float, p: Any, v: Any) -> float:
        """The value of an event."""
        return self.events[event].value(t, *self.state(p, v))

    def state(self, p: Any, v: Any) -> tuple[np.ndarray, np.ndarray]:
        """Copies of the core's p and v, as an event may keep them."""
        return tuple(_array_over(pointer, shape).copy() for pointer, shape in zip((p, v), self._shapes, strict=True))

    def arrays(self, event: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Where an event was found: t (k,), p (k, nq), v (k, nv)."""
        columns = tuple(zip(*self.found[event], strict=True)) or ((), (), ())
        return tuple(np.array(column).reshape(-1, *shape) for column, shape in zip(columns, ((), *self._shapes), strict=True))


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_event_in_python(owner, event, t, p, v, value):
    value[0] = ffi.from_handle(owner).value(event, t, p, v)
    return DONE


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_found_in_python(owner, event, t, p, v):
    watcher = ffi.from_handle(owner)
    watcher.found[event].append((t, *watcher.state(p, v)))
    return DONE


CALLBACK_CODE = Evaluator.write.__code__, Watcher.value.__code__      # the code of users runs below these


class PythonCore(CoreSystem):
    """A system whose terms `write` computes.

    ``write(want, t, arrays)`` fills the arrays of the terms whose bits are in `want`, from `arrays["p"]` and `arrays["v"]`;
    ``write.not_finite(name, t, value)`` is the error for a term that came out not finite.
    """

    def __init__(self, sizes: tuple[int, int, int, int], names: Iterable[str], write: Callable[..., None],
                 variables: Iterable[Variable]) -> None:
        system = ffi.new("zd_system *")
        system.nq, system.nv, system.mh, system.mn = sizes
        for name in names:
            system.provides |= TERMS[name][0]
        system.evaluate = lib.zd_evaluate_in_python
        system.lengths = self._lengths = lengths(variables)
        super().__init__(system, None)
        self.write, self.evaluator = write, None

    def for_run(self) -> PythonCore:
        """The same system with an evaluator of its own, so that runs do not share memory."""
        mine = copy.copy(self)
        bridge = ffi.new("zd_python *")
        mine.c = ffi.new("zd_system *", self.c[0])
        mine.evaluator = Evaluator(mine, bridge)
        mine._data = ffi.new_handle(mine.evaluator)
        bridge.evaluator, bridge.system, mine.c.data = mine._data, mine.c, bridge
        return mine

    @property
    def error(self) -> BaseException | None:
        """What a callable raised."""
        return self.evaluator.failure() if self.evaluator else None
