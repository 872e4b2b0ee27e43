"""Minimum-norm solutions of linear equations, which may be redundant, and the Levenberg-Marquardt method."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

RANK = 1e-9             # of the largest singular value: bound below which rows are redundant
ATTEMPTS = 200          # accepted steps of a minimization, at most
FIRST_DAMPING, MOST_DAMPING = 1e-2, 1e12


class Damping(NamedTuple):
    """Control of the damping: its factor after a refused step, its divisor after an accepted one, its minimum, and when to stop.

    The minimization stops at a sum of squares below `solved`, and after a gain below `least_gain`, relative to that sum,
    or below `least_absolute_gain`.
    """

    refused: float
    accepted: float
    minimum: float
    solved: float
    least_gain: float
    least_absolute_gain: float


class Attempt(NamedTuple):
    """Positions with their residuals, the Jacobian, and the sum of squares that is minimized."""

    p: np.ndarray
    residual: np.ndarray
    rows: Any
    size: float


def levenberg_marquardt(at: Attempt, step: Callable[[Attempt], Callable[[float], Attempt | None]], control: Damping) -> Attempt:
    """Positions with the smallest sum of squares that damped steps reach.

    `step(at)` returns what takes the damping and returns the attempt after the damped step, or None if that cannot be made.
    """
    damping = FIRST_DAMPING
    for _ in range(ATTEMPTS):
        if at.size < control.solved:
            break
        damped = step(at)
        while damping < MOST_DAMPING:
            tried = damped(damping)
            if tried is not None and tried.size < at.size:
                break
            damping *= control.refused
        else:
            break
        gain, size = at.size - tried.size, at.size
        at, damping = tried, max(damping / control.accepted, control.minimum)
        if gain < control.least_gain * size or gain < control.least_absolute_gain:
            break
    return at


def shortest(rows: np.ndarray, weight: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution x of rows @ x = right, or of least squares, with the smallest norm of weight * x."""
    unit = units(rows, weight)
    return np.linalg.lstsq(rows / weight * unit[:, None], right * unit, rcond=RANK)[0] / weight


def units(rows: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Factors (m,) that preserve the lengths of rows when they are divided by the weights.

    Without them the rows of light bodies would be so long that those of heavy ones seem redundant.
    """
    weighted = np.linalg.norm(rows / weight, axis=1)
    return np.where(weighted > 0, np.linalg.norm(rows, axis=1) / np.where(weighted > 0, weighted, 1.0), 1.0)


def least_along(rows: np.ndarray, free: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Minimum-norm y with rows @ free @ y nearest to the right side, without directions that change rows by rounding only."""
    u, s, vt = np.linalg.svd(rows @ free, full_matrices=False)
    counts = s > RANK * np.linalg.norm(rows) * np.linalg.norm(free)
    return vt[counts].T @ ((u.T @ right)[counts] / s[counts])


def nullspace(rows: np.ndarray) -> np.ndarray:
    """Orthonormal basis (n, k) of the null space of the rows."""
    if not len(rows):
        return np.eye(rows.shape[1])
    _, s, vt = np.linalg.svd(rows)
    rank = int((s > RANK * s.max(initial=0.0)).sum())
    return vt[rank:].T
