"""The one door between Python and the C core: nothing outside this package touches ``ffi`` and ``lib``."""

from .base import (
    CALLBACK,
    DONE,
    ERRORS,
    EVENT,
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
from .callbacks import PythonCore, Watcher
from .runs import Record, Run, acceleration, count_steps, project, settings, step
from .systems import CoreSystem, Kind, kinds

__all__ = [
    "CALLBACK", "DONE", "ERRORS", "EVENT", "FULL", "INTERRUPTED", "PAUSED", "TERMS", "Card", "CoreSystem", "Kind", "Parameter",
    "PythonCore", "Record", "Run", "Variable", "Watcher", "acceleration", "cards", "count_steps", "doubles", "error_of", "kinds",
    "project", "settings", "step",
]

check_fingerprint()
