"""What every system is, wherever its equations are written."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .. import _check, _gateway
from .._gateway import Variable, known_events
from .._gateway.known_events import Reading
from .measure_values import Place, Watching
from .parameter_tables import NumberTables
from .shapes import Shape
from .structure import Structure, of_core
from .terms import Terms

FIRST_PRINTED, LAST_PRINTED = 18, 6     # of many names, parameters and rows


class BaseSystem:
    """A mechanism: its sizes, names, start, and the equations behind them.

    Attributes
    ----------
    name : str
    parameters : dict
        What it depends on, by name; `with_parameters` changes it.
    coordinates, velocities, constraints : tuple of Variable(name, unit)
        What the entries of p, of v and of the multipliers are.
    p0, v0 : ndarray (nq,), (nv,)
        Where `zerodrift.simulate` starts unless told otherwise; None: it has to be told.
    """

    name: str
    parameters: dict[str, Any]
    coordinates: tuple[Variable, ...]
    velocities: tuple[Variable, ...]
    constraints: tuple[Variable, ...]
    p0: np.ndarray | None
    v0: np.ndarray | None
    _core: _gateway.CoreSystem

    nq = property(lambda self: self._core.nq, doc="Number of coordinates, the entries of p.")
    nv = property(lambda self: self._core.nv, doc="Number of velocities, the entries of v.")
    mh = property(lambda self: self._core.mh, doc="Number of holonomic constraints.")
    mn = property(lambda self: self._core.mn, doc="Number of nonholonomic constraints.")
    m = property(lambda self: self._core.m, doc="Number of constraints.")
    quaternions = property(lambda self: self._core.quaternions, doc="Where unit quaternions, of four entries each, begin in p.")
    has_energy = property(lambda self: self._core.has_energy, doc="Whether a potential energy is declared.")

    def evaluate(self, p: Any = None, v: Any = None, t: float = 0.0) -> Terms:
        """The terms of the equations of motion at (t, p, v); p and v left out: the system's own start.

        Matrices are dense, also those of a system that declares its structure.

        Raises
        ------
        ValueError
            If the structure is declared, and a dense matrix would have more than 1000 rows: `product` multiplies by it.

        Examples
        --------
        >>> import zerodrift as zd
        >>> zd.systems.oscillator(mass=2.0).evaluate().M
        array([[2.]])
        """
        p, v = self._state_or_start(p, v, "p", "v")
        return Terms(**self._core.evaluate(_check.number("t", t), p, v))

    def product(self, term: str, x: Any, p: Any = None, v: Any = None, t: float = 0.0, *, transposed: bool = False) -> np.ndarray:
        """The product of "A", "M" or "C" at (t, p, v), or of its transpose, and a vector; of a system of any size.

        Parameters
        ----------
        term : {"A", "M", "C"}
        x : array_like
            (nv,); of a transpose as many as the matrix has rows: (nq,), (nv,) or (m,).
        p, v : array_like (nq,), (nv,), optional
            Left out: the system's own start.
        t : float
            s
        transposed : bool
            Whether to multiply by the transpose.

        Returns
        -------
        ndarray
            (nq,), (nv,) or (m,); of a transpose (nv,).

        Raises
        ------
        ValueError
            If the system has no such term.

        Examples
        --------
        >>> import zerodrift as zd
        >>> zd.systems.oscillator(mass=2.0).product("M", [3.0])
        array([6.])
        """
        _check.choice("term", term, [name for name in _gateway.PACKED if self._core.provides & _gateway.TERMS[name].bit])
        p, v = self._state_or_start(p, v, "p", "v")
        x = _check.vector("x", x, {"A": self.nq, "M": self.nv, "C": self.m}[term] if transposed else self.nv)
        t = _check.number("t", t)
        return self._core.times(term, self._core.evaluate_stored(t, p, v)[term], x, t, p, v, transposed=transposed)

    @property
    def structure(self) -> Structure | None:
        """Of which bodies the system consists, and which constraints join which; None where that is not declared."""
        return of_core(self._core)

    def _sizes_in_words(self) -> str:
        """For the repr."""
        packing = self._core.packing
        blocks = f", {len(packing.blocks)} blocks and {len(packing.groups)} groups of constraints" if packing else ""
        return (f"{self.nq} coordinates, {self.nv} velocities, {self.mh} holonomic and {self.mn} nonholonomic "
                f"constraints{blocks}")

    def _state_or_start(self, p: Any, v: Any, p_name: str = "p0", v_name: str = "v0",
                        t: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """The state given, or the system's own start at t for what is left out."""
        if p is None and self.p0 is None:
            raise ValueError(f"{p_name} is needed: {self.name} has no start of its own")
        p = self.p0 if p is None else _check.vector(p_name, p, self.nq)
        if v is None:       # what is the system's own was checked when it was made
            return p, np.zeros(self.nv) if self.v0 is None else self.v0
        return p, _check.vector(v_name, v, self.nv)

    def with_parameters(self, changes: Mapping[str, Any] | None = None, /, **changed: Any) -> Any:
        """The same system with some parameters changed; nothing is derived or compiled again.

        Parameters
        ----------
        changes : dict of str to value, optional
            New values by name, for names that Python does not take as keywords.
        **changed
            New values by name.

        Raises
        ------
        ValueError
            If the system has no parameter of that name.
        TypeError
            If a parameter is changed twice, or its value is none that it can have.

        Examples
        --------
        >>> import zerodrift as zd
        >>> zd.systems.oscillator().with_parameters(mass=2.0)
        zd.systems.oscillator(mass=2.0)
        >>> zd.systems.oscillator().with_parameters({"mass": 2.0}, stiffness=3.0)
        zd.systems.oscillator(mass=2.0, stiffness=3.0)
        """
        if changes is not None and not isinstance(changes, Mapping):
            raise TypeError(f"changes must be a dict of values by the parameters' names, not {changes!r}")
        for key in changes or ():
            if key in changed:
                raise TypeError(f"parameter {key!r} is changed twice: to {changes[key]!r} and to {changed[key]!r}")
        changed = {**(changes or {}), **changed}
        for key in changed:
            _check.choice("parameter", key, self.parameters)
        return self._with(changed)

    def _with(self, changed: dict[str, Any]) -> Any:
        raise NotImplementedError

    def __str__(self) -> str:
        rows = [("coordinates", _listed(self.coordinates)), ("velocities", _listed(self.velocities)),
                ("holonomic", _listed(self.constraints[:self.mh])), ("nonholonomic", _listed(self.constraints[self.mh:])),
                ("freedom", self._freedom())]
        units = self._parameter_units()
        numbers = _shortened([f"{name} = {_check.shown(value)} {units.get(name, '')}".rstrip()
                              for name, value in self.parameters.items()])
        rows += [("parameters" if not i else "", number) for i, number in enumerate(numbers)]
        return "\n".join([self.name, *(f"  {title:14}{what}" for title, what in rows)])

    def _freedom(self) -> str:
        """Velocities that the constraints leave free, as far as the start tells."""
        least = f"at least {max(0, self.nv - self.m)}"
        if not self.m:
            return str(self.nv)
        try:
            C = self.evaluate().C
            size = np.abs(C).max(axis=1, keepdims=True)
            rank = int(np.linalg.matrix_rank(C / np.where(size > 0, size, 1)))
        except Exception:       # there is no start, or a user's own function fails there
            return least
        return f"{self.nv - rank}" + (f", as {self.m - rank} rows follow from others at the start" if rank < self.m else "")

    def _direct_core(self, vector: str = "baseline", embeds: bool = False) -> _gateway.CoreSystem:
        """With direct functions, of which those for formulations in independent velocities are others: they `embed`."""
        return self._core

    def _number_tables(self, parameters: Mapping[str, np.ndarray], count: int,
                       direct: tuple[str, bool] | None = None) -> NumberTables | None:
        """So many systems with these parameters, (count,) or (count, size) each, and direct functions, if they are wanted and
        there are any, for a vector unit and of those that embed or do not; None where each has to be made, or run, in Python.
        """
        core = getattr(self, "_core", None)
        if parameters or core is None or core.for_run() is not core:
            return None
        return NumberTables(core if direct is None else self._direct_core(*direct), None, 0, self.p0, self.v0, {})

    def _why_not_direct(self, embeds: bool = False) -> str | None:
        """Why it has no direct functions, as far as is known; empty: it has some; None: systems of its kind have none."""
        core = getattr(self, "_core", None)
        return "" if core is not None and core.has_direct else None

    def _parameter_units(self) -> dict[str, str]:
        """The units of the parameters, where they are known."""
        return {}

    def points(self, p: Any) -> np.ndarray | None:
        """The drawing at p: points (n, 2) or (n, 3) in m, joined by lines where not NaN. None: there is no drawing."""
        return None

    def _sketches(self, positions: Sequence[np.ndarray], motion: Sequence[np.ndarray] = ()) -> list[list[Shape]] | None:
        """What there is to draw at each of some positions, which may be of a motion, where more is known than points and
        lines; None: that is all.
        """
        return None

    def _shapes(self, p: np.ndarray) -> list[Shape] | None:
        """The same at one position."""
        found = self._sketches([p])
        return None if found is None else found[0]

    def _forces(self, names: Any, solution: Any, rows: np.ndarray) -> list[tuple[str, np.ndarray, np.ndarray]]:
        """Forces by name, with where they act and what they are at rows of a solution, (k, 2) in m and (k, 2) in N."""
        return []

    @property
    def _measuring(self) -> _gateway.CoreSystem | None:
        """The core's system that has the measures; None where only a description is left."""
        return getattr(self, "_core", None)

    @functools.cached_property
    def _watching(self) -> Watching:
        return Watching(self._measuring)

    @functools.cached_property
    def _columns_of(self) -> dict[str, list[tuple[int, int]]]:
        """By each name all columns that have it: of p, 0, of v, 1, or of the multipliers, 2; and which."""
        found: dict[str, list[tuple[int, int]]] = {}
        for group, variables in enumerate((self.coordinates, self.velocities, self.constraints)):
            for column, variable in enumerate(variables):
                found.setdefault(variable.name, []).append((group, column))
        return found

    def _measured(self, name: Any, solution: Any) -> np.ndarray | None:
        """A measure at every row of a solution; None where nothing is measured by that name."""
        return self._watching.values(getattr(name, "name", name), solution)

    def _reading(self, name: str, what: str) -> Reading:
        """Where the core finds a scalar measure of positions or velocities, or a coordinate or a velocity."""
        place, core = self._watching.find(name), self._measuring
        if place is not None:
            is_scalar = place.component is not None or core.measure_size(place.number) == 1
            if not is_scalar or core.measure_depends(place.number) == "accelerations":
                raise ValueError(f"{what} must be a scalar measure of positions or velocities, and {name!r} is none")
            return Reading(known_events.MEASURE, place.number, place.component or 0)
        coordinates, velocities = ([variable.name for variable in group] for group in (self.coordinates, self.velocities))
        if name in coordinates:
            return Reading(known_events.COORDINATE, coordinates.index(name))
        return Reading(known_events.VELOCITY, velocities.index(_check.choice(what, name, [*coordinates, *velocities])))

    def _read(self, reading: Reading, t: float, p: np.ndarray, v: np.ndarray) -> float:
        """What is found there."""
        match reading.what:
            case known_events.TIME:
                return t
            case known_events.COORDINATE:
                return float(p[reading.index])
            case known_events.VELOCITY:
                return float(v[reading.index])
            case known_events.NUMBER:
                return reading.number
        return float(self._watching.at(Place(reading.index, reading.component), t, p, v))

    def _advice(self, error: Exception) -> str | None:
        """What a system knows of an error at the start that the core has told in its own words; None: nothing."""
        return None

    def _advice_on_failure(self, t: float, p: np.ndarray) -> str | None:
        """The same of a run that failed near a state."""
        return None

    def _why_locked(self) -> str | None:
        """What may be wrong where nothing is free to move; None: it is meant so."""
        return None

    def _why_unknown(self, name: Any) -> str | None:
        """What there is to say of a name that nothing has; None: it is a wrong one."""
        return None

    def _names_of_measures(self) -> list[str]:
        """What is measured by names of its own."""
        return list(self._watching.number)

    def _unit_of_measure(self, name: str) -> str:
        """The unit of a measure, or of a component of it; "" where it has none."""
        place = self._watching.find(name)
        return "" if place is None else self._measuring.measures[place.number].unit

    def _is_scalar_measure(self, name: str) -> bool:
        return name in self._watching.number and self._measuring.measure_size(self._watching.number[name]) == 1

    def _unique(self, name: Any, solution: Any) -> Any:
        """Which components of a measure are the same whatever admissible multipliers there are."""
        if not self._watching.number:
            raise KeyError(f"nothing is measured in {self.name}, which is no mechanism")
        return self._watching.unique(getattr(name, "name", name), solution)

    def _with_series(self, core: _gateway.CoreSystem, vector: str = "baseline") -> _gateway.CoreSystem:
        """That core of the system with the Taylor series of its motion, where there is one."""
        return core

    def _with_jacobian(self, core: _gateway.CoreSystem, vector: str = "baseline") -> _gateway.CoreSystem:
        """That core of the system with the Jacobian of its motion, where there is one."""
        return core

    def _with_series_of_perturbed(self, core: _gateway.PerturbedCore, vector: str) -> _gateway.CoreSystem:
        """That core, of the system off by rounding, with the series of what moves so."""
        return core

    @property
    def _brings_series(self) -> bool:
        """Whether there is one."""
        return False

    def _in_other_coordinates(self) -> BaseSystem | None:
        """The same system in other coordinates, whose solutions have all of its own by name; None where there are none."""
        return None

    @property
    def _has_plain_laws(self) -> bool:
        """Whether its terms are known to be polynomials, sines and cosines, besides elements that are smooth."""
        return False

    def _what_it_costs(self, steps: int | None) -> str | None:
        """What so many steps (None: nobody knows how many) cost, where they could cost far less; None: they could not."""
        return None

    def _described(self) -> dict[str, Any]:
        """What a saved solution says of its system, as JSON."""
        return {"name": self.name, "coordinates": self.coordinates, "velocities": self.velocities,
                "constraints": self.constraints, "has_energy": self.has_energy}


