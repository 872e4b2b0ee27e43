"""`equilibria`: the equilibria of a system over one of its parameters, through limit points."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, SystemLike, Values
from ..errors import EquilibriumFailed, WrongValue
from ..runs.states.instant import KnownInstant
from ..systems.base import BaseSystem, core_of, unswitched
from .equilibrium import equilibrium
from .path import FIRST_STEP, LARGEST_STEP, Curve, Knot

MAX_STEPS = 5000


class LimitPoint(NamedTuple):
    """A point at which the parameter turns back: its value, and the position (nq,)."""

    value: float
    p: np.ndarray


class EquilibriumPath:
    """Equilibria along a path; ``path["apex.position.y"]`` is a measure at all of them.

    Attributes
    ----------
    system : system
    parameter : str
    values : ndarray (k,)
        The parameter at each of them, in the order of the path; a value comes again where the path passes it again.
    p : ndarray (k, nq)
    stable : ndarray (k,), bool
        No direction has a negative stiffness.
    limit_points : tuple of LimitPoint
        Points of the path at which the parameter turns back and the stability changes.
    """

    def __init__(self, system: BaseSystem, parameter: str, found: list[Knot], limits: list[Knot]) -> None:
        self.system, self.parameter, self._found = system, parameter, found
        self.values = np.array([each.value for each in found])
        self.p = np.array([each.balance.at.p for each in found])
        self.stable = np.array([each.balance.is_stable for each in found])
        self.limit_points = tuple(LimitPoint(each.value, each.balance.at.p) for each in limits)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, name: Any) -> np.ndarray:
        return np.array([_reading(each)[name] for each in self._found])

    def __repr__(self) -> str:
        limits = ", ".join(f"{each.value:.9g}" for each in self.limit_points)
        return (f"<{len(self)} equilibria of {self.system.name}, {int(self.stable.sum())} stable, over {self.parameter} = "
                f"{self.values[0]:g} ... {self.values[-1]:g}{f'; limit points at {limits}' if limits else ''}>")


def _reading(knot: Knot) -> KnownInstant:
    at = knot.balance.at
    return KnownInstant(at.system, at.t, at.p, at.v, np.zeros_like(at.v), knot.balance.multipliers[:at.system.m])


def equilibria(system: SystemLike, parameter: str, values: ArrayLike, *, near: ArrayLike | Values | None = None,
               t: float = 0.0) -> EquilibriumPath:
    """The equilibria of a system while one of its parameters changes slowly.

    The path is followed along its arc length from the stable equilibrium at the first value until the parameter reaches the
    last one, or leaves their range. It goes through limit points, at which the parameter turns back and a real system snaps.

    Parameters
    ----------
    system : system or Mechanism
    parameter : str
        One of its parameters, such as a load.
    values : array_like (j,)
        Values at which equilibria are wanted, increasing or decreasing.
    near : array_like (nq,), or dict of measure to value, optional
        Starting point of the search for the first equilibrium, as in `equilibrium`.
    t : float
        Time in s at which drives stand.

    Returns
    -------
    EquilibriumPath

    Raises
    ------
    EquilibriumFailed
        If there is no first equilibrium, or the path cannot be followed, as where branches meet.
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> path = zd.equilibria(zd.models.slider_crank(), "spring.stiffness", np.linspace(1.0, 2.0, 3))
    >>> path.values
    array([1. , 1.5, 2. ])
    """
    system = unswitched(system, "equilibria")
    core_of(system)
    checks.choice("parameter", parameter, system.parameters)
    values = _values(values)
    first = system.with_parameters({parameter: float(values[0])})
    p = equilibrium(first, near=near, t=t).p
    curve = Curve(system, parameter, t, float(np.ptp(values)))
    return EquilibriumPath(system, parameter, *_followed(curve, p, values))


def _values(given: Any) -> np.ndarray:
    values = checks.real("values must hold", given).astype(float)
    if values.ndim != 1 or len(values) < 2 or not np.isfinite(values).all():
        raise WrongValue(f"values must be at least two finite numbers, not {checks.shown(given)}", "shape")
    if not ((np.diff(values) > 0).all() or (np.diff(values) < 0).all()):
        raise WrongValue("values must increase or decrease", "not-increasing")
    return values


def _followed(curve: Curve, p: np.ndarray, values: np.ndarray) -> tuple[list[Knot], list[Knot]]:
    """Equilibria at the values, each time the path passes them, and limit points."""
    start = curve.balance(p, values[0])
    if not start.V.shape[1]:
        raise EquilibriumFailed(f"{curve.system.name} must have a free direction, and its constraints leave none")
    sense = 1.0 if values[-1] > values[0] else -1.0
    knot = curve.knot(start, float(values[0]), np.zeros(len(start.V)), sense)
    found, limits, length = [knot], [], FIRST_STEP
    for _ in range(MAX_STEPS):
        there, length = curve.advance(knot, length)
        pieces = [(knot, there)]
        if knot.slope * there.slope < 0:
            limits.append(turn := curve.limit_point(knot, there, length))
            pieces = [(knot, turn), (turn, there)]
        for one, other in pieces:
            found += [curve.between(one, other, value) for value in _passed(values, one.value, other.value)]
        if not min(values) <= there.value <= max(values):
            return found, limits
        knot, length = there, min(LARGEST_STEP, 1.5 * length)
    raise EquilibriumFailed(f"the path of equilibria of {curve.system.name} must reach {curve.parameter} = {values[-1]:g}, and "
                            f"is at {knot.value:.6g} after {MAX_STEPS} steps")


def _passed(values: np.ndarray, first: float, last: float) -> list[float]:
    """Values behind the first and up to the last, in the order in which they are passed."""
    low, high = min(first, last), max(first, last)
    inside = np.sort(values[(values >= low) & (values <= high) & (values != first)])
    return [float(each) for each in (inside if last > first else inside[::-1])]
