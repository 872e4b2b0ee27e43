"""Units of display: tables and pictures use them; computations are in SI units."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from types import MappingProxyType
from typing import Any, NamedTuple, ParamSpec, TypeVar

from ._private import checks
from .errors import WrongType, WrongValue

QUANTITIES = {"length": "m", "angle": "rad", "velocity": "m/s", "angular_velocity": "rad/s", "force": "N", "torque": "N m",
              "energy": "J", "power": "W", "mass": "kg", "time": "s"}
OF_UNIT = {unit: quantity for quantity, unit in QUANTITIES.items()}
TURN = 2 * math.pi
UNITS: dict[str, dict[str, float]] = {       # in the SI unit of the quantity
    "length": {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254, "ft": 0.3048},
    "angle": {"rad": 1.0, "mrad": 1e-3, "deg": TURN / 360, "rev": TURN},
    "velocity": {"m/s": 1.0, "mm/s": 1e-3, "m/min": 1 / 60, "km/h": 1 / 3.6, "mph": 0.44704, "ft/s": 0.3048},
    "angular_velocity": {"rad/s": 1.0, "deg/s": TURN / 360, "rpm": TURN / 60, "rev/s": TURN},
    "force": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "MN": 1e6, "lbf": 4.4482216152605},
    "torque": {"N m": 1.0, "N mm": 1e-3, "mN m": 1e-3, "kN m": 1e3, "MN m": 1e6, "lbf ft": 1.3558179483314004,
               "lbf in": 0.1129848290276167},
    "energy": {"J": 1.0, "mJ": 1e-3, "kJ": 1e3, "MJ": 1e6, "W h": 3600.0, "kW h": 3.6e6},
    "power": {"W": 1.0, "mW": 1e-3, "kW": 1e3, "MW": 1e6, "hp": 745.6998715822702},
    "mass": {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": 0.45359237},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
}
_chosen: ContextVar[Mapping[str, str]] = ContextVar("units of display", default=MappingProxyType({}))
Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


class Shown(NamedTuple):
    """Unit in which a quantity is shown, and factor of values in the SI unit."""

    unit: str
    factor: float


class display_units:        # noqa: N801 - called as a function
    """Choose the units in which results and pictures show quantities from now on.

    Results stay in SI units: ``sol["pin.force"]`` is in N. The choice holds for `Solution.to_csv`, `Solution.to_excel`,
    `Solution.to_frame`, `Solution.loads`, ``zerodrift.plot``, and for films, explorations and live pages that are made after it;
    their argument `display` takes precedence. Each call replaces the previous choice, and one without arguments restores SI
    units. In a ``with`` statement the choice ends with it.

    Parameters
    ----------
    units : dict of str to str, optional
        The same as `more`, as a dict.
    **more
        A unit for each quantity: ``force="kN"``, ``angle="deg"``, ``angular_velocity="rpm"``. Quantities are length, angle,
        velocity, angular_velocity, force, torque, energy, power, mass and time.

    Raises
    ------
    ValueError
        If there is no such quantity or unit; the message lists the known ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.slider_crank(), 0.1, step=0.01)
    >>> with zd.display_units(force="kN", angle="deg"):
    ...     zd.plot.measures(sol, ["main.force.x", "crank.angle"]).get_ylabel()
    'kN, deg'
    """

    def __init__(self, units: Mapping[str, str] | None = None, **more: str) -> None:
        self._before = _chosen.set(_checked({**(units or {}), **more}))

    def __enter__(self) -> display_units:
        return self

    def __exit__(self, *_: object) -> None:
        _chosen.reset(self._before)

    def __repr__(self) -> str:
        return f"display units: {', '.join(f'{quantity} in {unit}' for quantity, unit in chosen().items()) or 'SI'}"


def displayed(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Give a function an argument `display`, units that hold while it works; None: those of the session."""
    @functools.wraps(function)
    def with_units(*arguments: Arguments.args, **keywords: Arguments.kwargs) -> Result:
        display: Any = keywords.get("display")
        if display is None:
            return function(*arguments, **keywords)
        with display_units(_checked(display)):
            return function(*arguments, **keywords)

    return with_units


def chosen() -> Mapping[str, str]:
    """Units of display by quantity."""
    return _chosen.get()


def shown(unit: str) -> Shown:
    """Unit and factor for values in an SI unit; a unit of no quantity is kept."""
    quantity = OF_UNIT.get(unit, "")
    wanted = chosen().get(quantity, unit)
    return Shown(wanted, 1 / UNITS[quantity][wanted] if wanted != unit else 1.0)


def shown_label(label: str) -> Shown:
    """Label, such as "mass [kg]", with the unit of display, and the factor of its values."""
    found = re.fullmatch(r"(.*\[)([^\[\]]+)\]", label)
    of = shown(found[2] if found else "")
    return Shown(f"{found[1]}{of.unit}]" if found else label, of.factor)


def _checked(given: Any) -> Mapping[str, str]:
    if not isinstance(given, Mapping):
        raise WrongType(f"display must be a dict of units by quantity, such as {{'force': 'kN'}}, not {checks.shown(given)}")
    for quantity, unit in given.items():
        if quantity not in QUANTITIES:
            raise WrongValue(f"display must name a quantity, not {quantity!r}; there are {', '.join(QUANTITIES)}",
                             "unknown-choice")
        if unit not in UNITS[quantity]:
            raise WrongValue(f"display unit of {quantity} must be one of {', '.join(UNITS[quantity])}, not {checks.shown(unit)}",
                             "unknown-choice")
    return MappingProxyType(dict(given))
