"""Runs, their records, and the same operations outside a run."""

from __future__ import annotations

import collections
import functools
import itertools
import math
import struct
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from .._core import ffi, lib
from ..errors import NoMemory
from .base import CALLBACK, MESSAGE_SIZE, doubles, error_of, row_named, strided_doubles, text
from .callbacks import Watcher
from .inputs import Inputs
from .measures import Outputs
from .systems import CoreSystem

# Types that every run needs: their names are read once.
SETTINGS, RECORD, DOUBLES, INTEGERS = map(ffi.typeof, ("zd_settings *", "zd_record *", "double[]", "int *"))
MESSAGE = ffi.typeof(f"char[{MESSAGE_SIZE}]")


def settings(members: dict[str, Any], like: Any = None) -> Any:
    """A `zd_settings` from its members, the others as in `like`; an array `t_eval` has to outlive it.

    What is given of rows are their numbers, of corrections by their names.
    """
    made, t_eval = ffi.new(SETTINGS, like[0] if like else None), None
    for name, value in members.items():
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


def takes_closed_form(core: CoreSystem, settings: Any) -> bool:
    """True if a run of this system with these settings uses closed-form functions, if the system has them."""
    return bool(lib.zd_takes_closed_form(settings) and lib.zd_may_have_closed_form(core.c, settings))


def disagreement(settings: Any) -> str:
    """Reason why formulation, integrator and corrections of these settings exclude each other; empty if they do not."""
    message = ffi.new(MESSAGE)
    return text(message) if lib.zd_check_methods_agree(settings, message, MESSAGE_SIZE) else ""


def takes_series(settings: Any) -> bool:
    """True if the integrator of these settings uses the Taylor series of the system."""
    return bool(lib.zd_takes_series(settings))


def takes_jacobian(settings: Any) -> bool:
    """True if the integrator of these settings uses the Jacobian of the system's rates, if the system has one."""
    return bool(lib.zd_takes_jacobian(settings))


def row_takes_series(integrator: int) -> bool:
    """True if an entry of the table of integrators uses the Taylor series of a system."""
    return takes_series(settings({"integrator": integrator}))


def takes_embeddings(settings: Any) -> bool:
    """True if the closed-form functions of these settings are those in independent velocities."""
    return bool(lib.zd_takes_embeddings(settings))


def lanes_serve(core: CoreSystem, settings: Any) -> bool:
    """True if SIMD lanes can make runs of this system with these settings, if it has closed-form functions for them."""
    return settings.steps == lib.ZD_FIXED_STEPS and bool(lib.zd_lanes_serve_settings(core.c, settings))


def closed_form_unit(core: CoreSystem, settings: Any) -> int | None:
    """Number of the vector unit whose closed-form functions a run of this system uses; None if it uses none."""
    unit = lib.zd_closed_form_unit(core.c, settings)
    return unit if unit >= 0 else None


def count_steps(t0: float, t1: float, step: float) -> int:
    """Steps from t0 to t1."""
    return int(lib.zd_count_steps(t0, t1, step))


COUNTS = ("iterations", "energy_skipped")     # the integers of a row
NAMES_AND_KINDS = {name: field.type.cname for name, field in ffi.typeof("zd_statistics").fields}
Statistics = collections.namedtuple("Statistics", NAMES_AND_KINDS)
_unpacked = struct.Struct("".join({"int64_t": "q", "double": "d"}[kind] for kind in NAMES_AND_KINDS.values())).unpack


class _Layout(NamedTuple):
    """Layout of the columns of a record in one array, one after the other; counts are last, two per double."""

    shapes: dict[str, tuple[int, ...]]      # of a sample's numbers
    starts: dict[str, int]                  # doubles of a sample before those of this column
    width: int                              # doubles of a sample


