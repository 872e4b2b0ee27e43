"""Levenberg-Marquardt method for the sparse rows of many bodies."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

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
