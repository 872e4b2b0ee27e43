"""Events: functions of the motion whose zeros are located, with SciPy's attributes, and measures that reach a value."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .. import _check
from ..systems.base import BaseSystem


@dataclass(frozen=True)
class Event:
    """A measure that reaches a value, or a function that does, for the argument `events` of `simulate`.

    Parameters
    ----------
    what : measure, str or callable
        A scalar measure of positions or velocities, or a coordinate or velocity of the system, by name; or a function that names
        what it wants: ``t``, ``p``, ``v``, parameters, and what `of` binds.
    value : float
        Which it reaches, in the unit of the measure.
    direction : {-1, 0, 1}
        1: from below only, -1: from above only.
    terminal : bool or int
        Whether the run ends when it has happened, once or that often.
    of : dict of str to measure, optional
        Under which names a function is handed which measures.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> sol = zd.simulate(m, 2.0, step=0.01, events=zd.Event(link.end.position.y, value=-0.5, terminal=True))
    >>> sol[link.end.position][-1].round(9).tolist()
    [0.866025404, -0.5]
    """

    what: Any
    value: float = 0.0
    direction: int = 0
    terminal: bool | int = False
    of: Mapping[str, Any] | None = None

    def function(self, name: str, system: BaseSystem) -> Callable[[float, np.ndarray, np.ndarray], float]:
        """The function of (t, p, v) whose zero it is."""
        level = _check.number(f"value of {name}", self.value)
        if callable(self.what):
            bound = {key: _reader(f"of[{key!r}] of {name}", measure, system) for key, measure in (self.of or {}).items()}
            return _Called(name, self.what, system, bound, level)
        read = _reader(name, self.what, system)
        return lambda t, p, v: read(t, p, v) - level


class _Called:
    """A function that is handed what it names."""

    def __init__(self, name: str, function: Callable[..., Any], system: BaseSystem, bound: dict[str, Any], level: float) -> None:
        from ..systems.callables import arguments  # slow to import

        parameters = {key: value for key, value in system.parameters.items() if key.isidentifier()}
        names = arguments(name, function, [*_check.STATE, *parameters, *bound])
        self._function, self._level = function, level
        self._fixed = {key: parameters[key] for key in names if key in parameters and key not in bound}
        self._read = {key: bound[key] for key in names if key in bound}
        self._state = [key for key in names if key in _check.STATE]

    def __call__(self, t: float, p: np.ndarray, v: np.ndarray) -> float:
        state = {"t": t, "p": p, "v": v}
        asked = {key: state[key] for key in self._state} | {key: read(t, p, v) for key, read in self._read.items()}
        return self._function(**asked, **self._fixed) - self._level


def _reader(what: str, measure: Any, system: BaseSystem) -> Callable[[float, np.ndarray, np.ndarray], float]:
    """The function of (t, p, v) that reads a scalar measure."""
    name = getattr(measure, "name", measure)
    if not isinstance(name, str):
        raise TypeError(f"{what} must be a measure, the name of one, or a callable, not {_check.shown(measure)}")
    return system._reader(name, what)


class Watched(NamedTuple):
    """A function of the motion, checked: `value` of (t, p, v) is a finite number."""

    name: str
    function: Callable[[float, np.ndarray, np.ndarray], float]
    direction: int
    terminal: int

    def value(self, t: float, p: np.ndarray, v: np.ndarray) -> float:
        """What the function returns, if that is a number."""
        try:
            value = self.function(t, p, v)
        except BaseException as error:
            _check.tell(error, f"in {self.name}, called at t = {t:g}")
            raise
        if type(value) is float and abs(value) < np.inf:
            return value
        return _check.number(f"what {self.name} returns at t = {t:g}", value)


def events(given: Any, system: BaseSystem) -> tuple[Watched, ...] | None:
    """The argument `events` of `simulate`: None, one event, or several; each a callable, an `Event` or a measure."""
    if given is None:
        return None
    if not isinstance(given, Sequence) or isinstance(given, str):
        return (_event("events", given, system),)
    return tuple(_event(f"events[{i}]", each, system) for i, each in enumerate(given))


def _event(name: str, given: Any, system: BaseSystem) -> Watched:
    if isinstance(given, str) or hasattr(given, "name"):
        given = given if callable(given) else Event(given)
    if isinstance(given, Event):
        return _watched(name, given.function(name, system), given.direction, given.terminal)
    if not callable(given):
        raise TypeError(f"{name} must be a callable event(t, p, v), a zd.Event or a measure, or a list of these, not {given!r}")
    return _watched(name, given, getattr(given, "direction", 0), getattr(given, "terminal", False))


def _watched(name: str, function: Any, direction: Any, terminal: Any) -> Watched:
    """An event, checked."""
    if _check.number(f"{name}.direction", direction) not in (-1, 0, 1):
        raise ValueError(f"{name}.direction must be -1, 0 or 1, not {direction!r}")
    if not isinstance(terminal, bool | np.bool_):
        _check.count(f"{name}.terminal, where it is not True or False,", terminal, least=0)
    return Watched(name, function, int(direction), int(terminal))
