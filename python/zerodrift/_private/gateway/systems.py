"""Systems of the core's table."""

from __future__ import annotations

import copy
import functools
import math
from collections.abc import Sequence
from typing import Any, Self
from weakref import ref

import numpy as np

from ...errors import WrongValue
from ..core import ffi, lib
from .base import MESSAGE_SIZE, TERMS, Variable, card_of, doubles, error_of, lengths, parameter_of, row_named, text
from .compiled.precise import Precise
from .measures import Acting, Measuring
from .packed_layout import PACKED, Packing

MAX_ROWS = 1000        # of a matrix that is made dense where it is packed
SUSPECT = 1e-6          # rows of larger entries are not compared with their terms, which would have to be a million
CANCELLED = 2.0**-40    # of the terms of a row of C: smaller entries are their rounding error, as in csrc/point/units.c


class ConstraintNames:
    """Names of the constraints of a system, read from the system while it exists."""

    def __init__(self) -> None:
        self.handle = ffi.new_handle(self)
        self._system: Any = None

    def take_from(self, system: Any) -> None:
        """Take the names from a system's `constraints`, unless names of an equal system are set."""
        if self._system is None or self._system() is None:
            self._system = ref(system)

    def of(self, row: int) -> str:
        """Name of a constraint; empty if it is only its index."""
        system = self._system and self._system()
        names: Sequence[Variable] = system.constraints if system is not None else ()
        name = names[row].name if row < len(names) else ""
        return "" if name == f"constraint{row}" else name


@ffi.def_extern()
def zd_name_row_in_python(names: Any, row: int, to: Any, size: int) -> None:
    name = ffi.from_handle(names).of(row).encode()[: size - 1].decode(errors="ignore").encode()
    ffi.memmove(to, name + b"\0", len(name) + 1)


class Kind:
    """A built-in kind of system: its parameters, and the functions that create and draw its instances."""

    def __init__(self, c: Any) -> None:
        self.c, self.card, self.constants = c, card_of(c.card), c.constants
        system = self.c.system
        self.parameters = tuple(parameter_of(self.c.parameter[i]) for i in range(self.c.parameters))
        self.coordinates = self._variables(self.c.coordinate, system.nq)
        self.velocities = self._variables(self.c.velocity, system.nv)
        self.constraints = self._variables(self.c.constraint, system.mh + system.mn)

    @staticmethod
    def _variables(c: Any, size: int) -> tuple[Variable, ...]:
        return tuple(Variable(text(c[i].name), text(c[i].unit)) for i in range(size))

    def make(self, parameters: np.ndarray) -> tuple[CoreSystem, np.ndarray, np.ndarray]:
        """The core's system for these parameters (NaN: derived), and its start (p0, v0)."""
        given = doubles(parameters, sum(parameter.size for parameter in self.parameters))
        constants = ffi.new("double[]", max(1, self.c.constants))
        reason = self.c.prepare(given, constants)
        if reason:
            raise WrongValue(f"{self.card.name}: {text(reason)}")
        system = ffi.new("zd_system *", self.c.system)
        system.data = constants
        system.lengths = dimensions = lengths((*self.coordinates, *self.velocities))
        p0, v0 = np.empty(system.nq), np.empty(system.nv)
        self.c.start(given, doubles(p0, system.nq, writable=True), doubles(v0, system.nv, writable=True))
        return CoreSystem(system, (constants, dimensions)), p0, v0

    def precise(self, numbers: np.ndarray) -> Precise | None:
        """Functions in double-double arithmetic for these numbers (k, 2), or None."""
        system = self.c.system
        address = int(ffi.cast("uintptr_t", self.c.precise))
        return Precise(address, numbers, (system.nq, system.nv, system.mh, system.mn), None) if address else None

    @property
    def independent(self) -> tuple[int, ...]:
        """Indices of the entries of p that are independent coordinates, as far as the kind declares them."""
        system = self.c.system
        return tuple(system.independent[i] for i in range(system.nv - system.mh)) if system.independent else ()

    def draw(self, core: CoreSystem, p: np.ndarray) -> np.ndarray | None:
        """Drawing at p: points (n, dimension) to be joined by lines, or None."""
        if not self.c.points:
            return None
        points = np.empty((self.c.points, self.c.dimension))
        self.c.draw(core.c.data, doubles(p, core.nq), doubles(points, points.size, writable=True))
        return points


