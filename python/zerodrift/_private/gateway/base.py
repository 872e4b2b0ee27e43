"""Shared parts of the gateway: the core's tables, its statuses as exceptions, and checks of arrays passed to the core."""

from __future__ import annotations

import builtins
import os
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ... import errors
from ...errors import WrongType
from ..core import ffi, lib

TABLES = {"systems": lib.ZD_SYSTEMS, "formulations": lib.ZD_FORMULATIONS,
          "integrators": lib.ZD_INTEGRATORS, "corrections": lib.ZD_CORRECTIONS}
MESSAGE_SIZE = 512
PROCESSOR_UNIT = lib.zd_processor_unit()      # the number of the last vector unit that it has
FINGERPRINT = ffi.string(lib.zd_fingerprint).decode()       # of the sources that the core was compiled from
LAYOUT = ffi.string(lib.zd_layout).decode()                 # the fingerprint of how they lay out the memory of runs
ROW_VALUES = lib.ZD_ROW_VALUES      # for how many numbers of a row's parameters settings have room

FIXED_STEPS, ADAPTIVE_STEPS = lib.ZD_FIXED_STEPS, lib.ZD_ADAPTIVE_STEPS
SWITCHES = lib.ZD_SWITCHES       # input of an action of an event that switches the first group
DONE, PAUSED, FULL, EVENT, CALLBACK = lib.ZD_DONE, lib.ZD_PAUSED, lib.ZD_FULL, lib.ZD_EVENT, lib.ZD_CALLBACK
BAD_ARGUMENT, BAD_INPUT, COLLAPSED = lib.ZD_BAD_ARGUMENT, lib.ZD_BAD_INPUT, lib.ZD_COLLAPSED
INTERRUPTED = 3     # positive, as it is Python that stops early


class Card(NamedTuple):
    """An entry of one of the core's tables."""

    name: str
    summary: str
    equations: str
    order: int
    error_order: int
    stability: float
    description: str
    reference: str
    parameters: tuple[Parameter, ...]


class Variable(NamedTuple):
    """A coordinate, velocity or constraint."""

    name: str
    unit: str


class Parameter(NamedTuple):
    """A parameter of a table entry; `initial` is None if it is derived from the others; `words` are the options of a choice."""

    name: str
    unit: str
    text: str
    size: int
    rule: str
    initial: tuple[float, ...] | None
    words: tuple[str, ...]


DIMENSIONLESS = ("", "1", "rad", "deg")


def lengths(variables: Iterable[Variable]) -> Any:
    """`zd_system.lengths`: which variables are lengths or their rates."""
    return ffi.new("int[]", [is_length(variable) for variable in variables])


def set_quaternions(system: Any, places: Sequence[int]) -> Any:
    """Set the offsets of unit quaternions in p in a `zd_system`; the returned memory must be kept as long as it."""
    if not places:
        return None
    system.quaternions, system.quaternion = len(places), (memory := ffi.new("int[]", list(places)))
    return memory


def is_length(variable: Variable) -> bool:
    """True if a variable counts as a length or its rate: its unit is not that of a pure number (1, rad) or of its rate."""
    return variable.unit not in {*DIMENSIONLESS, *(f"{unit}/s" for unit in DIMENSIONLESS), "1/s"}


RULES = {lib.ZD_ANY: "any", lib.ZD_POSITIVE: "positive", lib.ZD_NOT_NEGATIVE: "not negative", lib.ZD_CHOICE: "choice",
         lib.ZD_COUNT: "count", lib.ZD_SWITCH: "switch"}


class WarningLimits(NamedTuple):
    """Limits beyond which a completed run gives a warning: step_limits.h."""

    pivot: float                # smallest relative pivot
    energy_error: float         # error of the energy balance (28), relative to the largest kinetic energy
    energy_correction: float    # energy of one correction, relative to the largest kinetic energy
    energy_rounding: float      # error of (28) that is rounding, relative to kinetic and potential energy


WARNING_LIMITS = WarningLimits(*(getattr(lib.zd_limits_of_warnings(), name) for name in WarningLimits._fields))


def check_fingerprint() -> None:
    """In a source tree, refuses a compiled core that does not belong to the sources beside it."""
    root = os.path.realpath(__file__)
    for _ in range(5):
        root = os.path.dirname(root)
    if not os.path.isfile(os.path.join(root, "python", "build_core.py")):
        return
    from ..fingerprint import core_fingerprint  # where nothing is developed, that is not imported

    if core_fingerprint(root) != FINGERPRINT:
        sources = os.path.join(root, "csrc")
        raise errors.StaleCore(f"the compiled core is older than {sources}; rebuild it with: pip install -e {root}")


def text(characters: Any) -> str:
    """A C string as a Python string; a message may end within a character."""
    return ffi.string(characters).decode(errors="replace")


def doubles(array: np.ndarray, size: int, *, writable: bool = False) -> Any:
    """Memory of a C-contiguous float64 array of `size` entries; other arrays are refused, which CFFI would reinterpret."""
    if array.dtype != np.float64 or not array.flags.c_contiguous or array.size != size:
        raise WrongType(f"expected {size} contiguous float64 values, got {array.dtype} of shape {array.shape}", "shape")
    if writable and not array.flags.writeable:
        raise WrongType("expected a writable array", "shape")
    return ffi.from_buffer("double[]", array, require_writable=writable)


