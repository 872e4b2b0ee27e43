"""The one door between Python and the C core: nothing outside this package touches ``ffi`` and ``lib``."""

from .base import (
    CALLBACK,
    DONE,
    ERRORS,
    FULL,
    INTERRUPTED,
    PAUSED,
    TERMS,
    Card,
    Parameter,
    Variable,
    cards,
    check_fingerprint,
    doubles,
    error_of,
)
from .callbacks import PythonCore
from .native import NativeCore, address_of, load_library
from .runs import Record, Run, acceleration, count_steps, project, settings, step
from .systems import CoreSystem, Kind, kinds

__all__ = [
    "CALLBACK", "DONE", "ERRORS", "FULL", "INTERRUPTED", "PAUSED", "TERMS", "Card", "CoreSystem", "Kind", "NativeCore",
    "Parameter", "PythonCore", "Record", "Run", "Variable", "acceleration", "address_of", "cards", "count_steps", "doubles",
    "error_of", "kinds", "load_library", "project", "settings", "step",
]

check_fingerprint()
