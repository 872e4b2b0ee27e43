"""Starts of drives that prescribe a speed: the driven coordinate keeps its drawn value, unless the start moves it.

Such a drive determines the rate of a coordinate alone. Held and wished values determine the coordinate where they depend on it;
without them the assembly would move the crank where that is the lightest body.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..._private.gateway.mechanisms.core import MechanismCore
from ...errors import CorrectionFailed, InconsistentStart
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Motor
from .assembly import NUDGE, Assembly, Target


class DriveStarts(NamedTuple):
    """Driven coordinates that keep their drawn values, and drives that cannot, though no start moves them."""

    drawn: tuple[str, ...] = ()
    unmet: tuple[Motor, ...] = ()


class Conditions(NamedTuple):
    """Drawn positions (nq,), and targets of the start: held, wished, and those of coordinates that stay."""

    p: np.ndarray
    held: Sequence[Target]
    wished: Sequence[Target]
    staying: Sequence[Target]


def speed_drives(drawing: Drawing) -> list[Motor]:
    """Motors that prescribe a speed, by a number, a user function or an input."""
    return [motor for motor in drawing.of(Motor) if motor.drives == "speed"]


def driven_coordinate(drive: Motor | Actuator) -> str:
    """Measure of the coordinate that a motor or an actuator drives."""
    return f"{getattr(drive, 'joint', drive).name}.{drive.coordinate}"


def drawn_targets(names: Sequence[str], core: MechanismCore) -> list[Target]:
    """Targets that keep these joint coordinates as drawn, where they are zero."""
    index = {row.name: i for i, row in enumerate(core.measures)}
    return [Target(name, index[name], 0, 0.0) for name in names]


def drive_starts(drives: Sequence[Motor], assembly: Assembly, given: Conditions) -> DriveStarts:
    """Driven coordinates that keep their drawn values: all, or those that do one after the other."""
    if not drives:
        return DriveStarts()
    p, is_told = None, bool(given.held or given.wished)
    if is_told:
        p = _assembled(assembly, given)
        given = given if p is None else _with_wishes_held(assembly, given, p)
    drawn = _kept([driven_coordinate(motor) for motor in drives], assembly, given)
    unmet = [motor for motor in drives if driven_coordinate(motor) not in drawn]
    if p is not None:
        unmet = [motor for motor in unmet if _is_free(driven_coordinate(motor), assembly, given, p)]
    return DriveStarts(tuple(drawn), () if is_told and p is None else tuple(unmet))


def _kept(names: Sequence[str], assembly: Assembly, given: Conditions) -> list[str]:
    if _assembled(assembly, given, drawn_targets(names, assembly.core)) is not None:
        return [*names]
    kept: list[str] = []
    for name in names if len(names) > 1 else ():
        if _assembled(assembly, given, drawn_targets([*kept, name], assembly.core)) is not None:
            kept.append(name)
    return kept


def _with_wishes_held(assembly: Assembly, given: Conditions, p: np.ndarray) -> Conditions:
    """The same conditions with wished values held as they are at p."""
    reached = [target._replace(value=_value(assembly, target, p)) for target in given.wished]
    return given._replace(held=[*given.held, *reached], wished=())


def _is_free(name: str, assembly: Assembly, given: Conditions, p: np.ndarray) -> bool:
    """True if a coordinate can move from its value at p, while held values stay."""
    target, = drawn_targets([name], assembly.core)
    ways = (target._replace(value=_value(assembly, target, p) + step) for step in (NUDGE, -NUDGE))
    return any(_assembled(assembly, given._replace(p=p, held=[*given.held, way])) is not None for way in ways)


def _value(assembly: Assembly, target: Target, p: np.ndarray) -> float:
    return float(assembly.core.measure_at(target.measure, assembly.t, p, np.zeros(assembly.core.nv))["value"][target.component])


def _assembled(assembly: Assembly, given: Conditions, drawn: Sequence[Target] = ()) -> np.ndarray | None:
    """Positions (nq,), or None if there are none."""
    try:
        return assembly.positions(*given, drawn)
    except (CorrectionFailed, InconsistentStart):
        return None
