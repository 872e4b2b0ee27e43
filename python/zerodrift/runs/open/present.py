"""The present state of an open run, read by name, and its inputs, set by name."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import checks, gateway
from ..._private.types import ArrayLike, MeasureLike
from ...errors import WrongValue
from ..arguments.inputs import refuse_unknown
from ..samples.summary import run_summary
from ..states.reading import Reading
from .beginning import Prepared
from .ending import with_reason


class Present:
    """Values of an open run at its present time."""

    def _prepare(self, ready: Prepared) -> None:
        self._ready, self.system, self.settings = ready, ready.system, ready.settings
        self.inputs = ready.inputs.values if ready.inputs else np.empty(0)
        self._places: dict[Any, Any] = ready.declared.places() if ready.declared else {}

    def _open(self, core: gateway.OpenRun) -> None:
        """Read the core's run, from now on."""
        self._core, self._c = core, core.c
        self._reading = Reading(self._ready.of, core, self._ready)

    @property
    def t(self) -> float:
        """Present time, in s."""
        return self._core.t

    @property
    def p(self) -> np.ndarray:
        """Coordinates (nq,) at the present time, in their units; a copy."""
        return self._core.p

    @property
    def v(self) -> np.ndarray:
        """Velocities (nv,) at the present time, in their units; a copy."""
        return self._core.v

    @property
    def steps(self) -> int:
        """Number of steps made."""
        return self._core.steps

    @property
    def event(self) -> int | None:
        """Index of the terminal event at which the last advance stopped; None: it reached its goal."""
        ended = self._core.ended_by
        return None if ended < 0 else ended

    @property
    def vdot(self) -> np.ndarray:
        """Accelerations (nv,) at the present state, with which the next step begins."""
        return self._core.accelerations()[0]

    @property
    def multipliers(self) -> np.ndarray:
        """Constraint reactions (m,) at the present state, with the sign of (7)."""
        return self._core.accelerations()[1]

    def __getitem__(self, name: MeasureLike) -> Any:
        """Value of an input, coordinate, velocity, measure, or multiplier of a constraint at the present state, by name.

        Parameters
        ----------
        name : str or measure
            As of `Solution`.

        Returns
        -------
        float, or ndarray (2,) or (3,) of a vector, (3, 3) of a rotation, or of the shape of an input that is an array

        Raises
        ------
        KeyError
            If nothing has this name, or several variables have.
        """
        place = self._places.get(name)
        if place is None:
            return self._reading(name)
        return float(self.inputs[place]) if type(place) is int else self.inputs[place]

    def __setitem__(self, name: MeasureLike, value: ArrayLike) -> None:
        """Set an input, from the next step on: a number; or an array of its shape, or a number for all of its entries.

        Raises
        ------
        KeyError
            If the run has no input of this name.
        """
        try:
            self.inputs[self._places[name]] = value
        except KeyError:
            self.inputs[self._place_of(name)] = value
        except ValueError:
            raise WrongValue(f"input {name!r} must be set to real numbers of shape {np.shape(self._places[name])}, not "
                             f"{checks.shown(value)}", "shape") from None

    def _place_of(self, name: Any) -> int | np.ndarray:
        """Index of an input, by its name or its measure."""
        name = getattr(name, "name", name)
        if name in self._places:
            return self._places[name]
        refuse_unknown(self.system, name, self._places)

    def _ipython_key_completions_(self) -> list[str]:
        return [*self._places, *self._ready.of._names_of_quantities()]

    def __repr__(self) -> str:
        return run_summary(self, with_reason(self._core.results().as_stats(), self._ready.system, self.settings))
