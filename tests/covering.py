"""Covering arrays: few cases of a product of axes in which each pair of values of two axes occurs."""

import itertools


def product(axes, allowed=lambda **case: True):
    """All allowed cases, as dictionaries; `axes` has the values of each axis by its name."""
    cases = (dict(zip(axes, values, strict=True)) for values in itertools.product(*axes.values()))
    return [case for case in cases if allowed(**case)]


def covering(axes, allowed=lambda **case: True):
    """Cases of the product in which all pairs of values occur that occur in any of it; a single axis has all its values.

    Each is the case with the most pairs that are still missing, the first in the order of the product if there are several: the
    choice is the same in every process.
    """
    cases = product(axes, allowed)
    pairs = [frozenset(itertools.combinations(case.items(), min(2, len(axes)))) for case in cases]
    missing, chosen = set().union(*pairs), []
    while missing:
        best = max(range(len(cases)), key=lambda k: len(pairs[k] & missing))
        chosen.append(best)
        missing -= pairs[best]
    return [cases[k] for k in sorted(chosen)]
