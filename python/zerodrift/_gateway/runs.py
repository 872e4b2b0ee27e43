"""Runs, their records, and the same operations outside a run."""

from __future__ import annotations

import functools
import math
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np

from .._core import ffi, lib
from .base import MESSAGE_SIZE, doubles, error_of, row_named, text
from .callbacks import Watcher
from .measures import Outputs
from .systems import CoreSystem


def settings(options: dict[str, Any], like: Any = None) -> Any:
    """A `zd_settings` from its members, the others as in `like`; an array `t_eval` has to outlive it.

    What is given of rows are their numbers, of corrections by their names.
    """
    made, t_eval = ffi.new("zd_settings *", like[0] if like else None), None
    for name, value in options.items():
        if name == "t_eval":
            t_eval = value
        elif name == "correction":
            for correction, values in value.items():
                made.correction[row_named("corrections", correction)] = {"given": 1, "value": values}
        else:
            setattr(made, name, {"given": 1, "value": value} if name in ("of_formulation", "of_integrator") else value)
    if t_eval is not None:
        made.t_eval, made.t_evals = doubles(t_eval, t_eval.size), t_eval.size
    return made


def count_steps(t0: float, t1: float, step: float) -> int:
    """Steps from t0 to t1."""
    return int(lib.zd_count_steps(t0, t1, step))


COUNTS = ("iterations", "energy_skipped")     # the integers of a row
FIELDS = {name: field.type.cname for name, field in ffi.typeof("zd_statistics").fields}
STATISTICS = tuple(FIELDS)
_unpacked = struct.Struct("".join({"int64_t": "q", "double": "d"}[kind] for kind in FIELDS.values())).unpack


@functools.lru_cache
def _shapes(nq: int, nv: int, mh: int, m: int, has_energy: bool) -> dict[str, tuple[int, ...]]:
    """The shapes of a row's numbers."""
    energies = {"potential": (), "input": (), "energy_violation": ()} if has_energy else {}
    return {"t": (), "p": (nq,), "v": (nv,), "multipliers": (m,), "position_violation": (mh,), "velocity_violation": (m,),
            "kinetic": (), **energies}


class Record:
    """The arrays a run writes into, one row per saved instant: a block of them, and further ones as long as they are needed."""

    def __init__(self, core: CoreSystem, capacity: int, outputs: Outputs | None = None) -> None:
        self._shapes = _shapes(core.nq, core.nv, core.mh, core.m, core.has_energy)
        if outputs:
            self._shapes = self._shapes | {"outputs": (outputs.width,)}
        self._blocks: list[tuple[Any, dict[str, np.ndarray]]] = []
        self._add(capacity)

    def _add(self, capacity: int) -> None:
        try:
            columns = self._taken(capacity)
            counts = {name: np.empty(capacity, dtype=np.intc) for name in COUNTS}
        except (MemoryError, ValueError):
            columns = {}        # the traceback keeps this frame, but what it took is needed
            size = capacity * (sum(map(math.prod, self._shapes.values())) + 0.5) * 8 / 2**30
            raise MemoryError(f"{capacity} saved rows need {size:.3g} GiB; save fewer with save_every") from None
        c = self.c = ffi.new("zd_record *")
        c.capacity = capacity
        for name, array in columns.items():
            setattr(c, name, ffi.from_buffer("double[]", array, require_writable=True))
        for name, array in counts.items():
            setattr(c, name, ffi.from_buffer("int[]", array, require_writable=True))
        self._blocks.append((c, columns | counts))

    def _taken(self, capacity: int) -> dict[str, np.ndarray]:
        """Arrays for so many rows."""
        return {name: np.empty((capacity, *shape)) for name, shape in self._shapes.items()}

    def grow(self) -> None:
        """Go on in a block as large as all before it."""
        self._add(sum(c.capacity for c, _ in self._blocks))

    def take(self) -> dict[str, np.ndarray]:
        """The rows written so far. Several blocks are joined column by column and let go, as memory may be short."""
        if len(self._blocks) == 1:
            c, columns = self._blocks.pop()
            return columns if c.rows == c.capacity else {name: array[: c.rows] for name, array in columns.items()}
        return {name: self._joined(name) for name in (*self._shapes, *COUNTS)}

    def _joined(self, name: str) -> np.ndarray:
        parts = [columns[name][: c.rows] for c, columns in self._blocks]
        joined = np.concatenate(parts)
        for _, columns in self._blocks:
            del columns[name]
        return joined


