"""Reach of drives: the dead point at which joints no longer let a driven coordinate move on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..systems.base import BaseSystem
from .retraction import onto
from .state import State, scales, state
from .tangent import DEPENDENT

LARGEST_STEP = 0.25     # of a part of the way, in characteristic scales
SMALLEST_PART = 1e-12   # of the time, or of the way ahead
DEAD = 1e-3             # residual norm of a drive's constraint relative to its scale: next to a dead point
CLOSED = 1e-11         # m, or rad: residuals of constraints
LARGEST = 300           # velocities


class DeadPointOfDrive(NamedTuple):
    """Last state that drives reach, at rest, and the constraints of those that end there."""

    at: State
    rows: list[int]


def dead_point(system: BaseSystem, drives: Mapping[int, float], t: float, p: np.ndarray,
               ahead: float) -> DeadPointOfDrive | None:
    """Dead point of drives that a motion at (t, p) comes to within a time `ahead` in s; None: it does not.

    `drives` are constraints that move with time, and the characteristic scales of what they drive, in rad or m.
    """
    if not system.mh or system.nv > LARGEST or not np.isfinite(p).all():
        return None
    begin, end = _reached(system, t, p, ahead), t + ahead
    if begin is None:
        return None
    (t, p), part = begin, ahead
    while part > SMALLEST_PART * max(abs(t), ahead):
        found = _part(system, t + part, p)
        if found is None:
            part /= 2
            continue
        t, p = t + part, found
        if t >= end:
            return None
        part = min(2 * part, end - t)
    at = state(system, t, p, np.zeros(system.nv))
    rows = _dependent(at, drives)
    return DeadPointOfDrive(at, rows) if rows else None


def _reached(system: BaseSystem, t: float, p: np.ndarray, ahead: float) -> tuple[float, np.ndarray] | None:
    """Last time, not later than t, at which there is a position next to p, and this position."""
    for back in (0.0, *(ahead / 2**k for k in range(40, -1, -1))):
        if (found := _part(system, t - back, p)) is not None:
            return t - back, found
    return None


def _part(system: BaseSystem, t: float, p: np.ndarray) -> np.ndarray | None:
    """Position at a time, next to p; None if there is none that near."""
    try:
        found = onto(system, t, p)
        if np.abs(state(system, t, found, np.zeros(system.nv)).Phi).max() > CLOSED:
            return None
    except Exception:       # user functions may fail at later times, too
        return None
    return found if float(np.abs((found - p) / scales(system, p).p).max()) <= LARGEST_STEP else None


def _dependent(at: State, drives: Mapping[int, float]) -> list[int]:
    """Drives whose constraints depend on all others, or vanish, so that no velocities satisfy them."""
    rows, found = at.holonomic * scales(at.system, at.p).v, []
    for k, size in drives.items():
        others = np.delete(rows, k, axis=0)
        others = others / np.maximum(np.linalg.norm(others, axis=1, keepdims=True), 1e-300)
        weights = np.linalg.lstsq(others.T, rows[k], rcond=DEPENDENT)[0]
        if at.Phi_t[k] and np.linalg.norm(others.T @ weights - rows[k]) < DEAD * size:
            found.append(k)
    return found
