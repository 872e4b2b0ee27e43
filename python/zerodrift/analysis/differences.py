"""Derivatives by central differences of eighth order, with an estimate of their error.

The difference of eighth order is compared with that of sixth order, which uses the same points. Where they disagree, as they do
near kinks and for functions that vary on a short scale, the step is reduced; below that, the fourth-order difference with a
short step stands. For functions that are smooth on their characteristic scale the error is a few units of rounding divided by
the first step, 1e-14.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

EIGHTH = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])      # weights of f(k h) - f(-k h), k = 1 ... 4, over h
SIXTH = np.array([3 / 4, -3 / 20, 1 / 60, 0.0])
FOURTH = np.array([2 / 3, -1 / 12, 0.0, 0.0])
STEPS = (2e-2, 2e-3, 5e-4)      # in characteristic scales
ROUGH_STEP = 1e-4
AGREE = 1e-10                   # of the size: accepted without a shorter step


def roughly(function: Callable[[float], np.ndarray], size: float) -> np.ndarray:
    """The derivative at h = 0 by a central difference of second order, 1e-8 relative: for the steps of an iteration."""
    h = ROUGH_STEP / max(size, 1e-300)
    return (np.asarray(function(h), dtype=float) - np.asarray(function(-h), dtype=float)) / (2 * h) if size > 0 else (
        np.zeros_like(np.asarray(function(0.0), dtype=float)))


def along(function: Callable[[float], np.ndarray], size: float) -> np.ndarray:
    """The derivative of ``function(h)`` at h = 0.

    Parameters
    ----------
    function : callable
        Of a float; returns an array.
    size : float
        The size of the direction in characteristic scales: steps are so many times shorter.

    Returns
    -------
    ndarray
    """
    return with_error(function, size)[0]


def with_error(function: Callable[[float], np.ndarray], size: float) -> tuple[np.ndarray, float]:
    """The derivative of `along`, and the difference to that of lower order, which estimates its error."""
    if not size > 0:
        return np.zeros_like(np.asarray(function(0.0), dtype=float)), 0.0
    best, least = None, np.inf
    for step in STEPS:
        h = step / size
        ends = np.array([np.asarray(function(k * h), dtype=float) - np.asarray(function(-k * h), dtype=float)
                         for k in (1, 2, 3, 4)])
        derivative, lower = (np.tensordot(weights, ends, 1) / h for weights in (EIGHTH, SIXTH))
        error = float(np.abs(derivative - lower).max(initial=0.0))
        if error < least:
            best, least = derivative, error
        if error <= AGREE * np.abs(derivative).max(initial=1e-300):
            return derivative, error
    return (np.tensordot(FOURTH, ends, 1) / h, np.inf) if best is None else (best, least)