class Run:
    """A run of the core."""

    def __init__(self, core: CoreSystem, options: Any, p0: np.ndarray, v0: np.ndarray, watcher: Watcher | None = None,
                 outputs: Outputs | None = None) -> None:
        self._core = core = core.for_run()
        self._watcher, self._outputs = watcher, outputs
        options.given_jacobian = core.given_jacobian
        if watcher:
            options.events = watcher.c
        if outputs:
            options.outputs = outputs.c
        status, message = ffi.new("int *"), ffi.new("char[]", MESSAGE_SIZE)
        run = lib.zd_run_create(core.c, options, doubles(p0, core.nq), doubles(v0, core.nv), status, message, MESSAGE_SIZE)
        if not run:
            raise self._raised or error_of(status[0], text(message))
        self._run = ffi.gc(run, lib.zd_run_free)

    def advance(self, record: Record, seconds: float) -> int:
        """Steps for about that long; the status. The interpreter is free for other threads meanwhile."""
        return lib.zd_run_advance(self._run, record.c, seconds)

    def error(self, status: int) -> BaseException:
        """The exception that stands for a failed status: what was raised in Python, or our own."""
        return self._raised or error_of(status, self.message)

    @property
    def _raised(self) -> BaseException | None:
        return self._core.error or (self._watcher and self._watcher.error) or (self._outputs and self._outputs.error)

    @property
    def notes(self) -> Sequence[str]:
        """Where in the system it was raised."""
        return getattr(self._core.error, "__notes__", ())

    @property
    def progress(self) -> float:
        """The part that is done, 0 ... 1."""
        return lib.zd_run_progress(self._run)

    @property
    def message(self) -> str:
        """The first failure, in one sentence."""
        return text(lib.zd_run_message(self._run))

    @property
    def redundant(self) -> list[int]:
        """The constraints that follow from others wherever the system goes."""
        rows = ffi.new("int[]", max(1, self._core.m))
        return list(rows[0:lib.zd_run_redundant(self._run, rows)])

    @property
    def statistics(self) -> dict[str, Any]:
        """Counts of what the run did, and its largest omega h."""
        c = lib.zd_run_statistics(self._run)
        return dict(zip(STATISTICS, _unpacked(ffi.buffer(c)), strict=True)) | {
            "omega_h": lib.zd_run_omega_h(self._run), "largest_kinetic": lib.zd_run_kinetic(self._run)}

    @property
    def sizes(self) -> np.ndarray:
        """The sizes of the rows of Phi (mh,)."""
        return np.array(ffi.unpack(lib.zd_run_sizes(self._run), self._core.mh) if self._core.mh else [], dtype=float)


def step(core: CoreSystem, options: Any, p: np.ndarray, v: np.ndarray) -> None:
    """`zd_step`: one corrected step, p and v in place."""
    core, message = core.for_run(), ffi.new("char[]", MESSAGE_SIZE)
    status = lib.zd_step(core.c, options, doubles(p, core.nq, writable=True), doubles(v, core.nv, writable=True), message,
                         MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))


def acceleration(core: CoreSystem, formulation: int, on_singular: int, t: float, p: np.ndarray,
                 v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`zd_acceleration`: vdot (nv,) and multipliers (m,)."""
    core = core.for_run()
    vdot, multipliers, message = np.empty(core.nv), np.empty(core.m), ffi.new("char[]", MESSAGE_SIZE)
    status = lib.zd_acceleration(core.c, formulation, on_singular, t, doubles(p, core.nq), doubles(v, core.nv),
                                 doubles(vdot, core.nv, writable=True), doubles(multipliers, core.m, writable=True),
                                 message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return vdot, multipliers


def accelerations(core: CoreSystem, formulation: int, on_singular: int, t: np.ndarray, p: np.ndarray,
                  v: np.ndarray) -> np.ndarray:
    """`zd_accelerations`: vdot (k, nv) at t (k,), p (k, nq), v (k, nv)."""
    core, k = core.for_run(), len(t)
    vdot, multipliers, message = np.empty((k, core.nv)), np.empty((k, core.m)), ffi.new("char[]", MESSAGE_SIZE)
    status = lib.zd_accelerations(core.c, formulation, on_singular, k, doubles(t, k), doubles(p, p.size), doubles(v, v.size),
                                  doubles(vdot, vdot.size, writable=True), doubles(multipliers, multipliers.size, writable=True),
                                  message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return vdot


def project(core: CoreSystem, options: Any, t: float, p: np.ndarray, v: np.ndarray,
            hold_p: list[int] | None = None, hold_v: list[int] | None = None) -> int:
    """`zd_project`: corrects p and v in place; the number of iterations."""
    core = core.for_run()
    iterations, message = ffi.new("int *"), ffi.new("char[]", MESSAGE_SIZE)
    held = [ffi.NULL if hold is None else ffi.new("int[]", hold) for hold in (hold_p, hold_v)]
    status = lib.zd_project(core.c, options, t, doubles(p, core.nq, writable=True), doubles(v, core.nv, writable=True),
                            *held, iterations, message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return iterations[0]
