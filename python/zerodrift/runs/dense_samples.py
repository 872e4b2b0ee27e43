"""Samples between the adaptive steps of a solution, for smooth curves and films of a few long steps."""

from __future__ import annotations

import math
import warnings
import weakref

import numpy as np

from ..errors import ZerodriftError
from .samples.solution import Solution
from .simulate import simulate

FEW_SAMPLES = 400       # of a solution: with as many, straight lines between them are shorter than what can be seen
_found: weakref.WeakKeyDictionary[Solution, Solution] = weakref.WeakKeyDictionary()


def dense(sol: Solution) -> Solution:
    """Solution of the same motion with at least `FEW_SAMPLES` samples, including those of the given one, which is returned if it
    has enough.

    The run is repeated with the method's dense output at these times, which takes few steps where there are few samples. A
    solution by fixed steps, or whose samples are not all its steps, is returned as it is; so is one that cannot be repeated.
    """
    if not 1 < len(sol.t) < FEW_SAMPLES or not _is_adaptive(sol):
        return sol
    if sol not in _found:
        _found[sol] = _repeated(sol)
    return _found[sol]


def _is_adaptive(sol: Solution) -> bool:
    """True if each adaptive step of the run is a sample."""
    given = sol.settings
    return given.get("step") is None and given.get("save_every") == 1 and "t_eval" not in given


def _repeated(sol: Solution) -> Solution:
    """Run repeated with dense output up to its last sample; the solution itself if that fails or differs."""
    parts = math.ceil(FEW_SAMPLES / (len(sol.t) - 1))
    times = np.append(np.linspace(sol.t[:-1], sol.t[1:], parts, endpoint=False, axis=1).ravel(), sol.t[-1])
    given = {name: value for name, value in sol.settings.items() if name != "save_every"}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")     # of accuracy: they were given with the first run
            found = simulate(sol.system, (float(sol.t[0]), float(sol.t[-1])), **given, t_eval=times)
    except (ZerodriftError, ValueError, TypeError):
        return sol
    is_same = len(found.t) == len(times) and np.array_equal(found.p[::parts], sol.p)
    return found if is_same else sol
