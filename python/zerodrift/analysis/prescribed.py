"""Prescribed quantities over time: values, rates and second rates at samples, from arrays, callables or SymPy expressions.

Arrays over time are differentiated by polynomials of degree six through the seven nearest samples; the difference to degree
four is the estimate of their error. Callables of NumPy functions are differentiated by forward mode, expressions by SymPy, both
exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .. import _check
from ..systems import autodiff

NEAREST = 7


class Prescribed(NamedTuple):
    """A quantity at k samples: value, rate and second rate (k, size), and the estimated error of the second rate."""

    value: np.ndarray
    rate: np.ndarray
    second: np.ndarray
    error: float


def prescribed(name: str, given: Any, t: np.ndarray | None, speed: float | None) -> Prescribed:
    """A quantity from what was given for it: an array over the samples, a callable of t, or a SymPy expression in t.

    Raises
    ------
    ValueError, TypeError
        If it has another number of samples, or is not finite.
    """
    if callable(given) or hasattr(given, "free_symbols"):
        if t is None:
            raise TypeError(f"{name} is a function of time, and t must be given: the times of the samples")
        return _of_function(name, given, t)
    values = _check.real(f"{name} must hold", given).astype(float)
    values = values[:, None] if values.ndim == 1 else values
    if values.ndim != 2 or not len(values) or not np.isfinite(values).all():
        raise ValueError(f"{name} must have shape (k,) or (k, size) and be finite, not {_check.shown(given)}")
    if t is not None and len(values) != len(t):
        raise ValueError(f"{name} must have one value for each of {len(t)} times, not {len(values)}")
    if speed is not None:
        return Prescribed(values, np.full_like(values, speed), np.zeros_like(values), 0.0)
    if t is None:
        return Prescribed(values, np.full_like(values, np.nan), np.full_like(values, np.nan), np.nan)
    return _of_array(values, t)


def _of_function(name: str, given: Any, t: np.ndarray) -> Prescribed:
    function = _of_expression(name, given) if hasattr(given, "free_symbols") else given
    samples = [_jets(name, function, float(each)) for each in t]
    value, rate, second = (np.array([autodiff.part(each, part, None) for each in samples], dtype=float) for part in PARTS)
    if not (np.isfinite(value).all() and np.isfinite(rate).all() and np.isfinite(second).all()):
        raise ValueError(f"{name} must be finite with its derivatives at all samples")
    return Prescribed(value, rate, second, 0.0)


PARTS = ("value", "first", "second")


def _jets(name: str, function: Callable[[Any], Any], t: float) -> np.ndarray:
    """The values of a function (size,) with their derivatives with respect to time."""
    try:
        found = np.atleast_1d(np.asarray(function(autodiff.Jet(t, 0.0, 1.0, 0.0)), dtype=object))
    except Exception as error:
        _check.tell(error, f"in {name}, called at t = {t:g}: it must be written in NumPy's functions")
        raise
    jets = [each if isinstance(each, autodiff.Jet) else autodiff.Jet(_check.number(name, each)) for each in found.ravel()]
    return np.array(jets, dtype=object)


def _of_expression(name: str, given: Any) -> Callable[[Any], Any]:
    import sympy  # slow to import, and not needed without expressions

    symbols = sorted(given.free_symbols, key=str)
    if len(symbols) > 1:
        raise ValueError(f"{name} must be an expression in t alone, not in {', '.join(map(str, symbols))}")
    symbol = symbols[0] if symbols else sympy.Symbol("t")
    entries = list(given) if isinstance(given, sympy.MatrixBase) else [given]
    parts = [sympy.lambdify(symbol, [each.diff(symbol, order) for each in entries], "numpy") for order in range(3)]

    def function(t: Any) -> np.ndarray:
        return np.array([autodiff.Jet(float(value), 0.0, float(rate), float(second))
                         for value, rate, second in zip(*(part(t.value) for part in parts), strict=True)], dtype=object)

    return function


def _of_array(values: np.ndarray, t: np.ndarray) -> Prescribed:
    """Derivatives of an array over time."""
    rate, second, coarse = (np.zeros_like(values) for _ in range(3))
    for i in range(len(t)):
        fine, rough = (_weights(t, i, count) for count in (NEAREST, NEAREST - 2))
        rate[i], second[i] = (np.tensordot(each, values[fine[0]], 1) for each in fine[1:])
        coarse[i] = np.tensordot(rough[2], values[rough[0]], 1)
    return Prescribed(values, rate, second, float(np.abs(second - coarse).max(initial=0.0)))


def _weights(t: np.ndarray, i: int, count: int) -> tuple[slice, np.ndarray, np.ndarray]:
    """The samples next to one, and their weights in its first and second derivative."""
    count = min(count, len(t))
    first = min(max(0, i - count // 2), len(t) - count)
    near = slice(first, first + count)
    offset = t[near] - t[i]
    size = float(np.abs(offset).max()) or 1.0
    inverse = np.linalg.inv(np.vander(offset / size, increasing=True))
    none = np.zeros(count)
    return near, inverse[1] / size if count > 1 else none, 2 * inverse[2] / size**2 if count > 2 else none
