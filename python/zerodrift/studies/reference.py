"""`reference`: a motion with a certified error, in double precision or in double-double arithmetic."""

from __future__ import annotations

import contextlib
import math
from typing import Any

from .._private import checks
from .._private.gateway.compiled.precise import Precise
from .._private.types import ArrayLike, Formulation, StabilizationName, SystemLike
from ..errors import UnreachableTolerance, WrongValue, ZerodriftError
from ..runs.arguments import methods, settings
from ..systems.base import BaseSystem, system_of
from .certificate import Reference
from .reference_precise import PRECISIONS, PreciseSearch, functions_of
from .reference_runs import Difference, Motion
from .reference_search import SPACING, Search, SearchBySeries

__all__ = ["Difference", "Reference", "reference"]

EVIDENCE = 1e-9     # part of the motion's size, certified in double precision before an error beyond it


def reference(
    system: SystemLike,
    t_span: float | tuple[float, float],
    p0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    *,
    error: float | None = None,
    first_step: float | None = None,
    max_step: float | None = None,
    max_move: float | None = None,
    t_eval: ArrayLike | None = None,
    formulations: tuple[Formulation, Formulation] | None = None,
    stabilization: StabilizationName | settings.Stabilization = settings.STABILIZATION,
    precision: str | None = None,
) -> Reference:
    """Compute a motion with a certified error.

    The fixed step of the integrator of highest order is halved until successive runs agree. The result is compared with runs
    with other steps, by another method, in another formulation, and with start and terms perturbed by rounding. The certified
    error is 1.5 times the root of the sum of squares of the differences, or ten times the largest where terms are not smooth,
    plus the effect of rounding of time. If that exceeds `error`, systems with Taylor coefficients are also computed by `taylor`,
    which needs fewer steps.

    If that is not enough, and without `error`, the motion is computed in double-double arithmetic, by Taylor's method with
    projection. It must lie within the error certified in double precision, and is compared with a run of higher order and shorter
    steps, and with one whose start and numbers are perturbed: five times the root of the sum of squares is certified. Values
    between samples, measures and times of events are then known beyond double precision, too: `Reference.at`, `Reference.measure`
    and `Reference.events`.

    Parameters
    ----------
    system : system
        System or Mechanism, as in `simulate`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Initial state; by default that of the system.
    error : float, optional
        Largest allowed error of any coordinate at any sample, in its own unit. By default the smallest that can be certified.
    first_step, max_step : float, optional
        In s, as in `simulate`: first step of the run that determines the number of steps, and largest step of any run. A short
        action may be missed unless `max_step` is at most its duration.
    max_move : float, optional
        As in `simulate`: largest change of a coordinate in any step of any run, in m or rad. A force in a narrow region may be
        missed unless `max_move` is at most a third of its width.
    t_eval : array_like (k,), optional
        Output times in s. By default every step; `zerodrift.plot.error` and `zerodrift.studies.compare.difference` then evaluate
        the motion at any other time, too, by a shorter step of the same method.
    formulations : (str, str), optional
        Formulations of the solution and of the check; by default the first and the last that suit the system.
    stabilization : None, "projection", "baumgarte", Projection or Baumgarte
        As in `simulate`. Near singular positions a smaller ``Projection(tol=...)`` may allow a smaller error.

    precision : {"double", "double-double"}, optional
        Arithmetic of the motion. By default double-double (106 bits) where the system has it and `error`, or the smallest error
        that can be certified, requires it: built-in systems, and compiled ones of expressions that are smooth. The motion is then
        ``ref.p + ref.p_low``, ``ref.v + ref.v_low``, and errors of 1e-20 and less are certified.

    Returns
    -------
    Reference
        For an argument `reference` of other functions. Its `caveats` list the sources of error that are not excluded.

    Raises
    ------
    UnreachableTolerance
        If `error` is below the limit of the precision for this motion, which the message gives; or `precision` is
        "double-double" and the motion cannot be computed to more than double precision.
    ValueError
        If `precision` is "double-double" and the system has no functions in this arithmetic.
    ZerodriftError
        If the motion cannot be simulated.

    Notes
    -----
    With contacts, stops or dry friction, all runs that are compared must have the same sequence of phases; changes within 1e-9 of
    the span count as one. The caveats name the open contact that passes its shape most closely, and bounces that are omitted.
    Without `t_eval`, samples are at equal distances in time, and the arithmetic is double precision.

    Start and parameters count as exact in double precision; in double-double arithmetic what follows from them, such as dependent
    coordinates of the start, is computed with 32 digits, and can be read at the first sample. Fractions in expressions are exact;
    other numbers, such as pi, are the doubles nearest to them. In a sensitive motion, the rounding of a decimal parameter may
    change the motion by more than `error`; this is not part of the certificate.

    Examples
    --------
    >>> import numpy as np, zerodrift as zd
    >>> ref = zd.reference(zd.systems.oscillator(mass=1.0, stiffness=4.0, x0=0.1), 2.0, error=1e-12)
    >>> bool(abs(ref.solution.p[:, 0] - 0.1 * np.cos(2 * ref.solution.t)).max() <= ref.error <= 1e-12)
    True
    >>> ref.caveats
    ()

    The same motion beyond double precision:

    >>> ref = zd.reference(zd.systems.oscillator(mass=1.0, stiffness=4.0, x0=0.1), 2.0, error=1e-25)
    >>> ref.precision, ref.error <= 1e-25
    ('double-double', True)
    >>> from fractions import Fraction
    >>> Fraction(ref.p[0, 0]) + Fraction(ref.p_low[0, 0]) == Fraction(0.1)
    True
    """
    wanted = None if error is None else checks.number("error", error, above=0)
    system = system_of(system, p0, v0)
    pairs = _pairs(system, formulations)
    bounds = {"first_step": first_step, "max_step": max_step, "max_move": max_move}
    motion = Motion(system, checks.span(t_span), p0, v0, t_eval, stabilization, pairs[0][0], bounds)
    functions = _functions(system, precision)
    if functions is None or (precision is None and wanted is not None and wanted >= SPACING * motion.size):
        try:
            return _in_double(motion, pairs, wanted)
        except UnreachableTolerance:
            if functions is None:
                raise
    evidence = Search(motion, pairs, None if wanted is None else EVIDENCE * motion.size).found()
    search = PreciseSearch(motion, functions, evidence, wanted)
    found = search.certified()
    if precision is not None and not found.low:
        raise UnreachableTolerance(f"this motion has no reference in double-double arithmetic: {search.reason}; in double "
                                   f"precision, {found.error:.2g} can be certified")
    return found if found.low and found.error <= (wanted or math.inf) else _in_double(motion, pairs, wanted)


