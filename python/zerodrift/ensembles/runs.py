"""`Runs`: parameters, initial state and system of each run of an ensemble."""

from __future__ import annotations

import copy
import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._private import checks
from .._private.types import ArrayLike
from ..errors import WrongType, WrongValue, ZerodriftError
from ..mechanisms.elements.measures import name_of
from ..mechanisms.system import MechanismSystem
from ..runs.states.operations import assemble
from ..systems.base import BaseSystem, core_of, system_of
from ..systems.parameter_tables import NumberTables


class Grid(Mapping):
    """The product of several parameters' values; `grid` makes it. A mapping from each name to its value in every run.

    Attributes
    ----------
    shape : tuple of int
        Number of values of each parameter; runs are in the order of ``numpy.ndindex(shape)``.
    """

    def __init__(self, values: Mapping[str, np.ndarray]) -> None:
        self.shape = tuple(len(each) for each in values.values())
        places = np.indices(self.shape).reshape(len(self.shape), -1)
        self._columns = {name: each[place] for (name, each), place in zip(values.items(), places, strict=True)}

    def __getitem__(self, name: str) -> np.ndarray:
        return self._columns[name]

    def __iter__(self) -> Any:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<grid of {' x '.join(f'{count} {name}' for name, count in zip(self, self.shape, strict=True))}>"


def grid(values: Mapping[str, ArrayLike] | None = None, /, **named: ArrayLike) -> Grid:
    """All combinations of parameters' values, for `zerodrift.ensemble`.

    Parameters
    ----------
    values : dict of str to array_like (k,), optional
        Values by name, for names that Python does not take as keywords.
    **named
        Values by name. What has more axes, the values of a parameter of several entries, has them behind the first.

    Returns
    -------
    Grid

    Raises
    ------
    ValueError, TypeError
        If there are no values, or one name is given twice.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.grid({"crank.mass": [1.0, 2.0]}, damping=[0.1, 0.2, 0.3])
    <grid of 2 crank.mass x 3 damping>
    """
    if values is not None and not isinstance(values, Mapping):
        raise WrongType(f"values must be a dict of values by name, not {checks.shown(values)}")
    for name in named:
        if name in (values or {}):
            raise WrongType(f"{name!r} is given twice", "duplicate-name")
    columns = {name: _column(name, each) for name, each in {**(values or {}), **named}.items()}
    if not columns or any(each.ndim == 0 or not len(each) for each in columns.values()):
        raise WrongValue("a grid must have parameters, and at least one value of each, in an array or a list", "missing-argument")
    return Grid(columns)


def _column(name: str, value: Any) -> np.ndarray:
    return checks.real(f"parameter {name!r} must hold", value)


class NoSystem(WrongType):
    """Raised if a function that must return a system returned something else."""

    code = "user-function"


def named(function: Any) -> str:
    """Name of a function for messages."""
    return getattr(function, "__qualname__", None) or checks.shown(function)


