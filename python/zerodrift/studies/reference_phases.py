"""Sources of error of a reference with contacts that the comparison of runs cannot exclude."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .._private import gateway
from ..runs.samples.phases import state_from_samples
from ..runs.samples.solution import Solution
from ..systems.base import core_of

PHASES = ("all runs that were compared have the same sequence of {count} phases; a contact that the exact motion touches, or "
          "just misses, unlike all of them is not excluded: {nearest}")
OMITTED = "bounces slower than the rest speed are omitted, as contacts stay closed: of {time:.2g} s and {energy:.2g} J"


def of_phases(sol: Solution) -> Iterator[str]:
    """Sentences on the phases of a motion: the open contact that passes its shape most closely, and omitted bounces."""
    found = min(_passages(sol), default=None)
    nearest = "no open contact passes its shape without touching it" if found is None else (
        f"the smallest gap at a sample at which an open contact passes its shape is {found[0]:.2g} of the characteristic length, "
        f"of {found[1]!r} at t = {found[2]:.6g}")
    yield PHASES.format(count=len(sol.phases), nearest=nearest)
    if sol.stats["omitted_bounce_time"] > 0:
        yield OMITTED.format(time=sol.stats["omitted_bounce_time"], energy=sol.stats["omitted_bounce_energy"])


def _passages(sol: Solution) -> Iterator[tuple[float, str, float]]:
    """Smallest gaps of open contacts between two samples at which they are larger: gap, name, and time in s."""
    state: Any = state_from_samples(sol.t, sol.transitions)
    groups = sol.system._groups
    gaps = [gateway.gaps(core_of(sol.system), t, p) for t, p in zip(sol.t, sol.p, strict=True)]
    for g in gaps[0]:
        gap = np.array([each[g] for each in gaps])
        hits = sol.transitions["t"][(sol.transitions["impulse"][:, g] != 0) | (sol.transitions["loss"][:, g] != 0)]
        for k in np.flatnonzero((gap[1:-1] < gap[:-2]) & (gap[1:-1] < gap[2:])) + 1:
            touches = ((hits >= sol.t[k - 1]) & (hits <= sol.t[k + 1])).any()
            if not state[k - 1:k + 2, g].any() and not touches:
                yield float(gap[k]), groups[g][0], float(sol.t[k])
