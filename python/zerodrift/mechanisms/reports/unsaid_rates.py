"""Coordinates that start moving though neither drives nor values of the start determine their rates, in words."""

from __future__ import annotations

import numpy as np

from ..assembly.assembly import Assembly
from ..assembly.free_coordinates import rates_of_tree
from ..assembly.relative_rates import Rates
from ..elements.drawing import Drawing
from ..equations.measure_tables import read
from ..equations.tables import Tables

MOST_NAMED = 8
LEAST_RATE = 1e-9       # of the largest velocity: rate of a coordinate that rests


def moving_unsaid(drawing: Drawing, tables: Tables, assembly: Assembly, p: np.ndarray, rates: Rates) -> str | None:
    """Sentence on joint coordinates that start moving unsaid; None without such."""
    if not (rates.v.any() and rates.free.shape[1]):
        return None
    names = rates_of_tree(drawing, tables)
    core, said = tables.core(*read(tables, names)), []
    size = np.abs(rates.v / assembly.scale).max()
    for i, measure in enumerate(core.measures):
        found = core.measure_at(i, assembly.t, p, rates.v)
        unit = assembly.length if measure.unit == "m/s" else 1.0
        most = LEAST_RATE * unit * np.abs(rates.free / assembly.scale[:, None]).max()
        is_open = np.abs(found["jacobian"] @ rates.free).max() > most
        if measure.name in names and is_open and np.abs(found["value"]).max() > LEAST_RATE * unit * size:
            said.append(f"{measure.name} = {_numbers(found['value'])} {measure.unit}")
    others = [f"{len(said) - MOST_NAMED} others"] if len(said) > MOST_NAMED else []
    return f"starts moving, with the least energy: {', '.join([*said[:MOST_NAMED], *others])}" if said else None


def _numbers(values: np.ndarray) -> str:
    words = [f"{value if abs(value) > LEAST_RATE * np.abs(values).max() else 0.0:.3g}" for value in values]
    return words[0] if len(words) == 1 else f"({', '.join(words)})"
