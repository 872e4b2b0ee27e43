"""Interface between Python and the C core: only this package uses ``ffi`` and ``lib``.

Its modules of mechanisms are imported by `zerodrift.mechanisms` alone.
"""
# ruff: noqa: F401

import importlib
from typing import Any

from .base import (
    ADAPTIVE_STEPS,
    BAD_ARGUMENT,
    BAD_INPUT,
    CALLBACK,
    COLLAPSED,
    DONE,
    ERRORS,
    EVENT,
    FINGERPRINT,
    FIXED_STEPS,
    FULL,
    INTERRUPTED,
    LAYOUT,
    PAUSED,
    PROCESSOR_UNIT,
    ROW_VALUES,
    SWITCHES,
    TERMS,
    WARNING_LIMITS,
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
from .derived_systems import PerturbedCore, gaps, in_phase, perturbed, switch, switching_rows
from .inputs import Following, Inputs
from .kinematics import Prescribing, Tracked, quintic_spline
from .known_events import KnownEvent
from .measures import MAX_LEAST, Acting, Outputs
from .operations import acceleration, accelerations, accelerations_with, needed_efforts, project, states_between
from .packed_layout import CONSTANT, DIAGONAL, PACKED, Packing
from .records import COUNTS, Record, row_bytes
from .runs import (
    Results,
    Run,
    Saved,
    Statistics,
    closed_form_unit,
    count_steps,
    disagreement,
    lanes_serve,
    row_takes_series,
    settings,
    takes_closed_form,
    takes_embeddings,
    takes_jacobian,
    takes_series,
)
from .systems import CoreSystem, Kind, kinds

# Imported at first use: most people have no compiled systems of their own.
_LATER = {
    "batches": ("Assembly", "BY_ITSELF", "BatchResults", "IN_LANES", "NOT_BEGUN", "UNUSUAL", "Stop", "derive", "error_name",
                "has_lanes", "run_batch", "tables_of_kind"),
    "compiled.functions": ("Function", "InLibrary", "SET_SINES_OF_LARGE", "address_of", "find", "in_library", "load_data",
                           "numba_signature", "set_sines_of_large"),
    "open_runs": ("ManyOpenRuns", "OpenRun", "STEP", "Saved", "NO_RECORD", "MAX_STEPS", "phase_at"),
    "compiled.native": ("VERSION", "NativeCore", "kind_at", "probe", "terms_of"),
}


def _at_first_use(name: str) -> Any:
    for module, names in _LATER.items():
        if name in names:
            globals()[name] = found = getattr(importlib.import_module(f".{module}", __name__), name)
            return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__getattr__ = _at_first_use     # assigned, as type checkers then know it before they have read this file
check_fingerprint()