def kinds() -> dict[str, Kind]:
    """The built-in systems by name."""
    return {kind.card.name: kind for kind in (Kind(lib.zd_kind_of(row)) for row in range(lib.zd_entry_count(lib.ZD_SYSTEMS)))}


class CoreSystem(Measuring):
    """A `zd_system` and the memory it refers to."""

    def __init__(self, system: Any, data: Any) -> None:
        self.c, self._data = system, data
        self.nq, self.nv, self.mh, self.mn = system.nq, system.nv, system.mh, system.mn
        self.m = self.mh + self.mn
        self.r = self.nv - self.m
        self.provides, self.timeless = system.provides & ~lib.ZD_TIMELESS, bool(system.provides & lib.ZD_TIMELESS)
        self.has_energy = bool(system.provides & lib.ZD_POTENTIAL)
        self.packing = Packing.of(system.structure)
        self.quaternions = tuple(system.quaternion[i] for i in range(system.quaternions))

    calls_python: Any = False               # True if the core calls functions written in Python
    error: Any = None                       # exception that a system written in Python raised
    row_names: ConstraintNames | None = None
    keep: Any = None                        # that its functions live in
    without_lanes: CoreSystem | None = None # system that this one has SIMD lanes besides
    given_jacobian = False                  # whether its C and Phi_t were written down beside Phi, and may be wrong

    def names_of_constraints(self, system: Any) -> None:
        """Let the core's messages use the constraint names of the given system."""
        names = self.row_names
        if names is None:
            names = self.__dict__.setdefault("row_names", ConstraintNames())       # one, whichever thread comes first
            self.c.name_constraint, self.c.names = lib.zd_name_row_in_python, names.handle
        names.take_from(system)

    def structure_work(self, p: np.ndarray) -> Any:
        """Operation count and accuracy of eliminating C W C^T of a declared structure at p: `zd_structure_work` of the core.

        If the system cannot be evaluated there, the elimination is assumed to be accurate.
        """
        core, work = self.for_run(), ffi.new("zd_structure_work *")
        status = lib.zd_structure_count(core.c, doubles(p, self.nq), work)
        if status == lib.ZD_NO_MEMORY:
            raise error_of(status, "there is no memory for the order of elimination of the constraints")
        if status:
            work.is_alike, work.share = 1, 1.0
        return work

    @property
    def has_closed_form(self) -> bool:
        """True if the system has closed-form functions."""
        return self.c.closed_forms > 0

    @property
    def has_lanes(self) -> bool:
        """True if it has closed-form functions for SIMD lanes."""
        return any(self.c.closed_form[i].lanes > 1 for i in range(self.c.closed_forms))

    @property
    def lane_numbers(self) -> Any:
        """Numbers that closed-form functions read, an array of C, or None without such functions."""
        return self._data[0] if self.has_closed_form and self._data[0] else None

    def with_lanes(self, address: int, keep: Any) -> Self:
        """Copy of the system with a second `zd_closed_form`, at `address`, for SIMD lanes; unchanged if that serves one
        trajectory only, as with compilers without vectors.
        """
        more = ffi.cast("const zd_closed_form *", address)
        if more.lanes == 1:
            return self
        other, both = copy.copy(self), ffi.new("zd_closed_form[]", [self.c.closed_form[0], more[0]])
        other.c = ffi.new("zd_system *", self.c[0])
        other.c.closed_form, other.c.closed_forms = both, 2
        other._data, other.without_lanes = (*self._data, both, keep), self
        return other

    def for_run(self) -> CoreSystem:
        """The system for one run; one written in Python needs memory of its own for each."""
        return self

    @property
    def functions(self) -> int:
        """Number of user functions of which some read reactions; their values u are the inputs of the system."""
        return self.c.reading.functions if self.c.reading else 0

    def read_solved(self, t: np.ndarray, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Values u (k, functions) at states t (k,), p (k, nq), v (k, nv), solved for with the accelerations.

        Quaternions may differ from length 1, as where derivatives are differences of p.
        """
        core, u, message = self.for_run(), np.zeros((len(t), self.functions)), ffi.new("char[]", MESSAGE_SIZE)
        if u.size:
            p = np.array(p).reshape(len(t), -1)
            for first in self.quaternions:
                p[:, first:first + 4] /= np.linalg.norm(p[:, first:first + 4], axis=1, keepdims=True)
            status = lib.zd_accelerations(core.c, row_named("formulations", "augmented"), lib.ZD_CONTINUE, len(t),
                                          doubles(t, len(t)), doubles(p, p.size), doubles(v, v.size), *[ffi.NULL] * 3,
                                          doubles(u, u.size, writable=True), message, MESSAGE_SIZE)
            if status:
                raise core.error or error_of(status, text(message))
        return u

    def forces_of_functions(self, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Generalized forces (nv, functions) of unit values of the user functions."""
        if not self.functions:
            return np.zeros((self.nv, 0))
        k, shape = self.functions, (self.functions + 1, -1)
        u = np.vstack([np.eye(k), np.zeros((1, k))])
        times, p, v = (np.ascontiguousarray(np.broadcast_to(each, (k + 1, np.size(each)))) for each in (t, p, v))
        f = self._evaluated(("f",), times.ravel(), p, v, u)["f"].reshape(shape)
        return (f[:-1] - f[-1]).T

    def read_given(self, t: np.ndarray, p: np.ndarray, v: np.ndarray, vdot: np.ndarray, lam: np.ndarray, *,
                   acting: Acting | None = None, is_own: bool = False) -> np.ndarray:
        """Values u (k, functions) where vdot (k, nv) and the multipliers (k, m) are given, too; the others: as of `measure`."""
        core, u = self if is_own else self.for_run(), np.zeros((len(t), self.functions))
        if u.size:
            status = lib.zd_read_states(core.c, len(t), *(doubles(each, each.size) for each in (t, p, v, vdot, lam)),
                                       acting.c if acting else ffi.NULL, doubles(u, u.size, writable=True))
            if status:
                raise core.error or error_of(status, "user functions must have one value at given reactions")
        return u

    def initial_inputs(self) -> Any:
        """Array of inputs (2 inputs + 1,) with their initial values; NULL without inputs."""
        n = self.c.inputs
        return ffi.new("double[]", [self.c.input[i].initial for i in range(n)] + [0.0] * (n + 1)) if n else ffi.NULL

    def series(self, order: int, t: float, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Taylor coefficients (order + 1, ...) of p, v and the supplied energy, if the system has a series."""
        size, brought = order + 1, self.c.series
        found = np.zeros((size, self.nq)), np.zeros((size, self.nv)), np.zeros(size)
        scratch = ffi.new("double[]", max(1, size * brought.scratch))
        to = [doubles(each, each.size, writable=True) for each in found]
        status = brought.evaluate(self.c.data, self.initial_inputs(), order, t, doubles(p, self.nq), doubles(v, self.nv), *to,
                                  scratch)
        if status:
            raise error_of(status, "the series failed")
        return found

    def jacobian(self, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Jacobian of (pdot, vdot), and in an additional row of the power if there is any, with respect to (p, v), if the system
        provides it.
        """
        columns, brought = self.nq + self.nv, self.c.jacobian
        found = np.zeros((columns + bool(self.provides & (lib.ZD_POWER | lib.ZD_PHI_T)), columns))
        scratch = ffi.new("double[]", max(1, brought.scratch))
        status = brought.evaluate(self.c.data, self.initial_inputs(), t, doubles(p, self.nq), doubles(v, self.nv),
                                  doubles(found, found.size, writable=True), scratch)
        if status:
            raise error_of(status, "the Jacobian failed")
        return found

    def suits(self, integrator: int) -> bool:
        """True if that entry of the table of integrators accepts the system."""
        return bool(lib.zd_suits(self.c, integrator))

    def suits_formulation(self, formulation: int) -> bool:
        """True if that entry of the table of formulations accepts the system."""
        return bool(lib.zd_formulation_suits(self.c, formulation))

    def stored(self, name: str) -> tuple[int, ...]:
        """Shape of the stored entries of a term."""
        return (self.packing.size(name),) if self.packing and name in PACKED else TERMS[name].shape(self.c)

    def evaluate(self, t: float, p: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """All terms of the system at (t, p, v), with dense matrices."""
        largest = max(self.nq, self.nv, self.m)
        if self.packing and largest > MAX_ROWS:
            raise WrongValue(f"evaluate() makes dense matrices of up to {MAX_ROWS} rows, and here these would have {largest}: "
                             "sol[...] has coordinates, velocities and multipliers, and product() multiplies by A, M and C")
        found = self.evaluate_states(tuple(self.layout), np.array([float(t)]), p[None], v[None])
        return {name: values[0] for name, values in found.items()}

    def rows_above_rounding(self, t: float, p: np.ndarray, v: np.ndarray, C: np.ndarray) -> np.ndarray:
        """C (m, nv) or its first rows, with zeros in rows that are the rounding error of terms that cancel, as in constraints
        that a tree of joints satisfies identically.
        """
        if not self.c.magnitudes or not (np.abs(C).max(axis=1, initial=0.0) < SUSPECT).any():
            return C
        magnitude, scratch, core = np.zeros((self.m, 2)), np.zeros(max(1, self.c.magnitudes_scratch)), self.for_run()
        to = doubles(magnitude, magnitude.size, writable=True), doubles(scratch, scratch.size, writable=True)
        if core.c.magnitudes(core.c.data, t, doubles(p, self.nq), doubles(v, self.nv), *to):
            return C        # a user function fails, which the terms report
        is_angle = [int(not (self.c.lengths and self.c.lengths[self.nq + i])) for i in range(self.nv)]
        terms = magnitude[:len(C), is_angle]
        return np.where((np.abs(C) <= CANCELLED * terms).all(axis=1, keepdims=True), 0.0, C)

    def check_domain(self, t: float, p: np.ndarray, v: np.ndarray) -> None:
        """Check that all user functions are defined at a state: that no table has an argument beyond its ends."""
        core, scratch = self.for_run(), np.zeros(self.c.scratch + 1)
        if core.c.check_domain and core.c.check_domain(core.c.data, 0.0, 0.0, t, doubles(p, self.nq), doubles(v, self.nv),
                                                       doubles(scratch, scratch.size, writable=True)):
            raise core.error or error_of(lib.ZD_CALLBACK, "a user function is not defined")

    def force_magnitudes(self, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray | None:
        """Sums of the magnitudes of the terms of f (nv,) before they cancel; None where the system does not provide them."""
        if not self.c.force_magnitudes:
            return None
        magnitude, scratch, core = np.zeros(self.nv), np.zeros(max(1, self.c.scratch)), self.for_run()
        u = self.read_solved(np.array([float(t)]), p, v)
        inputs = doubles(u, u.size) if u.size else self.initial_inputs()
        to = doubles(magnitude, self.nv, writable=True), doubles(scratch, scratch.size, writable=True)
        status = core.c.force_magnitudes(core.c.data, inputs, t, doubles(p, self.nq), doubles(v, self.nv), *to)
        if status:
            raise core.error or error_of(status, "the system's evaluation failed")
        return magnitude

    def follower_rows(self, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Rows of A (followers, nv) of dependent angles, which are not stored; computed column by column."""
        terms, scratch, inputs = ffi.new("zd_terms *"), ffi.new("double[]", max(1, self.c.scratch)), self.initial_inputs()
        terms.scratch, terms.inputs = scratch, inputs
        self.c.evaluate(self.c.data, lib.ZD_MOVED, t, doubles(p, self.nq), doubles(v, self.nv), terms)
        columns = np.zeros((self.nv, self.nq))
        for x, column in zip(np.eye(self.nv), columns, strict=True):
            self.c.operations.times_A(self.c.data, terms, doubles(x, self.nv), doubles(column, self.nq, writable=True))
        return np.ascontiguousarray(columns[:, self.nq - self.c.followers:].T)

    def times(self, name: str, stored: np.ndarray, x: np.ndarray, t: float, p: np.ndarray, v: np.ndarray, *,
              transposed: bool = False) -> np.ndarray:
        """Product of a matrix, given by its stored entries at (t, p, v), or of its transpose, and a vector."""
        if not self.packing:
            return (stored.T if transposed else stored) @ x
        if name != "A" or not self.c.followers:
            return self.packing.times(name, stored, x, transposed=transposed)
        rows, others = self.follower_rows(t, p, v), self.nq - self.c.followers
        if transposed:
            return self.packing.times(name, stored, x[:others], transposed=True) + rows.T @ x[others:]
        return np.concatenate([self.packing.times(name, stored, x), rows @ x])

    def evaluate_stored(self, t: float, p: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """All terms of the system at (t, p, v), as stored."""
        found = self._evaluated(tuple(self.layout), np.array([float(t)]), p, v)
        return {name: values.reshape(self.layout[name]) for name, values in found.items()}

    @functools.cached_property
    def layout(self) -> dict[str, tuple[int, ...]]:
        """Shapes of the stored entries of each term of the system."""
        return {name: self.stored(name) for name, term in TERMS.items() if self.provides & term.bit}

    def evaluate_states(self, names: tuple[str, ...], t: np.ndarray, p: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """Terms of these names that the system has, at many states t (k,), p (k, nq), v (k, nv), with dense matrices."""
        k, arrays = len(t), self._evaluated(tuple(name for name in names if name in self.layout), t, p, v)
        found = {name: array.reshape(k, *self.layout[name]) for name, array in arrays.items()}
        if self.packing:
            found |= {name: self.packing.expand(name, found[name]) for name in PACKED if name in found}
        if self.packing and self.c.followers and "A" in found:
            rows = [self.follower_rows(*at) for at in zip(t.tolist(), p, v, strict=True)]
            found["A"] = np.concatenate([found["A"], np.reshape(rows, (k, self.c.followers, self.nv))], axis=1)
        return found

    def residuals_along(self, parts: str, at: tuple[float, np.ndarray, np.ndarray], vdot: np.ndarray, lam: np.ndarray,
                        directions: tuple[np.ndarray, ...], *, u: np.ndarray | None = None, is_rough: bool = False) -> np.ndarray:
        """Derivatives (k, entries of the parts) of residuals at (t, p, v) along k directions, with vdot, lambda and u frozen.

        Parts are "r" of (2) (nv,), "s" of (6) (m,), or both, or "Psi" of (5) (m,). Directions are dt (k,), dp (k, nq),
        dv (k, nv), and their sizes (k,) in characteristic scales, zero where nothing changes.
        """
        core, (t, p, v), (dt, dp, dv, sizes) = self.for_run(), at, directions
        r, s, Psi = (lib.ZD_RESIDUAL_R, self.nv), (lib.ZD_RESIDUAL_S, self.m), (lib.ZD_RESIDUAL_PSI, self.m)
        bits, width = {"r": r, "s": s, "rs": (r[0] | s[0], self.nv + self.m), "Psi": Psi}[parts]
        k = len(dt)
        found = np.zeros((k, width))
        u = self.read_solved(np.array([float(t)]), p, v) if u is None else u
        status = lib.zd_residuals_along(
            core.c, doubles(u, u.size), bits, t, doubles(p, self.nq), doubles(v, self.nv), doubles(vdot, self.nv),
            doubles(lam, self.m), is_rough, k, doubles(dt, k), doubles(dp, k * self.nq), doubles(dv, k * self.nv),
            doubles(sizes, k), doubles(found, found.size, writable=True))
        if status:
            raise core.error or error_of(status, "the system's evaluation failed")
        return found

    def _evaluated(self, names: tuple[str, ...], t: np.ndarray, p: np.ndarray, v: np.ndarray,
                   u: np.ndarray | None = None) -> dict[str, np.ndarray]:
        """Stored entries of these terms at all states, concatenated; u (k, functions) is left out where it is solved for."""
        core, terms, k = self.for_run(), ffi.new("zd_terms *"), len(t)
        sizes = [k * math.prod(self.layout[name]) for name in names]
        memory = np.zeros(sum(sizes))
        start, first, want, arrays = doubles(memory, memory.size, writable=True), 0, lib.ZD_MOVED, {}
        for name, size in zip(names, sizes, strict=True):
            setattr(terms, name, start + first)
            arrays[name], want, first = memory[first:first + size], want | TERMS[name].bit, first + size
        scratch, inputs = ffi.new("double[]", max(1, self.c.scratch)), self.initial_inputs()
        terms.scratch, terms.inputs = scratch, inputs
        if self.functions and {"f", "power"} & set(names):
            u = self.read_solved(t, p, v) if u is None else u
            terms.inputs = inputs = doubles(u, u.size)
        status = lib.zd_evaluate_states(core.c, want, k, doubles(t, k), doubles(p, k * self.nq), doubles(v, k * self.nv), terms)
        if status:
            raise core.error or error_of(status, "the system's evaluation failed")
        return arrays
