"""Values of a motion in double-double arithmetic: between its samples, of measures and expressions, and at events.

Each is computed from all runs of the certificate, and has the bound that follows from their differences. Measures are evaluated
in decimal arithmetic, from the graph of which the code of the equations is generated.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from .._private.gateway import known_events
from .._private.gateway.known_events import Reading
from ..errors import UnreachableTolerance, WrongType, WrongValue
from ..runs.arguments.events import Event
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..systems.base import BaseSystem
from . import double_double as dd
from .decimal_programs import DIGITS, Decimals, Program, context, decimals, pair
from .precise_motion import Piece, PreciseMotion, PreciseRun, Settings

SAFETY = 5              # the certified error, in units of the root of the sum of squares of the differences
FLOOR = 2 * dd.EPS      # part of a value; the accuracy of sums and differences of samples
ITERATIONS = 10         # of Newton's method, for the time of an event
INCREMENT = Decimal("1e-7")     # of its slope, part of the duration
CONVERGED = Decimal("1e-31")    # largest last correction, part of the duration
FOUND = Decimal("1e-25")        # from the time found to those before and after at which signs must differ, part of the duration
FARTHEST = Decimal("1e-3")      # from the event in double precision, part of the duration

Value = Callable[[Decimal, Decimals, Decimals], Decimal]


class Samples(NamedTuple):
    """Coordinates and velocities at times: p + p_low is within `error` of the motion, v + v_low within `velocity_error`."""

    t: np.ndarray
    p: np.ndarray
    p_low: np.ndarray
    v: np.ndarray
    v_low: np.ndarray
    error: float
    velocity_error: float


class Quantity(NamedTuple):
    """Values (k,) of a measure: value + low is within `error` of that of the motion."""

    value: np.ndarray
    low: np.ndarray
    error: float


class EventTimes(NamedTuple):
    """Times (k,) of an event, t + low, which are within `error`, and the state (k, nq), (k, nv) then."""

    t: np.ndarray
    low: np.ndarray
    error: float
    p: np.ndarray
    p_low: np.ndarray
    v: np.ndarray
    v_low: np.ndarray


def bound(apart: Iterable[float], size: float) -> float:
    """Certified error, from the differences of other runs and the size of the values."""
    return SAFETY * math.hypot(*apart) + FLOOR * size


class Runs(NamedTuple):
    """All runs of a certificate at common times, the motion first; and how they are made again at other times."""

    motion: PreciseMotion
    ways: tuple[tuple[Settings, int], ...]      # arguments of PreciseMotion.run
    times: np.ndarray
    made: tuple[PreciseRun, ...]

    def at(self, times: np.ndarray) -> Runs:
        """The same runs at other times, from the polynomials of their steps."""
        each, places = np.unique(times, return_inverse=True)
        made = [self.motion.run(each, *way) for way in self.ways]
        return self._replace(times=times, made=tuple(PreciseRun(run.p[places], run.v[places], run.steps) for run in made))

    def samples(self) -> Samples:
        """Coordinates and velocities of the motion."""
        own, *others = self.made
        errors = [bound((float(np.abs(dd.minus(getattr(own, name), getattr(run, name))[..., 0]).max()) for run in others),
                        float(np.abs(getattr(own, name)).max())) for name in "pv"]
        return Samples(self.times, own.p[..., 0], own.p[..., 1], own.v[..., 0], own.v[..., 1], *errors)

    def values(self, of: Value) -> Quantity:
        """Values of a scalar quantity at all times."""
        with context():
            found = [[of(Decimal(t), decimals(p), decimals(v)) for t, p, v in zip(self.times.tolist(), run.p, run.v, strict=True)]
                     for run in self.made]
            return Quantity(*_parts(found[0]), _bound(found))

    def events(self, of: Value, near: np.ndarray) -> EventTimes:
        """Times near those given at which a quantity is zero."""
        last = self.times[-1:]
        polynomials = [Polynomials(self.motion, self.motion.run(last, *way, keeps_pieces=True).pieces, float(last[0]))
                       for way in self.ways]
        with context():
            found = [[each.root(of, Decimal(t)) for t in near.tolist()] for each in polynomials]
            states = [polynomials[0].state(t) for t in found[0]]
            p, v = (np.array([state[i] for state in states]).reshape(len(near), -1, 2) for i in (0, 1))
            return EventTimes(*_parts(found[0]), _bound(found), p[..., 0], p[..., 1], v[..., 0], v[..., 1])


class Polynomials:
    """The polynomials of all steps of a run, from which its state follows at any time."""

    def __init__(self, motion: PreciseMotion, pieces: Sequence[Piece], end: float) -> None:
        self._functions, self._pieces, self._begins = motion.functions, pieces, [piece.t for piece in pieces]
        self._duration = Decimal(end) - Decimal(motion.t0)

    def state(self, t: Decimal) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities (n, 2) at a time."""
        piece = self._pieces[max(bisect.bisect(self._begins, float(t)) - 1, 0)]
        h = np.array(pair(t - Decimal(piece.t)))
        p, v = (self._functions.value(x, h) for x in piece.series)
        return p, v

    def root(self, of: Value, t: Decimal) -> Decimal:
        """Time near t at which a quantity is zero, by Newton's method."""
        def value(at: Decimal) -> Decimal:
            return of(at, *map(decimals, self.state(at)))

        first, by, ends = t, INCREMENT * self._duration, FOUND * self._duration
        for _ in range(ITERATIONS):
            slope = (value(t + by) - value(t - by)) / (2 * by)
            change = value(t) / slope if slope else Decimal(0)
            t -= change
            if abs(change) <= CONVERGED * self._duration:
                break
        if abs(t - first) > FARTHEST * self._duration or not value(t - ends) * value(t + ends) < 0:
            raise UnreachableTolerance(f"the event near t = {float(first):.6g} s must cross its value at a rate that is not zero "
                                       "to be located beyond double precision")
        return t


