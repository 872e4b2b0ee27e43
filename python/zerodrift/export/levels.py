"""Events of a block: quantities that reach a value, and inputs that are set there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .._private.gateway import known_events
from ..errors import WrongValue
from ..runs.arguments.events import Watched, events
from ..systems.base import BaseSystem, switches_of

SOURCES = (known_events.COORDINATE, known_events.VELOCITY, known_events.MEASURE)


def levels(given: Any, system: BaseSystem) -> tuple[Watched, ...]:
    """Check the argument `events` of `block`."""
    found = events(given, system) or ()
    for each in found:
        if each.known is None or each.known.function or each.known.readings[0].what not in SOURCES:
            raise WrongValue(f"{each.name} of a block must be a measure, coordinate or velocity that reaches a value, not a "
                             "function of several: make that a measure with m.measure", "not-portable")
    return found


def measures_of(found: Sequence[Watched], names: Sequence[str]) -> tuple[str, ...]:
    """Measures that events read, of these names."""
    readings = [each.known.readings[0] for each in found if each.known]
    return tuple(names[each.entry] for each in readings if each.what == known_events.MEASURE)


def sections(found: Sequence[Watched], names: Sequence[str], measures: Sequence[str],
             inputs: Sequence[str], system: Any) -> dict[str, list[float]]:
    """Sections of events, which read measures of these names, and of actions, in a block with these measures and inputs."""
    rows: list[float] = []
    places = {**switches_of(system), **{name: i for i, name in enumerate(inputs)}}
    for each in found:
        assert each.known       # levels() has seen to that
        what, entry, component, _ = each.known.readings[0]
        entry = measures.index(names[entry]) if what == known_events.MEASURE else entry
        rows += [what, entry, component, each.known.value, each.direction, each.terminal]
    actions = [number for i, each in enumerate(found) for action in each.actions(places) for number in (i, *action)]
    return {"events": rows, "actions": actions}
