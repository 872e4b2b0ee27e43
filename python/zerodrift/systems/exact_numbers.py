"""Numbers of built-in systems as pairs of doubles: parameters as they are, and exactly rounded those that follow from them."""

from __future__ import annotations

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
    numbers = [number for group in derive(given) for number in group]
    return np.array([[float(x), float(x - Fraction(float(x)))] for x in numbers]).reshape(-1, 2)


def _exact(value: Any) -> tuple[Fraction, ...]:
    return tuple(map(Fraction, value)) if isinstance(value, Sequence) else (Fraction(value),)


Groups = list[Sequence[Fraction]]
Given = Mapping[str, Sequence[Fraction]]


def _as_given(given: Given) -> Groups:
    return list(given.values())


def _bar(given: Given) -> Groups:
    """Slender rods, m l^2 / 12, where no inertias are given."""
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