@functools.lru_cache
def _layout(nq: int, nv: int, mh: int, m: int, has_energy: bool, outputs: int | None) -> _Layout:
    energies = {"potential": (), "input": (), "energy_violation": ()} if has_energy else {}
    shapes = {"t": (), "p": (nq,), "v": (nv,), "multipliers": (m,), "position_violation": (mh,), "velocity_violation": (m,),
              "kinetic": (), **energies, **({} if outputs is None else {"outputs": (outputs,)})}
    ends = list(itertools.accumulate(map(math.prod, shapes.values()), initial=0))
    return _Layout(shapes, dict(zip(shapes, ends, strict=False)), ends[-1] + 1)


def row_bytes(core: CoreSystem, outputs: Outputs | None = None) -> int:
    """Bytes of a sample of the record."""
    return 8 * _layout_of(core, outputs).width


def _layout_of(core: CoreSystem, outputs: Outputs | None) -> _Layout:
    return _layout(core.nq, core.nv, core.mh, core.m, core.has_energy, outputs.width if outputs else None)


class Record:
    """The arrays a run writes into, one row per saved instant: a block of them, and further ones as long as they are needed.

    The columns of the first block are views of one array, which takes a fraction of the time of as many arrays: most runs are
    short, and need no other. Those of further blocks are arrays of their own, which can be let go one by one.
    """

    def __init__(self, core: CoreSystem, capacity: int, outputs: Outputs | None = None) -> None:
        self._layout = _layout_of(core, outputs)
        self._memory = self._taken(capacity, np.empty, self._layout.width * capacity)
        c = self.c = self._first = ffi.new(RECORD)
        self._further: list[tuple[Any, dict[str, np.ndarray]]] = []
        self._joined: dict[str, np.ndarray] = {}
        c.capacity, start = capacity, ffi.from_buffer(DOUBLES, self._memory)
        for name, doubles_before in self._layout.starts.items():
            setattr(c, name, start + doubles_before * capacity)
        c.iterations = ffi.cast(INTEGERS, start + (self._layout.width - 1) * capacity)
        c.energy_skipped = c.iterations + capacity

    def _taken(self, capacity: int, take: Callable[..., Any], *given: Any) -> Any:
        """Allocate memory for this number of samples."""
        try:
            return take(*given)
        except (MemoryError, ValueError):
            size = capacity * (self._layout.width - 0.5) * 8 / 2**30
            raise NoMemory(f"{capacity} samples need {size:.3g} GiB; save fewer with save_every, or write them to a file "
                              "with save_to") from None

    def keep(self) -> None:
        """Do nothing, as the samples are in memory already."""

    def grow(self) -> None:
        """Add a block as large as all blocks before it."""
        capacity = self.next_rows
        columns = self._taken(capacity, self._columns, capacity)
        c = self.c = ffi.new(RECORD, {"capacity": capacity})
        for name, array in columns.items():
            setattr(c, name, ffi.from_buffer("int[]" if name in COUNTS else "double[]", array, require_writable=True))
        self._further.append((c, columns))

    def _columns(self, capacity: int) -> dict[str, np.ndarray]:
        # One expression: where memory ends within it, the traceback keeps nothing of what was taken.
        shapes = self._layout.shapes
        return {name: np.empty((capacity, *shapes.get(name, ())), np.intc if name in COUNTS else float)
                for name in (*shapes, *COUNTS)}

    def take(self) -> dict[str, np.ndarray]:
        """Samples written so far."""
        return self._joined or self._of_first()

    @property
    def row_bytes(self) -> int:
        """Bytes of one sample."""
        return 8 * self._layout.width

    @property
    def next_rows(self) -> int:
        """Number of samples for which `grow` allocates memory."""
        return self._first.capacity + sum(c.capacity for c, _ in self._further)

    @property
    def columns(self) -> dict[str, tuple[int, tuple[int, ...]]]:
        """Offset and shape of each column in a sample, except the counts."""
        return {name: (self._layout.starts[name], shape) for name, shape in self._layout.shapes.items()}

    def pack(self) -> np.ndarray:
        """Remove and return the samples of the first block (samples, width), the counts as two integers in the last column."""
        columns = self._of_first()
        packed = np.empty((self._first.rows, self._layout.width))
        for name, (start, shape) in self.columns.items():
            width = math.prod(shape)
            packed[:, start:start + width] = columns[name].reshape(len(packed), width)
        packed.view(np.intc)[:, -2:] = np.column_stack([columns[name] for name in COUNTS])
        self._first.rows = 0
        return packed

    def _of_first(self) -> dict[str, np.ndarray]:
        """The columns of the first block."""
        rows, capacity, memory = self._first.rows, self._first.capacity, self._memory
        columns = {name: memory[start * capacity:start * capacity + rows * math.prod(shape)].reshape(rows, *shape)
                   for (name, start), shape in zip(self._layout.starts.items(), self._layout.shapes.values(), strict=True)}
        counts = memory[(self._layout.width - 1) * capacity:].view(np.intc)
        return columns | {"iterations": counts[:rows], "energy_skipped": counts[capacity:capacity + rows]}

    def snapshot(self) -> Snapshot:
        """Copy of the samples so far, for a run that goes on recording."""
        first = self._of_first()
        return Snapshot({name: np.concatenate([column, *(columns[name][: c.rows] for c, columns in self._further)])
                         for name, column in first.items()})

    def join(self) -> None:
        """Join the blocks column by column, releasing the joined parts, as memory may be short."""
        if not self._further:
            return
        for name, first in self._of_first().items():
            self._joined[name] = np.concatenate([first, *(columns[name][: c.rows] for c, columns in self._further)])
            for _, columns in self._further:
                del columns[name]
        self._further.clear()


