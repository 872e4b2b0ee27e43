"""Events of an FMU: quantities that reach a value, as tables of its sources."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from .._private.gateway import known_events
from .._private.gateway.known_events import Reading
from .._private.gateway.mechanisms import blocks
from ..errors import WrongValue
from ..runs.arguments import events as _events
from ..systems.base import BaseSystem
from .block import Chosen, written

SOURCES = {known_events.COORDINATE: "ZD_READS_P", known_events.VELOCITY: "ZD_READS_V", known_events.MEASURE: "ZD_READS_MEASURE"}


class Level(NamedTuple):
    """An event: the quantity that reaches a value, and the name of its measure if it is one."""

    reading: Reading
    measure: str
    value: float
    direction: int
    is_terminal: bool


def chosen_events(given: Any, system: BaseSystem, version: str) -> list[Level]:
    """Check the argument `events` of `fmu`."""
    found, names = [], list(system._watching.known)
    for each in _events.events(given, system) or ():
        if each.known is None or each.known.function or each.known.readings[0].what not in SOURCES:
            raise WrongValue(f"{each.name} of an FMU must be a measure, coordinate or velocity that reaches a value, and not be "
                             "a function", "not-portable")
        if each.terminal > 1:
            raise WrongValue(f"{each.name}.terminal must be True or False in an FMU, not {each.terminal}", "not-available")
        if version == "2.0" and not each.terminal:
            raise WrongValue(f"{each.name} must be terminal in FMI 2.0, whose steps do not return early", "not-available")
        reading = each.known.readings[0]
        measure = names[reading.entry] if reading.what == known_events.MEASURE else ""
        found.append(Level(reading, measure, each.known.value, each.direction, bool(each.terminal)))
    return found


def table(events: Sequence[Level], made: Chosen) -> str:
    """Tables of the events in C, which have one more entry, as there may be no event."""
    measures = [measure.name for measure in blocks.BlockCore(written(made)).measures]
    readings = [f"{{.what = {SOURCES[each.reading.what]}, .component = {each.reading.component}, "
                f".index = {measures.index(each.measure) if each.measure else each.reading.index}}}" for each in events]
    known = [f"{{.readings = 1, .reading = event_reading + {i}, .value = {each.value!r}}}" for i, each in enumerate(events)]
    columns = [("zd_argument event_reading", [*readings, "{.index = 0}"]),
               ("zd_event event_table", [*known, "{.readings = 0}"]),
               ("int event_direction", [*(str(each.direction) for each in events), "0"]),
               ("int event_is_terminal", [*(str(int(each.is_terminal)) for each in events), "0"])]
    return "\n".join(["", f"enum {{ EVENTS = {len(events)} }};",
                      *(f"static const {name}[EVENTS + 1] = {{{', '.join(entries)}}};" for name, entries in columns), ""])
