"""Arguments are checked at the door: each error names the argument, its value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np


def number(name: str, value: Any, *, above: float | None = None, least: float | None = None) -> float:
    """A finite real number, more than `above` or at least `least`."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, Real):
        raise TypeError(f"{name} must be a real number, not {value!r}")
    value = _double(value)
    if not math.isfinite(value):
        raise ValueError(f"{name} must be finite, not {value}")
    if above is not None and not value > above:
        raise ValueError(f"{name} must be greater than {above:g}, not {value:g}")
    if least is not None and not value >= least:
        raise ValueError(f"{name} must be at least {least:g}, not {value:g}")
    return value


def _double(value: Real) -> float:
    try:
        return float(value)
    except OverflowError:       # whole numbers may be larger than doubles
        return math.inf


def count(name: str, value: Any, *, least: int = 1) -> int:
    """A whole number, at least `least`."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, Integral):
        raise TypeError(f"{name} must be a whole number, not {value!r}")
    if not least <= value < 2**31:
        raise ValueError(f"{name} must be between {least} and {2**31 - 1}, not {value}")
    return int(value)


def choice(name: str, value: Any, allowed: Iterable[str]) -> str:
    """One of the allowed words."""
    words = list(allowed)
    if isinstance(value, str) and value in words:
        return value
    raise ValueError(f"{name} must be one of {', '.join(map(repr, words))}, not {value!r}")


def names(name: str, value: Any, prefix: str, *, least: int = 1) -> list[str]:
    """Different names, given as a sequence or in one string; or how many, numbered behind the prefix."""
    if isinstance(value, str):
        value = value.replace(",", " ").split()
    if not isinstance(value, Sequence):
        return [f"{prefix}{i}" for i in range(count(name, value, least=least))]
    words = list(value)
    if len(words) < least or not all(isinstance(word, str) and word for word in words) or len(set(words)) != len(words):
        raise ValueError(f"{name} must be a number or different names, not {words!r}")
    return words


def vector(name: str, value: Any, size: int) -> np.ndarray:
    """A fresh, contiguous float64 array of shape (size,), all finite."""
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name} must have shape ({size},), not be a ragged sequence") from error
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers, not {array.dtype}")
    if array.shape != (size,):
        raise ValueError(f"{name} must have shape ({size},), not {array.shape}")
    array = np.array(array, dtype=np.float64, order="C")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite, not {array}")
    return array


def span(value: Any) -> tuple[float, float]:
    """`t_span`: an end time, or (t0, t1)."""
    if isinstance(value, Real):
        t0, t1 = 0.0, number("t_span", value)
    else:
        try:
            t0, t1 = value
        except (TypeError, ValueError):
            raise TypeError(f"t_span must be an end time or a pair (t0, t1), not {value!r}") from None
        t0, t1 = number("t_span[0]", t0), number("t_span[1]", t1)
    if not t1 > t0:
        raise ValueError(f"t_span must run forwards: {t1:g} is not after {t0:g}")
    number("the length of t_span", t1 - t0)
    return t0, t1