class Makes:
    """What is no system, but makes one: every function that takes a system takes it."""

    name: str

    def system(self) -> BaseSystem:
        """The system that is meant where none was made."""
        raise NotImplementedError


def system_of(given: Any, *state: Any) -> Any:
    """The system that an argument means: a mechanism stands for its own, and takes no state in coordinates."""
    if not isinstance(given, Makes):
        return given
    if any(part is not None for part in state):
        raise TypeError(f"p0 and v0 are for a system, whose coordinates are known, and {given.name!r} is a mechanism: say where "
                        'it starts by its start(), or take its system("joint")')
    return given.system()


def _listed(variables: Sequence[Variable]) -> str:
    return ", ".join(_shortened([f"{name} [{unit}]" if unit else name for name, unit in variables])) or "none"


def _shortened(entries: Sequence[str]) -> list[str]:
    """The entries if they are few; of many the first, the last, and how many are between."""
    left_out = len(entries) - FIRST_PRINTED - LAST_PRINTED
    if left_out <= LAST_PRINTED:
        return list(entries)
    return [*entries[:FIRST_PRINTED], f"({left_out} more)", *entries[-LAST_PRINTED:]]


def core_of(system: Any) -> _gateway.CoreSystem:
    """What the core knows a system by; refuses what is no system, and what is only the description of one."""
    core = getattr(system, "_core", None) if isinstance(system, BaseSystem) else None
    if core is None:
        raise TypeError(f"system must be one of zd.systems or a zd.System, not {_check.shown(system)}")
    core.name_rows(system)
    return core


def direct_core_of(system: Any, vector: str, options: Any) -> _gateway.CoreSystem:
    """The same with the system's direct functions for a vector unit, where it has any that serve a run with this `zd_settings`.

    They are made when they are first wanted.
    """
    core = core_of(system)
    if _gateway.takes_direct(core, options):
        core = system._direct_core(vector, _gateway.takes_embeddings(options))
        core.name_rows(system)
    brought = with_what_it_takes(system, core, vector, options)
    if brought is not core:
        brought.name_rows(system)
    return brought


def with_what_it_takes(system: Any, core: _gateway.CoreSystem, vector: str, options: Any) -> _gateway.CoreSystem:
    """That core of a system with what the integrator of this `zd_settings` takes of it besides its terms."""
    if _gateway.takes_series(options):
        return system._with_series(core, vector)
    return system._with_jacobian(core, vector) if _gateway.takes_jacobian(options) else core
