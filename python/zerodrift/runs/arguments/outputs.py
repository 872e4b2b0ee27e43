"""The argument `outputs` of `simulate`: measures that are recorded during the run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..._private import checks, gateway
from ...errors import WrongType, WrongValue
from ...systems.base import BaseSystem


class Recorded:
    """Measures that a run records in addition to its state; vectors with all components."""

    def __init__(self, names: tuple[str, ...], system: BaseSystem, core: gateway.CoreSystem, measured: Any = None) -> None:
        watching = system._watching
        places = [place for name in names if (place := watching.view(name)) is not None]
        numbers = list(dict.fromkeys(place.number for place in places))     # without duplicates
        known = list(watching.known)
        self.names = [known[number] for number in numbers]
        self.core = gateway.Outputs(numbers, measured or watching.core, core, is_own=measured is not None) if numbers else None

    def columns(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """Measures by name, (k,) or (k, size) each, from the recorded samples."""
        parts = zip(self.names, self.core.split(rows) if self.core else (), strict=True)
        return {name: part[:, 0] if part.shape[1] == 1 else part for name, part in parts}


def names(given: Any, system: BaseSystem) -> tuple[str, ...]:
    """Names in the argument `outputs`, checked: measures, coordinates, velocities and multipliers."""
    single = isinstance(given, str) or hasattr(given, "name")
    if not single and not isinstance(given, Sequence):
        raise WrongType(f"outputs must be a list of measures or their names, not {checks.shown(given)}")
    return tuple(_name(f"outputs[{i}]", each, system) for i, each in enumerate((given,) if single else given))


def _name(what: str, given: Any, system: BaseSystem) -> str:
    name = getattr(given, "name", given)
    if not isinstance(name, str):
        raise WrongType(f"{what} must be a measure or the name of one, not {checks.shown(given)}")
    if system._watching.view(name) is None and name not in system._columns_of:
        raise WrongValue(f"{what} must name a measure or a variable of {system.name}, not {name!r}; "
                         f"{checks.closest(name, system._names_of_quantities())}", "wrong-name")
    return name
