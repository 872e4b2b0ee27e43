"""Certificates in double precision, from comparisons with independent runs.

The motion is computed with fixed steps by the integrator of highest order, and the step is halved until two such runs do not
come closer any more. It is compared with four other runs, and the differences are added as independent errors are: what is
certified is 1.5 times the root of the sum of their squares, three times one of them if all are equal. It is ten times the largest
where halving the step divides the differences too slowly for smooth terms. Each of the four has another reason to disagree:

* one with half the steps, for a step that is still too long: its truncation error is 2^8 times as large;
* one with the same steps, whose start, arguments and terms are all off by one or two units of rounding, always the same way:
  what rounding does that every step, method and formulation shares, and how the motion multiplies it;
* one by another method, an extrapolated midpoint rule, with two thirds of the steps, in another formulation if there are
  constraints, rounded off in yet another way: for errors of a method, its coefficients, and of a formulation. Without constraints
  all formulations do the same arithmetic, and would only seem to agree;
* one with five thirds of the steps, rounded off in a third way: it is finer than what it checks, and shares few of its instants.
  In time, its points of evaluation are more than three times as dense as those of the first;
* of a mechanism that has joint and absolute coordinates, one in the others: runs that share coordinates share what follows from
  their ranks;
* where terms are not all polynomials, sines and cosines, so that something may act in a narrow place which no other run has
  evaluated: one with many times the steps, whose points of evaluation lie as densely in the state as in time. At least three
  times its difference is certified, as it may be the only one that has seen something.

Each is compared with the motion at all rows that both have. The differences cannot all be small by luck, as they are not
rounded alike. Where a system has a Taylor series and that is not enough, the motion is computed once more by this, with some
tenth of the steps, so that less is rounded. The integrator of highest order among the others then is the other method, with as
many steps as bring it nearest.

To this is added what no run shows: times are doubles, and the steps and coefficients that are multiplied by rates are, too, which
may shift the motion by two roundings of the time that has passed, at the rates around each sample. What none of this can exclude
is said in `Reference.caveats`.
"""

from __future__ import annotations

import contextlib
import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from ..errors import UnreachableTolerance, ZerodriftError
from ..runs.arguments import methods
from ..runs.samples.solution import Solution
from ..systems.base import core_of
from .certificate import Reference
from .reference_phases import of_phases
from .reference_runs import EPS, UNIT, Difference, Motion, Way

SAFETY = 1.5        # the certified error, in units of the root of the sum of squares of all differences
SAFETY_DENSE = 3    # the smallest, in units of the difference of the run that looks for what acts in a narrow place
SAFETY_ROUGH = 10   # the certified error, in units of the largest difference, where terms are not smooth for the steps
STALL_RATIO = 4     # halving the step has stalled where it divides the difference by less than this, perhaps for rounding
SMOOTH_RATIO = 8    # where it divides the difference by less than this, far above rounding, terms are not smooth for the steps
MAX_STALLS = 2     # refinement ends after so many stalls that rounding does not explain, unless a smaller error is wanted
EXPLAINED = 30      # a difference of at most so many times what rounding was seen to do is rounding
RESOLVED = 1e-2     # part of the motion's size; where errors are larger, steps are too long for the order of the method to show
REFINEMENTS = 14    # the largest number of times that this number of steps is doubled
CHECKS = 4          # runs with which any motion is compared
FORGOTTEN = 3       # a motion has forgotten its start where rounding alone makes another one of it, so many refinements in a row
AT_JUMP = 1e4       # a jump is met where rounding changes one run so many times as much as another
GROWTH = 1e4        # a motion is sensitive where it makes so many times as much of rounding as its own size and speed do
LARGEST_GAP = 0.21  # part of a step, between the instants at which the integrator of highest order evaluates
DENSE = 9000        # steps of the run that looks for what acts in a narrow place, or more
SPACING = 4 * EPS      # part of the motion's size; doubles cannot express a smaller error

TIME = ("terms depend on t, and no max_step was said: what acts for less than the time between the instants at which they were "
        "evaluated, some {apart:.2g} s, may have been missed")
