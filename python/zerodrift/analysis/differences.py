"""Derivatives by central differences of eighth order, with an estimate of their error.

The difference of eighth order is compared with that of sixth order, which uses the same points. Where they disagree, as they do
near kinks and for functions that vary on a short scale, the step is reduced; below that, the fourth-order difference with a
short step stands. Many directions are differenced at once, so that one call evaluates all states. For functions that are smooth
on their characteristic scale the error is a few units of rounding divided by the first step, 1e-14.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

POINTS = np.array([1.0, 2.0, 3.0, 4.0])     # k
EIGHTH = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])      # weights of f(k h) - f(-k h), k = 1 ... 4, over h
SIXTH = np.array([3 / 4, -3 / 20, 1 / 60, 0.0])
WEIGHTS = np.array([EIGHTH, SIXTH])
FOURTH = np.array([2 / 3, -1 / 12, 0.0, 0.0])
NODES = np.arange(9.0)     # of one-sided differences of eighth and of sixth order
ONE_SIDED = np.array([np.append(np.linalg.inv(np.vander(NODES[:n], increasing=True))[1], np.zeros(9 - n)) for n in (9, 7)])
STEPS = (2e-2, 2e-3, 5e-4)      # in characteristic scales
ROUGH_STEP = 1e-4
AGREE = 1e-10                   # of the size: accepted without a shorter step


Function = Callable[[np.ndarray, np.ndarray], np.ndarray]


def each(function: Function, sizes: np.ndarray, width: int) -> np.ndarray:
    """Derivatives (k, width) at h = 0 along k directions.

    Parameters
    ----------
    function : callable
        Function of the numbers (j,) of directions and the distances h (j,) along them; returns values (j, width).
    sizes : ndarray (k,)
        The sizes of the directions in characteristic scales: steps are so many times shorter. Zero: nothing changes along it.
    width : int
    """
    return each_with_error(function, sizes, width)[0]


def each_roughly(function: Function, sizes: np.ndarray, width: int) -> np.ndarray:
    """Derivatives as of `each`, by differences of second order with relative errors of 1e-8: for the steps of an iteration."""
    h, which = ROUGH_STEP / np.maximum(sizes, 1e-300), np.arange(len(sizes))
    if not which.size:
        return np.zeros((0, width))
    values = np.asarray(function(np.concatenate([which, which]), np.concatenate([h, -h])), dtype=float)
    return np.where(sizes[:, None] > 0, (values[:len(h)] - values[len(h):]) / (2 * h[:, None]), 0.0)


def each_with_error(function: Function, sizes: np.ndarray, width: int, small: float = 1e-300) -> tuple[np.ndarray, np.ndarray]:
    """The derivatives of `each`, and the differences (k,) to those of lower order, which estimate their errors.

    Errors are compared with the derivative, or with `small` where that is larger.
    """
    best, error = np.zeros((len(sizes), width)), np.where(sizes > 0, np.inf, 0.0)
    left = np.flatnonzero(sizes > 0)
    for step in STEPS:
        if not left.size:
            break
        h = step / sizes[left]
        distances = h[:, None] * np.concatenate([POINTS, -POINTS])
        values = np.asarray(function(np.repeat(left, distances.shape[1]), distances.ravel()), dtype=float)
        values = values.reshape(*distances.shape, width)
        change = values[:, :len(POINTS)] - values[:, len(POINTS):]
        derivative, lower = (WEIGHTS @ change).swapaxes(0, 1) / h[:, None]
        found = np.abs(derivative - lower).max(axis=1, initial=0.0)
        is_better = found < error[left]
        best[left[is_better]], error[left[is_better]] = derivative[is_better], found[is_better]
        if step == STEPS[-1] and np.isinf(error[left]).any():       # not a number at all steps
            best[np.isinf(error)] = (FOURTH @ change / h[:, None])[np.isinf(error[left])]
        left = left[~(found <= AGREE * np.abs(derivative).max(axis=1, initial=small))]
    return best, error


def along(function: Callable[[float], np.ndarray], size: float) -> np.ndarray:
    """The derivative of ``function(h)``, of a float, (n,), at h = 0, along a direction of that size in characteristic scales."""
    return with_error(function, size)[0]


def with_error(function: Callable[[float], np.ndarray], size: float, small: float = 1e-300) -> tuple[np.ndarray, float]:
    """Derivative as of `along`, and its difference from that of lower order, which estimates the error."""
    width = np.size(function(0.0))

    def values(_: np.ndarray, distances: np.ndarray) -> np.ndarray:
        return np.array([function(float(h)) for h in distances])

    found, error = each_with_error(values, np.array([float(size)]), width, small)
    return found[0], float(error[0])


def one_sided_with_error(function: Callable[[float], np.ndarray], size: float, side: float,
                         small: float = 1e-300) -> tuple[np.ndarray, float]:
    """Derivative and error as of `with_error`, by values at h = 0 and on one side of it, 1 or -1: the other may be undefined."""
    best, least = np.zeros(0), np.inf
    for step in STEPS:
        h = side * step / size
        derivative, lower = ONE_SIDED @ np.array([function(float(k * h)) for k in NODES]) / h
        error = float(np.abs(derivative - lower).max(initial=0.0))
        best, least = (derivative, error) if not best.size or error < least else (best, least)
        if error <= AGREE * np.abs(derivative).max(initial=small):
            break
    return best, least
