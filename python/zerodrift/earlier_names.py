"""Modules of earlier versions that pickles name, as aliases of the modules that define their classes and functions now."""

from __future__ import annotations

import importlib
import sys
import types
import warnings
from typing import Any

ELEMENTS = ("bodies", "columns", "drawing", "forces", "joints", "measures", "numbers", "space_bodies", "space_joints")
MOVED = {
    **{f"mechanisms.{name}": f"mechanisms.elements.{name}" for name in ELEMENTS},
    "mechanisms.laws": "mechanisms.elements.user_functions",
    "mechanisms.made_forces": "mechanisms.elements.table_forces",
    "mechanisms.making_couplings": "mechanisms.building.coupling_verbs",
    "mechanisms.plane": "mechanisms.elements.frames",
    "mechanisms.space": "mechanisms.elements.frames",
    "mechanisms.splines": "mechanisms.building.periodic_spline",
    "models.symbolic": "models._energies",
    "runs.rows": "runs.methods",
    "symbolics.direct_functions": "symbolics.compile.closed_form_library",
    "symbolics.series_functions": "symbolics.compile.series_library",
    "systems.watching": "systems.measure_values",
}
DEPRECATED = {
    "models.symbolic": "zd.models.symbolic is deprecated: zd.models has these mechanisms from bodies and joints; the notebooks "
                       "'andrews' and 'your_mechanism_from_sympy' are worked examples of zd.symbolic",
}
RENAMED = {"DirectFunctions": "ClosedFormFunctions"}


class _Moved(types.ModuleType):
    """Module of an earlier version: its attributes are those of the module that has replaced it, imported when one is used."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        earlier = self.__name__.removeprefix(f"{__package__}.")
        now = getattr(importlib.import_module(f"{__package__}.{MOVED[earlier]}"), RENAMED.get(name, name))
        if earlier in DEPRECATED:
            warnings.warn(DEPRECATED[earlier], DeprecationWarning, stacklevel=2)
        return now


def register() -> None:
    """Add the modules of earlier versions to those that can be imported, so that their pickles load."""
    for name in MOVED:
        sys.modules.setdefault(f"{__package__}.{name}", _Moved(f"{__package__}.{name}", f"Moved to {MOVED[name]}."))
