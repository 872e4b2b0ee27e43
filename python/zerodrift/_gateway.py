"""The one door between Python and the C core: nothing else touches ``ffi`` and ``lib``."""

from __future__ import annotations

import copy
import hashlib
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import errors
from ._core import ffi, lib

TABLES = {"systems": lib.ZD_SYSTEMS, "formulations": lib.ZD_FORMULATIONS,
          "integrators": lib.ZD_INTEGRATORS, "corrections": lib.ZD_CORRECTIONS}
MESSAGE_SIZE = 512

ERRORS = {
    lib.ZD_NOT_FINITE: errors.Diverged,
    lib.ZD_NOT_DEFINITE: errors.SingularSystem,
    lib.ZD_NOT_SYMMETRIC: errors.SingularSystem,
    lib.ZD_DEPENDENT: errors.SingularSystem,
    lib.ZD_SINGULAR: errors.SingularSystem,
    lib.ZD_NO_CONVERGENCE: errors.CorrectionFailed,
    lib.ZD_NO_STEP: errors.StepFailed,
    lib.ZD_NO_EMBEDDING: errors.StepFailed,
    lib.ZD_TINY_STEP: errors.StepFailed,
    lib.ZD_BAD_START: errors.InconsistentStart,
    lib.ZD_UNREACHABLE: errors.UnreachableTolerance,
    lib.ZD_NO_MEMORY: MemoryError,
}
DONE, PAUSED, FULL, CALLBACK = lib.ZD_DONE, lib.ZD_PAUSED, lib.ZD_FULL, lib.ZD_CALLBACK
INTERRUPTED = 3     # positive, as it is Python that stops early

# The terms a system may have: bit, shape in terms of its sizes.
TERMS = {
    "A": (lib.ZD_A, ("nq", "nv")), "M": (lib.ZD_M, ("nv", "nv")), "d": (lib.ZD_BIAS, ("nv",)),
    "f": (lib.ZD_FORCE, ("nv",)), "Phi": (lib.ZD_PHI, ("mh",)), "C": (lib.ZD_C, ("m", "nv")),
    "Phi_t": (lib.ZD_PHI_T, ("m",)), "xi": (lib.ZD_XI, ("m",)), "V": (lib.ZD_POTENTIAL, ()),
    "power": (lib.ZD_POWER, ()), "D": (lib.ZD_COMPLEMENT, ("nv", "r")), "gamma": (lib.ZD_GAMMA, ("nv",)),
}


class Card(NamedTuple):
    """A row of one of the core's tables."""

    name: str
    summary: str
    equations: str
    order: int
    error_order: int


class Variable(NamedTuple):
    """A coordinate, velocity or constraint."""

    name: str
    unit: str


class Parameter(NamedTuple):
    """A parameter of a built-in system; `initial` is None where it is derived from the others."""

    name: str
    unit: str
    text: str
    size: int
    rule: str
    initial: tuple[float, ...] | None


RULES = {lib.ZD_ANY: "any", lib.ZD_POSITIVE: "positive", lib.ZD_NOT_NEGATIVE: "not negative", lib.ZD_CHOICE: "choice"}


