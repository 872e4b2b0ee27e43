"""Numbers and starts of built-in systems as pairs of doubles: parameters exact, derived numbers correctly rounded."""

from __future__ import annotations

import decimal
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

# Coordinates and velocities that are given at the start, and from which all others follow.
HELD_AT_START: dict[str, tuple[list[int], list[int]]] = {
    "four_bar": ([0], [0]), "slider_crank": ([0], [0]), "rolling_disc": ([0, 1, 3, 4, 5], [3, 4, 5]),
    "vertical_disc": ([0, 1, 2, 3], [2, 3])}


def exact_numbers(name: str, parameters: Mapping[str, Any]) -> np.ndarray:
    """Numbers (k, 2) of the functions in double-double arithmetic, high and low parts: see zd_precise."""
    given = {key: _exact(value) for key, value in parameters.items() if not isinstance(value, str) and value is not None}
    derive = _DERIVED.get(name, _as_given)
    return _pairs([number for group in derive(given) for number in group])


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


def _disc_start(given: Mapping[str, Fraction]) -> tuple[list[Fraction], list[Fraction]]:
    """As rolling_disc.c: yaw and spin are 0, and the contact point is the origin."""
    s, c = sine_and_cosine(given["lean"])
    zero, R, lean_rate = Fraction(0), given["radius"], given["lean_rate"]
    w1 = given["spin_rate"] - given["yaw_rate"] * s
    return ([R * s, zero, R * c, zero, given["lean"], zero],
            [R * lean_rate * c, -R * w1, -R * lean_rate * s, w1, lean_rate, given["yaw_rate"] * c])


_STARTS = {"pendulum": _pendulum_start, "knife_edge": _skate_start, "chaplygin_sleigh": _skate_start, "rolling_disc": _disc_start}


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
            residuals.append(sum(a * b for a, b in zip(entries[i], entries[j], strict=True)) - (i == j))
            slopes.append(np.zeros(len(places)))
            for one, other in ((i, j), (j, i)):
                for (number, factor), value in zip(frame[one], entries[other], strict=True):
                    if number >= 0:
                        slopes[-1][places[number]] += factor * float(value)
    return residuals, np.array(slopes).reshape(len(residuals), len(places))


Groups = list[Sequence[Fraction]]
Given = Mapping[str, Sequence[Fraction]]


def _as_given(given: Given) -> Groups:
    return list(given.values())


def _bar(given: Given) -> Groups:
    """Inertias of slender rods, m l^2 / 12, if none are given."""
    rods = [m * length**2 / 12 for m, length in zip(given["masses"], given["lengths"][1:], strict=True)]
    return [given["lengths"], given["masses"], given.get("inertias", rods), given["gravity"]]


def _driven_bar(given: Given) -> Groups:
    return [*_bar(given), *(given[key] for key in ("crank_angle", "crank_rate", "amplitude", "frequency"))]


def _inertias(given: Given) -> Groups:
    """Inertias of a thin disc, m R^2 / 2 about its axle and half of it about a diameter, where they are not given."""
    (m,), (R,) = given["mass"], given["radius"]
    return [given.get("axle_inertia", (m * R**2 / 2,)), given.get("diameter_inertia", (m * R**2 / 4,))]


def _upright_disc(given: Given) -> Groups:
    return [given["mass"], given["radius"], *_inertias(given), *(given[key] for key in ("heading", "turn_rate", "roll_rate"))]


def _disc(given: Given) -> Groups:
    (m,), (g,) = given["mass"], given["gravity"]
    return [given["mass"], given["radius"], (m * g,), *_inertias(given)]


_DERIVED: dict[str, Callable[[Given], Groups]] = {
    "four_bar": _bar, "driven_four_bar": _driven_bar, "vertical_disc": _upright_disc, "rolling_disc": _disc}