def _functions(system: BaseSystem, precision: str | None) -> Precise | None:
    """Functions in double-double arithmetic, if they may be used; ValueError where they are requested and there are none."""
    if precision is not None:
        checks.choice("precision", precision, PRECISIONS)
    functions = None if system._groups else functions_of(system, precision)
    if functions is None and precision == PRECISIONS[1]:
        raise WrongValue(f"precision must be 'double', as {system.name} has no functions in double-double arithmetic: built-in "
                         "systems have some, and compiled ones of expressions without cases", "not-available")
    return functions


def _in_double(motion: Motion, pairs: list[tuple[str, str]], wanted: float | None) -> Reference:
    """The reference in double precision."""
    if wanted is not None and wanted < SPACING * motion.size:
        raise UnreachableTolerance(f"error must be at least {SPACING * motion.size:.2g}, the spacing of doubles at the size of "
                                   f"this motion, not {wanted:g}")
    search = Search(motion, pairs, wanted)
    found = search.found()
    if (wanted is None or found.error > wanted) and motion.follows_series(pairs[0][0]):
        with contextlib.suppress(ZerodriftError):
            found = min(found, SearchBySeries(motion, pairs, wanted).found(), key=lambda each: each.error)
    if wanted is not None and not found.error <= wanted:
        raise UnreachableTolerance(f"error = {wanted:g} cannot be certified: {search.limit(found)}; what can be certified is "
                                   f"{found.error:.2g}")
    return found


def _pairs(system: BaseSystem, formulations: Any) -> list[tuple[str, str]]:
    """Pairs of formulations (motion, check): the given one, or candidates in the order in which they are tried."""
    if formulations is None:
        first, *others = methods.formulations(system)
        return [(first, other) for other in reversed(others)] if system.m and others else [(first, first)]
    names = tuple(formulations)
    if len(names) != 2 or names[0] == names[1]:
        raise WrongValue(f"formulations must be two different formulations, not {formulations!r}")
    for name in names:
        methods.row_of("formulations", name)
    return [names]