class Snapshot(NamedTuple):
    """Samples of a run by name, as `Record` gives them."""

    columns: dict[str, np.ndarray]

    def join(self) -> None:
        """Do nothing, as there is one block."""

    def take(self) -> dict[str, np.ndarray]:
        """The samples."""
        return self.columns


class Results(NamedTuple):
    """Results of a run, without its samples."""

    statistics: Any         # counts of the core
    omega_h: float          # maximum over the run
    largest_kinetic: float  # J
    energy_error: float     # J: maximum |Psi_E| over the samples
    redundant: list[int]    # constraints that are redundant in all positions
    phi_sizes: bytes     # of its rows (mh,), as doubles

    def as_stats(self) -> dict[str, Any]:
        """Entries of `Solution.stats`."""
        return {**self.statistics._asdict(), "omega_h": self.omega_h, "largest_kinetic": self.largest_kinetic,
                "redundant": self.redundant}

    @property
    def sizes(self) -> np.ndarray:
        """Characteristic sizes of the position constraints (mh,)."""
        return np.ndarray(len(self.phi_sizes) // 8, float, self.phi_sizes)


class Saved(NamedTuple):
    """The state of a run, and the text that identifies its system and the core: the first 63 characters count."""

    state: bytes
    fingerprint: str


class Run:
    """A run of the core, from a start, or from a saved state (then p0 and v0 are ignored)."""

    def __init__(self, core: CoreSystem, settings: Any, p0: np.ndarray, v0: np.ndarray, watcher: Watcher | None = None,
                 outputs: Outputs | None = None, inputs: Inputs | None = None,
                 saved: Saved | None = None) -> None:
        self._core = core = core if inputs else core.for_run()      # with inputs, it is this run's own already
        self.inputs = inputs
        self._watcher, self._outputs = watcher, outputs
        settings.given_jacobian = core.given_jacobian
        if watcher:
            settings.events = watcher.c
        if outputs:
            settings.outputs = outputs.c
        settings.inputs = inputs.c if inputs else ffi.NULL
        status, message = ffi.new(INTEGERS), ffi.new(MESSAGE)
        if saved:
            run = lib.zd_state_restore(core.c, settings, ffi.from_buffer(saved.state), len(saved.state),
                                       saved.fingerprint.encode(), status, message, MESSAGE_SIZE)
        else:
            run = lib.zd_run_create(core.c, settings, doubles(p0, core.nq), doubles(v0, core.nv), status, message, MESSAGE_SIZE)
        if not run:
            raise self._raised or error_of(status[0], text(message))
        self._run = ffi.gc(run, lib.zd_run_free)

    def begin_saving(self, p0: np.ndarray, v0: np.ndarray) -> None:
        """Allows `save`: called before the first step of a run from this start."""
        status = lib.zd_state_begin(self._run, doubles(p0, self._core.nq), doubles(v0, self._core.nv))
        if status:
            raise error_of(status, "there is no memory for the state of a run")

    def save(self, fingerprint: str) -> Saved:
        """State of the run; requires `begin_saving`, or a run created from a saved state."""
        memory = bytearray(lib.zd_state_size(self._run))
        lib.zd_state_save(self._run, fingerprint.encode(), ffi.from_buffer(memory, require_writable=True))
        return Saved(bytes(memory), fingerprint)

    def advance(self, record: Record | None, seconds: float) -> int:
        """Make steps for about `seconds`; return the status. The interpreter lock is released meanwhile."""
        return lib.zd_run_advance(self._run, ffi.NULL if record is None else record.c, seconds)

    def record_states(self, record: Record, columns: Mapping[str, np.ndarray]) -> None:
        """Record samples with given "t" (k,), "p", "v" and "input" (k,); the run cannot be continued afterwards."""
        given = (doubles(columns[name], columns[name].size) for name in ("t", "p", "v", "input"))
        status = lib.zd_run_record_states(self._run, len(columns["t"]), *given, record.c)
        if status:
            raise self.error(status)

    def error(self, status: int) -> BaseException:
        """Exception of a failed status: the one raised in Python, or one of this package."""
        raised = self._raised
        is_past = status != CALLBACK and raised is not None and raised is getattr(self._core, "refusal", None)
        return error_of(status, self.message) if raised is None or is_past else raised

    @property
    def _raised(self) -> BaseException | None:
        return (self._watcher and self._watcher.error) or (self._outputs and self._outputs.error) or self._core.error

    @property
    def has_raised(self) -> bool:
        """True if an exception in Python stopped the run."""
        return self._raised is not None

    @property
    def notes(self) -> Sequence[str]:
        """Notes on the exception: the function of the system that raised it."""
        return getattr(self._core.error, "__notes__", ())

    @property
    def progress(self) -> float:
        """Completed fraction, 0 to 1."""
        return lib.zd_run_progress(self._run)

    @property
    def message(self) -> str:
        """One sentence on the first failure or the refused input."""
        refused = self.inputs.refused() if self.inputs else ""
        return text(lib.zd_run_message(self._run)) or (refused and f"at t = {lib.zd_run_time(self._run):g}: {refused}")

    def _redundant(self, rank: int) -> list[int]:
        """Indices of constraints that are redundant in all positions."""
        if rank == self._core.m:
            return []
        rows = ffi.new("int[]", self._core.m)
        return list(rows[0:lib.zd_run_redundant(self._run, rows)])

    def place(self) -> tuple[float, np.ndarray, np.ndarray]:
        """Time in s, p (nq,) and v (nv,) that the run has reached; copies."""
        run, sizes = self._run, (8 * self._core.nq, 8 * self._core.nv)
        p, v = (np.frombuffer(ffi.buffer(at, size)[:])
                for at, size in zip((lib.zd_run_p(run), lib.zd_run_v(run)), sizes, strict=True))
        return lib.zd_run_time(run), p, v

    def results(self) -> Results:
        """Results of the run so far, without its samples."""
        run, size = self._run, 8 * self._core.mh
        statistics = Statistics._make(_unpacked(ffi.buffer(lib.zd_run_statistics(run))))
        return Results(statistics, lib.zd_run_omega_h(run), lib.zd_run_kinetic(run), lib.zd_run_energy_error(run),
                       self._redundant(statistics.rank), ffi.buffer(lib.zd_run_sizes(run), size)[:] if size else b"")


def _columns(columns: dict[str, tuple[np.ndarray, int]]) -> tuple[dict[str, Any], int]:
    """Pointers to columns with `count` entries, and their stride (0: contiguous). Columns of a file are read in place."""
    strides = {array.strides[0] for array, _ in columns.values()}
    if len(strides) == 1 and not all(array.flags.c_contiguous for array, _ in columns.values()):
        return {name: strided_doubles(array, size) for name, (array, size) in columns.items()}, strides.pop() // 8
    return {name: doubles(np.ascontiguousarray(array), size) for name, (array, size) in columns.items()}, 0


def states_between(core: CoreSystem, settings: Any, t: np.ndarray, p: np.ndarray, v: np.ndarray, energy_input: np.ndarray | None,
                   ends_in_event: bool, times: np.ndarray, *, is_own: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """`zd_states_between`: p (k, nq) and v (k, nv) at times (k,) between the samples t, p, v of a run.

    is_own: the system's data belong to the caller.
    """
    core, message, rows, count = core if is_own else core.for_run(), ffi.new("char[]", MESSAGE_SIZE), len(t), len(times)
    columns = {"t": (t, rows), "p": (p, rows * core.nq), "v": (v, rows * core.nv)}
    if energy_input is not None:
        columns["input"] = energy_input, rows
    memory, stride = _columns(columns)
    saved = ffi.new("zd_saved *", {"rows": rows, "ends_in_event": ends_in_event, "stride": stride, **memory})
    found_p, found_v = np.empty((count, core.nq)), np.empty((count, core.nv))
    found = doubles(found_p, count * core.nq, writable=True), doubles(found_v, count * core.nv, writable=True)
    status = lib.zd_states_between(core.c, settings, saved, count, doubles(times, count), *found, message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return found_p, found_v


def acceleration(core: CoreSystem, formulation: int, on_singular: int, t: float, p: np.ndarray,
                 v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`zd_acceleration`: vdot (nv,) and multipliers (m,)."""
    core = core.for_run()
    vdot, multipliers, message = np.empty(core.nv), np.empty(core.m), ffi.new("char[]", MESSAGE_SIZE)
    status = lib.zd_acceleration(core.c, formulation, on_singular, t, doubles(p, core.nq), doubles(v, core.nv),
                                 doubles(vdot, core.nv, writable=True), doubles(multipliers, core.m, writable=True),
                                 ffi.NULL, message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return vdot, multipliers


def accelerations(core: CoreSystem, formulation: int, on_singular: int, t: np.ndarray, p: np.ndarray,
                  v: np.ndarray, *, is_own: bool = False, are_deficient: np.ndarray | None = None) -> np.ndarray:
    """`zd_accelerations`: vdot (k, nv) at t (k,), p (k, nq), v (k, nv).

    is_own: the system's data belong to the caller. are_deficient (k,) of intc <- 1 where some constraints depend on others.
    """
    core, k = core if is_own else core.for_run(), len(t)
    vdot, multipliers, message = np.empty((k, core.nv)), np.empty((k, core.m)), ffi.new("char[]", MESSAGE_SIZE)
    flags = np.zeros(k, dtype=np.intc) if are_deficient is None else are_deficient
    status = lib.zd_accelerations(core.c, formulation, on_singular, k, doubles(t, k), doubles(p, p.size), doubles(v, v.size),
                                  doubles(vdot, vdot.size, writable=True), doubles(multipliers, multipliers.size, writable=True),
                                  ffi.from_buffer("int[]", flags, require_writable=True), message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return vdot


def project(core: CoreSystem, settings: Any, t: float, p: np.ndarray, v: np.ndarray,
            hold_p: list[int] | None = None, hold_v: list[int] | None = None) -> int:
    """`zd_project`: corrects p and v in place; the number of iterations."""
    core = core.for_run()
    iterations, message = ffi.new("int *"), ffi.new("char[]", MESSAGE_SIZE)
    held = [ffi.NULL if hold is None else ffi.new("int[]", hold) for hold in (hold_p, hold_v)]
    status = lib.zd_project(core.c, settings, t, doubles(p, core.nq, writable=True), doubles(v, core.nv, writable=True),
                            *held, iterations, message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return iterations[0]
