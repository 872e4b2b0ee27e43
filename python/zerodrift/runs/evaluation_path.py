"""Evaluation path of a run: closed form (generated functions of the system), or matrices of the formulation, and why."""

from __future__ import annotations

from typing import Any

from .. import _gateway
from ..systems.base import BaseSystem, core_of
from .methods import name_of
from .settings import VECTOR_UNITS, core_settings

EXPLICIT = "rk4"        # an integrator that uses closed-form functions wherever the formulation does


def unit(core: _gateway.CoreSystem, settings: Any) -> str | None:
    """Vector unit of the closed-form functions that a run uses; None if it uses none."""
    found = _gateway.closed_form_unit(core, settings)
    return None if found is None else VECTOR_UNITS[found]


def matrix_path_reason(system: BaseSystem, settings: dict[str, Any], stats: dict[str, Any]) -> str | None:
    """Reason why no step used the closed form; None if some did, or if systems of this kind have no closed form."""
    translated, core = core_settings((0.0, 0.0), settings), core_of(system)
    lacks = system._why_no_closed_form(_gateway.takes_embeddings(translated))
    if stats["closed_form_steps"] or not stats["steps"] or lacks is None:
        return None
    if settings["closed_form"] is False:
        return "closed_form=False"
    if not _gateway.takes_closed_form(core, translated):
        explicit = core_settings((0.0, 0.0), settings | {"integrator": EXPLICIT})
        table = "integrator" if _gateway.takes_closed_form(core, explicit) else "formulation"
        return f"{table} {name_of(f'{table}s', settings[table])!r} has none" + " for such a system" * (table == "formulation")
    if lacks:
        return lacks
    return "some constraints are redundant" if stats["redundant"] else "the elimination order is unsuitable at every step"