PLACE = ("not all terms are polynomials, sines and cosines, and neither max_move nor max_step was given: what acts in a place "
         "narrower than the way between the points at which they were evaluated, some {apart:.2g} of a coordinate, may have been "
         "missed")
COORDINATES = "the mechanism's other coordinates cannot follow this motion, so that no run in these was compared"
ROUNDED = ("the difference between runs stops falling at round-off and at the tolerance of corrections, which this motion "
           "multiplies")
UNRESOLVED = "the differences between runs fall slowly, as where a term jumps"
SLOWLY = "halving the steps divides the differences"
SMOOTH = (SLOWLY + " by {ratio:.2g} only, where smooth terms give up to {most:.3g}: the terms jump or "
          "have corners, or change faster than the steps, and the error is a multiple of the differences that were seen")
SENSITIVE = ("the motion multiplies roundings by some {growth:.1g}: the error follows the growth that was seen in these runs, "
             "and no bound of it was proved")


class Search:
    """Search that halves the step until the error is certified or stops decreasing."""

    def __init__(self, motion: Motion, pairs: list[tuple[str, str]], wanted: float | None) -> None:
        self.motion, self.pairs, self.wanted = motion, pairs, wanted or 0.0
        self._least_rounded = math.inf      # smallest effect of rounding in the runs compared so far

    def found(self) -> Reference:
        """Certified reference with enough steps for the wanted error, or with as many as rounding allows."""
        motion, steps, stalls, forgotten = self.motion, self.motion.steps, 0, 0
        previous, coarse, best = math.inf, None, None
        for doublings in range(REFINEMENTS):
            fine, last = motion.run(self._way(steps)), steps
            if fine and coarse:
                halved = motion.difference(self._way(steps // 2), fine, steps, coarse)
                forgotten = forgotten + 1 if halved.p > RESOLVED * motion.size and self._is_forgotten(fine, steps) else 0
                if forgotten == FORGOTTEN:
                    break
                stalled = STALL_RATIO * halved.p >= previous
                enough = stalled or SAFETY * halved.p <= self.wanted or doublings == REFINEMENTS - 1
                if previous < math.inf and halved.p <= RESOLVED * motion.size and enough:
                    best = self._certified(fine, steps, halved, previous)
                    stalls += stalled
                    if best.error <= self.wanted or (stalled and self._is_final(best, stalls)):
                        break
                previous = halved.p
            coarse, steps = fine, 2 * steps
        if best is None or best.error > max(RESOLVED * motion.size, self.wanted):
            if motion.disagreement:
                raise UnreachableTolerance("all runs that are compared must have the same sequence of phases, and it is "
                                           f"{motion.disagreement}; use a shorter t_span")
            raise UnreachableTolerance(f"no error can be certified: runs still differ with {last} steps; the motion takes "
                                       "shorter ones, or amplifies round-off until no digit is left; use a shorter t_span")
        return best

    def _way(self, steps: int) -> Way:
        return Way(steps, self.pairs[0][0], self.motion.method)

    def _certified(self, fine: Solution, steps: int, halved: Difference, previous: float) -> Reference:
        """Reference from the run with `steps` steps and its comparisons with all other runs."""
        motion = self.motion
        motion.run_side_by_side(self._checks(steps), steps)
        differences = [halved, motion.difference(self._rounded(steps), fine, steps), self._by_other_method(fine, steps)]
        differences.append(motion.difference(self._finer(steps), fine, steps))
        if self._looks_for_places:
            differences.append(motion.difference(self._dense(steps), fine, steps))
        if motion.elsewhere is not None:
            differences += self._in_other_coordinates(fine, steps)
        found = Reference(fine, *self._bounds(fine, differences), tuple(differences))
        caveats = tuple(self._caveats(found, steps, previous))
        self._least_rounded = min(self._least_rounded, differences[1].p)
        if any(caveat.startswith(SLOWLY) for caveat in caveats):
            found = Reference(fine, *self._bounds(fine, differences, is_rough=True), tuple(differences))
        return dataclasses.replace(found, caveats=caveats)

    def _bounds(self, fine: Solution, differences: list[Difference], is_rough: bool = False) -> tuple[float, float]:
        """Bounds of the errors of p and v: from the differences, and what rounding of times and samples adds."""
        p, v = (self._bound([getattr(d, name) for d in differences], is_rough) + shift
                + SPACING * float(np.abs(getattr(fine, name)).max())
                for name, shift in zip("pv", self.motion.shift_at(fine.t), strict=True))
        return p, v

    def _bound(self, seen: list[float], is_rough: bool) -> float:
        """Bound of the error that all differences of one variable show."""
        if is_rough:
            return SAFETY_ROUGH * max(seen)
        dense = seen[CHECKS] if self._looks_for_places else 0.0
        return max(SAFETY * math.hypot(*seen), SAFETY_DENSE * dense)

    def _by_other_method(self, fine: Solution, steps: int) -> Difference:
        """In the first of the other formulations that can follow the motion; those that cannot are not asked again."""
        while len(self.pairs) > 1:
            with contextlib.suppress(ZerodriftError):
                difference = self._other_method(fine, steps)
                if math.isfinite(difference.p):
                    return difference
            del self.pairs[0]
        return self._other_method(fine, steps)

    def _other_method(self, fine: Solution, steps: int) -> Difference:
        return self.motion.difference(self._other(steps), fine, steps)

    def _checks(self, steps: int) -> list[Way]:
        """Runs that a certificate takes, if the other formulation can follow the motion; the longest first."""
        dense = [self._dense(steps)] if self._looks_for_places else []
        return [*dense, self._finer(steps), self._other(steps), self._rounded(steps)]

    def _rounded(self, steps: int) -> Way:
        return Way(steps, self.pairs[0][0], self.motion.method, rounding=1)

    def _other(self, steps: int) -> Way:
        return Way(2 * steps // UNIT, self.pairs[0][1], self.motion.other, rounding=2)

    def _finer(self, steps: int) -> Way:
        return Way(5 * steps // UNIT, self._of_finer(), self.motion.method, rounding=3)

    def _in_other_coordinates(self, fine: Solution, steps: int) -> list[Difference]:
        """The difference of a run in other coordinates; none where these cannot follow the motion, which is a caveat then."""
        motion = self.motion
        way = Way(steps, next(iter(methods.formulations(motion.elsewhere))), motion.method, is_elsewhere=True)
        with contextlib.suppress(ZerodriftError):
            found = motion.difference(way, fine, steps)
            if math.isfinite(found.p):
                return [found]
        motion.elsewhere_failed = True
        motion.elsewhere = None
        return []

    def _dense(self, steps: int) -> Way:
        return Way(steps * max(2, math.ceil(DENSE / steps)), self._of_finer(), self.motion.method, rounding=4)

    @property
    def _looks_for_places(self) -> bool:
        return not self.motion.is_plain

    def _of_finer(self) -> str:
        """The formulation of the runs with the shortest steps."""
        return self.pairs[0][1]

    def _of_instants(self, found: Reference, steps: int) -> int:
        """Number of steps of the run with the densest points of evaluation."""
        return found.differences[CHECKS].steps if self._looks_for_places else steps

    def _is_forgotten(self, fine: Solution, steps: int) -> bool:
        """True if rounding alone changes the motion completely. With far too long steps this may happen by chance."""
        rounded = self.motion.difference(self._rounded(steps), fine, steps)
        return RESOLVED * self.motion.size < rounded.p < math.inf

    def _is_final(self, found: Reference, stalls: int) -> bool:
        """True if shorter steps would not reduce the error, or only slightly and no error was requested."""
        if self._is_missing_something(found):
            return False
        enough = stalls >= MAX_STALLS and found.error <= RESOLVED * self.motion.size
        return self._is_rounding(found) or (enough and not self.wanted)

    def _is_missing_something(self, found: Reference) -> bool:
        """True if the run with the densest points of evaluation differs from the motion far more than all others."""
        if not self._looks_for_places:
            return False
        others, dense = found.differences[:CHECKS], found.differences[CHECKS]
        return dense.p > EXPLAINED * (max(each.p for each in others) + EPS * self.motion.size)

    def _is_rounding(self, found: Reference) -> bool:
        """True if the differences of runs are explained by rounding, observed or accumulated with the same sign in each step."""
        size, steps = self.motion.size, max(d.steps for d in found.differences)
        seen = found.differences[1].p + self.motion.shift[0] + SPACING * size
        return max(d.p for d in found.differences) <= EXPLAINED * seen + steps * EPS / 2 * size

    def limit(self, found: Reference) -> str:
        """Reason why the error of a reference is not smaller.

        A motion that multiplies roundings does so in all runs; at a jump, rounding matters in a run with a step that ends there.
        """
        if slowly := [caveat for caveat in found.caveats if caveat.startswith(SLOWLY)]:
            return slowly[0]
        at_jump = found.differences[1].p > AT_JUMP * (self._least_rounded + EPS * self.motion.size)
        return ROUNDED if self._is_rounding(found) and not at_jump else UNRESOLVED

    def _caveats(self, found: Reference, steps: int, previous: float) -> Iterator[str]:
        motion = self.motion
        halved, rounded, _, finer, *_ = (d.p for d in found.differences)
        apart = LARGEST_GAP * (motion.span[1] - motion.span[0]) / self._of_instants(found, steps)
        if not (core_of(motion.system).timeless or motion.bounded):
            yield TIME.format(apart=apart)
        if motion.elsewhere_failed:
            yield COORDINATES
        if not (motion.is_plain or motion.bounded or motion.bounds.get("max_move")):
            yield PLACE.format(apart=apart * motion.speed)
        if motion.system._groups:
            yield from of_phases(found.solution)
        ratios = [a / b for a, b in ((previous, halved), (halved, finer)) if b]      # the finer run differs by the error itself
        if not self._is_rounding(found) and min(ratios, default=math.inf) < SMOOTH_RATIO:
            yield SMOOTH.format(ratio=min(ratios), most=2.0**methods.integrators()[motion.method].order)
        own = EPS * motion.size + motion.shift[0]
        if rounded > GROWTH * own:
            yield SENSITIVE.format(growth=rounded / own)


class SearchBySeries(Search):
    """Search by Taylor's method, whose few steps accumulate little rounding error."""

    def __init__(self, motion: Motion, pairs: list[tuple[str, str]], wanted: float | None) -> None:
        super().__init__(motion.by_series(pairs[0][0]), pairs, wanted)
        self.least = motion.steps

    def _other_method(self, fine: Solution, steps: int) -> Difference:
        """With as many steps as bring it nearest, of all those that are 2/3 of the motion's, doubled."""
        steps_of_other, nearest = 2 * steps // UNIT, None
        while steps_of_other < self.least:
            steps_of_other *= 2
        for _ in range(REFINEMENTS):
            found = self.motion.difference(Way(steps_of_other, self.pairs[0][1], self.motion.other, rounding=2), fine, steps)
            is_resolved = nearest is not None and nearest.p <= RESOLVED * self.motion.size
            nearest, before = min(nearest or found, found, key=lambda each: each.p), nearest
            if SAFETY * found.p <= self.wanted or found.p == math.inf or (is_resolved and STALL_RATIO * found.p >= before.p):
                break
            steps_of_other *= 2
        return nearest or found

    def _checks(self, steps: int) -> list[Way]:
        """None in threads: their steps are few, and the first has their series compiled."""
        return []

    def _of_instants(self, found: Reference, steps: int) -> int:
        """In those of the check: the terms of a series are evaluated once in a step."""
        return max(found.differences[i].steps for i in ((2, CHECKS) if self._looks_for_places else (2,)))

    def _dense(self, steps: int) -> Way:
        return dataclasses.replace(super()._dense(steps), integrator=self.motion.other)

    def _of_finer(self) -> str:
        """Another formulation than those of the motion and of the check, if there is one."""
        return self.pairs[min(1, len(self.pairs) - 1)][1]
