"""Vector units, and sets of functions for one trajectory or several: what this machine has, and one call for all of them."""

import ctypes

import numpy as np
import pytest

from zerodrift._private import gateway
from zerodrift._private.core import ffi, lib
from zerodrift._private.gateway.compiled import programs
from zerodrift.symbolics.compile.shared_library import QUICKLY

# The sets of csrc/include/zerodrift/units.h by their unit's number and how many trajectories they take at once
SETS = {(0, 1): "BASELINE_1", (0, 2): "BASELINE_2", (1, 1): "AVX2_1", (1, 4): "AVX2_4", (2, 1): "AVX512_1", (2, 8): "AVX512_8"}
UNIT = lib.zd_processor_unit()
IN_LANES = [each for each in SETS if each[1] > 1]


def available(of):
    """The set, where this processor has its unit."""
    if of[0] > UNIT:
        pytest.skip(f"this processor has not the vector unit of {SETS[of]}")
    return of


class DirectSet:
    """Closed-form functions of one set, called for as many trajectories as it takes; `data` (lanes, doubles).

    `of_mechanism`: those for one trajectory are handed where the doubles are, and not these.
    """

    def __init__(self, closed_form, sizes, data, of_mechanism=False):
        self.closed_form, self.lanes, (self.nq, self.nv, self.mh, self.m) = closed_form, closed_form.lanes, sizes
        assert data.shape[0] == self.lanes
        self._data = np.ascontiguousarray(data.T)
        doubles = ffi.from_buffer("double[]", self._data)
        self.data = ffi.new("double *[1]", [doubles]) if of_mechanism and self.lanes == 1 else doubles
        self.orders = range(closed_form.orders)

    def _into(self, **sizes):
        arrays = {name: np.full((size, self.lanes), np.nan) for name, size in sizes.items()}
        return arrays, [ffi.from_buffer("double[]", array) if array.size else ffi.NULL for array in arrays.values()]

    def _called(self, i, name, inputs, sizes):
        arrays, memory = self._into(**sizes)
        given = [ffi.NULL if x is None else ffi.from_buffer("double[]", np.ascontiguousarray(np.transpose(x))) for x in inputs]
        order = self.closed_form.order + i
        assert getattr(order, name)(order, self.data, ffi.NULL, *given, *memory) == 0
        return {name: array.T for name, array in arrays.items()}

    def accelerate(self, i, t, p, v, added=None):
        """By name (lanes, size), of t (lanes,), p (lanes, nq), v (lanes, nv)."""
        pivots = self.closed_form.order[i].solves + self.nv - self.m
        return self._called(i, "accelerate", (t, p, v, added if self.m else None), {
            "pdot": self.nq, "vdot": self.nv, "lambda": self.m, "power": 1, "pivots": pivots})

    def correct(self, i, t, p, v):
        return self._called(i, "correct", (t, p, v), {"Phi": self.mh, "dp": self.nq, "dv": self.nv})

    def all(self, i, t, p, v, added):
        found = self.accelerate(i, t, p, v, added)
        found |= {f"{name} with nothing added": value for name, value in self.accelerate(i, t, p, v).items()}
        return found | (self.correct(i, t, p, v) if self.m else {})


def closed_form_sets(system):
    """Closed-form functions of any system by unit and lanes, (nq, nv, mh, m), its data and its start."""
    if hasattr(system, "_closed_form"):
        known = [f"ZD_SET_{name}" for of, name in SETS.items() if of[0] <= UNIT]
        closed_form = system._closed_form[1] if hasattr(system, "_written") else system._closed_form
        library = closed_form.library_of("|".join(known), QUICKLY)
        table = ffi.cast("const zd_closed_form *", gateway.address_of(library, "zd_symbolic_closed_form"))
        rows = [table[i] for i in range(len(known))]
        data = (doubles_of(system._written, closed_form, library) if hasattr(system, "_written") else
                system._with_closed_form_data(library, closed_form))
    else:
        c, kind = system._core.c, gateway.kinds()[system.name].c
        rows = [c.closed_form[i] for i in range(c.closed_forms)]
        data = np.frombuffer(ffi.buffer(ffi.cast("double *", c.data), 8 * kind.constants)).copy()
    sizes = system.nq, system.nv, system._core.c.mh, system.m
    return {(row.unit, row.lanes): row for row in rows}, sizes, data, system.p0


def sets_by_programs(system):
    """The same as programs, of a symbolic system or a mechanism; the last is what they refer to."""
    is_mechanism = hasattr(system, "_written")
    closed_form = system._closed_form[1] if is_mechanism else system._closed_form
    sizes = system.nq, system.nv, system._core.c.mh, system.m
    found, orders = closed_form.programs
    rows, keep = programs.closed_forms(found, orders, (*sizes[:3], sizes[3] - sizes[2]), embeds=False)
    data = programs.constants(found, system._written._values if is_mechanism else system._values)
    return {(row.unit, row.lanes): row for row in rows if row.unit <= UNIT}, sizes, data, system.p0, (rows, keep)


def doubles_of(written, closed_form, library):
    """Data of the compiled functions of a mechanism: its numbers, and constants derived from these."""
    doubles = np.concatenate([written._values, np.zeros(written._code.constants + closed_form.constants + 1)])
    for fill in (written._library.zd_symbolic_constants, library.zd_symbolic_closed_form_constants):
        fill(ctypes.c_void_p(doubles.ctypes.data))
    return doubles
