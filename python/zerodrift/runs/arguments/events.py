"""Events: functions of the motion whose zeros are located, with SciPy's attributes, and measures that reach a value."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from ..._private import checks, gateway
from ..._private.gateway.known_events import Reading
from ..._private.types import Bindings, Expression, MeasureLike
from ...errors import WrongType, WrongValue
from ...systems.base import BaseSystem, switches_of


@dataclass(frozen=True)
class Event:
    """A measure that reaches a value, or a function that does, for the argument `events` of `simulate`.

    Parameters
    ----------
    what : measure, str, SymPy expression or callable
        A scalar measure, or a coordinate or velocity of the system, by name; or an expression of these, of ``t``, of parameters,
        and of the names in `of`, as symbols; or a Python function with arguments among ``t``, ``p``, ``v``, parameters, and the
        names in `of`. The core evaluates all but the last itself, in nanoseconds; in ensembles, runs with only these use SIMD
        lanes, unless they read reactions or accelerations.
    value : float
        Value to reach, in the unit of the measure.
    direction : {-1, 0, 1}
        1: from below only, -1: from above only.
    terminal : bool or int
        True: the run ends at the first occurrence; an integer n: at the n-th.
    of : dict of str to measure, optional
        Measures that the function receives, by argument name, or that symbols of the expression stand for.
    then : callable or dict, optional
        Action at each occurrence, after which the run goes on: a dict has values of inputs by name, which need not be declared
        as inputs elsewhere. The core sets them, in `simulate`, `Run`, `ensemble`, `block`, `c_source`, `fmu` and live views. Or
        a function, of `simulate` and `Run`: ``then(run)`` may set inputs and `Run.set_state`. A terminal event acts, too, and
        the last sample is the one before. The name of a joint that was made with `active`: False releases it, True joins the
        bodies where they are.

    Notes
    -----
    The event is evaluated at 16 points of each step, and near extremes towards zero: zeros further apart than a tenth of a step
    are found. Set `max_step` for those of a function that changes faster. A touch of zero, to rounding, is not an event,
    except exactly at the end of a step.

    With `then` an event is armed again once its function has left zero; several at one instant act in the order of the list, and
    one that acts three times within 1e-9 of the elapsed time is an error. A shortened fixed step is followed by another short
    one to its grid. `Solution.jumps` has all actions. Samples of steps have the states before and after `set_state`, and
    ``sol(t)`` at the located instant has the one after; a time of `t_eval` at the instant has the one before. Saved states do
    not include data that a function keeps.

    Reactions and accelerations are those of the state at which the event is evaluated. Where an input jumps, they jump with
    it: the event happens there, and the state after the jump is reported. The same holds for forces and velocities that jump
    past the value where a contact changes, as in an impact.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> sol = zd.simulate(m, 2.0, step=0.01, events=zd.Event(link.end.position.y, value=-0.5, terminal=True))
    >>> sol[link.end.position][-1].round(9).tolist()
    [0.866025404, -0.5]

    The pin bears 10 N: the force along the link is 5/2 m g times the sine of its angle below the horizontal, and the one across
    m g / 4 times the cosine:

    >>> load = zd.Event(lambda x, y: (x**2 + y**2)**0.5 - 10, of={"x": pin.force.x, "y": pin.force.y}, terminal=True)
    >>> sol = zd.simulate(m, 2.0, step=0.01, events=load)
    >>> float(round(sol[pin.angle][-1], 6))
    -0.408558

    A ball that bounces, with a coefficient of restitution of 0.5:

    >>> m = zd.Mechanism("ball", gravity=(0, -9.81))
    >>> ball = m.body("ball", at=(0, 1), mass=1.0, inertia=0.1)
    >>> def bounce(run: zd.Run) -> None:
    ...     run.set_state(v=run.v * [1, -0.5, 1])
    >>> floor = zd.Event(ball.position.y, direction=-1, then=bounce)
    >>> sol = zd.simulate(m, 1.0, events=floor)
    >>> sol.t_events[0].round(6).tolist()
    [0.451524, 0.903047]

    The crank and the rocker of a four-bar at right angles, compiled:

    >>> import numpy as np
    >>> import sympy
    >>> bar = zd.systems.four_bar()
    >>> across = sympy.cos(sympy.Symbol("alpha1") - sympy.Symbol("alpha3"))
    >>> sol = zd.simulate(bar, 8.0, step=0.01, events=zd.Event(across, direction=1))
    >>> bool(abs(np.cos(sol.p_events[0][:, 0] - sol.p_events[0][:, 2])).max() < 1e-12)
    True
    """

    what: MeasureLike | Expression | Callable[..., Any]
    value: float = 0.0
    direction: Literal[-1, 0, 1] = 0
    terminal: bool | int = False
    of: Bindings | None = None
    then: Callable[[Any], object] | Mapping[str, float] | None = None

    def watched(self, name: str, system: BaseSystem) -> Watched:
        """The event, checked for a system; error messages call it `name`, such as ``events[1]``."""
        level, function, known, sign = checks.number(f"value of {name}", self.value), None, None, 1
        if hasattr(self.what, "free_symbols"):
            function, known, sign = _expression(name, self.what, system, dict(self.of or {}), level)
        elif callable(self.what):
            function = _Called(name, self.what, system, tuple(self.of or {}), level)
            bound = [_reading(f"of[{key!r}] of {name}", measure, system) for key, measure in (self.of or {}).items()]
            known = _called(bound, level)
        elif self.of:
            raise WrongValue(f"of must be left out of {name}: it binds measures to names in a function or an expression, and "
                             f"{checks.shown(self.what)} is a measure", "conflicting-arguments")
        else:
            known = gateway.KnownEvent((_reading(name, self.what, system),), level)
        return _watched(name, function, sign * self.direction, self.terminal, known, _action(name, self.then))


def _action(name: str, then: Any) -> Callable[[Any], object] | Mapping[str, float] | None:
    if isinstance(then, Mapping):
        return {checks.instance(f"a name in then of {name}", key, str, "the name of an input or a joint"):
                float(value) if isinstance(value, bool) else checks.number(f"then[{key!r}] of {name}", value)
                for key, value in then.items()}
    if then is not None and not callable(then):
        raise WrongType(f"then of {name} must be a function of the run, or a dict of inputs, not {checks.shown(then)}")
    return then


def _expression(name: str, what: Any, system: BaseSystem, of: dict[str, Any],
                level: float) -> tuple[Callable[..., float] | None, gateway.KnownEvent | None, int]:
    """The function that an expression is: one that the core knows, or else one of Python; and the sign of its direction."""
    from . import expressions  # slow to import, as SymPy is

    found = expressions.read(name, what, system, of, is_dynamic=True)
    if line := expressions.line(found):
        slope, constant = line
        return None, gateway.KnownEvent((found.readings[0],), (level - constant) / slope), 1 if slope > 0 else -1
    program = expressions.program(name, found) if found.readings else None
    if program is None:
        value = expressions.in_python(found)
        return lambda t, p, v, x: value(*x) - level, _called(found.readings, level), 1
    return None, gateway.KnownEvent(tuple(program[1]), level, program[0], found.parameters), 1


def _called(readings: list[Reading], level: float) -> gateway.KnownEvent | None:
    """Measures that the core reads for a function in Python; None: none."""
    return gateway.KnownEvent(tuple(readings), level, is_called=True) if readings else None


class _Called:
    """A function called with the arguments that it names, of which `bound` are read."""

    def __init__(self, name: str, function: Callable[..., Any], system: BaseSystem, bound: Sequence[str], level: float) -> None:
        from ...systems.user_callables import arguments  # slow to import

        parameters = {key: value for key, value in system.parameters.items() if key.isidentifier()}
        names = arguments(name, function, [*checks.STATE, *parameters, *bound])
        self._function, self._level = function, level
        self._fixed = {key: parameters[key] for key in names if key in parameters and key not in bound}
        self._read = {key: i for i, key in enumerate(bound) if key in names}
        self._state = [key for key in names if key in checks.STATE]

    def __call__(self, t: float, p: np.ndarray, v: np.ndarray, x: Sequence[float]) -> float:
        state = {"t": t, "p": p, "v": v}
        asked = {key: state[key] for key in self._state} | {key: x[i] for key, i in self._read.items()}
        return self._function(**asked, **self._fixed) - self._level


def _reading(what: str, measure: Any, system: BaseSystem) -> Reading:
    """Description of a scalar measure by which the core evaluates it."""
    name = getattr(measure, "name", measure)
    if not isinstance(name, str):
        raise WrongType(f"{what} must be a measure, the name of one, an expression or a callable, not {checks.shown(measure)}")
    return system._reading(name, what, is_dynamic=True)


class Watched(NamedTuple):
    """Event function, checked; `value(t, p, v, x)` is a finite number."""

    name: str
    function: Callable[..., Any] | None     # float of (t, p, v, x), x as `known` has it; None if the core evaluates the event
    direction: int
    terminal: int
    known: gateway.KnownEvent | None   # what the core reads, or None
    then: Callable[[Any], object] | Mapping[str, float] | None = None
    is_own: bool = True         # False: of a latch of the mechanism, not of the argument `events`

    def actions(self, places: Mapping[str, Any]) -> list[tuple[int, float]]:
        """Indices of the inputs that it sets, with their values; -1: a function acts."""
        if not isinstance(self.then, Mapping):
            return [(-1, 0.0)] if self.then else []
        return [(int(i), value) for name, value in self.then.items() for i in np.ravel(places[name])]

    def act(self, run: Any) -> None:
        """Call the function that acts at an occurrence."""
        try:
            self.then(run)      # type: ignore[operator, misc]
        except BaseException as error:
            checks.tell(error, f"in then of {self.name}, called at t = {run.t:g}")
            raise

    def value(self, t: float, p: np.ndarray, v: np.ndarray, x: Sequence[float]) -> float:
        """Value of the event function, checked to be a finite number."""
        try:
            assert self.function
            value = self.function(t, p, v, x)
        except BaseException as error:
            checks.tell(error, f"in {self.name}, called at t = {t:g}")
            raise
        if type(value) is float and abs(value) < np.inf:
            return value
        return checks.number(f"value of {self.name} at t = {t:g}", value)


def events(given: Any, system: BaseSystem, *, may_act: bool = False) -> tuple[Watched, ...] | None:
    """Check the argument `events` of `simulate`: None, one event or several; each a callable, an `Event` or a measure.

    Functions as `then` are refused unless they may act.
    """
    latches = tuple(watched for joins, word in ((False, "until"), (True, "when"))      # at one instant joints are released first
                    for each in system._latches for watched in _of_latch(each, word, joins, system))
    if given is None:
        return latches or None
    is_one = not isinstance(given, Sequence) or isinstance(given, str)
    found = (_event("events", given, system),) if is_one else tuple(
        _event(f"events[{i}]", each, system) for i, each in enumerate(given))
    for each in found:
        if callable(each.then) and not may_act:
            raise WrongValue(f"{each.name}.then must be a dict of inputs here: functions act in simulate and Run",
                             "not-available")
    return found + latches


def _of_latch(latch: Any, word: str, joins: bool, system: BaseSystem) -> Iterator[Watched]:
    """Event at which a latch joins its joint, or lets it go."""
    given = getattr(latch, word)
    if given is None:
        return
    event = given if isinstance(given, Event) else Event(given, direction=1)
    if isinstance(event.what, str) and not system._watching.find(event.what):
        from .formula_text import Parser  # slow to import

        parser = Parser(f"{word} of latch {latch.name!r}", event.what, system._names_of_scalars())
        event = replace(event, what=parser.expression())
    watched = replace(event, direction=event.direction or 1, then={latch.joint: joins}).watched(latch.name, system)
    yield watched._replace(is_own=False)


def inputs_of(given: Any, system: Any) -> list[str]:
    """Inputs of a system that are set by the dicts of events, each once; joints that are released and joined are not inputs."""
    listed = given if isinstance(given, Sequence) and not isinstance(given, str) else [given]
    return list(dict.fromkeys(key for each in listed if isinstance(each, Event) and isinstance(each.then, Mapping)
                              for key in each.then if key not in switches_of(system)))


def _event(name: str, given: Any, system: BaseSystem) -> Watched:
    if hasattr(given, "free_symbols") or ((isinstance(given, str) or hasattr(given, "name")) and not callable(given)):
        given = Event(given)
    if isinstance(given, Event):
        return given.watched(name, system)
    if not callable(given):
        raise WrongType(f"{name} must be a callable event(t, p, v), a zd.Event or a measure, or a list of these, not {given!r}")
    return _watched(name, lambda t, p, v, x: given(t, p, v), getattr(given, "direction", 0), getattr(given, "terminal", False))


def _watched(name: str, function: Any, direction: Any, terminal: Any, known: gateway.KnownEvent | None = None,
             then: Any = None) -> Watched:
    """An event, checked."""
    if checks.number(f"{name}.direction", direction) not in (-1, 0, 1):
        raise WrongValue(f"{name}.direction must be -1, 0 or 1, not {direction!r}", "unknown-choice")
    if not isinstance(terminal, bool | np.bool_):
        checks.count(f"{name}.terminal, where it is not True or False,", terminal, least=0)
    return Watched(name, function, int(direction), int(terminal), known, then)
