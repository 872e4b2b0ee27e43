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

from .._private import checks, gateway
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
    values = checks.real(f"{name} must hold", given).astype(float)
    values = values[:, None] if values.ndim == 1 else values
    if values.ndim != 2 or not len(values) or not np.isfinite(values).all():
        raise WrongValue(f"{name} must have shape (k,) or (k, size) and be finite, not {checks.shown(given)}", "shape")
    if t is not None and len(values) != len(t):
        raise WrongValue(f"{name} must have one value for each of {len(t)} times, not {len(values)}", "shape")
    if speed is not None:
        return Prescribed(values, np.full_like(values, speed), np.zeros_like(values), 0.0)
    if t is None:
        return Prescribed(values, np.full_like(values, np.nan), np.full_like(values, np.nan), np.nan)
    return _of_array(values, t)


def _of_function(name: str, given: Any, t: np.ndarray) -> Prescribed:
    function, some = _of_expression(name, given) if hasattr(given, "free_symbols") else given, len(t) // 3
    expected = _parts(name, function, float(t[some]))
    try:
        with np.errstate(all="ignore"):
            parts = _parts(name, function, t)
        is_elementwise = (np.abs(parts[..., some] - expected) <= 1e-12 + 1e-9 * np.abs(expected)).all()
    except Exception:
        is_elementwise = False      # it takes single times only
    if not is_elementwise or not np.isfinite(parts).all():
        parts = np.dstack([_parts(name, function, each) for each in t.tolist()])
        if not np.isfinite(parts).all():
            raise WrongValue(f"{name} must be finite with its derivatives at all samples", "not-finite")
    values, rates, seconds = np.ascontiguousarray(parts.swapaxes(1, 2))
    return Prescribed(values, rates, seconds, 0.0)


def _parts(name: str, function: Callable[[Any], Any], t: Any) -> np.ndarray:
    """Values with their first and second derivatives with respect to time, (3, size), or (3, size, k) at times (k,)."""
    try:
        found = np.ravel(np.asarray(function(autodiff.Jet(t, 0.0, 1.0, 0.0)), dtype=object))
    except Exception as error:
        checks.tell(error, f"in {name}, called at t = {t:g}: it must be written in NumPy's functions")
        raise
    parts = np.empty((3, len(found), *np.shape(t)))
    for j, each in enumerate(found):
        jet = each if isinstance(each, autodiff.Jet) else autodiff.Jet(checks.number(name, each))
        parts[0, j], parts[1, j], parts[2, j] = jet.value, jet.first, jet.second
    return parts


def _of_expression(name: str, given: Any) -> Callable[[Any], Any]:
    import sympy  # slow to import, and not needed without expressions

    symbols = sorted(given.free_symbols, key=str)
    if len(symbols) > 1:
        raise WrongValue(f"{name} must be an expression in t alone, not in {', '.join(map(str, symbols))}", "expression")
    symbol = symbols[0] if symbols else sympy.Symbol("t")
    entries = list(given) if isinstance(given, sympy.MatrixBase) else [given]
    parts = [sympy.lambdify(symbol, [each.diff(symbol, order) for each in entries], "numpy") for order in range(3)]

    def function(t: Any) -> np.ndarray:
        return np.array([autodiff.Jet(value, 0.0, rate, second)
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
    rate, second = rates.copy(), seconds.copy()
    gateway.quintic_spline(t, values, rate, second)
    at_ends = float(np.abs(seconds - coarse)[[0, -1]].max())
    return Prescribed(values, rate, second, max(at_ends, float(np.abs(second - seconds).max())), rounding)


def _of_polynomials(values: np.ndarray, t: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives (k, size) of polynomials through so many nearest samples, in Newton's form."""
    k, count = len(t), max(1, min(count, len(t)))
    near = np.clip(np.arange(k) - count // 2, 0, k - count)[:, None] + np.arange(count)
    x, c = (t[near] - t[:, None])[..., None], values[near]
    for j in range(1, count):
        c[:, j:] = (c[:, j:] - c[:, j - 1:-1]) / (x[:, j:] - x[:, :-j])
    value, rate, second = np.zeros((3, *values.shape))
    for j in reversed(range(count)):
        second = 2 * rate - x[:, j] * second
        rate = value - x[:, j] * rate
        value = c[:, j] - x[:, j] * value
    return rate, second