def _parts(found: Sequence[Decimal]) -> tuple[np.ndarray, np.ndarray]:
    high, low = np.array([pair(x) for x in found]).reshape(-1, 2).T
    return high, low


def _bound(found: Sequence[Sequence[Decimal]]) -> float:
    own, *others = found
    apart = [float(max((abs(a - b) for a, b in zip(own, other, strict=True)), default=0)) for other in others]
    return bound(apart, float(max(map(abs, own), default=0)))


# ---- quantities ----


def value_of(what: str, given: Any, system: BaseSystem, of: Mapping[str, Any]) -> Value:
    """Function of a state in decimal arithmetic: of a coordinate, a velocity or a measure by its name, or of an expression."""
    if hasattr(given, "free_symbols"):
        return _expression(what, given, system, of)
    name = getattr(given, "name", given)
    if not isinstance(name, str):
        raise WrongType(f"{what} must be a measure, the name of one, a coordinate, a velocity or a SymPy expression, not "
                        f"{checks.shown(given)}")
    return _reader(what, system._reading(name, what), system)


def _reader(what: str, reading: Reading, system: BaseSystem) -> Value:
    match reading.what:
        case known_events.TIME:
            return lambda t, p, v: t
        case known_events.COORDINATE:
            return lambda t, p, v: p[reading.entry]
        case known_events.VELOCITY:
            return lambda t, p, v: v[reading.entry]
        case known_events.NUMBER:
            return lambda t, p, v: Decimal(reading.number)
    name = system._watching.core.measures[reading.entry].name
    program = system._program_of(name)
    if program is None:
        raise WrongValue(f"{what} must be a measure of positions or velocities, which {name!r} is not")
    lowering, results, parameters = program
    return Program(lowering, results[reading.component], parameters).value


def _expression(what: str, given: Any, system: BaseSystem, of: Mapping[str, Any]) -> Value:
    import mpmath  # slow to import, as SymPy is
    import sympy

    from ..runs.arguments import expressions

    found = expressions.read(what, given, system, of)
    readers = [_reader(what, reading, system) for reading in found.readings]
    function = sympy.lambdify(found.atoms, found.expression, "mpmath")

    def value(t: Decimal, p: Decimals, v: Decimals) -> Decimal:
        with mpmath.workdps(DIGITS):
            return Decimal(mpmath.nstr(function(*(mpmath.mpf(str(read(t, p, v))) for read in readers)), DIGITS))

    return value


def located(runs: Runs, solution: Solution, given: Any) -> EventTimes:
    """Times of one event: found in double precision, by the run of the solution, and then by the polynomials of all runs."""
    event = given if isinstance(given, Event) else Event(given)
    value = value_of("events", event.what, solution.system, event.of or {})
    settings = {name: value for name, value in solution.settings.items() if name != "t_eval"}
    run = simulate(solution.system, solution.t_span, **settings, events=event)
    times, p, v = (each[0] for each in (run.t_events, run.p_events, run.v_events) if each)
    if not len(times):
        return EventTimes(times, times, 0.0, p, p, v, v)
    level = Decimal(checks.number("value of events", event.value))
    return runs.events(lambda t, p, v: value(t, p, v) - level, times)
