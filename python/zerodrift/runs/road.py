"""The road that a run took: that of its system's direct functions, or the general one, and then why."""

from __future__ import annotations

from typing import Any

from .. import _gateway
from ..systems.base import BaseSystem, core_of
from .rows import name_of
from .settings import VECTOR_UNITS, core_settings

EXPLICIT = "rk4"        # an integrator with which direct functions are taken, where the formulation takes them


def unit(core: _gateway.CoreSystem, options: Any) -> str | None:
    """The vector unit of the direct functions that a run takes; None: it takes none."""
    found = _gateway.direct_unit(core, options)
    return None if found is None else VECTOR_UNITS[found]


def why_general(system: BaseSystem, settings: dict[str, Any], stats: dict[str, Any]) -> str | None:
    """Why no step was made by direct functions; None: some were, or the system is of a kind that has none."""
    options, core = core_settings((0.0, 0.0), settings), core_of(system)
    lacks = system._why_not_direct(_gateway.takes_embeddings(options))
    if stats["direct_steps"] or not stats["steps"] or lacks is None:
        return None
    if settings["direct"] is False:
        return "direct=False"
    if not _gateway.takes_direct(core, options):
        explicit = core_settings((0.0, 0.0), settings | {"integrator": EXPLICIT})
        table = "integrator" if _gateway.takes_direct(core, explicit) else "formulation"
        return f"{table} {name_of(f'{table}s', settings[table])!r} takes none" + " of such a system" * (table == "formulation")
    if lacks:
        return lacks
    return "some constraints are redundant" if stats["redundant"] else "at no step is their elimination sound"
