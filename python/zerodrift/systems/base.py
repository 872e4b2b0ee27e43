"""`BaseSystem`: the interface common to all systems, built-in, in NumPy, compiled or symbolic."""

from __future__ import annotations

import functools
import operator
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks, gateway
from .._private.gateway import Variable, known_events
from .._private.gateway.known_events import Reading
from .._private.rotations import COMPONENTS
from ..errors import WrongName, WrongType, WrongValue
from .defaults import Defaults
from .measure_values import Watching, component_names
from .parameter_tables import NumberTables
from .structure import Structure, of_core

FIRST_PRINTED, LAST_PRINTED = 18, 6     # of many names, parameters and rows


class Terms:
    __doc__ = "\n".join([
        "The terms of the equations of motion at one (t, p, v); those that a system does not have are None.", "",
        "Attributes", "----------",
        *(f"{name} : ndarray {term.sizes}\n    {term.text[0].upper()}{term.text[1:]}." for name, term in gateway.TERMS.items())])

    __slots__ = tuple(gateway.TERMS)

    if TYPE_CHECKING:
        A = M = d = f = Phi = C = Phi_t = xi = V = power = D = gamma = np.empty(0)

    def __init__(self, **arrays: np.ndarray) -> None:
        for name in self.__slots__:
            setattr(self, name, arrays.get(name))

    def __repr__(self) -> str:
        present = (f"{name} {array.shape}" for name in self.__slots__ if (array := getattr(self, name)) is not None)
        return f"Terms({', '.join(present)})"


def _of_core(name: str, doc: str) -> Any:
    return property(operator.attrgetter(f"_core.{name}"), doc=doc)