def strided_doubles(array: np.ndarray, size: int) -> Any:
    """The address of a float64 array of `size` entries, each of whose rows is contiguous; the caller keeps the array."""
    is_regular = array.strides[0] > 0 and array.strides[0] % 8 == 0 and (len(array) == 0 or array[0].flags.c_contiguous)
    if array.dtype != np.float64 or not array.flags.aligned or not is_regular or array.size != size:
        raise WrongType(f"expected {size} float64 values in contiguous rows, got {array.dtype} of shape {array.shape}", "shape")
    return ffi.cast("double *", array.ctypes.data)


def cards(table: str) -> tuple[Card, ...]:
    """Entries of a table of the core."""
    rows = (lib.zd_entry_card(TABLES[table], row) for row in range(lib.zd_entry_count(TABLES[table])))
    return tuple(map(card_of, rows))


def default(table: str) -> Any:
    """Name of the default entry of a table of the core."""
    return cards(table)[lib.zd_default_entry(TABLES[table])].name


class Status(NamedTuple):
    """An entry of the core's list of statuses."""

    status: int
    error: str      # name of the exception that stands for it
    sentence: str
    code: str       # of that exception, where this status raises it; "" of a callable's own exception


OF_PYTHON = {"MemoryError": "NoMemory"}     # exceptions of Python in the core's list, to those with a code


def statuses() -> list[Status]:
    """The core's list of statuses of failures."""
    rows: list[Status] = []
    while c := lib.zd_status_at(len(rows)):
        error = OF_PYTHON.get(text(c.error), text(c.error)) or "ZerodriftError"
        code = errors.OF_STATUS.get(text(c.symbol), "") or getattr(getattr(errors, error, None), "code", "")
        rows.append(Status(c.status, error, text(c.sentence), code))
    return [row for row in rows if row.status < 0]


# Exceptions of failed statuses, by the names in the core's list of statuses.
ERRORS: dict[int, type[Exception]] = {row.status: getattr(errors, row.error, None) or vars(builtins)[row.error]
                                      for row in statuses()}
CODES = {row.status: row.code for row in statuses() if row.code}


class Term(NamedTuple):
    """A term of the equations of motion that a system may have, an entry of the core's list."""

    bit: int
    symbol: str     # what C calls the bit
    row: int
    offset: int     # of its pointer in `zd_terms`, in bytes
    sizes: str      # "(nv, nv)"
    depends_on_v: bool
    text: str

    def shape(self, system: Any) -> tuple[int, ...]:
        """Shape of the term in a `zd_system`."""
        shape = lib.zd_term_shape(system, self.row)
        return tuple(shape.size[0:shape.dimensions])


def _terms() -> dict[str, Term]:
    """The core's list of terms, by name."""
    terms: dict[str, Term] = {}
    while c := lib.zd_term_at(len(terms)):
        sizes = f"({text(c.shape).partition('(')[2].strip(')')})"
        terms[text(c.name)] = Term(c.term, text(c.symbol), len(terms), c.offset, sizes, c.depends != lib.ZD_OF_POSITIONS,
                                   text(c.text))
    return terms


TERMS = _terms()


def card_of(c: Any) -> Card:
    """A `zd_card`."""
    description, reference = (text(each) if each else "" for each in (c.description, c.reference))
    return Card(text(c.name), text(c.summary), text(c.equations), c.order, c.error_order, c.stability, description, reference,
                tuple(parameter_of(c.parameter[i]) for i in range(c.parameters)))


def parameter_of(c: Any) -> Parameter:
    """A `zd_parameter`."""
    initial, meaning = tuple(c.initial[0:c.size]) if c.initial else None, text(c.text)
    words: tuple[str, ...] = ()
    if c.rule == lib.ZD_CHOICE:
        listed, _, meaning = meaning.partition(":")
        words = tuple(listed.split())
    return Parameter(text(c.name), text(c.unit), meaning.strip(), c.size, RULES[c.rule], initial, words)


def row_named(table: str, name: str) -> int:
    """Entry of a table of the core, by its name."""
    return lib.zd_entry_named(TABLES[table], name.encode())


def clash(table: str, name: str, values: Sequence[float]) -> str:
    """Error message for the parameters of an entry of a table of the core; empty if they are consistent."""
    message = ffi.new("char[]", MESSAGE_SIZE)
    row, given = row_named(table, name), ffi.new("zd_parameter_values *", {"given": 1, "value": values})
    return text(message) if lib.zd_check_parameter_values(TABLES[table], row, given, message, MESSAGE_SIZE) else ""


def required(correction: str) -> int:
    """The bits of the terms that a correction requires of a system."""
    return lib.zd_correction_requires(row_named("corrections", correction))


def error_of(status: int, message: str) -> Exception:
    """Exception of a failed status, with its code."""
    error: Any = ERRORS.get(status, errors.ZerodriftError)(message)
    if status in CODES:
        error.code = CODES[status]
    return error
