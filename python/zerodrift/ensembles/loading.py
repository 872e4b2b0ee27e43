"""Ensembles from files and from stores."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..errors import WrongValue
from ..systems.base import BaseSystem
from . import saving, store
from .part import filled
from .result import Ensemble


def read(path: str | Path, rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> Ensemble | None:
    """Ensemble of a file or folder; None if it has none. `rebuilt` makes the system of a mechanism from JSON."""
    if not Path(path).is_dir():
        found = saving.read(path, rebuilt)
        return None if found is None else Ensemble(*found, 0.0, f"as {Path(path).name} has it")
    if not store.is_one(path):
        raise WrongValue(f"{path} is a folder, and no store of an ensemble", "unreadable-file")
    plan, parts = store.load(path, rebuilt)
    return Ensemble(plan, filled(parts, plan.runs.count), 0.0, f"as {Path(path).name} has it")