class BaseSystem(Defaults):
    """Multibody system: sizes, names, start, and equations of motion.

    Attributes
    ----------
    name : str
    parameters : dict
        Parameters by name; `with_parameters` returns a system with other values.
    coordinates, velocities, constraints : tuple of Variable(name, unit)
        Names and units of the entries of p, of v and of the multipliers.
    p0, v0 : ndarray (nq,), (nv,)
        Start of `zerodrift.simulate` if none is given; None: a start must be given.
    """

    _has_own_energy = False     # True if the user writes the potential energy and the power, beside the forces

    nq: int = _of_core("nq", "Number of coordinates, the entries of p.")
    nv: int = _of_core("nv", "Number of velocities, the entries of v.")
    mh: int = _of_core("mh", "Number of holonomic constraints.")
    mn: int = _of_core("mn", "Number of nonholonomic constraints.")
    m: int = _of_core("m", "Number of constraints.")
    quaternions: Sequence[int] = _of_core("quaternions", "Indices in p of the first entries of unit quaternions.")
    has_energy: bool = _of_core("has_energy", "True if a potential energy is declared.")

    def evaluate(self, p: ArrayLike | None = None, v: ArrayLike | None = None, t: float = 0.0) -> Terms:
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
        return Terms(**self._core.evaluate(checks.number("t", t), p, v))

    def product(self, term: Literal["A", "M", "C"], x: ArrayLike, p: ArrayLike | None = None, v: ArrayLike | None = None,
                t: float = 0.0, *, transposed: bool = False) -> np.ndarray:
        """Product of "A", "M" or "C" at (t, p, v), or of its transpose, with a vector; for systems of any size.

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
            True: multiply by the transpose.

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
        checks.choice("term", term, [name for name in gateway.PACKED if self._core.provides & gateway.TERMS[name].bit])
        p, v = self._state_or_start(p, v, "p", "v")
        x = checks.vector("x", x, {"A": self.nq, "M": self.nv, "C": self.m}[term] if transposed else self.nv)
        t = checks.number("t", t)
        return self._core.times(term, self._core.evaluate_stored(t, p, v)[term], x, t, p, v, transposed=transposed)

    @property
    def structure(self) -> Structure | None:
        """Declared block structure of A, M and C; None if there is none."""
        return of_core(self._core)

    def _sizes_in_words(self) -> str:
        """Sizes as text for `repr`."""
        packing = self._core.packing
        blocks = f", {len(packing.blocks)} blocks and {len(packing.groups)} groups of constraints" if packing else ""
        return (f"{self.nq} coordinates, {self.nv} velocities, {self.mh} holonomic and {self.mn} nonholonomic "
                f"constraints{blocks}")

    def _state_or_start(self, p: Any, v: Any, p_name: str = "p0", v_name: str = "v0",
                        t: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """The given state; missing parts are those of the system's start at t."""
        if p is None and self.p0 is None:
            raise WrongValue(f"{p_name} is needed: {self.name} has no start of its own", "missing-argument")
        at: Any = self.p0 if p is None else checks.vector(p_name, p, self.nq)
        if v is None:       # what is the system's own was checked when it was made
            return at, np.zeros(self.nv) if self.v0 is None else self.v0
        return at, checks.vector(v_name, v, self.nv)

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
            If a parameter is changed twice, or its value is out of range.

        Examples
        --------
        >>> import zerodrift as zd
        >>> zd.systems.oscillator().with_parameters(mass=2.0)
        zd.systems.oscillator(mass=2.0)
        >>> zd.systems.oscillator().with_parameters({"mass": 2.0}, stiffness=3.0)
        zd.systems.oscillator(mass=2.0, stiffness=3.0)
        """
        if changes is not None and not isinstance(changes, Mapping):
            raise WrongType(f"changes must be a dict of values by the parameters' names, not {changes!r}")
        more = changes or {}
        for key in more:
            if key in changed:
                raise WrongType(f"parameter {key!r} is changed twice: to {more[key]!r} and to {changed[key]!r}",
                                "duplicate-name")
        changed = {**more, **changed}
        for key in changed:
            checks.choice("parameter", key, self.parameters)
        return self._with(changed)

    def _with(self, changed: dict[str, Any]) -> Any:
        raise NotImplementedError

    def __str__(self) -> str:
        rows = [("coordinates", _listed(self.coordinates)), ("velocities", _listed(self.velocities)),
                ("holonomic", _listed(self._lasting(0, self.mh))), ("nonholonomic", _listed(self._lasting(self.mh, self.m))),
                *([("switching", ", ".join(dict.fromkeys(name for name, _ in self._groups)))] if self._groups else []),
                ("freedom", self._freedom())]
        units = self._parameter_units()
        numbers = _shortened([f"{name} = {checks.shown(value)} {units.get(name, '')}".rstrip()
                              for name, value in self.parameters.items()])
        rows += [("parameters" if not i else "", number) for i, number in enumerate(numbers)]
        return "\n".join([self.name, *(f"  {title:14}{what}" for title, what in rows)])

    def _lasting(self, first: int, last: int) -> list[Variable]:
        """Constraints of a range that do not switch."""
        rows = gateway.switching_rows(self._core) if self._groups else ()
        return [variable for row, variable in enumerate(self.constraints) if first <= row < last and row not in rows]

    def _freedom(self) -> str:
        """Number of degrees of freedom, from the rank of the constraints at the start; without those that switch."""
        m = len(self._lasting(0, self.m))
        least = f"at least {max(0, self.nv - m)}"
        if not m:
            return str(self.nv)
        try:
            C = np.delete(self.evaluate().C, list(gateway.switching_rows(self._core)), axis=0)
            size = np.abs(C).max(axis=1, keepdims=True)
            rank = int(np.linalg.matrix_rank(C / np.where(size > 0, size, 1)))
        except Exception:       # there is no start, or a user's own function fails there
            return least
        return f"{self.nv - rank}" + (f", redundant constraints at the start: {m - rank}" if rank < m else "")

    def _number_tables(self, parameters: Mapping[str, np.ndarray], count: int,
                       closed_form: tuple[str, bool] | None = None) -> NumberTables | None:
        """Tables of `count` systems with these parameters, (count,) or (count, size) each; None if each must be made or run in
        Python. `closed_form`: the vector unit of closed-form functions, and True for those in independent velocities.
        """
        core = getattr(self, "_core", None)
        if parameters or core is None or core.for_run() is not core:
            return None
        return NumberTables(core if closed_form is None else self._closed_form_core(*closed_form), None, 0, self.p0, self.v0, {})

    @property
    def _measuring(self) -> gateway.CoreSystem | None:
        """The core's system that provides the measures; None for systems restored from a description only."""
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
                if group < 2 or self._effort_of(variable.name) is None:
                    found.setdefault(variable.name, []).append((group, column))
        return found

    def _reading(self, name: str, what: str, *, is_dynamic: bool = False) -> Reading:
        """Index of a scalar measure, of reactions and accelerations only if `is_dynamic`, or of a coordinate or velocity."""
        place = self._watching.find(name)
        if place is not None:
            core = self._watching.core
            if core.measure_depends(place.number) == "accelerations" and not is_dynamic:
                raise WrongValue(f"{what} must be a scalar measure of positions or velocities, and {name!r} depends on "
                                 "accelerations", "wrong-measure")
            if place.component is None and (size := core.measure_size(place.number)) != 1:
                raise WrongValue(f"{what} must be a scalar measure, and {name!r} has {size} components: "
                                 f"'{name}.{COMPONENTS[size][0]}' is one", "wrong-measure")
            return Reading(known_events.MEASURE, place.number, place.component or 0)
        coordinates, velocities = ([variable.name for variable in group] for group in (self.coordinates, self.velocities))
        if name in coordinates:
            return Reading(known_events.COORDINATE, coordinates.index(name))
        if name not in velocities:
            if is_dynamic and (columns := [column for group, column in self._columns_of.get(name, ()) if group == 2]):
                return Reading(known_events.MULTIPLIER, columns[0])
            known = checks.closest(name, [*coordinates, *velocities, *self._watching.known])
            raise WrongValue(f"{what} must be a measure, a coordinate or a velocity of {self.name}, not {name!r}; {known}",
                             "unknown-choice")
        return Reading(known_events.VELOCITY, velocities.index(name))

    def _names_of_measures(self) -> list[str]:
        """Names of all measures."""
        return list(self._watching.known)

    def _names_of_scalars(self) -> list[str]:
        """Names of all scalar measures and of components of the others, and "t"."""
        known = self._watching.known
        return ["t", *(part for name, (_, size) in known.items() for part in component_names(name, () if size == 1 else (size,)))]

    def _names_of_quantities(self) -> list[str]:
        """Names of all measures, coordinates, velocities and constraints."""
        return [*self._names_of_measures(), *self._columns_of]

    def _column(self, name: Any) -> tuple[int, int]:
        """Array, of p, v and the multipliers, and column of the variable of that name; KeyError if there is none, or several."""
        found = self._columns_of.get(name, ()) if isinstance(name, str) else ()
        if len(found) > 1:
            raise WrongName(f"a name must be unique in {self.name}, but {name!r} names {len(found)} variables: take the entries "
                            "of p, v or multipliers", "duplicate-name")
        return found[0] if found else self._refuse_name(name)

    def _refuse_name(self, name: Any) -> NoReturn:
        """Raise the error of a name that no quantity has."""
        if effort := self._effort_of(name):
            raise WrongName(f"{name!r} names an element, whose effort is {effort!r}, and its constraint, whose multiplier is in "
                            "multipliers and has the opposite sign, by (7)", "duplicate-name")
        if why := self._why_unknown(name):
            raise WrongName(why, "not-available")
        raise WrongName(f"nothing in {self.name} is called {name!r}; {checks.closest(name, self._names_of_quantities())}",
                        "wrong-name")

    def _unit_of_measure(self, name: str) -> str:
        """Unit of a measure, or of a component of it; "" if it has none."""
        return self._watching.unit(name) or ""

    def _effort_of(self, name: Any) -> str | None:
        """Name of the scalar force or torque of the drive, coupling or constraint of that name, or None."""
        known = self._watching.known
        return next((each for each in (f"{name}.force", f"{name}.torque") if known.get(each, (0, 0))[1] == 1), None)

    def _described(self) -> dict[str, Any]:
        """Description of the system in a saved solution, as JSON."""
        return {"name": self.name, "coordinates": self.coordinates, "velocities": self.velocities,
                "constraints": self.constraints, "has_energy": self.has_energy}


