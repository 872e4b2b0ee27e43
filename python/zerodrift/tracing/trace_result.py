"""Results of `trace` and `reach`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from ..analysis.effort_result import Efforts
from ..analysis.inverse_dynamics import inverse_dynamics
from ..errors import WrongName
from ..mechanisms.elements.measures import name_of
from ..mechanisms.system import MechanismSystem


class DeadPoint(NamedTuple):
    """Dead point: an extremum of the measure along the motion of the mechanism.

    Attributes
    ----------
    value : float
        The measure there, in rad or m.
    p : ndarray (nq,)
        The position, in the system's coordinates.
    before : int or None
        Index of the traced position that follows the dead point or equals it.
    """

    value: float
    p: np.ndarray
    before: int | None


@dataclass(frozen=True, eq=False, repr=False)
class Trace:
    """Positions of a mechanism by the values of one of its measures; ``trace["P.position"]`` reads any measure of them.

    Attributes
    ----------
    system : system
        System of the mechanism, with its coordinates.
    measure, unit : str
        Name of the traced measure, and "rad" or "m".
    values : ndarray (k,)
        Values of that measure.
    p : ndarray (k, nq)
        The positions, in the coordinates of `system`.
    slopes : ndarray (k, nq)
        Their derivatives with respect to the measure; infinite at dead points.
    dead_points : tuple of DeadPoint
        Passed dead points, in order.
    efforts : Efforts or None
        Forces of the mechanism at rest in each position, if they were requested.
    """

    system: MechanismSystem
    measure: str
    unit: str
    values: np.ndarray
    p: np.ndarray
    slopes: np.ndarray
    dead_points: tuple[DeadPoint, ...]
    efforts: Efforts | None = None

    def __post_init__(self) -> None:
        for array in (self.values, self.p, self.slopes, *(dead.p for dead in self.dead_points)):
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, name: Any) -> np.ndarray:
        """A measure of positions at every position; of a trace with forces also one of these, or "effort".

        Parameters
        ----------
        name : str or measure

        Returns
        -------
        ndarray (k,), or (k, 2) of a vector

        Raises
        ------
        KeyError
            If there is no measure of that name, or it depends on velocities or forces.

        Examples
        --------
        >>> import zerodrift as zd
        >>> turn = zd.trace(zd.models.chebyshev_lambda(), "crank.angle")
        >>> turn["rocker.angle"].shape, turn["P.position"].shape
        ((361,), (361, 2))
        """
        if self.efforts is not None and (held := self._force(name_of(name, "name"))) is not None:
            return held
        place, core = self._find(name), self.system._measuring
        zeros = np.zeros((len(self), core.nv))
        return place.pick(core.measure(place.number, np.zeros(len(self)), self.p, zeros))

    def derivative(self, name: Any) -> np.ndarray:
        """Derivative of a measure with respect to the traced one: ratio of their speeds, inverse ratio of their forces.

        Parameters
        ----------
        name : str or measure

        Returns
        -------
        ndarray (k,), or (k, 2) of a vector
            Infinite at dead points, where the traced measure is at rest and others are not.

        Raises
        ------
        KeyError
            As for ``trace[name]``.

        Examples
        --------
        >>> import zerodrift as zd
        >>> turn = zd.trace(zd.models.chebyshev_lambda(), "crank.angle")
        >>> bool(abs(turn.derivative("rocker.angle")[:-1].mean()) < 1e-12)     # it swings, and comes back
        True
        """
        place, core = self._find(name), self.system._measuring
        rest = np.zeros(core.nv)
        with np.errstate(invalid="ignore"):
            values = np.array([core.measure_at(place.number, 0.0, p, rest)["row"] @ slope
                               for p, slope in zip(self.p, self.slopes, strict=True)])
        return place.pick(values)

    def unit_of(self, name: Any) -> str:
        """The unit of a measure that the trace has."""
        if self.efforts is not None and name_of(name, "name") == "effort":
            return {"rad": "N m", "m": "N"}[self.unit]
        if self.efforts is not None:
            return self.system._unit_of_measure(name_of(name, "name"))
        return self.system._measuring.measures[self._find(name).number].unit

    def with_forces(self, along: list[str]) -> Trace:
        """The same with the forces of the mechanism at rest, held along these measures."""
        system, rest = self.system._without_drives(), np.zeros((len(self), self.system.nv))
        return replace(self, efforts=inverse_dynamics(system, np.zeros(len(self)), self.p, rest, rest, efforts=along))

    def _force(self, name: str) -> np.ndarray | None:
        """A force by its name; None: it is a measure of positions, or nothing."""
        assert self.efforts is not None
        if name == "effort":
            return next(iter(self.efforts.efforts.values()))
        place = self.system._watching.find(name)
        depends = place and self.system._measuring.measure_depends(place.number)
        return self.efforts[name] if depends == "accelerations" else None

    def _find(self, name: Any) -> Any:
        """Index and component of a measure of positions."""
        name, watching = name_of(name, "name"), self.system._watching
        place = watching.find(name)
        if place is None:
            raise WrongName(f"nothing in {self.system.name} is called {name!r}; {checks.closest(name, watching.known)}",
                            "wrong-name")
        depends = self.system._measuring.measure_depends(place.number)
        if depends != "positions":
            hint = ("; derivative() of a position has its ratio to that of the traced measure" if depends == "velocities" else
                    "; forces=True adds those at rest")
            raise WrongName(f"{name!r} depends on {depends}, and a trace has positions alone{hint}", "not-available")
        return place

    def _ipython_key_completions_(self) -> list[str]:
        core = self.system._measuring
        return [name for name, (number, _) in self.system._watching.known.items() if core.measure_depends(number) == "positions"]

    def __repr__(self) -> str:
        dead = ", ".join(f"{point.value:.6g}" for point in self.dead_points)
        through = f", through dead points at {dead} {self.unit}" if dead else ""
        return (f"<trace of {self.system.name}: {len(self)} positions, {self.measure} from {self.values[0]:.6g} to "
                f"{self.values[-1]:.6g} {self.unit}{through}>")


@dataclass(frozen=True, eq=False, repr=False)
class Reach:
    """Range of a measure.

    Attributes
    ----------
    measure, unit : str
    low, high : float
        Minimum and maximum on the assembly branch; infinite if the measure makes full turns.
    dead_points : tuple of DeadPoint
        In the order in which they occur when the measure increases from the start; empty if it makes full turns.
    """

    measure: str
    unit: str
    low: float
    high: float
    dead_points: tuple[DeadPoint, ...]

    @property
    def turns_fully(self) -> bool:
        """True if the measure makes full turns, as the crank of a Grashof four-bar."""
        return not np.isfinite(self.high)

    def __contains__(self, value: float) -> bool:
        return bool(self.low <= value <= self.high)

    def __repr__(self) -> str:
        what = "turns fully" if self.turns_fully else f"{self.low:.4g} ... {self.high:.4g} {self.unit}, between dead points"
        return f"<reach of {self.measure}: {what}>"
