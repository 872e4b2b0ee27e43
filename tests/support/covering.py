"""Covering arrays: few cases of a product of axes in which each pair of values of two axes occurs."""

import itertools
import os

WHOLE = bool(os.environ.get("ZERODRIFT_PRODUCTS"))     # products instead of pairs, all values and draws
EACH_VALUE = bool(os.environ.get("ZERODRIFT_EACH_VALUE"))     # each value instead of pairs, for what looks at code, not numbers


def product(axes, allowed=lambda **case: True):
    """All allowed cases, as dictionaries; `axes` has the values of each axis by its name."""
    cases = (dict(zip(axes, values, strict=True)) for values in itertools.product(*axes.values()))
    return [case for case in cases if allowed(**case)]


def spread(values, count):
    """`count` of the values, evenly spread, the first and the last among them; all with ZERODRIFT_PRODUCTS=1."""
    values = list(values)
    return values if WHOLE else [values[round(k * (len(values) - 1) / (count - 1))] for k in range(count)]


def draws(few, many):
    """Number of random draws or of repetitions, or the end of a run: `few`, or `many` with ZERODRIFT_PRODUCTS=1."""
    return many if WHOLE else few


def covering(axes, allowed=lambda **case: True, strength=2):
    """Cases of the product in which all pairs of values occur that occur in any of it; a single axis has all its values.

    With a strength of 1, each value occurs.

    Each is the case with the most pairs that are still missing, the first in the order of the product if there are several: the
    choice is the same in every process.
    """
    cases = product(axes, allowed)
    pairs = [frozenset(itertools.combinations(case.items(), min(strength, len(axes)))) for case in cases]
    missing, chosen = set().union(*pairs), []
    while missing:
        best = max(range(len(cases)), key=lambda k: len(pairs[k] & missing))
        chosen.append(best)
        missing -= pairs[best]
    return [cases[k] for k in sorted(chosen)]
