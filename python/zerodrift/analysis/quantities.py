"""Named quantities of a system at a state: measures, coordinates and velocities, their rows and the efforts conjugate to them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from ..errors import WrongType, WrongValue
from ..systems.base import BaseSystem
from . import differences
from .state import State, scales, small_core, state

AXES = "xyz"
# Coordinates or speeds of a joint or motor that its efforts act along, and their units
EFFORTS = {"torque": ("angle", "speed"), "force": ("displacement", "length", "speed")}
UNITS = {"torque": ("rad", "rad/s"), "force": ("m", "m/s")}


class Found(NamedTuple):
    """A quantity at a state: a measure, a coordinate or a velocity.

    Attributes
    ----------
    value : ndarray (size,)
    rate : ndarray (size,)
        Rate of change of a quantity of positions.
    row : ndarray (size, nv)
        Derivative with respect to v: of the rate; of the value, if that is a velocity.
    bias : ndarray (size,)
        ``row @ vdot + bias`` is the second rate; the first, if the value is a velocity.
    is_velocity : bool
    """

    value: np.ndarray
    rate: np.ndarray
    row: np.ndarray
    bias: np.ndarray
    is_velocity: bool


PARTS = Found._fields[:-1]


def name_of(given: Any, what: str) -> str:
    """The name of a measure or variable that is given as such or by name."""
    name = getattr(given, "name", given)
    if not isinstance(name, str):
        raise WrongType(f"{what} must be a measure, such as crank.angle, or its name, not {checks.shown(given)}")
    return name


def names_of(given: Any, what: str) -> list[str]:
    """Names of one or several measures or variables, given as such or by name."""
    single = isinstance(given, str) or hasattr(given, "name")
    if not single and not isinstance(given, Iterable):
        raise WrongType(f"{what} must be measures or their names, not {checks.shown(given)}")
    return [name_of(each, f"an entry of {what}") for each in ((given,) if single else given)]


def values_of(given: Any, what: str) -> dict[str, Any]:
    """A dictionary of values by measure, by names."""
    if not isinstance(given, Mapping):
        raise WrongType(f"{what} must be a dict of values by measure, not {checks.shown(given)}")
    return {name_of(key, f"a key of {what}"): value for key, value in given.items()}


def _place(system: BaseSystem, name: str, what: str) -> Any:
    """Index of a measure or a component; None: no measure has that name."""
    place = system._watching.find(name)
    if place is not None and system._watching.core.measure_depends(place.number) == "accelerations":
        raise WrongValue(f"{what} must be a quantity of positions or velocities, and {name!r} depends on accelerations or "
                         "reactions", "wrong-measure")
    return place


def find(at: State, name: str, what: str) -> Found:
    """A measure of positions or velocities, a coordinate or a velocity, at a state.

    Raises
    ------
    ValueError
        If nothing has that name, or it depends on accelerations or reactions.
    """
    found = rates_of(at.system, (name,), what, np.array([at.t]), at.p[None], at.v[None])
    value, rate, row, bias = (found[part][0] for part in PARTS)
    return Found(value, rate, row, bias, is_velocity(at.system, name))


def is_velocity(system: BaseSystem, name: str) -> bool:
    """True if a quantity depends on velocities."""
    place = system._watching.find(name)
    return name in _names(system.velocities) if place is None else (
        system._watching.core.measure_depends(place.number) == "velocities")


def rows_of(at: State, names: Iterable[str]) -> np.ndarray:
    """Rows (k, nv) of quantities that are held, stacked."""
    return np.vstack([np.zeros((0, at.system.nv)), *(find(at, name, "hold").row for name in names)])


def rates_of(system: BaseSystem, names: tuple[str, ...], what: str, t: np.ndarray, p: np.ndarray,
             v: np.ndarray | None = None, parts: Sequence[str] = PARTS) -> dict[str, np.ndarray]:
    """Values, rates, biases (k, size) and rows (k, size, nv) of quantities, stacked, at states t (k,), p (k, nq), v (k, nv).

    `v` left out: at rest. `parts`: those of them that are wanted.
    """
    watching, v = system._watching, np.zeros((len(t), system.nv)) if v is None else v
    places = [_place(system, name, what) for name in names]
    if any(place is None for place in places):
        each = [_of_variable(system, name, what, t, p, v, parts) if place is None else
                rates_of(system, (name,), what, t, p, v, parts) for name, place in zip(names, places, strict=True)]
        return {part: np.concatenate([one[part] for one in each], axis=1) for part in parts}
    core, numbers = watching.core, [place.number for place in places]
    rates = core.measure_rates(numbers, t, np.ascontiguousarray(p), np.ascontiguousarray(v), parts)
    if all(place.component is None for place in places):
        return rates
    ends = np.cumsum([core.measure_size(place.number) for place in places])
    columns = np.concatenate([np.arange(first, end) if place.component is None else [first + place.component]
                              for place, first, end in zip(places, [0, *ends[:-1]], ends, strict=True)])
    return {part: each[:, columns] for part, each in rates.items()}


def _names(variables: Iterable[Any]) -> list[str]:
    return [each.name for each in variables]


def _of_variable(system: BaseSystem, name: str, what: str, t: np.ndarray, p: np.ndarray, v: np.ndarray,
                 parts: Iterable[str]) -> dict[str, np.ndarray]:
    """The same of a coordinate or a velocity."""
    coordinates, velocities, core = _names(system.coordinates), _names(system.velocities), small_core(system)
    if name not in coordinates and name not in velocities:
        raise WrongValue(f"{what} names {name!r}, and nothing in {system.name} is called that; "
                         f"{checks.closest(name, system._names_of_quantities())}", "wrong-name")
    k, bias, identity = len(t), np.zeros((len(t), 1)), np.eye(core.nq, core.nv)
    if name not in coordinates:
        j = velocities.index(name)
        return {"value": v[:, [j]], "rate": bias, "bias": bias, "row": np.broadcast_to(np.eye(core.nv)[[j]], (k, 1, core.nv))}
    A = core.evaluate_states(("A",), t, p, v).get("A", np.broadcast_to(identity, (k, *identity.shape)))
    i, pdot = coordinates.index(name), np.einsum("kij,kj->ki", A, v)
    for n in range(k if "bias" in parts else 0):
        if v[n].any() and not np.array_equal(A[n], identity):
            size = float(np.abs(pdot[n] / scales(system, p[n]).p).max(initial=0.0))
            def row(h: float, at_t: float = float(t[n]), n: int = n) -> np.ndarray:
                return state(system, at_t, p[n] + h * pdot[n], v[n]).A[[i]] @ v[n]

            bias[n] = differences.along(row, size)
    return {"value": p[:, [i]], "rate": pdot[:, [i]], "bias": bias, "row": A[:, [i]]}


def conjugate(system: BaseSystem, name: str) -> str:
    """The quantity along whose rate an effort acts.

    The name is that of a measure or variable, whose rate the effort multiplies to a power, or ``joint.torque``, ``joint.force``,
    ``motor.torque``: the effort along the coordinate of that joint, or of the joint that the motor drives.
    """
    owner, _, quantity = name.rpartition(".")
    for rate in EFFORTS.get(quantity, ()):
        for base in (owner, _driven(system, owner)):
            along = f"{base}.{rate}"
            if system._watching.find(along) is not None and system._watching.unit(along) in UNITS[quantity]:
                return along
    return name


def _driven(system: BaseSystem, motor: str) -> str:
    """The name of the joint that a motor of a mechanism drives; of anything else, its own."""
    element = getattr(getattr(system, "_drawing", None), "elements", {}).get(motor)
    return getattr(getattr(element, "joint", None), "name", motor)


def components(name: str, size: int) -> list[str]:
    """Names of the components of a quantity."""
    if size == 1:
        return [name]
    return [f"{name}.{AXES[i]}" if size <= 3 else f"{name}[{i}]" for i in range(size)]
