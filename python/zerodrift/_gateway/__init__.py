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
from .callbacks import CALLBACK_CODE, PythonCore
from .runs import Record, Run, acceleration, count_steps, project, settings, step
from .systems import CoreSystem, Kind, kinds

__all__ = [
    "CALLBACK", "CALLBACK_CODE", "DONE", "ERRORS", "FULL", "INTERRUPTED", "PAUSED", "TERMS", "Card", "CoreSystem", "Kind",
    "Parameter", "PythonCore", "Record", "Run", "Variable", "acceleration", "cards", "count_steps", "doubles", "error_of",
    "kinds", "project", "settings", "step",
]

check_fingerprint()
