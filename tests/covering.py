"""Covering arrays: few cases of a product of axes in which each pair of values of two axes occurs."""

import itertools


def covering(axes, allowed=lambda **case: True):
    """Cases, as dictionaries, in which all pairs of values occur that occur in allowed cases of the product of `axes`.

    `axes` has the values of each axis by its name; a single axis has all its values. Each case is the one with the most pairs
    that are still missing, the first in the order of the product if there are several: the choice is the same in every process.
    """
    cases = [case for values in itertools.product(*axes.values()) if allowed(**(case := dict(zip(axes, values, strict=True))))]
    pairs = [frozenset(itertools.combinations(case.items(), min(2, len(axes)))) for case in cases]
    missing, chosen = set().union(*pairs), []
    while missing:
        best = max(range(len(cases)), key=lambda k: len(pairs[k] & missing))
        chosen.append(best)
        missing -= pairs[best]
    return [cases[k] for k in sorted(chosen)]
