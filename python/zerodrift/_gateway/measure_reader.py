"""Measures of a run at its present state."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .._core import ffi, lib
from .base import doubles, error_of
from .systems import CoreSystem


class MeasureReader:
    """Reads measures of a system, which has the equations of the run, without memory for each call."""

    def __init__(self, run: Any, core: CoreSystem, *, is_own: bool) -> None:
        self._run, self._core = run, core if is_own else core.for_run()
        measures = self._core.c.measures
        self._scratch = ffi.new("double[]", max(1, measures.scratch))
        self._out, self._acceleration = ffi.new("zd_measured *"), (np.empty(core.nv), np.empty(core.m))
        self._at = doubles(self._acceleration[0], core.nv), doubles(self._acceleration[1], core.m)
        self._evaluate, self._measures = measures.evaluate, measures

    def function(self, number: int, component: int | None) -> Callable[[], Any]:
        """Function that returns a measure, or a component of it, at the present state: a float or an array (size,)."""
        measure = self._measures.measure[number]
        value = np.empty(measure.size)
        memory, needs = doubles(value, measure.size, writable=True), measure.depends == lib.ZD_OF_ACCELERATIONS
        place = 0 if measure.size == 1 else component
        core, out, run = self._core, self._out, self._run

        def read() -> Any:
            vdot, multipliers = self._accelerations() if needs else (ffi.NULL, ffi.NULL)
            out.value, out.is_least = memory, needs and not lib.zd_run_is_deficient(run.c)
            at = run.t, run.c_p, run.c_v, vdot, multipliers
            status = self._evaluate(core.c.data, lib.zd_run_functions(run.c), number, *at, out, self._scratch)
            if status:
                raise core.error or error_of(status, "a measure could not be evaluated")
            return value.copy() if place is None else float(value[place])

        return read

    def _accelerations(self) -> tuple[Any, Any]:
        self._run.accelerations_into(*self._at)
        return self._at
