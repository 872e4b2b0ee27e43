"""One state (t, p, v): any quantity by its name, reactions included; and the start of a run from it."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..._private import checks
from ..._private.types import ArrayLike, MeasureLike, SystemLike
from ...errors import WrongType, WrongValue
from ...systems.base import BaseSystem, Makes, core_of, system_of
from .operations import acceleration, project


def _sample(values: Any) -> np.ndarray:
    return np.ascontiguousarray(values)[None]


class Reading:
    """Any quantity by its name at a state whose accelerations vdot (nv,) and multipliers (m,) are known."""

    system: BaseSystem
    t: float
    p: np.ndarray
    v: np.ndarray
    vdot: Any
    multipliers: Any
    _acting: Any = None     # efforts besides the forces of the system, see `CoreSystem.measure`
    _least: np.ndarray | None = None        # (1, m) multipliers of the least reactions

    def __getitem__(self, given: MeasureLike) -> Any:
        name, of = getattr(given, "name", given), self.system
        if (place := of._watching.view(name)) is not None:
            states = self._state_for(place.number)
            value = place.pick(of._watching.core.measure(place.number, *states, is_least=True, acting=self._acting))[0]
            return float(value) if np.ndim(value) == 0 else value
        group, column = of._column(name)
        return float(getattr(self, ("p", "v", "multipliers")[group])[column])

    def _state_for(self, number: int) -> tuple[np.ndarray, ...]:
        """Arguments of a measure, (1, ...) each: accelerations and least multipliers for one that depends on them."""
        core, states = self.system._watching.core, (np.array([float(self.t)]), _sample(self.p), _sample(self.v))
        if core.measure_depends(number) != "accelerations":
            return states
        vdot = _sample(self.vdot)
        if self._least is None:
            given = _sample(self.multipliers)
            self._least = given if not self.system.m or self.system._groups else core.measure(
                number, *states, vdot, given, wanted="least", acting=self._acting)
        return *states, vdot, self._least


class KnownInstant(Reading):
    """A state whose accelerations and multipliers are given; acting: as of `CoreSystem.measure`."""

    def __init__(self, system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray, vdot: np.ndarray,
                 multipliers: np.ndarray, acting: Any = None) -> None:
        self.system, self.t, self.p, self.v, self.vdot, self.multipliers = system, t, p, v, vdot, multipliers
        self._acting = acting


class Instant(Reading):
    """A state (t, p, v) of a system, from which any quantity is read by its name: ``zd.Instant(m, t, p, v)["pin.force"]``.

    Accelerations and multipliers are those of the equations of motion, computed when they are first needed. `simulate` and
    `linearize` start from it.

    Parameters
    ----------
    system : system or Mechanism
    t : float
        Time in s.
    p, v : array_like (nq,), (nv,), optional
        Coordinates and velocities; left out: the start.

    Attributes
    ----------
    system : system
    t : float
    p, v : ndarray (nq,), (nv,)

    Raises
    ------
    KeyError
        If nothing has the name by which it is read.
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    >>> link = m.link("link", (0, 0), (1, 0), mass=2.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> now = zd.Instant(m.system("joint"), 0.0, [0.0], [3.0])
    >>> round(now["link.end.velocity.y"], 9), round(now["pin.force.x"], 9)       # m v, and m v^2 / 2
    (3.0, -9.0)
    """

    def __init__(self, system: SystemLike, t: float = 0.0, p: ArrayLike | None = None, v: ArrayLike | None = None) -> None:
        self.system, self.t = system_of(system), checks.number("t", t)
        core_of(self.system)
        p, v = self.system._state_or_start(p, v, "p", "v", self.t)
        self.p, self.v = np.array(p), np.array(v)
        self._inputs: Sequence[str] = ()        # inputs of the run that made this state
        core_of(self.system).check_domain(self.t, self.p, self.v)

    @functools.cached_property
    def _moving(self) -> tuple[np.ndarray, np.ndarray]:
        if self._inputs:
            raise WrongValue(f"accelerations and multipliers must be read at a sample, by sol[name], or be recorded by outputs=: "
                             f"they depend on {', '.join(self._inputs)}, which may change between samples", "not-available")
        return acceleration(self.system, self.p, self.v, self.t, "augmented")

    @property
    def vdot(self) -> np.ndarray:
        """Accelerations (nv,)."""
        return self._moving[0]

    @property
    def multipliers(self) -> np.ndarray:
        """Multipliers (m,) of the constraints, with the sign of (2)."""
        return self._moving[1]

    def __repr__(self) -> str:
        named = [f"{variable.name} = {value:.6g}" for variables, values in ((self.system.coordinates, self.p),
                                                                            (self.system.velocities, self.v))
                 for variable, value in zip(variables, values, strict=True)]
        shown = ", ".join(named[:8]) + (f" and {len(named) - 8} more" if len(named) > 8 else "")
        return f"<{self.system.name} at t = {self.t:g} s: {shown}>"


def start_of(system: Any, p0: Any, v0: Any, t0: float) -> tuple[Any, Any, Any]:
    """System and initial state (p0, v0) from the arguments of a run.

    An equilibrium or a `zerodrift.Instant` gives its position and velocities; these are projected onto drives that move at t0.

    Raises
    ------
    TypeError
        If v0 is given with an equilibrium or an instant as p0.
    ValueError
        If p0 is an equilibrium or an instant of a system with other coordinates.
    """
    if not isinstance(p0, Reading):
        return system_of(system, p0, v0), p0, v0
    if v0 is not None:
        raise WrongType("v0 must be left out where p0 is an equilibrium or an instant, which has its velocities",
                        "conflicting-arguments")
    system = system.system(getattr(p0.system, "layout", None)) if isinstance(system, Makes) else system
    if [each.name for each in system.coordinates] != [each.name for each in p0.system.coordinates]:
        raise WrongValue(f"p0 must be an equilibrium or an instant of {system.name} in its coordinates, not of {p0.system.name} "
                         "in others", "wrong-element")
    terms = p0.system.evaluate(p0.p, p0.v, t0)
    if terms.Phi_t is None or not np.any(terms.Phi_t):
        return system, p0.p, p0.v
    return system, *project(system, p0.p, p0.v, t0)
