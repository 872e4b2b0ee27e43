"""Start velocities that are not zero though neither drives nor given values determine them, in words."""

from __future__ import annotations

import numpy as np

from ..assembly.assembly import MIN_RATE, Assembly
from ..assembly.drawing_changes import listed
from ..assembly.free_coordinates import rates_of_tree
from ..assembly.start import Starting
from ..equations.measure_tables import read
from ..equations.tables import Tables


def moving_unsaid(start: Starting, tables: Tables, assembly: Assembly, p: np.ndarray) -> list[str]:
    """Sentences on undetermined rates of joint coordinates that are not zero, and on bodies carried without such a rate."""
    v = start.velocities(assembly, p).v
    if not v.any() or not (free := start.undetermined(assembly, p)).shape[1]:
        return []
    size = np.abs(v / assembly.scale).max()
    bodies = rates_of_tree(start.drawing, tables)
    core = tables.core(*read(tables, list(bodies)))
    moving = {each.body for each, rate in zip(core.motions, v / assembly.scale, strict=True) if abs(rate) > MIN_RATE * size}
    said, riding = {}, []
    for i, measure in enumerate(core.measures):
        body, unit = bodies.get(measure.name), assembly.length if measure.unit == "m/s" else 1.0
        found = core.measure_at(i, assembly.t, p, v)
        if body is None or body not in moving or np.abs(found["row"] @ free).max() <= MIN_RATE * unit:
            continue
        if np.abs(found["value"]).max() > MIN_RATE * unit * size:
            said[f"{measure.name} = {_numbers(found['value'])} {measure.unit}"] = body
        else:
            riding.append(body)
    names = dict.fromkeys(tables.parts[body - 1].name for body in riding if body not in said.values())
    return [f"starts moving, {how}: {listed(each)}" for how, each in
            (("with the least energy", list(said)), ("at rest relative to what it hangs on", list(names))) if each]


def _numbers(values: np.ndarray) -> str:
    words = [f"{value if abs(value) > MIN_RATE * np.abs(values).max() else 0.0:.3g}" for value in values]
    return words[0] if len(words) == 1 else f"({', '.join(words)})"
