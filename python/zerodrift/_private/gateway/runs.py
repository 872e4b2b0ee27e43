"""Runs: their settings, their steps and their results."""

from __future__ import annotations

import collections
import struct
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core import ffi, lib
from .base import CALLBACK, MESSAGE_SIZE, doubles, error_of, row_named, text
from .callbacks import Watcher
from .inputs import Inputs
from .measures import Outputs
from .records import Record
from .systems import CoreSystem

# Types that every run needs: their names are read once.
SETTINGS, INTEGERS, MESSAGE = map(ffi.typeof, ("zd_settings *", "int *", f"char[{MESSAGE_SIZE}]"))


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


NAMES_AND_KINDS = {name: field.type.cname for name, field in ffi.typeof("zd_statistics").fields}
_made: Any = collections.namedtuple
Statistics = _made("Statistics", NAMES_AND_KINDS)
_unpacked = struct.Struct("".join({"int64_t": "q", "double": "d"}[kind] for kind in NAMES_AND_KINDS.values())).unpack


class Results(NamedTuple):
    """Results of a run, without its samples."""

    statistics: Any         # counts of the core
    omega_h: float          # maximum over the run
    largest_kinetic: float  # J
    energy_error: float     # J: maximum |Psi_E| over the samples
    redundant: list[int]    # constraints that are redundant in all positions
    phi_sizes: bytes     # of its rows (mh,), as doubles
    calls: Mapping[str, float]      # s in each user function that was called

    def as_stats(self) -> dict[str, Any]:
        """Entries of `Solution.stats`."""
        return {**self.statistics._asdict(), "omega_h": self.omega_h, "largest_kinetic": self.largest_kinetic,
                "redundant": self.redundant, "calls": self.calls}

    @property
    def sizes(self) -> np.ndarray:
        """Characteristic sizes of the position constraints (mh,)."""
        return np.ndarray(len(self.phi_sizes) // 8, float, self.phi_sizes)


class Saved(NamedTuple):
    """The state of a run, and the text that identifies its system and the core: the first 63 characters count."""

    state: bytes
    fingerprint: str


class Run:
    """A run of the core, from a start, or from a saved state (then p0 and v0 are ignored).

    Attributes
    ----------
    transitions : list of (float, list of int, list of float, list of float)
        Time in s of the start and of each change of phase, and by group the state, the impulse in N s and the energy lost in J.
    jumped : list of (float, str, float)
        Time in s of each jump of the state, the name of what made it, and the change of the energy in J.
    """

    def __init__(self, core: CoreSystem, settings: Any, p0: np.ndarray, v0: np.ndarray, watcher: Watcher | None = None,
                 outputs: Outputs | None = None, inputs: Inputs | None = None,
                 saved: Saved | None = None) -> None:
        self._core = core = core if inputs else core.for_run()      # with inputs, it is this run's own already
        if settings.steps == lib.ZD_ADAPTIVE_STEPS and not settings.is_open and hasattr(core, "meet_breaks"):
            core.meet_breaks(settings.t0, settings.t1)
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
        self.jumped: list[tuple[float, str, float]] = []
        self._jumps = lib.zd_run_energy_jump(run).count
        self._changed = 0
        self.transitions: list[tuple[float, list[int], list[float], list[float]]] = []
        self._changes = lib.zd_run_transition(run)
        if self._note_changes() and saved:
            state, none = self.transitions[0][1], [0.0] * core.c.groups
            self.transitions = [(lib.zd_run_time(run), state, none, none)]

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
        status = lib.zd_run_advance(self._run, ffi.NULL if record is None else record.c, seconds)
        self.note_jump("" if self._note_changes() else "break")
        if record is None:
            del self.transitions[:-1]
        return status

    def _note_changes(self) -> bool:
        """Note the last change of phase in `transitions`, if it is new; return True if it is."""
        last = self._changes
        if not last or last.count == self._changed:
            return False
        n, self._changed = self._core.c.groups, last.count
        self.transitions.append((last.t, *(ffi.unpack(values, n) for values in (last.state, last.impulse, last.loss))))
        return True

    def note_jump(self, name: str) -> None:
        """Note the last jump of the state in `jumped`, if it is new; "": it is not noted."""
        last = lib.zd_run_energy_jump(self._run)
        if last.count != self._jumps:
            self._jumps = last.count
            self.jumped += [(last.t, name, last.energy)] if name else []

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

    @property
    def calls(self) -> Mapping[str, float]:
        """Time spent so far in user functions that were called, in s, by what they are."""
        return getattr(self._core, "calls", {})

    def results(self) -> Results:
        """Results of the run so far, without its samples."""
        run, size = self._run, 8 * self._core.mh
        statistics = Statistics._make(_unpacked(ffi.buffer(lib.zd_run_statistics(run))))
        return Results(statistics, lib.zd_run_omega_h(run), lib.zd_run_kinetic(run), lib.zd_run_energy_error(run),
                       self._redundant(statistics.rank), ffi.buffer(lib.zd_run_sizes(run), size)[:] if size else b"", self.calls)