class Makes:
    """Description that makes a system, such as a mechanism; accepted by every function that takes a system."""

    name: str

    def system(self, coordinates: Any = None) -> BaseSystem:
        """The system of this description, in coordinates of one kind or in those that suit it."""
        raise NotImplementedError


def system_of(given: Any, *state: Any) -> Any:
    """System of an argument: a system itself, or that of a mechanism, which does not accept a state in coordinates."""
    if not isinstance(given, Makes):
        return given
    if any(part is not None for part in state):
        raise WrongType(f"p0 and v0 are for a system, whose coordinates are known, and {given.name!r} is a mechanism: say where "
                        'it starts by its start(), or take its system("joint")', "conflicting-arguments")
    return given.system()


def switches_of(system: Any) -> dict[str, int]:
    """Joints that can be released and joined, by name, with the numbers by which actions of events name them."""
    return {name: gateway.SWITCHES - i for i, (name, kind) in enumerate(getattr(system, "_groups", ())) if kind == "two-sided"}


def unswitched(given: Any, what: str) -> Any:
    """System of an argument whose constraints are active at all times; ValueError for one with contacts, which has phases."""
    system = system_of(given)
    if groups := getattr(system, "_groups", ()):
        raise WrongValue(f"{what} must have constraints that are active at all times, and {groups[0][0]!r} of {system.name} "
                         "switches: simulate it, or leave out contacts, stops and dry friction", "not-available")
    return system


