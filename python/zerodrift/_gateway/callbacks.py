"""Systems written in Python: the way from the core to their callables and back."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from .._core import ffi, lib
from .base import CALLBACK, DONE, TERMS
from .systems import CoreSystem


class Evaluator:
    """Between the core's evaluation of one run and the callables of a system.

    The core hands the same memory to each call of a run, so the arrays over it are made once. What `write` raises is kept,
    and the run stops.
    """

    def __init__(self, core: PythonCore, bridge: Any) -> None:
        self.core, self.bridge, self.error, self.arrays = core, bridge, None, {}

    def write(self, want: int, t: float, elsewhere: int) -> int:
        """What the core calls: `elsewhere` says that its memory is another than at the last call."""
        try:
            if elsewhere:
                self.arrays = self._over(self.bridge)
            self.core.write(want, t, self.arrays)
        except BaseException as error:      # it surfaces where the run was started
            self.error = error
            return CALLBACK
        return DONE

    def _over(self, memory: Any) -> dict[str, np.ndarray]:
        core = self.core
        arrays = {"p": _over(memory.p, (core.nq,)), "v": _over(memory.v, (core.nv,))}
        arrays["p"].flags.writeable = arrays["v"].flags.writeable = False
        for name, (bit, shape) in TERMS.items():
            if core.provides & bit:
                arrays[name] = _over(getattr(memory.terms, name), [getattr(core, size) for size in shape])
        if "C" in arrays:
            arrays["C_H"], arrays["C_NH"] = arrays["C"][: core.mh], arrays["C"][core.mh :]
        return arrays

    def failure(self) -> BaseException | None:
        """What a callable raised, or the error for a term that was not finite."""
        bit = self.bridge.not_finite
        if self.error is None and bit:
            name = next(name for name, (mine, _) in TERMS.items() if mine == bit)
            self.error = self.core.write.not_finite(name, self.bridge.t, self.arrays[name])
        return self.error


def _over(pointer: Any, shape: Any) -> np.ndarray:
    size = int(np.prod(shape))
    if size == 0:
        return np.empty(shape)
    return np.frombuffer(ffi.buffer(pointer, size * 8), dtype=np.float64).reshape(shape)


def _keep(kind: Any, error: BaseException, traceback: Any) -> None:
    """Ctrl-C between C and `Evaluator.write` is an error like any other."""
    ffi.from_handle(traceback.tb_frame.f_locals["evaluator"]).error = error


@ffi.def_extern(error=lib.ZD_CALLBACK, onerror=_keep)
def zd_write_in_python(evaluator, want, t, elsewhere):
    return ffi.from_handle(evaluator).write(want, t, elsewhere)


CALLBACK_CODE = Evaluator.write.__code__    # below it runs what users wrote


class PythonCore(CoreSystem):
    """A system whose terms `write` computes.

    ``write(want, t, arrays)`` fills the arrays of the terms whose bits are in `want`, from `arrays["p"]` and `arrays["v"]`;
    ``write.not_finite(name, t, value)`` is the error for a term that came out not finite.
    """

    def __init__(self, sizes: tuple[int, int, int, int], names: Iterable[str], write: Callable[..., None]) -> None:
        system = ffi.new("zd_system *")
        system.nq, system.nv, system.mh, system.mn = sizes
        for name in names:
            system.provides |= TERMS[name][0]
        system.evaluate = lib.zd_evaluate_in_python
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
