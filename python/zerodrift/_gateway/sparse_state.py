"""Consistent velocities and redundant constraints of systems of many bodies, without dense matrices."""

from __future__ import annotations

from typing import Any

import numpy as np

from .base import cards, row_named
from .runs import Run, project, settings
from .systems import CoreSystem


def nearest_velocities(core: CoreSystem, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Consistent velocities nearest to `v` in the mass metric at (t, p); the positions may violate their constraints."""
    nearest = np.array(v, dtype=float)
    project(core, _settings(t, positions=0.0), t, np.array(p, dtype=float), nearest)
    return nearest


def redundant_rows(core: CoreSystem, t: float, p: np.ndarray, v: np.ndarray) -> list[int]:
    """Indices of redundant constraints, determined by the core at a consistent state.

    Raises
    ------
    Bifurcation
        If constraints are redundant at this state only.
    """
    return Run(core, _settings(t), p, v).results().redundant


def _settings(t: float, **given: float) -> Any:
    """Settings of a run that is created but makes no steps."""
    parameters = next(card.parameters for card in cards("corrections") if card.name == "projection")
    values = [given.get(parameter.name, parameter.initial[0]) for parameter in parameters if parameter.initial]
    return settings({"formulation": row_named("formulations", "augmented"), "t0": t, "t1": t + 1.0, "step": 1.0, "save_every": 1,
                     "correction": {"projection": values}})
