"""Prescribed quantities over time: values, rates and second rates at samples, from arrays, callables or SymPy expressions.

Arrays over time become splines of degree five, whose fourth derivative is continuous, with the derivatives at both ends of
polynomials through the seven nearest samples. The estimate of the error is the largest difference of its second derivatives to
those of such polynomials, and at the ends of these to those through six samples. Callables of NumPy functions are differentiated
by forward mode, expressions by SymPy, both exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .. import _check
from ..errors import WrongType, WrongValue
from ..systems import autodiff

NEAREST = 7
VALUE_ROUNDING = 1e-12  # of values, over the square of the distance: 1e-13 was measured


class Prescribed(NamedTuple):
    """A quantity at k samples: value, rate and second rate (k, size), the estimated error of the latter, and its rounding."""

    value: np.ndarray
    rate: np.ndarray
    second: np.ndarray
    error: float
    rounding: float = 0.0


def prescribed(name: str, given: Any, t: np.ndarray | None, speed: float | None) -> Prescribed:
    """A quantity from what was given for it: an array over the samples, a callable of t, or a SymPy expression in t.

    Raises
    ------
    ValueError, TypeError
        If it has another number of samples, or is not finite.
    """
    if callable(given) or hasattr(given, "free_symbols"):
        if t is None:
            raise WrongType(f"{name} is a function of time, and t must be given: the times of the samples", "missing-argument")
        return _of_function(name, given, t)
    values = _check.real(f"{name} must hold", given).astype(float)
    values = values[:, None] if values.ndim == 1 else values
    if values.ndim != 2 or not len(values) or not np.isfinite(values).all():
        raise WrongValue(f"{name} must have shape (k,) or (k, size) and be finite, not {_check.shown(given)}", "shape")
    if t is not None and len(values) != len(t):
        raise WrongValue(f"{name} must have one value for each of {len(t)} times, not {len(values)}", "shape")
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
        raise WrongValue(f"{name} must be finite with its derivatives at all samples", "not-finite")
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
        raise WrongValue(f"{name} must be an expression in t alone, not in {', '.join(map(str, symbols))}", "expression")
    symbol = symbols[0] if symbols else sympy.Symbol("t")
    entries = list(given) if isinstance(given, sympy.MatrixBase) else [given]
    parts = [sympy.lambdify(symbol, [each.diff(symbol, order) for each in entries], "numpy") for order in range(3)]

    def function(t: Any) -> np.ndarray:
        return np.array([autodiff.Jet(float(value), 0.0, float(rate), float(second))
                         for value, rate, second in zip(*(part(t.value) for part in parts), strict=True)], dtype=object)

    return function


def _of_array(values: np.ndarray, t: np.ndarray) -> Prescribed:
    """Derivatives of an array over time."""
    rates, seconds = _of_polynomials(values, t, NEAREST)
    _, coarse = _of_polynomials(values, t, NEAREST - 1)
    rounding = VALUE_ROUNDING * float(np.abs(values).max() / np.diff(t).min(initial=np.inf)**2)
    if len(t) < NEAREST:        # a single polynomial
        error = float(np.abs(seconds - _of_polynomials(values, t, len(t) - 1)[1]).max())
        return Prescribed(values, rates, seconds, error, rounding)
    rate, second = _spline(values, np.diff(t), rates[[0, -1]], seconds[[0, -1]])
    at_ends = float(np.abs(seconds - coarse)[[0, -1]].max())
    return Prescribed(values, rate, second, max(at_ends, float(np.abs(second - seconds).max())), rounding)


def _of_polynomials(values: np.ndarray, t: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives (k, size) of polynomials through so many nearest samples."""
    local = [_weights(t, i, count) for i in range(len(t))]
    rates, seconds = (np.array([weights[order] @ values[weights[0]] for weights in local]) for order in (1, 2))
    return rates, seconds


def _spline(values: np.ndarray, h: np.ndarray, rates: np.ndarray, seconds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives (k, size) at the samples of the quintic spline with these derivatives at both ends, (2, size).

    Between two samples the polynomial of degree five follows from values and both derivatives at its ends. Its third and fourth
    derivatives are continuous at each inner sample: a block tridiagonal system for x = (rate, second), solved by elimination.
    """
    k, steps = len(values), np.diff(values, axis=0)
    x = np.zeros((k, 2, values.shape[1]))
    x[0], x[-1] = (np.stack([rates[i], seconds[i]]) for i in (0, 1))
    factor, right = [np.zeros((2, 2))], [x[0]]
    for i in range(1, k - 1):
        before, after = h[i - 1], h[i]
        lower = np.array([[-24 / before**2, -3 / before], [-168 / before**3, -24 / before**2]])
        middle = np.array([[-36 / before**2 + 36 / after**2, 9 / before + 9 / after],
                           [-192 / before**3 - 192 / after**3, 36 / before**2 - 36 / after**2]])
        upper = np.array([[24 / after**2, -3 / after], [-168 / after**3, 24 / after**2]])
        jump = np.stack([60 * (steps[i] / after**3 - steps[i - 1] / before**3),
                         -360 * (steps[i] / after**4 + steps[i - 1] / before**4)])
        pivot = np.linalg.inv(middle - lower @ factor[-1])
        factor.append(pivot @ upper)
        right.append(pivot @ (jump - lower @ right[-1]))
    for i in range(k - 2, 0, -1):
        x[i] = right[i] - factor[i] @ x[i + 1]
    return x[:, 0], x[:, 1]


def _weights(t: np.ndarray, i: int, count: int) -> tuple[slice, np.ndarray, np.ndarray]:
    """So many samples next to one, and their weights in its first and second derivative."""
    count = max(1, min(count, len(t)))
    first = min(max(0, i - count // 2), len(t) - count)
    near = slice(first, first + count)
    offset = t[near] - t[i]
    size = float(np.abs(offset).max()) or 1.0
    inverse = np.linalg.inv(np.vander(offset / size, increasing=True))
    none = np.zeros(count)
    return near, inverse[1] / size if count > 1 else none, 2 * inverse[2] / size**2 if count > 2 else none
