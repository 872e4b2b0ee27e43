"""Names and units of the coordinates and velocities of a system, and its quaternions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .._private import checks, gateway
from .._private.gateway import Variable
from ..errors import WrongValue


def quaternion_places(given: Any, names: Sequence[str], has_kinematics: bool) -> tuple[int, ...]:
    """Increasing indices in p at which unit quaternions begin, each given by index or name of its first coordinate."""
    listed = checks.instance("quaternions", given, Sequence, "a sequence of indices or names of coordinates")
    places = sorted(list(names).index(checks.choice("quaternions", first, names)) if isinstance(first, str) else
                    checks.count("quaternions", first, least=0) for first in listed)
    if places and not has_kinematics:
        raise WrongValue("quaternions need kinematics, as their rates are not velocities", "missing-argument")
    for k, place in enumerate(places):
        if place + 4 > min([*places[k + 1:k + 2], len(names)]):
            raise WrongValue(f"quaternions must begin with four of the {len(names)} coordinates each, not shared; not {given!r}")
    return tuple(places)


def with_units(names: Sequence[str], rates: Sequence[str], units: Any,
               are_rates: bool, quaternions: Sequence[int] = ()) -> tuple[tuple[Variable, ...], tuple[Variable, ...]]:
    """Coordinates and velocities with their units; velocities that are rates of coordinates have the units of rates."""
    size = len(names) if are_rates else len(names) + len(rates)
    all_units = [""] * size if units is None else units
    listed = isinstance(all_units, Sequence) and not isinstance(all_units, str)
    if not listed or len(all_units) != size or not all(isinstance(unit, str) for unit in all_units):
        raise WrongValue(f"units must be {size} strings, one for each coordinate"
                         f"{'' if are_rates else ' and each velocity'}, not {units!r}", "shape")
    coordinates = tuple(map(Variable, names, all_units))
    for variable in (coordinates[first + i] for first in quaternions for i in range(4)):
        if gateway.is_length(variable):
            raise WrongValue(f"units of a quaternion must be those of pure numbers, and {variable.name} has {variable.unit!r}")
    rate_units = [f"{unit}/s" if unit else "" for unit in all_units] if are_rates else all_units[len(names):]
    return coordinates, tuple(map(Variable, rates, rate_units))