def _listed(variables: Sequence[Variable]) -> str:
    return ", ".join(_shortened([f"{name} [{unit}]" if unit else name for name, unit in variables])) or "none"


def _shortened(entries: Sequence[str]) -> list[str]:
    """Text of the entries: all if they are few, else the first, the last and the number between."""
    left_out = len(entries) - FIRST_PRINTED - LAST_PRINTED
    if left_out <= LAST_PRINTED:
        return list(entries)
    return [*entries[:FIRST_PRINTED], f"({left_out} more)", *entries[-LAST_PRINTED:]]


def core_of(system: Any) -> gateway.CoreSystem:
    """The core's system of a system; TypeError for other objects and for descriptions without equations."""
    core = getattr(system, "_core", None) if isinstance(system, BaseSystem) else None
    if core is None:
        raise WrongType(f"system must be one of zd.systems, a zd.System or a zd.Mechanism, not {checks.shown(system)}")
    core.names_of_constraints(system)
    return core


def closed_form_core_of(system: Any, vector: str, core_settings: Any) -> gateway.CoreSystem:
    """Core system with closed-form functions for a vector unit, if the system has any that a run with these settings uses.

    They are compiled at first use.
    """
    core = core_of(system)
    if gateway.takes_closed_form(core, core_settings):
        core = system._closed_form_core(vector, gateway.takes_embeddings(core_settings))
        core.names_of_constraints(system)
    brought = with_what_it_takes(system, core, vector, core_settings)
    if brought is not core:
        brought.names_of_constraints(system)
    return brought


def with_what_it_takes(system: Any, core: gateway.CoreSystem, vector: str, core_settings: Any) -> gateway.CoreSystem:
    """The core's system with the series or the Jacobian that the integrator of these settings uses."""
    if gateway.takes_series(core_settings):
        return system._with_series(core, vector)
    return system._with_jacobian(core, vector) if gateway.takes_jacobian(core_settings) else core
