"""Numbers and starts of built-in systems as pairs of doubles: parameters exact, derived numbers correctly rounded."""

from __future__ import annotations

import decimal
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

# Coordinates and velocities that are given at the start, and from which all others follow.
HELD_AT_START: dict[str, tuple[list[int], list[int]]] = {"four_bar": ([0], [0])}


def exact_numbers(name: str, parameters: Mapping[str, Any]) -> np.ndarray:
    """Numbers (k, 2) of the functions in double-double arithmetic, high and low parts: see zd_precise."""
    given = {key: _exact(value) for key, value in parameters.items() if not isinstance(value, str) and value is not None}
    groups = list(given.values())
    if name == "four_bar":      # inertias of slender rods, m l^2 / 12, if none are given
        rods = tuple(m * length**2 / 12 for m, length in zip(given["masses"], given["lengths"][1:], strict=True))
        groups = [given["lengths"], given["masses"], given.get("inertias", rods), given["gravity"]]
    return _pairs([number for group in groups for number in group])


def exact_start(name: str, parameters: Mapping[str, Any]) -> tuple[np.ndarray, np.ndarray] | None:
    """Start p (nq, 2) and v (nv, 2) of a system whose start is computed from angles; None: doubles and constraints give it."""
    if name not in _STARTS:
        return None
    given = {key: Fraction(value) for key, value in parameters.items() if isinstance(value, float)}
    p, v = _STARTS[name](given)
    return _pairs(p), _pairs(v)


def _pairs(numbers: Sequence[Fraction]) -> np.ndarray:
    return np.array([[float(x), float(x - Fraction(float(x)))] for x in numbers]).reshape(-1, 2)


def sine_and_cosine(angle: Fraction) -> tuple[Fraction, Fraction]:
    """Sine and cosine to some 50 digits."""
    with decimal.localcontext(decimal.Context(prec=60)):
        sine, cosine = turned(decimal.Decimal(angle.numerator) / decimal.Decimal(angle.denominator))
    return Fraction(sine), Fraction(cosine)


def turned(angle: decimal.Decimal) -> tuple[decimal.Decimal, decimal.Decimal]:
    """Sine and cosine to the digits of the decimal context: by their series at a small part of the angle, doubled as often as
    that takes.
    """
    halvings = max(0, int(abs(angle)).bit_length() + 4)
    with decimal.localcontext() as context:
        context.prec += 10 + halvings
        x, least = angle / 2**halvings, decimal.Decimal(10)**-context.prec
        term, sine, cosine, n = decimal.Decimal(1), decimal.Decimal(0), decimal.Decimal(0), 0
        while abs(term) > least:
            cosine, sine = cosine + term * (1, 0, -1, 0)[n % 4], sine + term * (0, 1, 0, -1)[n % 4]
            term, n = term * x / (n + 1), n + 1
        for _ in range(halvings):
            sine, cosine = 2 * sine * cosine, (cosine - sine) * (cosine + sine)
    return sine, cosine


def _pendulum_start(given: Mapping[str, Fraction]) -> tuple[list[Fraction], list[Fraction]]:
    s, c = sine_and_cosine(given["angle"])
    length, rate = given["length"], given["rate"]
    return [length * s, -length * c], [length * rate * c, length * rate * s]


def _skate_start(given: Mapping[str, Fraction]) -> tuple[list[Fraction], list[Fraction]]:
    s, c = sine_and_cosine(given["heading"])
    zero, speed = Fraction(0), given["speed"]
    return [zero, zero, given["heading"]], [speed * c, speed * s, given["turn_rate"]]


_STARTS = {"pendulum": _pendulum_start, "knife_edge": _skate_start}


def _exact(value: Any) -> tuple[Fraction, ...]:
    return tuple(map(Fraction, value)) if isinstance(value, Sequence) else (Fraction(value),)


ORTHONORMAL = Fraction(1, 10**32)       # largest residual of a frame that is orthonormal
REFINEMENTS = 4     # of frames, each of which gains the digits of a double

Entry = tuple[int, int]     # of a frame: the number of a value, or -1, and the factor of the value, or the entry itself


def low_parts_of_frames(frames: Sequence[Sequence[Sequence[Entry]]], values: np.ndarray) -> np.ndarray:
    """Low parts (k,) of values, with which frames (3, 3) of these are orthonormal; zeros if there are none.

    The frames are orthonormal to the digits of doubles. Newton's method solves F F^T = 1 by the smallest changes of their
    entries, with residuals in fractions.
    """
    numbers = {number for frame in frames for row in frame for number, _ in row} - {-1}
    places = {number: i for i, number in enumerate(sorted(numbers))}
    exact = {number: Fraction(float(values[number])) for number in places}
    for _ in range(REFINEMENTS):
        residuals, slopes = _orthonormality(frames, exact, places)
        if max(map(abs, residuals), default=0) <= ORTHONORMAL:
            low = np.zeros(len(values))
            for number, value in exact.items():
                low[number] = float(value - Fraction(float(values[number])))
            return low
        changes = np.linalg.lstsq(slopes, -np.array(residuals, dtype=float), rcond=None)[0]
        exact = {number: value + Fraction(float(changes[places[number]])) for number, value in exact.items()}
    return np.zeros(len(values))


def _orthonormality(frames: Sequence[Sequence[Sequence[Entry]]], exact: Mapping[int, Fraction],
                    places: Mapping[int, int]) -> tuple[list[Fraction], np.ndarray]:
    """Residuals F F^T - 1 of frames, and their derivatives with respect to the values."""
    residuals, slopes = [], []
    for frame in frames:
        entries = [[factor * exact.get(number, Fraction(1)) for number, factor in row] for row in frame]
        for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
            residuals.append(sum((a * b for a, b in zip(entries[i], entries[j], strict=True)), Fraction(-(i == j))))
            slopes.append(np.zeros(len(places)))
            for one, other in ((i, j), (j, i)):
                for (number, factor), value in zip(frame[one], entries[other], strict=True):
                    if number >= 0:
                        slopes[-1][places[number]] += factor * float(value)
    return residuals, np.array(slopes).reshape(len(residuals), len(places))