def check_fingerprint() -> None:
    """In a source tree, refuses a compiled core that does not belong to the sources beside it."""
    root = Path(__file__).resolve().parents[2]
    if not (root / "python" / "build_core.py").is_file():
        return
    digest = hashlib.sha256()
    for path in sorted((root / "csrc").rglob("*.[ch]")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    if digest.hexdigest() != text(lib.zd_fingerprint):
        raise errors.StaleCore(f"the compiled core is older than {root / 'csrc'}; rebuild it with: pip install -e {root}")


def text(characters: Any) -> str:
    """A C string as a Python string."""
    return ffi.string(characters).decode()


def doubles(array: np.ndarray, size: int, *, writable: bool = False) -> Any:
    """The memory of a C-contiguous float64 array of `size` entries, and no other: CFFI itself would reinterpret it."""
    if array.dtype != np.float64 or not array.flags.c_contiguous or array.size != size:
        raise TypeError(f"expected {size} contiguous float64 values, got {array.dtype} of shape {array.shape}")
    if writable and not array.flags.writeable:
        raise TypeError("expected a writable array")
    return ffi.from_buffer("double[]", array, require_writable=writable)


def cards(table: str) -> tuple[Card, ...]:
    """The rows of a table of the core."""
    rows = (lib.zd_row(TABLES[table], row) for row in range(lib.zd_rows(TABLES[table])))
    return tuple(Card(text(row.name), text(row.summary), text(row.equations), row.order, row.error_order) for row in rows)


def error_of(status: int, message: str) -> Exception:
    """The exception that stands for a failed status."""
    return ERRORS.get(status, errors.ZerodriftError)(message)


# ---- built-in systems ----


class Kind:
    """A row of the table of systems: what it needs to be made, and what its instances consist of."""

    def __init__(self, row: int) -> None:
        self.c = lib.zd_kind_of(row)
        self.card = cards("systems")[row]
        system = self.c.system
        self.parameters = tuple(self._parameter(self.c.parameter[i]) for i in range(self.c.parameters))
        self.coordinates = self._variables(self.c.coordinate, system.nq)
        self.velocities = self._variables(self.c.velocity, system.nv)
        self.constraints = self._variables(self.c.constraint, system.mh + system.mn)

    @staticmethod
    def _parameter(c: Any) -> Parameter:
        initial = tuple(c.initial[i] for i in range(c.size)) if c.initial else None
        return Parameter(text(c.name), text(c.unit), text(c.text), c.size, RULES[c.rule], initial)

    @staticmethod
    def _variables(c: Any, size: int) -> tuple[Variable, ...]:
        return tuple(Variable(text(c[i].name), text(c[i].unit)) for i in range(size))

    def make(self, parameters: np.ndarray) -> tuple[CoreSystem, np.ndarray, np.ndarray]:
        """The core's system for these parameters (NaN: derived), and its start (p0, v0)."""
        given = doubles(parameters, sum(parameter.size for parameter in self.parameters))
        constants = ffi.new("double[]", max(1, self.c.constants))
        reason = self.c.prepare(given, constants)
        if reason:
            raise ValueError(f"{self.card.name}: {text(reason)}")
        system = ffi.new("zd_system *", self.c.system)
        system.data = constants
        p0, v0 = np.empty(system.nq), np.empty(system.nv)
        self.c.start(given, doubles(p0, system.nq, writable=True), doubles(v0, system.nv, writable=True))
        return CoreSystem(system, constants), p0, v0

    def draw(self, core: CoreSystem, p: np.ndarray) -> np.ndarray:
        """The drawing at p: points (n, dimension) to be joined by lines."""
        points = np.empty((self.c.points, self.c.dimension))
        self.c.draw(core.c.data, doubles(p, core.nq), doubles(points, points.size, writable=True))
        return points


def kinds() -> dict[str, Kind]:
    """The built-in systems by name."""
    return {card.name: Kind(row) for row, card in enumerate(cards("systems"))}


class CoreSystem:
    """A `zd_system` and what it refers to."""

    def __init__(self, system: Any, data: Any) -> None:
        self.c, self._data = system, data
        self.nq, self.nv, self.mh, self.mn = system.nq, system.nv, system.mh, system.mn
        self.m = self.mh + self.mn
        self.r = self.nv - self.m
        self.provides = system.provides
        self.has_energy = bool(system.provides & lib.ZD_POTENTIAL)

    error: BaseException | None = None      # what a system written in Python raised

    def for_run(self) -> CoreSystem:
        """The system for one run; one written in Python needs memory of its own for each."""
        return self

    def evaluate(self, t: float, p: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """All terms the system has, at (t, p, v)."""
        core = self.for_run()
        terms = ffi.new("zd_terms *")
        scratch = ffi.new("double[]", max(1, self.c.scratch))
        terms.scratch = scratch
        arrays = {}
        for name, (bit, shape) in TERMS.items():
            if not self.provides & bit:
                continue
            arrays[name] = array = np.zeros([getattr(self, size) for size in shape])
            setattr(terms, name, doubles(array, array.size, writable=True))
        status = core.c.evaluate(core.c.data, self.provides | lib.ZD_MOVED, t, doubles(p, self.nq), doubles(v, self.nv), terms)
        if status:
            raise core.error or error_of(status, "the system's evaluation failed")
        return arrays


# ---- systems written in Python ----


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


# ---- runs ----


def settings(options: dict[str, Any]) -> Any:
    """A `zd_settings` from nested dictionaries; an array `t_eval` has to outlive it."""
    t_eval = options.pop("t_eval", None)
    made = ffi.new("zd_settings *", options)
    if t_eval is not None:
        made.t_eval, made.t_evals = doubles(t_eval, t_eval.size), t_eval.size
    return made


def count_steps(t0: float, t1: float, step: float) -> int:
    """Steps from t0 to t1."""
    return int(lib.zd_count_steps(t0, t1, step))


STATISTICS = tuple(name for name, _ in ffi.typeof("zd_statistics").fields)


class Record:
    """The arrays a run writes into, one row per saved instant: a block of memory, and further ones as long as they are needed."""

    def __init__(self, core: CoreSystem, capacity: int) -> None:
        energies = {"potential": (), "input": (), "energy_violation": ()} if core.has_energy else {}
        self._shapes = {"t": (), "p": (core.nq,), "v": (core.nv,), "multipliers": (core.m,), "position_violation": (core.mh,),
                        "velocity_violation": (core.m,), "kinetic": (), **energies}
        self._blocks: list[tuple[Any, Any, dict[str, np.ndarray]]] = []
        self._add(capacity)

    def _add(self, capacity: int) -> None:
        widths = [math.prod(shape) for shape in self._shapes.values()]
        try:
            block, iterations = np.empty(capacity * sum(widths)), np.empty(capacity, dtype=np.intc)
        except (MemoryError, ValueError):
            size = capacity * (sum(widths) + 0.5) * 8 / 2**30
            raise MemoryError(f"{capacity} saved rows need {size:.3g} GiB; save fewer with save_every") from None
        self.c = ffi.new("zd_record *")
        self.c.capacity = capacity
        memory, arrays, start = doubles(block, block.size, writable=True), {"iterations": iterations}, 0
        for (name, shape), width in zip(self._shapes.items(), widths, strict=True):
            setattr(self.c, name, memory + start)
            arrays[name] = block[start:start + capacity * width].reshape(capacity, *shape)
            start += capacity * width
        self.c.iterations = counts = ffi.from_buffer("int[]", iterations, require_writable=True)
        self._blocks.append((self.c, (memory, counts), arrays))

    def grow(self) -> None:
        """Go on in a block as large as all before it."""
        self._add(sum(c.capacity for c, _, _ in self._blocks))

    def arrays(self) -> dict[str, np.ndarray]:
        """The rows written so far."""
        rows = [{name: array[: c.rows] for name, array in arrays.items()} for c, _, arrays in self._blocks]
        return rows[0] if len(rows) == 1 else {name: np.concatenate([part[name] for part in rows]) for name in rows[0]}


class Run:
    """A run of the core."""

    def __init__(self, core: CoreSystem, options: Any, p0: np.ndarray, v0: np.ndarray) -> None:
        core = core.for_run()
        status, message = ffi.new("int *"), ffi.new("char[]", MESSAGE_SIZE)
        run = lib.zd_run_create(core.c, options, doubles(p0, core.nq), doubles(v0, core.nv), status, message, MESSAGE_SIZE)
        if not run:
            raise core.error or error_of(status[0], text(message))
        self._run, self._core = ffi.gc(run, lib.zd_run_free), core

    def advance(self, record: Record, seconds: float) -> int:
        """Steps for about that long; the status. The interpreter is free for other threads meanwhile."""
        return lib.zd_run_advance(self._run, record.c, seconds)

    def error(self, status: int) -> BaseException:
        """The exception that stands for a failed status: what a system written in Python raised, or our own."""
        return self._core.error or error_of(status, self.message)

    @property
    def progress(self) -> float:
        """The part that is done, 0 ... 1."""
        return lib.zd_run_progress(self._run)

    @property
    def message(self) -> str:
        """The first failure, in one sentence."""
        return text(lib.zd_run_message(self._run))

    @property
    def statistics(self) -> dict[str, int]:
        """Counts of what the run did."""
        c = lib.zd_run_statistics(self._run)
        return {name: getattr(c, name) for name in STATISTICS}


def step(core: CoreSystem, options: Any, p: np.ndarray, v: np.ndarray) -> None:
    """`zd_step`: one corrected step, p and v in place."""
    core, message = core.for_run(), ffi.new("char[]", MESSAGE_SIZE)
    status = lib.zd_step(core.c, options, doubles(p, core.nq, writable=True), doubles(v, core.nv, writable=True), message,
                         MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))


def acceleration(core: CoreSystem, formulation: int, t: float, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`zd_acceleration`: vdot (nv,) and multipliers (m,)."""
    core = core.for_run()
    vdot, multipliers, message = np.empty(core.nv), np.empty(core.m), ffi.new("char[]", MESSAGE_SIZE)
    status = lib.zd_acceleration(core.c, formulation, t, doubles(p, core.nq), doubles(v, core.nv),
                                 doubles(vdot, core.nv, writable=True), doubles(multipliers, core.m, writable=True),
                                 message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return vdot, multipliers


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


check_fingerprint()
