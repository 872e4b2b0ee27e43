"""Batches: many runs in one call of the core, with tables of the data that differ between them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...errors import NoMemory
from ..core import ffi, lib
from .base import ERRORS, MESSAGE_SIZE, doubles, text
from .callbacks import Watcher
from .records import COUNTS
from .runs import NAMES_AND_KINDS
from .systems import CoreSystem, Kind

STATISTICS = np.dtype([(name, {"int64_t": np.int64, "double": float}[kind]) for name, kind in NAMES_AND_KINDS.items()])
NOT_BEGUN, BY_ITSELF, IN_LANES, UNUSUAL = lib.ZD_NOT_BEGUN, lib.ZD_BY_ITSELF, lib.ZD_IN_LANES, lib.ZD_UNUSUAL


class Stop:
    """Flag that requests runs in other threads to stop."""

    def __init__(self) -> None:
        self.c = ffi.new("int *")

    def set(self) -> None:
        self.c[0] = 1

    def __call__(self) -> bool:
        return self.c[0] != 0


class Assembly(NamedTuple):
    """Settings for making starts consistent: a `zd_settings`, and indices of held coordinates and velocities."""

    settings: Any
    hold_p: list[int]
    hold_v: list[int]


class Happened(NamedTuple):
    """Times and states of the events of k runs: the first occurrences of each event, up to `room`."""

    counts: np.ndarray      # (k, events): number of occurrences
    t: np.ndarray           # (k, events, room)
    p: np.ndarray | None    # (k, events, room, nq); None: not wanted
    v: np.ndarray | None    # (k, events, room, nv)

    def of(self, run: int) -> tuple[tuple[np.ndarray, ...], ...]:
        """Occurrences in one run: for each event t (n,), and p (n, nq) and v (n, nv) if requested."""
        return tuple(tuple(np.array(where[run, event, :count]) for event, count in enumerate(self.counts[run].tolist()))
                     for where in (self.t, self.p, self.v) if where is not None)


class BatchResults(NamedTuple):
    """Results of k runs."""

    columns: dict[str, np.ndarray]      # "t" (k, samples), "p" (k, samples, nq), and so on: requested ones
    samples: np.ndarray                 # (k,): number of samples of each run
    status: np.ndarray                  # (k,): of the core
    way: np.ndarray                     # (k,): way in which each run was computed
    statistics: np.ndarray              # (k,): counts of the core
    kinetic: np.ndarray                 # (k,): the largest energy seen, J
    energy_error: np.ndarray            # (k,): maximum |Psi_E| over the samples, J
    measured: dict[str, np.ndarray]     # (k,): quantities of `MEASURED`, of runs with settings of their own
    events: Happened | None             # where events were looked for
    messages: list[str]                 # (k,): of those that did not reach their end


MEASURED = ("omega_h", "position_violation", "velocity_violation", "seconds")   # the largest of each run, and the time it took
# Of each run: where the core writes it, and as what
OF_RUNS = {"samples": np.int64, "status": np.intc, "way": np.intc, "statistics": STATISTICS, "kinetic": float,
           "energy_error": float}
TYPES = {"samples": "int64_t[]", "status": "int[]", "way": "int[]", "statistics": "zd_statistics[]", "kinetic": "double[]",
         "energy_error": "double[]"}


def run_batch(tables: Any, settings: Any, k: int, capacity: int, wanted: tuple[str, ...], assembly: Assembly | None = None,
              stop: Stop | None = None, *, lanes: bool = True, outputs: Any = None, events: Watcher | None = None,
              room: int = 0, inputs: Any = None) -> BatchResults:
    """Execute k runs of systems with the numbers and starts of `tables`, a `NumberTables`.

    `settings` is one `zd_settings` for all runs, or a list with one per run; runs of a list do not use SIMD lanes, and are
    measured. Events must be evaluated by the core. Up to `room` occurrences of each are stored, with their states if "p" is
    requested. They set `inputs`, of a system of this call alone, in SIMD lanes; other runs are left to the caller.

    If their data is None, all runs use the data of the core: `size` doubles, or other data if `size` is 0. With a `family` each
    run has its own system, and computes its start if p0 is None. `outputs` are recorded measures. The interpreter lock is
    released during the call. The system must not be written in Python.
    """
    core, data, size, p0, v0, _, family = tables
    shapes = {"p": (core.nq,), "v": (core.nv,), "multipliers": (core.m,), "outputs": (outputs.width if outputs else 0,)}
    columns = {name: np.zeros((k, capacity, *shapes.get(name, ())), np.intc if name in COUNTS else float)
               for name in wanted}
    of_runs = {name: np.zeros(k, kind) for name, kind in OF_RUNS.items()}
    messages = np.empty((k, MESSAGE_SIZE), np.int8)
    several = settings if isinstance(settings, list) else [settings]
    found = {name: np.zeros(k) for name in MEASURED} if several is settings else {}
    happened = None if events is None else _room_for(events, core, k, room, with_states="p" in wanted)
    own = ffi.new("zd_settings[]", [each[0] for each in several])
    for each in own:
        each.given_jacobian, each.events = core.given_jacobian, events.c if events is not None else ffi.NULL
        each.outputs, each.inputs = (given.c if given else ffi.NULL for given in (outputs, inputs))
    members: dict[str, Any] = {
        "system": core.c, "settings": own,
        "settings_differ": several is settings, "runs": k, "capacity": capacity, "message_size": MESSAGE_SIZE,
        "doubles": size, "lanes": lanes, **{name: doubles(array, k, writable=True) for name, array in found.items()},
        "message": ffi.from_buffer("char[]", messages),
        **{name: ffi.from_buffer("int[]" if array.dtype == np.intc else "double[]", array) for name, array in columns.items()},
        **{name: ffi.from_buffer(TYPES[name], array) for name, array in of_runs.items()}}
    if happened is not None:
        members |= {"events_capacity": room, "found": ffi.from_buffer("int64_t[]", happened.counts),
                    **{f"{name}_events": ffi.from_buffer("double[]", array) for name in ("t", "p", "v")
                       if (array := getattr(happened, name)) is not None}}
    if p0 is not None:
        members |= {"p0": doubles(p0, k * core.nq), "v0": doubles(v0, k * core.nv)}
    if family is not None:
        members |= {"family": family.c}
    if data is not None:
        members |= {"data": doubles(data, data.size)}
    if assembly is not None:
        members |= {"assembly": assembly.settings, "hold_p": ffi.new("int[]", assembly.hold_p),
                    "hold_v": ffi.new("int[]", assembly.hold_v)}
    if stop is not None:
        members["stop"] = stop.c
    if lib.zd_batch_run(ffi.new("zd_batch *", members)):
        raise NoMemory(f"the {capacity} samples of a run must fit into memory, and do not")
    said = [""] * k
    for run in np.flatnonzero(of_runs["status"]).tolist():
        said[run] = messages[run].tobytes().partition(b"\0")[0].decode()
    return BatchResults(columns, **of_runs, measured=found, events=happened, messages=said)


def _room_for(events: Watcher, core: CoreSystem, k: int, room: int, *, with_states: bool) -> Happened:
    count = len(events.events)
    p, v = (np.zeros((k, count, room, size)) if with_states else None for size in (core.nq, core.nv))
    return Happened(np.zeros((k, count), np.int64), np.zeros((k, count, room)), p, v)


def error_name(status: int) -> str:
    """Name of the exception for a failed status."""
    return ERRORS[status].__name__


def tables_of_kind(kind: Kind, parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, dict[int, str]]:
    """Data and starts of many systems of a kind, from parameters (k, parameters), and error messages of invalid ones."""
    k, system = len(parameters), kind.c.system
    data, p0, v0 = np.empty((k, max(1, kind.c.constants))), np.full((k, system.nq), np.nan), np.full((k, system.nv), np.nan)
    reason, refused, first = ffi.new("const char **"), {}, 0
    while first < k:
        memory = [doubles(part, part.size, writable=part is not parameters)
                  for part in (each[first:] for each in (parameters, data, p0, v0))]
        first += lib.zd_batch_of_kind(kind.c, k - first, *memory, reason)
        if reason[0]:
            refused[first] = text(reason[0])
            first += 1
    return data, p0, v0, refused


def derive(address: int, data: np.ndarray) -> None:
    """Call a compiled function for each row of data (k, doubles)."""
    lib.zd_batch_derive(ffi.cast("void(*)(double *)", address), *data.shape, doubles(data, data.size, writable=True))


def has_lanes(unit: str) -> bool:
    """True if the core was compiled with SIMD lanes for this vector unit."""
    return bool(lib.zd_lanes_of_unit({"baseline": lib.ZD_BASELINE, "avx2": lib.ZD_AVX2, "avx512": lib.ZD_AVX512}[unit]))
