"""The one door between Python and the C core: nothing outside this package touches ``ffi`` and ``lib``.

Its module `mechanisms` is imported by whoever makes mechanisms, and by nobody else.
"""

from .base import (
    CALLBACK,
    DONE,
    ERRORS,
    EVENT,
    FULL,
    INTERRUPTED,
    PAUSED,
    ROW_VALUES,
    TERMS,
    Card,
    Parameter,
    Variable,
    cards,
    check_fingerprint,
    clash,
    default,
    doubles,
    error_of,
    is_length,
    required,
)
from .callbacks import CALLBACK_CODE, PythonCore, Watcher
from .functions import Function, InLibrary, address_of, find, in_library, load_data, numba_signature
from .measures import Outputs
from .native import VERSION, NativeCore, kind_at, probe, terms_of
from .packing import CONSTANT, DIAGONAL, PACKED, Packing
from .perturbed import perturbed
from .runs import Record, Results, Run, acceleration, accelerations, count_steps, project, settings, step
from .systems import CoreSystem, Kind, kinds

__all__ = [
    "CALLBACK", "CALLBACK_CODE", "CONSTANT", "DIAGONAL", "DONE", "ERRORS", "EVENT", "FULL", "INTERRUPTED", "PACKED",
    "PAUSED", "ROW_VALUES", "TERMS", "VERSION", "Card", "CoreSystem", "Function", "InLibrary", "Kind",
    "NativeCore", "Outputs", "Packing", "Parameter", "PythonCore", "Record", "Results", "Run", "Variable", "Watcher",
    "acceleration", "accelerations", "address_of", "cards", "clash", "count_steps", "default", "doubles", "error_of", "find",
    "in_library",
    "is_length", "kind_at", "kinds", "load_data", "numba_signature", "perturbed", "probe", "project",
    "required", "settings", "step", "terms_of",
]

check_fingerprint()