class Runs:
    """The runs of an ensemble.

    Parameters
    ----------
    made : system, Mechanism or callable
    parameters : dict, sequence of dicts, or None
    p0, v0 : array_like, optional
    start : dict, optional
    """

    def __init__(self, made: Any, parameters: Any, p0: Any, v0: Any, start: Any, hold: Any, *, assembles: bool) -> None:
        self.hold, self.may_assemble = hold, assembles
        self.made = made if callable(made) and not isinstance(made, BaseSystem) else system_of(made)
        if parameters and isinstance(self.made, BaseSystem):
            self.made = self.made._by_matrices()
        columns, counts = _columns("parameters", parameters)
        start, more = _columns("start", None if start is None else {name_of(each, "a key of start"): value
                                                                    for each, value in _dict("start", start).items()})
        states = {name: array for name, given in (("p0", p0), ("v0", v0))
                  if given is not None and (array := _state(name, given)) is not None}
        counts |= more | {name: len(array) for name, array in states.items() if array.ndim == 2}
        self.count = _common(counts)
        self.start_values, self.states = start, states
        self.parameters = {name: self._all(each) for name, each in columns.items()}
        self.shape = getattr(parameters, "shape", None) or (self.count,)
        if isinstance(self.made, BaseSystem):
            core_of(self.made)
            for name in self.parameters:
                checks.choice("parameter", name, self.made.parameters)

    def _all(self, column: tuple[np.ndarray, bool]) -> np.ndarray:
        array, varies = column
        return array if varies else np.broadcast_to(array, (self.count, *array.shape))

    def parameters_of(self, run: int) -> dict[str, Any]:
        """Parameters of one run by name, as its system takes them."""
        return {name: each[run].item() if each.ndim == 1 else np.array(each[run]) for name, each in self.parameters.items()}

    def table(self, first: int, last: int) -> dict[str, Any]:
        """Numbers of the runs first ... last - 1: everything in which they differ from other runs."""
        here = slice(first, last)
        return {"parameters": {name: np.ascontiguousarray(each[here]) for name, each in self.parameters.items()},
                "start_values": {name: (array[here] if varies else array, varies)
                                 for name, (array, varies) in self.start_values.items()},
                "states": {name: array[here] if array.ndim == 2 else array for name, array in self.states.items()},
                "count": last - first, "shape": (last - first,)}

    def with_table(self, table: dict[str, Any]) -> Runs:
        """Runs of the same kind with the numbers of a table."""
        other = copy.copy(self)
        vars(other).update(table)
        return other

    def system(self, run: int) -> BaseSystem:
        """The system of one run."""
        parameters = self.parameters_of(run)
        if not isinstance(self.made, BaseSystem):
            system = system_of(self.made(**parameters))
            if not isinstance(system, BaseSystem):
                raise NoSystem(f"{named(self.made)} must return a system or a Mechanism, not {checks.shown(system)}")
            return system._by_matrices()
        return self.made.with_parameters(parameters) if parameters else self.made

    def is_tabular(self, system: BaseSystem, run: int) -> bool:
        """True if starts and parameters can be given to the core as tables, without Python.

        `run` is the index of a run whose system can be built.
        """
        sizes = {"p0": system.nq, "v0": system.nv}
        is_mechanism = isinstance(system, MechanismSystem)
        if self.start_values or (is_mechanism and set(self.states) != set(sizes) and not (self.parameters and not self.states)):
            return False        # starts are assembled in Python
        fits = all(array.shape[-1] == sizes[name] for name, array in self.states.items())
        has_start = "p0" in self.states or is_mechanism or system.p0 is not None
        return fits and has_start and self.tables(system, run, run + 1) is not None

    def tables(self, system: BaseSystem, first: int, last: int, closed_form: tuple[str, bool] | None = None,
               ) -> NumberTables | None:
        """Tables of the runs first ... last - 1, which differ from this system in parameters only; None if it has no tables.

        None also if the numbers of one run are inconsistent: each run is then built individually and has its own error.
        """
        parameters = self.parameters_from(first, last)
        more = {"starts_are_known": bool(self.states)} if isinstance(system, MechanismSystem) else {}
        try:
            return system._number_tables(parameters, last - first, closed_form, **more)
        except (ValueError, ZerodriftError):
            return None

    def parameters_from(self, first: int, last: int) -> dict[str, np.ndarray]:
        """Parameters of the runs first ... last - 1, by name."""
        return {name: each[first:last] for name, each in self.parameters.items()}

    def assembles(self, system: BaseSystem) -> bool:
        """True if starts must be made consistent with the constraints, as parameters vary."""
        finds_start = isinstance(system, MechanismSystem) and not self.states
        return bool(self.may_assemble and self.parameters and system.m and not finds_start and not system._groups)

    def starts(self, tables: NumberTables, first: int, last: int) -> tuple[np.ndarray | None, np.ndarray | None]:
        """Initial p (k, nq) and v (k, nv) of the runs first ... last - 1, not yet consistent; NaN for refused runs.

        None if the core assembles them.
        """
        if tables.family is not None and not self.states:
            return None, None
        sizes = {"p0": tables.core.nq, "v0": tables.core.nv}
        own = {"p0": tables.p0, "v0": np.zeros(sizes["v0"]) if tables.v0 is None else tables.v0}
        found = [np.empty((last - first, size)) for size in sizes.values()]
        for name, start in zip(sizes, found, strict=True):
            array = self.states.get(name)
            start[:] = own[name] if array is None else array[first:last] if array.ndim == 2 else array
        if tables.refused:
            found[0][list(tables.refused)] = np.nan
        return found[0], found[1]

    def are_not_finite(self, first: int, last: int) -> np.ndarray:
        """Mask of the runs first ... last - 1 whose p0 or v0 is not finite, which `simulate` refuses."""
        found = np.zeros(last - first, dtype=bool)
        for array in self.states.values():
            found |= ~np.isfinite(array[first:last] if array.ndim == 2 else array).all(axis=-1)
        return found

    def start(self, run: int, system: BaseSystem, t: float) -> tuple[Any, Any]:
        """Initial p and v of a run at time t; None for those of the system, which a mechanism assembles."""
        if self.start_values:
            held = {name: array[run] if varies else array for name, (array, varies) in self.start_values.items()}
            return assemble(system, {name: float(value) if np.ndim(value) == 0 else value for name, value in held.items()}, t=t)
        p, v = (None if (array := self.states.get(name)) is None else array[run] if array.ndim == 2 else array
                for name in ("p0", "v0"))
        if isinstance(system, MechanismSystem) and p is None and v is None:
            return system._state_or_start(None, None, t=t)
        p, v = (system.p0 if p is None else p), (system.v0 if v is None else v)
        return assemble(system, p, v, self.hold, t=t) if self.assembles(system) and p is not None else (p, v)


