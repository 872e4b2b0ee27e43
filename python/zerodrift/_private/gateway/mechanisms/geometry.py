"""Constraints and measures of positions, evaluated at many positions in turn into arrays that are allocated once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...core import ffi, lib
from ..base import doubles, error_of
from .core import MechanismCore


class Component(NamedTuple):
    """A component of a measure of positions."""

    measure: int
    component: int


class Geometry:
    """Holonomic constraints of a system and components of measures, as functions of positions at t = 0.

    Parameters
    ----------
    core : MechanismCore
        In coordinates whose rates are the velocities.
    rows : sequence of int
        The rows of Phi that count.
    components : sequence of Component
    """

    def __init__(self, core: MechanismCore, rows: Sequence[int], components: Sequence[Component]) -> None:
        self._core, self._rows, self._components = core.for_run(), np.array(rows, dtype=int), tuple(components)
        self.n, self._rest = core.nv, np.zeros(core.nv)
        self._Phi, self._C = np.zeros(core.mh), np.zeros(core.stored("C"))
        self._scratch = ffi.new("double[]", max(1, core.c.scratch))
        self._terms = ffi.new("zd_terms *", {"scratch": self._scratch, "Phi": _memory(self._Phi), "C": _memory(self._C)})
        largest = max((core.measure_size(each.measure) for each in components), default=1)
        self._arrays = {name: np.zeros(largest) for name in ("value", "rate", "bias")}
        self._arrays["jacobian"] = np.zeros((largest, core.nv))
        self._measured = ffi.new("zd_measured *", {name: _memory(array) for name, array in self._arrays.items()})
        scratch = core.c.measures.scratch if components else 0
        self._measuring_scratch = ffi.new("double[]", max(1, scratch))

    def __call__(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values (k,) and gradients (k, n) of the independent constraints, followed by those of the components."""
        core, at = self._core, doubles(p, self.n)
        count = len(self._rows)
        values, rows = np.empty(count + len(self._components)), np.empty((count + len(self._components), self.n))
        if count:
            status = core.c.evaluate(core.c.data, (lib.ZD_PHI | lib.ZD_C) & core.provides | lib.ZD_MOVED, 0.0, at,
                                     _memory(self._rest), self._terms)
            if status:
                raise core.error or error_of(status, "the system's evaluation failed")
            C = core.packing.expand("C", self._C) if core.packing else self._C
            values[:count], rows[:count] = self._Phi[self._rows], C[self._rows]
        for i, (measure, component) in enumerate(self._components, count):
            core.c.measures.evaluate(core.c.data, ffi.NULL, measure, 0.0, at, _memory(self._rest), ffi.NULL, ffi.NULL,
                                     self._measured, self._measuring_scratch)
            values[i], rows[i] = self._arrays["value"][component], self._arrays["jacobian"][component]
        return values, rows


def _memory(array: np.ndarray) -> object:
    return ffi.from_buffer("double[]", array)
