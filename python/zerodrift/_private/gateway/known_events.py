"""Events whose quantities the core reads: one of them, an expression or a function in Python of several, reaches a value."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from ..core import ffi, lib

TIME, COORDINATE, VELOCITY = lib.ZD_READS_TIME, lib.ZD_READS_P, lib.ZD_READS_V
MEASURE, NUMBER, MULTIPLIER = lib.ZD_READS_MEASURE, lib.ZD_READS_NUMBER, lib.ZD_READS_MULTIPLIER


class Reading(NamedTuple):
    """Quantity that an event reads: a number of the motion, or a constant."""

    what: int                   # one of the above
    entry: int = 0              # of p, of v, of a measure, or of a constraint
    component: int = 0          # of the measure
    number: float = 0.0         # a NUMBER's


class KnownEvent(NamedTuple):
    """Event whose quantities the core reads; it evaluates it itself unless `is_called`."""

    readings: tuple[Reading, ...]
    value: float                        # which it reaches
    function: tuple[Any, Any] | None = None     # a `zd_expressions` of the readings, and what it refers to; None: the first
    parameters: frozenset[str] = frozenset()    # of the system, whose values are among the readings
    is_called: bool = False     # True: a function in Python is called with the readings

    @property
    def is_measured(self) -> bool:
        """True if the event reads a measure."""
        return any(reading.what == MEASURE for reading in self.readings)


def known_table(events: Sequence[KnownEvent | None]) -> tuple[Any, Any]:
    """The core's array of events, with None for those that Python evaluates; and the memory to keep with it."""
    kept = [None if event is None else ffi.new("zd_argument[]", [tuple(each) for each in event.readings]) for event in events]
    rows = [{} if event is None else {
        "readings": len(event.readings), "reading": readings, "value": event.value,
        "is_called": event.is_called,
        "function": event.function[0] if event.function else ffi.NULL}
        for event, readings in zip(events, kept, strict=True)]
    return ffi.new("zd_event[]", rows), (kept, events)
