"""Callbacks: evaluation of systems and events written in Python, called by the core, with their errors stored."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..core import ffi, lib
from .base import CALLBACK, DONE, TERMS, Variable, doubles, lengths, set_quaternions
from .known_events import known_table
from .packed_layout import Packing, declare
from .systems import CoreSystem


class Evaluator:
    """Evaluation of a system by its callables, called by the core in one run.

    Callables may store their arguments, and debuggers the frames of an error, beyond the end of the run. So no argument is a view
    of the core's memory, which is freed with the run: terms are written into arrays owned by Python, from which the core copies
    them, and each p and v is a separate immutable copy. An exception that `write` raises is stored, and the run stops.
    """

    def __init__(self, core: PythonCore) -> None:
        self.error: BaseException | None = None
        self.refusal: Exception | None = None
        self._write, terms = core.write, []
        p, v = ffi.new("double[]", core.nq), ffi.new("double[]", core.nv)
        self._p, self._v = ffi.buffer(p), ffi.buffer(v)
        self._arrays = {"p": _read_only(self._p), "v": _read_only(self._v)}
        for name, term in TERMS.items():
            if core.provides & term.bit:
                self._arrays[name] = array = np.zeros(core.stored(name))
                terms.append({"term": term.bit, "offset": term.offset, "size": array.nbytes,
                              "values": doubles(array, array.size)})
        self._memory = p, v, ffi.new("zd_python_term[]", terms)
        self.c = ffi.new("zd_python *", {"system": core.c, "p": p, "v": v, "terms": len(terms), "term": self._memory[-1]})
        if "C" in self._arrays and core.packing is None:
            self._arrays["C_H"], self._arrays["C_NH"] = self._arrays["C"][: core.mh], self._arrays["C"][core.mh :]

    def write(self, want: int, t: float, moved: int) -> int:
        """Compute the wanted terms, called by the core; bits 1 and 2 of `moved` mark p and v as changed since the last call."""
        arrays = self._arrays
        try:
            if moved & 1:
                arrays["p"] = _read_only(self._p)
            if moved & 2:
                arrays["v"] = _read_only(self._v)
            self._write(want, t, arrays)
        except BaseException as error:      # raised again where the run was started
            self.error = error
            return CALLBACK
        return DONE

    def refuse(self, term: int, t: float) -> int:
        """Store an error for a non-finite term, given as its bit; called by the core. A shorter step may avoid it."""
        name = next(name for name, (bit, *_) in TERMS.items() if bit == term)
        self.refusal = self._write.not_finite(name, t, self._arrays[name])
        return lib.ZD_NOT_FINITE


def _read_only(memory: Any) -> np.ndarray:
    """Copy of the doubles in a buffer, backed by a `bytes` object, so that it cannot be made writable."""
    return np.frombuffer(memory[:])


def _keep_error(kind: Any, error: BaseException, traceback: Any) -> None:
    """Store an exception raised in a callback, Ctrl-C included; the caller of the run raises it again."""
    ffi.from_handle(traceback.tb_frame.f_locals["owner"]).error = error.with_traceback(traceback)


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_write_in_python(owner: Any, *arguments: Any) -> int:
    return ffi.from_handle(owner).write(*arguments)


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_refuse_in_python(owner: Any, *arguments: Any) -> int:
    return ffi.from_handle(owner).refuse(*arguments)


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_interrupted_in_python(owner: Any) -> int:
    """Nothing: Python raises KeyboardInterrupt here after Ctrl-C."""
    return 0


class Watcher:
    """Evaluation of the events of one run, called by the core; stores the states of their occurrences.

    An event is a row with `direction` and `terminal`, as the core's `zd_events` has them; `known`, which the core reads, or None;
    unless the core evaluates it itself, `value(t, p, v, x)` of what is read; and `actions(places)`, the inputs that it sets, of
    which `places` has the indices, with their values, or -1 if the caller acts. Measures are those of the system `of`, which has
    the equations of `core`.
    """

    def __init__(self, core: CoreSystem, events: Sequence[Any], of: CoreSystem | None = None, *, is_own: bool = False,
                 places: Mapping[str, Any] | None = None) -> None:
        self.events = events
        self._error: BaseException | None = None
        is_measured = any(event.known and event.known.is_measured for event in events)
        self._of = None if of is None or not is_measured or of is core else of if is_own else of.for_run()
        self.found: tuple[list[tuple[float, np.ndarray, np.ndarray]], ...] = tuple([] for _ in events)
        self._shapes = (core.nq,), (core.nv,)
        actions = [(i, *each) for i, event in enumerate(events) for each in event.actions(places or {})]
        self._kept = (ffi.new_handle(self), ffi.new("int[]", [event.direction for event in events]),
                      ffi.new("int[]", [event.terminal for event in events]), ffi.new("zd_action[]", actions),
                      known_table([event.known for event in events]))
        data, direction, terminal, action, (known, _) = self._kept
        self.c = ffi.new("zd_events *", {
            "count": len(events), "direction": direction, "terminal": terminal, "data": data, "known": known,
            "actions": len(actions), "action": action,
            "of": self._of.c if self._of else ffi.NULL,
            "evaluate": lib.zd_event_in_python, "found": lib.zd_found_in_python})

    @property
    def error(self) -> BaseException | None:
        """Exception raised by an event, or by a measure of another system than the one of the run."""
        return self._error or (self._of.error if self._of else None)

    @error.setter
    def error(self, error: BaseException | None) -> None:
        self._error = error

    def value(self, event: int, t: float, p: Any, v: Any, x: Any) -> float:
        """The value of an event."""
        row = self.events[event]
        return row.value(t, *self.state(p, v), ffi.unpack(x, len(row.known.readings)) if row.known else ())

    def state(self, p: Any, v: Any) -> tuple[np.ndarray, np.ndarray]:
        """Copies of the core's p and v, which the event may store."""
        (nq,), (nv,) = self._shapes
        return np.array(ffi.unpack(p, nq)), np.array(ffi.unpack(v, nv))

    def arrays(self, event: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times and states of the occurrences of an event: t (k,), p (k, nq), v (k, nv)."""
        columns = tuple(zip(*self.found[event], strict=True)) or ((), (), ())
        t, p, v = (np.array(column).reshape(-1, *shape) for column, shape in zip(columns, ((), *self._shapes), strict=True))
        return t, p, v


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_event_in_python(owner: Any, event: int, t: float, p: Any, v: Any, x: Any, value: Any) -> int:
    value[0] = ffi.from_handle(owner).value(event, t, p, v, x)
    return DONE


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep_error)
def zd_found_in_python(owner: Any, event: int, t: float, p: Any, v: Any) -> int:
    watcher = ffi.from_handle(owner)
    watcher.found[event].append((t, *watcher.state(p, v)))
    return DONE


CALLBACK_CODE = Evaluator.write.__code__, Watcher.value.__code__      # the code of users runs below these


class PythonCore(CoreSystem):
    """A system whose terms `write` computes.

    ``write(want, t, arrays)`` fills the arrays of the terms whose bits are in `want`, from `arrays["p"]` and `arrays["v"]`;
    ``write.not_finite(name, t, value)`` is the error for a term that came out not finite. `timeless` says that no term depends
    on t; unit quaternions begin in p at `quaternions`. With a `packing`, the arrays of A, M and C have what is stored of them.
    """

    calls_python = True

    def __init__(self, sizes: tuple[int, int, int, int], names: Iterable[str], write: Any,
                 variables: Iterable[Variable], *, timeless: bool = False, quaternions: Sequence[int] = (),
                 packing: Packing | None = None) -> None:
        system = ffi.new("zd_system *")
        system.nq, system.nv, system.mh, system.mn = sizes
        system.provides = lib.ZD_TIMELESS if timeless else 0
        for name in names:
            system.provides |= TERMS[name].bit
        system.evaluate = ffi.addressof(lib, "zd_evaluate_in_python")      # older versions of cffi want the address
        system.lengths = self._lengths = lengths(variables)
        self._declared = set_quaternions(system, quaternions), declare(system, packing)
        super().__init__(system, None)
        self.write = write
        self.evaluator: Evaluator | None = None

    def for_run(self) -> PythonCore:
        """Copy of the system with an evaluator of its own, so that runs do not share memory."""
        mine = copy.copy(self)
        mine.c = ffi.new("zd_system *", self.c[0])
        evaluator = mine.evaluator = Evaluator(mine)
        mine._data = ffi.new_handle(evaluator)
        evaluator.c.evaluator, mine.c.data = mine._data, evaluator.c
        return mine

    @property
    def error(self) -> BaseException | None:
        """Exception raised by a callable, or else that for the last term that was not finite; None if there is neither."""
        return self.evaluator.error or self.evaluator.refusal if self.evaluator else None

    @property
    def refusal(self) -> BaseException | None:
        """Exception for the last term that was not finite, which shorter steps may have avoided since."""
        return self.evaluator.refusal if self.evaluator else None
