"""Constrained multibody systems without constraint drift.

>>> import zerodrift as zd
>>> bar = zd.systems.four_bar()
>>> sol = zd.simulate(bar, 8.0, step=0.05, energy=True)
>>> ax = zd.plot.motion(sol)
"""

import importlib
from typing import Any

from . import systems
from .checking import check
from .custom import System
from .errors import (
    Bifurcation,
    CorrectionFailed,
    CorrectionWarning,
    Diverged,
    InconsistentStart,
    Interrupted,
    SingularSystem,
    StaleCore,
    StepFailed,
    UnreachableTolerance,
    UnsuitedFormulation,
    ZerodriftError,
)
from .operations import acceleration, assemble, project
from .settings import Baumgarte, EnergyCorrection, Projection, corrections, formulations, integrators
from .simulation import simulate
from .solution import Solution, load

__version__ = "0.1.0"
__all__ = [
    "Baumgarte", "Bifurcation", "CorrectionFailed", "CorrectionWarning", "Diverged", "EnergyCorrection", "InconsistentStart",
    "Interrupted", "Projection", "SingularSystem", "Solution", "StaleCore", "StepFailed", "System",
    "UnreachableTolerance", "UnsuitedFormulation", "ZerodriftError", "acceleration", "assemble", "check",
    "corrections", "formulations", "integrators", "load", "plot", "project", "reference", "simulate", "systems",
    "tune", "work_precision",
]
_LATER = {"reference": "certified", "tune": "tuning", "work_precision": "benchmarking"}     # imported at first use


def __getattr__(name: str) -> Any:
    if name == "plot":      # matplotlib is imported when something is drawn
        return importlib.import_module(".plot", __name__)
    if name in _LATER:
        return getattr(importlib.import_module(f".{_LATER[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
