"""Numbers of a block as polynomials of parameters, so that lengths, masses and springs can be changed without Python.

Points of bodies are linear in lengths, inertias are products of masses and squares of lengths, and so on. The polynomials are
found from tables at the nodes of a grid, and checked at other values.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from .._private import checks
from ..errors import WrongType, WrongValue

DEGREES = {1: 3, 2: 3, 3: 2}        # of each parameter, by the number of parameters of a word; higher ones fit rational functions
EXACT = 1e-11                       # relative to the largest value: rounding of tables and of the fit
ROUNDING_OF_ZERO = 4e-16            # of coordinates of about 1 m that cancel
CHECKS = 3                          # values beside the nodes and the limits

Words = Callable[[Mapping[str, float]], np.ndarray]     # words of the tables at these parameters


def computed_once(words: Words) -> Words:
    """The same words, each combination of parameters computed once."""
    known: dict[tuple[tuple[str, float], ...], np.ndarray] = {}

    def found(changed: Mapping[str, float]) -> np.ndarray:
        key = tuple(sorted(changed.items()))
        if key not in known:
            known[key] = words(changed)
        return known[key]

    return found


def ranges(given: Any, known: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """Check the argument `parameters` of `block`: names with smallest and largest values."""
    if not isinstance(given, Mapping):
        raise WrongType(f"parameters must be a dict of ranges by names, not {checks.shown(given)}")
    found = {}
    for name, limits in given.items():
        if name not in known:
            raise WrongValue(f"parameters must name numbers of the mechanism, not {name!r}; {checks.closest(name, list(known))}",
                             "wrong-name")
        least, most = (checks.number(f"range of {name!r}", each) for each in limits)
        if not least <= known[name] <= most or least == most:
            raise WrongValue(f"the range of {name!r} must contain its value {known[name]:g}, and not be ({least:g}, {most:g})",
                             "out-of-range")
        found[name] = (least, most)
    return found


def effects(words: Words, limits: Mapping[str, tuple[float, float]]) -> tuple[list[float], list[float]]:
    """Sections of effects and of products; effects count words from the first of the tables.

    Raises
    ------
    ValueError
        If a word is not a polynomial of at most three parameters; they are named.
    """
    names, base = list(limits), words({})
    depends = {name: _changed(words, base, name, limits[name]) for name in names}
    groups: dict[tuple[str, ...], list[int]] = {}
    for word in np.flatnonzero(np.any(list(depends.values()), axis=0)) if names else ():
        groups.setdefault(tuple(name for name in names if depends[name][word]), []).append(int(word))
    found: list[float] = []
    products: list[float] = []
    for group, places in groups.items():
        if len(group) > max(DEGREES):
            raise WrongValue(f"at most {max(DEGREES)} parameters may change one number of the tables, and {', '.join(group)} do",
                             "not-portable")
        powers, coefficients = _fitted(words, group, limits, places)
        for place, column in zip(places, coefficients.T, strict=True):
            kept = [(factor, power) for factor, power in zip(column, powers, strict=True) if factor != 0]
            found += [place, len(products) // 7, len(kept)] if kept else []     # none: rounding of zero
            for factor, power in kept:
                pairs = [each for name, exponent in zip(group, power, strict=True) for each in (names.index(name), exponent)]
                products += [factor, *pairs, *[0.0] * (6 - len(pairs))]
    return found, products


def _changed(words: Words, base: np.ndarray, name: str, limits: tuple[float, float]) -> np.ndarray:
    """True for words that depend on a parameter."""
    changed = np.zeros(base.size, dtype=bool)
    for value in limits:
        found = words({name: value})
        if found.shape != base.shape:
            raise WrongValue(f"{name} must not change how many entries the tables have", "not-portable")
        changed |= found != base
    return changed


def _fitted(words: Words, group: Sequence[str], limits: Mapping[str, tuple[float, float]],
            places: Sequence[int]) -> tuple[list[tuple[int, ...]], np.ndarray]:
    """Exponents (terms,) and coefficients (terms, words) of polynomials through a grid of values."""
    degree = DEGREES[len(group)]
    scales = [max(map(abs, limits[name])) for name in group]
    turns = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    nodes = [(low + high) / 2 + (high - low) / 2 * turns for low, high in (limits[name] for name in group)]
    grid = list(itertools.product(*nodes))
    powers = list(itertools.product(range(degree + 1), repeat=len(group)))
    values = np.array([words(dict(zip(group, point, strict=True)))[places] for point in grid])
    coefficients = np.linalg.solve(_terms(grid, powers, scales), values)
    size = np.abs(values).max(axis=0)
    coefficients[np.abs(coefficients) < EXACT * np.maximum(size, 1e-300)] = 0.0
    random = np.random.default_rng(0)
    points = [*itertools.product(*(limits[name] for name in group)),
              *(tuple(random.uniform(*limits[name]) for name in group) for _ in range(CHECKS))]
    true = np.array([words(dict(zip(group, point, strict=True)))[places] for point in points])
    if (np.abs(_terms(points, powers, scales) @ coefficients - true) > 10 * EXACT * size + ROUNDING_OF_ZERO).any():
        raise WrongValue(f"the tables must be polynomials of {' and '.join(group)}, and are not", "not-portable")
    factors = np.array([np.prod([scale ** -exponent for scale, exponent in zip(scales, power, strict=True)])
                        for power in powers])
    return powers, coefficients * factors[:, None]


def _terms(points: Sequence[tuple[float, ...]], powers: Sequence[tuple[int, ...]], scales: Sequence[float]) -> np.ndarray:
    """Products of powers (points, terms) of the parameters in their scales."""
    scaled = np.array(points) / scales
    return np.array([[np.prod(point ** np.array(power)) for power in powers] for point in scaled])
