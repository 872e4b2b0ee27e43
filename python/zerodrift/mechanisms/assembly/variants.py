"""Mechanisms that differ from one drawing in their numbers: tables in columns, and starts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..._private.gateway.mechanisms.assembly import DRAWN, STAYS
from ..._private.gateway.mechanisms.core import MechanismCore
from ..._private.gateway.mechanisms.element_tables import OutputSpec
from ..._private.gateway.mechanisms.parameter_variants import Held, Varied
from ..elements.columns import Column, Varies, expand
from ..elements.drawing import Drawing
from ..elements.frames import turned
from ..elements.numbers import Numbers
from ..equations.measure_names import is_rate
from ..equations.measure_tables import read
from ..equations.tables import Tables
from .free_coordinates import Coordinate, names_of, unforced
from .start import Starting, drives_of, size_of


def are_plain(drawing: Drawing, tables: Tables, start: Starting) -> bool:
    """True if starts need no Python per mechanism: no user functions, no wishes, and every motion has inertia."""
    if drawing.dimension != 2 or tables.laws.rows or drawing.wished:
        return False
    return all(tables.inertias.is_massive(body) for body in tables.parts) or start.has_mass


def varied(drawing: Drawing, changed: Mapping[str, float], parameters: Mapping[str, np.ndarray], layout: str, core: MechanismCore,
           start: Starting, *, wrong: np.ndarray, starts_are_known: bool) -> Varied | None:
    """Mechanisms that differ from the drawing in the changed numbers and in `parameters`, each (count,) by its path.

    None if they differ in more than numbers. Mechanisms marked in `wrong` (count,) are not assembled.
    """
    count = len(wrong)
    numbers = Numbers({**changed, **{name: Column(np.asarray(each, dtype=float)) for name, each in parameters.items()}})
    try:
        tables = Tables(drawing, numbers, in_tree=layout != "absolute")
        absolute = tables.absolute()
        if layout == "absolute" and not all(tables.inertias.is_massive(body) for body in tables.parts):
            return None
        drives = drives_of(drawing)
        if (drives if starts_are_known else start.is_relative):
            return None
        places, rates, _ = unforced(drawing, tables)
        drawn_names = start.drive_starts(0.0).drawn
        quantities, observed = read(absolute, [*drawing.held, *drawn_names, *names_of([*places, *rates])])
        index = {row.name: i for i, row in enumerate(observed)}
        staying = [*_staying(places, observed, index, is_rate=False), *_staying(rates, observed, index, is_rate=True)]
        held = [*_held(drawing, index), *staying, *(Held(index[name], 0, False, 0.0, DRAWN) for name in drawn_names)]
        poses, length = _drawn(tables, count), expand(size_of(drawing, numbers), count)
        moving, drawn = tables.written(*read(tables)), absolute.written(quantities, observed)
    except Varies:
        return None
    has_its_measures = [row[1:-1] for row in moving.measures] == [row[1:-1] for row in core.measures]
    if absolute.relation_names != tables.relation_names or not has_its_measures:
        return None
    poses[wrong] = np.nan
    numbers_of_drives = [tables.relation_names.index(motor.name) for motor in drives]
    return Varied(moving, drawn, count, poses, length, held, numbers_of_drives, starts_are_known)


def _held(drawing: Drawing, index: Mapping[str, int]) -> list[Held]:
    """Held values of the start, by component."""
    held = []
    for name, value in drawing.held.items():
        rate, (base, _, axis) = is_rate(name, drawing.elements), name.rpartition(".")
        if name in index:
            held += [Held(index[name], i, rate, float(each)) for i, each in enumerate(np.atleast_1d(value))]
        else:
            held.append(Held(index[base], "xy".index(axis), rate, float(value)))
    return held


def _staying(coordinates: Sequence[Coordinate], observed: Sequence[OutputSpec], index: Mapping[str, int], *,
             is_rate: bool) -> Iterator[Held]:
    """Targets that keep coordinates as drawn, or at rest."""
    for each in coordinates:
        measure = index[each.rate if is_rate else each.position]
        components = range(observed[measure].size) if each.axis is None else ["xy".index(each.axis)]
        yield from (Held(measure, i, is_rate, 0.0, STAYS) for i in components)


def _drawn(tables: Tables, count: int) -> np.ndarray:
    """Poses (count, bodies, 3) of the mass centres as drawn."""
    poses = np.empty((count, len(tables.parts), 3))
    for i, body in enumerate(tables.parts):
        place = body.pose.origin + turned(body.pose.angle, tables.inertias.of[body.name][2])
        for j, each in enumerate((*place, body.pose.angle)):
            poses[:, i, j] = expand(each, count)
    return poses
