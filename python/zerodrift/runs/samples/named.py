"""Columns and statistics of a solution by name."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._private import gateway
from ..._private.types import Body, MeasureLike
from ...errors import WrongName
from ...systems.base import BaseSystem
from ...systems.measure_values import AXES, view


class Stats(dict):
    """Dictionary of statistics whose error for a missing key lists the keys."""

    def __missing__(self, name: str) -> Any:
        raise WrongName(f"nothing in stats is called {name!r}; there are {', '.join(self)}", "wrong-name")


class Named:
    """Columns of a solution by name: coordinates, velocities, multipliers and measures."""

    if TYPE_CHECKING:       # fields of a solution
        system: BaseSystem
        p: np.ndarray
        v: np.ndarray
        multipliers: np.ndarray
        outputs: dict[str, np.ndarray]

    def __getitem__(self, name: MeasureLike | tuple[MeasureLike, Any]) -> np.ndarray:
        """Values of a coordinate, velocity, measure, or multiplier of a constraint at all samples, by name.

        Parameters
        ----------
        name : str or measure, or (that, body)
            A measure of a mechanism, such as ``crank.angle`` or ``"C.force"``; or a name in ``system.coordinates``,
            ``system.velocities`` or ``system.constraints``. ``sol["C.force", "crank"]`` gives a vector in the axes of that
            body.

        Returns
        -------
        ndarray (k,), or (k, 2) of a measure that is a vector
            In the unit of the coordinate, velocity or measure; for a constraint, its column of `multipliers`.

        Raises
        ------
        KeyError
            If the name is unknown or ambiguous.

        Examples
        --------
        >>> import zerodrift as zd
        >>> sol = zd.simulate(zd.systems.pendulum(), 1.0, step=0.01)
        >>> bool((sol["y"] == sol.p[:, 1]).all() and (sol["rod"] == sol.multipliers[:, 0]).all())
        True
        """
        if isinstance(name, tuple) and len(name) == 2:
            return self._in_axes_of(*name)
        name = getattr(name, "name", name)
        measured = self._recorded(name)
        if measured is None:
            measured = self.system._watching.values(name, self)
        if measured is not None:
            return measured
        group, column = self.system._column(name)
        return (self.p, self.v, self.multipliers)[group][:, column]

    def _in_axes_of(self, name: Any, body: Any) -> np.ndarray:
        """Values of a vector measure in the axes of a body."""
        name, body = (getattr(each, "name", each) for each in (name, body))
        base, _, axis = name.rpartition(".") if isinstance(name, str) else ("", "", "")
        if axis in AXES:
            return self._in_axes_of(base, body)[:, AXES.index(axis)]
        values = self[name]
        if values.ndim == 1 or body == "ground":
            return values
        return np.einsum("kij,kj->ki", self._axes_of(body, values.shape[1]), values)

    def _axes_of(self, body: str, size: int) -> np.ndarray:
        """Unit vectors along the axes of a body at each sample, as rows of (k, size, size)."""
        if size == 3:
            return self[f"{body}.rotation"].transpose(0, 2, 1)
        angle = self[f"{body}.angle"]
        return np.moveaxis(np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]), 2, 0)

    def _recorded(self, name: Any) -> np.ndarray | None:
        """A recorded measure or a component of one; None if it was not recorded."""
        place = view(name, {each: (i, math.prod(values.shape[1:])) for i, (each, values) in enumerate(self.outputs.items())})
        if place is None:
            return None
        values = list(self.outputs.values())[place.number]
        return place.pick(values.reshape(len(values), math.prod(values.shape[1:])))

    def unique(self, name: MeasureLike, body: str | Body | None = None) -> Any:
        """Return whether a measure of a mechanism is determined uniquely, although constraints are redundant.

        With redundant constraints, the motion of rigid bodies does not determine all reactions. The least ones are reported then:
        those with the smallest sum, over all joints and other constraint elements, of force^2 + (moment / L)^2, with L the
        largest distance between ends of joints in the drawing. With more than 200 constraints, they depend on the coordinates.
        A component is unique if redundant multipliers change it by at most 1e-9 of the change of all these forces together.

        Parameters
        ----------
        name : str or measure
            Such as ``"A.force"``.
        body : str or body, optional
            Components are along the axes of this body at each sample. Default: along those of the drawing.

        Returns
        -------
        bool, or ndarray of bool
            For each component, True if it is unique at all samples.

        Raises
        ------
        KeyError
            If there is no measure or body of that name.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, link.start)
        >>> zd.simulate(m, 0.1, step=0.01).unique(pin.force)
        array([ True,  True])
        """
        name, body = (getattr(each, "name", each) for each in (name, body))
        return self.system._watching.unique(name, self, body)

    def _named(self) -> tuple[tuple[np.ndarray, tuple[gateway.Variable, ...]], ...]:
        """Arrays with named columns, each with the variables of its columns."""
        system = self.system
        return (self.p, system.coordinates), (self.v, system.velocities), (self.multipliers, system.constraints)

    def _ipython_key_completions_(self) -> list[str]:
        return self.system._names_of_quantities()

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of all measures that `sol[name]` reads, such as "pin.force"; none of a system that is not a mechanism."""
        return tuple(self.system._names_of_measures())
