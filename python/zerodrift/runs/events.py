"""Events: functions of the motion whose zeros are located, with SciPy's attributes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from .. import _check


class Event(NamedTuple):
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


def events(given: Any) -> tuple[Event, ...] | None:
    """The argument `events` of `simulate`: None, a callable, or several."""
    if given is None:
        return None
    if callable(given):
        return (_event("events", given),)
    if not isinstance(given, Sequence) or isinstance(given, str):
        raise TypeError(f"events must be a callable or a list of callables, not {given!r}")
    return tuple(_event(f"events[{i}]", each) for i, each in enumerate(given))


def _event(name: str, function: Any) -> Event:
    if not callable(function):
        raise TypeError(f"{name} must be a callable event(t, p, v), not {function!r}")
    direction, terminal = getattr(function, "direction", 0), getattr(function, "terminal", False)
    if _check.number(f"{name}.direction", direction) not in (-1, 0, 1):
        raise ValueError(f"{name}.direction must be -1, 0 or 1, not {direction!r}")
    if not isinstance(terminal, bool | np.bool_):
        _check.count(f"{name}.terminal, where it is not True or False,", terminal, least=0)
    return Event(name, function, int(direction), int(terminal))