def _dict(name: str, given: Any) -> Mapping:
    if not isinstance(given, Mapping):
        raise WrongType(f"{name} must be a dict of values by name, not {checks.shown(given)}")
    return given


def _columns(what: str, given: Any) -> tuple[dict[str, tuple[np.ndarray, bool]], dict[str, int]]:
    """Values by name, each with a flag whether it varies; and the number of runs that each varying one implies."""
    if given is None:
        return {}, {}
    if isinstance(given, Sequence) and not isinstance(given, str):
        return _rows(what, given)
    columns = {}
    for name, value in _dict(what, given).items():
        array = checks.real(f"{what}[{name!r}] must hold", value)
        columns[name] = array, array.ndim > 0
    return columns, {f"{what}[{name!r}]": len(array) for name, (array, varies) in columns.items() if varies}


def _rows(what: str, given: Sequence) -> tuple[dict[str, tuple[np.ndarray, bool]], dict[str, int]]:
    """Values by name from a list of dicts, one for each run; likewise."""
    rows = [_dict(f"{what}[{i}]", each) for i, each in enumerate(given)]
    if not rows:
        raise WrongValue(f"{what} must have at least one run", "shape")
    for i, row in enumerate(rows):
        if differing := set(row) ^ set(rows[0]):
            raise WrongValue(f"{what}[{i}] and {what}[0] must have the same names, and differ by {', '.join(sorted(differing))}",
                             "wrong-name")
    columns = {name: (checks.real(f"{what} {name!r} must hold", [row[name] for row in rows]), True) for name in rows[0]}
    return columns, {what: len(rows)}


def _state(name: str, given: Any) -> np.ndarray:
    array = np.array(checks.real(f"{name} must hold", given), dtype=float)
    if array.ndim not in (1, 2):
        raise WrongValue(f"{name} must have one axis, or a first axis for the runs and one more, not shape {array.shape}",
                         "shape")
    return array


def _common(counts: dict[str, int]) -> int:
    """Number of runs, on which all arguments must agree."""
    if not counts:
        return 1
    first = next(iter(counts))
    for name, count in itertools.islice(counts.items(), 1, None):
        if count != counts[first]:
            raise WrongValue(f"{first} has {counts[first]} values and {name} has {count}: there must be one for each run, or one "
                             "for all; zd.grid(...) takes the product", "shape")
    if not counts[first]:
        raise WrongValue(f"{first} must have at least one value: each is a run", "shape")
    return counts[first]
