"""Certificates in double-double arithmetic: comparisons of runs by Taylor's method of two orders, with two sequences of steps.

A certified motion in double precision comes first, for its evidence of other methods and formulations: the motion in
double-double arithmetic must lie within its bound. The certified error then follows from three runs:

* the motion;
* one of higher order, with a smaller tolerance and shorter steps, for truncation;
* one with these steps, whose start and numbers are off by one or two roundings of double-double arithmetic, for rounding.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from .._private import gateway
from .._private.gateway.compiled.precise import Precise
from ..errors import ZerodriftError, sentence
from ..systems.base import BaseSystem
from . import double_double as dd
from .certificate import Reference
from .precise_motion import PreciseMotion, PreciseRun, Settings
from .precise_values import Runs, bound
from .reference_runs import EPS, Difference, Motion

PRECISIONS = ("double", "double-double")
VECTOR = "avx2" if gateway.PROCESSOR_UNIT else "baseline"      # same bits, but faster with fma
METHOD = "taylor, order {}"
FINEST, COARSEST = 1e-30, 1e-18     # tolerance of the motion, relative to its size
MARGIN = 1000           # of the wanted error over the tolerance, times what the motion makes of rounding
FINER = 0.03            # tolerance of the run of higher order, relative to that of the motion
SHARE = 0.8             # of the step that its tolerance allows
MORE_ORDERS = 5


def functions_of(system: BaseSystem, precision: str | None) -> Precise | None:
    """Functions in double-double arithmetic; None if the system has none or they are not wanted."""
    return None if precision == "double" else system._precise_functions(VECTOR)


def order_of(tolerance: float) -> int:
    """Order of the series for a tolerance: Jorba and Zou, section 3."""
    return int(np.ceil(1 - np.log(tolerance) / 2)) - 4


class PreciseSearch:
    """Search with decreasing tolerances until the error is certified or rounding limits it."""

    def __init__(self, motion: Motion, functions: Precise, found: Reference, wanted: float | None) -> None:
        held = motion.system._held_at_start if motion.is_own_start else ([], [])
        p0, v0 = (motion.system._exact_start() if motion.is_own_start else None) or map(dd.of, motion.start)
        self.motion = PreciseMotion(functions, p0, v0, motion.system.quaternions, held, motion.size,
                                    motion.span[0], (motion.span[1] - motion.span[0]) / motion.most)
        self.found, self.wanted = found, wanted
        self.reason = "its certified error is not smaller"      # for which there is no better reference in this arithmetic

    def certified(self) -> Reference:
        """Reference in double-double arithmetic; the one in double precision if that is better or contradicts it."""
        best = self.found
        for tolerance in self._tolerances():
            candidate = self._of_tolerance(tolerance)
            if candidate is None or not candidate.error < best.error:
                break
            best = candidate
            if self.wanted and best.error <= self.wanted:
                break
        return best

    def _tolerances(self) -> list[float]:
        """Tolerances to try: the one that should reach the wanted error, from the motion's amplification of rounding, and the
        finest.
        """
        if self.wanted is None:
            return [FINEST]
        growth = max(1.0, self.found.differences[1].p / (EPS * self.motion.size))
        asked = self.wanted / (MARGIN * growth * self.motion.size)
        return [min(asked, COARSEST), FINEST] if asked > FINEST else [FINEST]

    def _of_tolerance(self, tolerance: float) -> Reference | None:
        times = np.asarray(self.found.solution.t)
        order = order_of(tolerance)
        finer = Settings(order + MORE_ORDERS, FINER * tolerance, SHARE)
        try:
            ways = (Settings(order, tolerance), 0), (finer, 0), (finer, 1)
            runs = Runs(self.motion, ways, times, tuple(self.motion.run(times, *way) for way in ways))
        except ZerodriftError as error:
            self.reason = sentence(error)
            return None
        own, *others = runs.made
        apart = [np.abs(getattr(own, name)[..., 0] - getattr(self.found.solution, name)).max() for name in "pv"]
        if not (apart[0] <= self.found.error and apart[1] <= self.found.velocity_error):
            self.reason = f"its motion differs by {apart[0]:.2g} from that certified in double precision"
            return None
        differences = tuple(self._difference(own, run, finer.order, i > 0) for i, run in enumerate(others))
        errors = [bound((getattr(each, name) for each in differences), float(np.abs(getattr(own, name)).max()))
                  for name in "pv"]
        high, low = ([_frozen(x[..., part]) for x in (own.p, own.v)] for part in (0, 1))
        solution = dataclasses.replace(self.found.solution, p=high[0], v=high[1])
        return dataclasses.replace(self.found, solution=solution, error=errors[0], velocity_error=errors[1],
                                   differences=differences + self.found.differences, low=(low[0], low[1]), _runs=runs)

    def _difference(self, own: PreciseRun, run: PreciseRun, order: int, is_rounded: bool) -> Difference:
        p, v = (float(np.abs(dd.minus(getattr(own, name), getattr(run, name))[..., 0]).max()) for name in "pv")
        return Difference(run.steps, "double-double", p, v, METHOD.format(order), is_rounded)


def _frozen(x: np.ndarray) -> np.ndarray:
    x = np.array(x)
    x.flags.writeable = False
    return x
