"""Measures: named functions of the motion that a system of the core provides, evaluated at saved states."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...errors import WrongValue
from ..core import ffi, lib
from .base import doubles, text

MAX_LEAST = lib.ZD_MAX_LEAST     # constraints: with more of them, reactions are not the least ones
PARTS = ("value", "rate", "row", "bias")        # in the order of zd_measured
DEPENDS = {lib.ZD_OF_POSITIONS: "positions", lib.ZD_OF_VELOCITIES: "velocities", lib.ZD_OF_ACCELERATIONS: "accelerations"}


class Named(NamedTuple):
    """A measure by its name, its unit and the number of its components."""

    name: str
    unit: str
    size: int


class Acting:
    """Efforts (k, n) at k states along n components of measures: index and component of each, and the joint it acts in, or -1."""

    def __init__(self, along: Sequence[tuple[int, ...]], efforts: np.ndarray) -> None:
        self._along, self._efforts = ffi.new("int[]", list(sum(along, ()))), np.ascontiguousarray(efforts)
        self.c = ffi.new("zd_efforts[]", [(len(along), self._along, doubles(each, each.size)) for each in self._efforts])


class Measuring:
    """Measures of a `CoreSystem`, identified by their indices."""

    c: Any
    nq: int
    nv: int
    m: int
    functions: Any      # these, as of `CoreSystem`
    read_given: Any
    for_run: Any
    initial_inputs: Any
    error: Any

    @functools.cached_property
    def measures(self) -> tuple[Any, ...]:
        """All measures by name; may be empty."""
        all_of = self.c.measures
        rows = [all_of.measure[i] for i in range(all_of.count)] if all_of else []
        return tuple(Named(text(row.name), text(row.unit), row.size) for row in rows)

    def measure_size(self, index: int) -> int:
        """Number of components of a measure."""
        return self.c.measures.measure[index].size

    def joint_of(self, _index: int) -> int:
        """Index of the joint whose coordinate, or its speed, a measure is; -1: none."""
        return -1

    def needs_reactions(self, index: int) -> bool:
        """True for a measure that a motion alone does not determine: of forces, which depend on what drives it."""
        return self.measures[index].unit in ("N", "N m", "W")

    def measure_depends(self, index: int) -> str:
        """Highest derivative that a measure depends on: "positions", "velocities" or "accelerations"."""
        return DEPENDS[self.c.measures.measure[index].depends]

    def measure(self, index: int, t: np.ndarray, p: np.ndarray, v: np.ndarray, vdot: np.ndarray | None = None,
                multipliers: np.ndarray | None = None, *, is_own: bool = False, wanted: str = "value",
                is_least: bool = False, acting: Acting | None = None) -> np.ndarray:
        """A measure at many states: t (k,), p (k, nq), v (k, nv), vdot (k, nv), multipliers (k, m) give values (k, size).

        vdot and multipliers may be None where the measure depends on positions or velocities alone (`measure_depends`).
        is_own: the system's data belong to the caller. wanted: "value"; "least", multipliers (k, m) of the least reactions; or
        "redundant", changes (k, size, m) by redundant multipliers, relative to the norm of those of all wrenches. is_least:
        the multipliers given are those of the least reactions. acting: efforts besides the forces of the system.
        """
        core, k, size = self if is_own else self.for_run(), len(t), self.measure_size(index)
        values = np.zeros((k, size, self.m) if wanted == "redundant" else (k, size))
        if wanted == "least":
            values = np.array(multipliers)
        out = ffi.new("zd_measured *", {wanted: doubles(values, values.size, writable=True), "is_least": is_least,
                                        "efforts": acting.c if acting else ffi.NULL})
        inputs = core.initial_inputs()
        if self.functions and vdot is not None and wanted != "redundant":
            u = core.read_given(t, p, v, vdot, np.zeros((k, 0)) if multipliers is None else multipliers, acting=acting,
                                is_own=True)
            inputs = doubles(u, u.size)
        core._measure((index,), inputs, (t, p, v), out, given(vdot, k * self.nv), given(multipliers, k * self.m))
        return values

    def measure_at(self, index: int, t: float, p: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """Value (size,), rate (size,), row (size, nv), bias (size,) of a measure of positions or velocities."""
        return {name: array[0] for name, array in self.measure_rates((index,), np.array([float(t)]), p, v).items()}

    def measure_rates(self, indices: Sequence[int], t: np.ndarray, p: np.ndarray, v: np.ndarray,
                      parts: Sequence[str] = PARTS) -> dict[str, np.ndarray]:
        """Values of several measures, stacked, at many states: (k, size), rates, rows (k, size, nv): the parts wanted."""
        core, k, size = self.for_run(), len(t), sum(self.measure_size(index) for index in indices)
        arrays = {part: np.empty((k, size, self.nv)) if part == "row" else np.zeros((k, size)) for part in parts}
        out = ffi.new("zd_measured *", [doubles(arrays[part], arrays[part].size, writable=True) if part in arrays else ffi.NULL
                                        for part in PARTS])
        core._measure(indices, core.initial_inputs(), (t, p, v), out)
        return arrays

    def _measure(self, indices: Sequence[int], inputs: Any, states: tuple[np.ndarray, ...], out: Any, vdot: Any = ffi.NULL,
                 multipliers: Any = ffi.NULL) -> None:
        """`zd_measure_states` of the system for one run."""
        k, which, scratch = len(states[0]), ffi.new("int[]", indices), ffi.new("double[]", max(1, self.c.measures.scratch))
        at = [doubles(each, k * size) for each, size in zip(states, (1, self.nq, self.nv), strict=True)]
        if lib.zd_measure_states(self.c, inputs, len(which), which, k, *at, vdot, multipliers, out, scratch):
            raise self.error or WrongValue(f"measure {text(self.c.measures.measure[indices[0]].name)} needs accelerations and "
                                           "multipliers", "not-available")


class Outputs:
    """Measures that a run records: their numbers, of the system that is run, or of one with the same equations."""

    def __init__(self, measures: Sequence[int], of: Any, run: Any, *, is_own: bool = False) -> None:
        self._of, self.measures = None if of is run else of if is_own else of.for_run(), tuple(measures)
        self.sizes = tuple(of.measure_size(index) for index in self.measures)
        self.width = sum(self.sizes)
        self._numbers = ffi.new("int[]", self.measures)
        whose = self._of.c if self._of else ffi.NULL
        self.c = ffi.new("zd_outputs *", {"of": whose, "count": len(self.measures), "measure": self._numbers})

    @property
    def error(self) -> BaseException | None:
        """Exception raised while measures were recorded, except by the system that is run, which stores its own."""
        return self._of.error if self._of else None

    def split(self, rows: np.ndarray) -> list[np.ndarray]:
        """Arrays (k, size) of each measure, from the recorded samples (k, width)."""
        ends = np.cumsum(self.sizes)[:-1]
        parts = np.split(rows, ends, axis=1)
        return [np.ascontiguousarray(part) for part in parts] if rows.flags.c_contiguous else parts     # else they are in a file


def given(array: np.ndarray | None, size: int) -> Any:
    """Pointer to an optional array; NULL for None."""
    return ffi.NULL if array is None else doubles(array, size)
