"""Sums and products of double-double numbers in NumPy: arrays (..., 2) of high and low parts."""

from __future__ import annotations

from typing import Any

import numpy as np

EPS = 2.0**-104    # bound of the relative error of an operation
SPLITTER = 134217729.0


def of(x: Any) -> np.ndarray:
    """Double-double numbers of doubles."""
    x = np.asarray(x, dtype=float)
    found = np.zeros((*x.shape, 2))
    found[..., 0] = x
    return found


def plus(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Sum."""
    high, error = _two_sum(a[..., 0], b[..., 0])
    low, of_low = _two_sum(a[..., 1], b[..., 1])
    high, error = _quick_sum(high, error + low)
    return _paired(*_quick_sum(high, error + of_low))


def minus(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Difference."""
    return plus(a, -b)


def times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Product."""
    high = a[..., 0] * b[..., 0]
    (x, more_x), (y, more_y) = _split(a[..., 0]), _split(b[..., 0])
    error = ((x * y - high) + x * more_y + more_x * y) + more_x * more_y
    return _paired(*_quick_sum(high, error + (a[..., 0] * b[..., 1] + a[..., 1] * b[..., 0])))


def total(x: np.ndarray) -> np.ndarray:
    """Sum (2,) of the numbers (n, 2)."""
    found = np.zeros(2)
    for each in x:
        found = plus(found, each)
    return found


def _paired(high: np.ndarray, low: np.ndarray) -> np.ndarray:
    found = np.empty((*np.shape(high), 2))
    found[..., 0], found[..., 1] = high, low
    return found


def _two_sum(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    high = a + b
    of_b = high - a
    return high, (a - (high - of_b)) + (b - of_b)


def _quick_sum(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    high = a + b
    return high, b - (high - a)


def _split(a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    shifted = SPLITTER * a
    high = shifted - (shifted - a)
    return high, a - high
