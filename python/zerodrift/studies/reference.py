"""`reference`: a motion whose error is known, from runs that differ in step and in formulation.

A method of order k that halves its step divides its error by 2^k: the difference of two such runs is then nearly the error
of the coarser one, and far above that of the finer. Near round-off nothing of this holds. There the runs differ because
they round differently, and so do runs of another formulation, which integrates other variables with other matrices.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .. import _check
from ..errors import UnreachableTolerance, ZerodriftError
from ..runs import settings
from ..runs.diagnosis import unwarned
from ..runs.simulate import simulate
from ..runs.solution import Solution
from ..systems.base import BaseSystem

SAFETY = 10         # the certified error, in units of the largest difference: rounding that all runs share is not seen in that
STALL_RATIO = 4     # halving the step has stalled where it divides the error by less than this, perhaps for round-off
MOST_STALLS = 2     # refinement ends after so many stalls; a single one may be chance, as where an error passes through zero
RESOLVED = 1e-2     # part of the motion's size; where errors are larger, steps are too long for the order of the method to show
PROBE = 1e-5        # tolerance of the run that tells how many steps the motion takes
REFINEMENTS = 12    # the largest number of times that this number of steps is doubled
SPACING = 4 * np.finfo(float).eps       # part of the motion's size; doubles cannot express a smaller error


@dataclass(frozen=True, eq=False, repr=False)
class Reference:
    """A solution and how wrong it is at most.

    Attributes
    ----------
    solution : Solution
        The motion, of the finest run.
    error : float
        Bound of ``abs(p - exact)`` at every row, each coordinate in its own unit.
    velocity_error : float
        The same of v.
    differences : tuple of Difference(steps, formulation, p, v)
        The evidence: the largest differences in p and v between the solution's formulation with so many steps and with half
        of them, and between it and the other formulation with as many.
    """

    solution: Solution
    error: float
    velocity_error: float
    differences: tuple[Difference, ...]

    def __repr__(self) -> str:
        lines = [f"Reference of {self.solution.system.name}: |error of p| <= {self.error:.2g}, "
                 f"|error of v| <= {self.velocity_error:.2g}, {len(self.solution.t)} rows"]
        lines += [f"  {d.steps:8} steps, {d.formulation:12}  differ by {d.p:.2g} in p, {d.v:.2g} in v" for d in self.differences]
        return "\n".join(lines)


class Difference(NamedTuple):
    """How far a run is from the one it is compared with."""

    steps: int
    formulation: str
    p: float
    v: float


def reference(
    system: BaseSystem,
    t_span: float | tuple[float, float],
    p0: Any = None,
    v0: Any = None,
    *,
    error: float | None = 1e-12,
    t_eval: Any = None,
    formulations: tuple[str, str] = ("augmented", "independent"),
    stabilization: str | settings.Stabilization = settings.STABILIZATION,
) -> Reference:
    """A motion with a certified error.

    The integrator of the highest order halves its fixed step until two runs agree, and a run of a second formulation agrees
    with both. The error certified is ten times the largest difference between them.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Start; left out: the system's own.
    error : float or None
        Largest error of any coordinate at any row, each in its own unit. None: the smallest that can be certified.
    t_eval : array_like (k,), optional
        Times to save. Left out: every step, and then values at any other time are there, too: `zerodrift.plot.error` and
        `zerodrift.compare.difference` take them by a shorter step of the same method.
    formulations : (str, str)
        That of the solution, and that of the check.
    stabilization : None, "projection", "baumgarte", Projection or Baumgarte
        As in `simulate`. Near singular positions a smaller ``Projection(tol=...)`` may allow a smaller error.

    Returns
    -------
    Reference
        It may be given wherever a reference is asked for.

    Raises
    ------
    UnreachableTolerance
        If `error` is below what double precision can give for this motion; the message says what it can.
    ZerodriftError
        If the motion itself cannot be followed.

    Notes
    -----
    The start and the parameters are taken as the doubles they are. Where the motion multiplies small differences, theirs
    from some exact number may grow beyond `error`; that is a property of the motion and is not part of the certificate.

    Examples
    --------
    >>> import numpy as np, zerodrift as zd
    >>> ref = zd.reference(zd.systems.oscillator(mass=1.0, stiffness=4.0, x0=0.1), 2.0, error=1e-12)
    >>> bool(abs(ref.solution.p[:, 0] - 0.1 * np.cos(2 * ref.solution.t)).max() <= ref.error <= 1e-12)
    True
    """
    span = _check.span(t_span)
    wanted = None if error is None else _check.number("error", error, above=0)
    first, second = _two_formulations(formulations)
    method = max(settings.integrators().values(), key=lambda card: card.order).name
    options = {"integrator": method, "stabilization": stabilization}
    with unwarned():
        probe = simulate(system, span, p0, v0, rtol=PROBE, atol=PROBE, formulation=first, **options)
    size = float(np.abs(probe.p).max())
    if wanted is not None and wanted < SPACING * size:
        raise UnreachableTolerance(f"error must be at least {SPACING * size:.2g}, the spacing of doubles at the size of this "
                                   f"motion, not {wanted:g}")

    def run(steps: int, formulation: str) -> Solution:
        return simulate(system, span, p0, v0, step=(span[1] - span[0]) / steps, formulation=formulation, t_eval=t_eval,
                        **options)

    found = _refine(run, probe.stats["steps"], wanted, size, (first, second), 2 if t_eval is None else 1)
    if wanted is not None and not found.error <= wanted:
        raise UnreachableTolerance(f"error = {wanted:g} cannot be certified: the difference between runs stops falling at "
                                   "round-off and at the tolerance of corrections, which this motion multiplies; what can be "
                                   f"certified is {found.error:.2g}")
    return found


def _two_formulations(formulations: Any) -> tuple[str, str]:
    names = tuple(formulations)
    if len(names) != 2 or names[0] == names[1]:
        raise ValueError(f"formulations must be two different formulations, not {formulations!r}")
    for name in names:
        settings.formulation_row(name)
    return names


def _refine(run, steps, wanted, size, formulations, stride) -> Reference:
    """Halve the step until the error is certified, or does not fall any more."""
    best, previous, coarse, stalls = None, math.inf, None, 0
    for _ in range(REFINEMENTS):
        fine = _attempt(run, steps, formulations[0])
        if fine and coarse:
            found = _certify(run, steps, fine, coarse, formulations, stride)
            best = found if best is None or found.error < best.error else best
            if wanted is not None and best.error <= wanted:
                return best
            stalls += found.error * STALL_RATIO > previous and found.error < RESOLVED * size
            if stalls == MOST_STALLS:
                return best
            previous = found.error
        coarse, steps = fine, 2 * steps
    if best is None or best.error > RESOLVED * size:
        raise UnreachableTolerance(f"no error can be certified: runs still differ with {steps // 2} steps; the motion takes "
                                   "shorter ones, or multiplies round-off until nothing is left. Ask for a shorter t_span")
    return best


def _certify(run, steps, fine, coarse, formulations, stride) -> Reference:
    """What the run of twice the step and that of the other formulation say."""
    differences = [_difference(steps, formulations[0], fine, coarse, stride),
                   _difference(steps, formulations[1], fine, _attempt(run, steps, formulations[1]), 1)]
    p, v = (max(getattr(d, name) for d in differences) for name in "pv")
    spacing = SPACING * np.array([np.abs(fine.p).max(), np.abs(fine.v).max()])
    return Reference(fine, max(SAFETY * p, spacing[0]), max(SAFETY * v, spacing[1]), tuple(differences))


def _attempt(run, steps, formulation) -> Solution | None:
    """A run; None where its steps were too long for it."""
    try:
        with unwarned():
            return run(steps, formulation)
    except ZerodriftError as error:
        if error.solution is None:      # it did not even start
            raise
        return None


def _difference(steps: int, formulation: str, fine: Solution, other: Solution | None, stride: int) -> Difference:
    if other is None:
        return Difference(steps, formulation, math.inf, math.inf)
    return Difference(steps, formulation, *(float(np.abs(getattr(fine, name)[::stride] - getattr(other, name)).max())
                                            for name in "pv"))
