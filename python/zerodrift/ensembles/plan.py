"""`Plan`: everything that a thread, another process or another machine needs to make runs of an ensemble."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._private import checks, gateway
from .._private.types import Events
from ..errors import WrongType, WrongValue, ZerodriftError
from ..mechanisms.elements.measures import name_of
from ..runs.arguments import events as events_of
from ..runs.arguments import settings
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..systems.base import BaseSystem, core_of
from .runs import NoSystem, Runs, named

OPTIONS = settings.DEFAULTS | {"events": None}      # arguments of `simulate`, with their defaults


@dataclass(eq=False)
class Plan:
    """Runs of an ensemble, their settings, and the results to keep.

    Attributes
    ----------
    runs : Runs
        Parameters and initial states of each run, and the function or system that makes its system.
    t_span : float or (float, float)
    options : dict
        Further arguments of `simulate`, always with ``vector``, so that results are bitwise the same on other machines.
    names : tuple of str
        Names of the outputs.
    reduce : callable or None
    keeps : bool
        True if solutions are kept.
    units : dict of str to str
        Units of outputs and parameters, where known.
    is_tabular : bool
        True if the core reads the numbers of all runs from tables.
    sizes : tuple of int, or None
        Bytes of each output over all runs, and of kept solutions; None if not known in advance.
    drawn_open : str, optional
        Sentence on a joint that the first run's drawing leaves open, where its start is not meant to differ.
    remembered : dict
        Cache of values that are computed once for all runs; not sent to other processes.
    """

    runs: Runs
    t_span: Any
    options: dict[str, Any]
    names: tuple[str, ...]
    reduce: Callable[[Solution], Any] | None = None
    keeps: bool = False
    units: dict[str, str] = field(default_factory=dict)
    is_tabular: bool = False
    sizes: tuple[int, ...] | None = None
    drawn_open: str | None = None
    remembered: dict[str, Any] = field(default_factory=dict, repr=False)

    @property
    def t_eval(self) -> np.ndarray | None:
        """Output times; None if each run has its own."""
        return self.options.get("t_eval")

    def over(self, runs: Runs) -> Plan:
        """The same plan for other runs; the cache is shared."""
        other = copy.copy(self)
        other.runs = runs
        return other

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"remembered": {}}

    def to_run(self, run: int) -> Plan:
        """Plan by which a run can be made: this plan."""
        return self

    def solution(self, run: int, **options: Any) -> Solution:
        """Solution of one run, by `simulate`."""
        system = self.runs.system(run)
        p, v = self.runs.start(run, system, checks.span(self.t_span)[0])
        return simulate(system, self.t_span, p, v, **self.options, **options)


def checked(runs: Runs, t_span: Any, outputs: Any, reduce: Any, *, keeps: bool, **options: Any) -> Plan:
    """Plan whose arguments are checked, with the first system that can be built; nothing is simulated."""
    for name in options:
        if name not in OPTIONS:
            raise WrongType(f"ensemble has no argument {name!r}; simulate, which has the options, takes {', '.join(OPTIONS)}",
                            "wrong-name")
    options.update(vector=settings.vector_unit(options.get("vector")))
    if reduce is not None and not callable(reduce):
        raise WrongType(f"reduce must be a function of a solution, not {checks.shown(reduce)}")
    names = _names(outputs)
    run, system = _first_system(runs)
    if system is not None:
        span = checks.span(t_span)
        rows = _check_options(system, span, **options)
        _check_names(system, names or [])
        _check_starts(runs, run, system, span[0])
        if names is None:
            names = [] if reduce is not None else [variable.name for variable in system.coordinates]
    if options.get("t_eval") is not None:
        options.update(t_eval=np.array(options["t_eval"], dtype=float))
    is_tabular = isinstance(runs.made, BaseSystem) and runs.is_tabular(runs.made, run)
    units = {} if system is None else _units(system, names or [])
    sizes = None if system is None or rows is None else tuple(
        runs.count * rows * each for each in _row_bytes(system, names or [], keeps=keeps))
    drawn_open = None if system is None or runs.states else system._drawn_open(runs.start_values)
    return Plan(runs, t_span, options, tuple(names or ()), reduce, keeps, units, is_tabular, sizes, drawn_open)


def _names(outputs: Any) -> list[str] | None:
    """Names in the argument `outputs`; None if it was left out."""
    if outputs is None:
        return None
    several = [outputs] if isinstance(outputs, str) or not isinstance(outputs, list | tuple) else outputs
    return [name_of(each, "each of outputs") for each in several]


def _first_system(runs: Runs) -> tuple[int, BaseSystem | None]:
    """First run whose system can be built, and that system; None if the function raises in every run.

    A run that cannot be built is data. If none can, a given system has been given wrong parameters, or a function returns
    something else: that is an error.
    """
    if not isinstance(runs.made, BaseSystem):
        _check_signature(runs)
    errors: list[Exception] = []
    for run in range(runs.count):
        try:
            return run, runs.system(run)
        except Exception as error:
            errors[1:] = [error]
    if isinstance(runs.made, BaseSystem) or any(isinstance(error, NoSystem) for error in errors):
        raise errors[0]
    return 0, None


def _check_signature(runs: Runs) -> None:
    """Check that a function accepts these parameters by name."""
    try:
        signature = inspect.signature(runs.made)
    except ValueError:      # it has none, as some functions in C
        return
    try:
        signature.bind(**runs.parameters_of(0))
    except TypeError as error:
        raise WrongType(f"{named(runs.made)}{signature} does not take the parameters {', '.join(runs.parameters) or '()'}: "
                        f"{error}", "user-function") from None


def _check_options(system: BaseSystem, span: tuple[float, float], *, events: Events | None = None, **options: Any) -> int | None:
    """Check options as `simulate` does; return the number of samples of a run, None if not known in advance."""
    events_of.events(events, system)
    return settings.plan(system, span, settings.Arguments(**options)).rows


def _row_bytes(system: BaseSystem, names: list[str], *, keeps: bool) -> Iterator[int]:
    """Bytes of one sample of each output, and of a kept solution."""
    for name in names:
        yield 8 * system._watching.known.get(name, (0, 1))[1]
    if keeps:
        yield gateway.row_bytes(core_of(system), None)


def _check_names(system: BaseSystem, names: list[str]) -> None:
    for name in names:
        if name not in system._columns_of and system._watching.find(name) is None:
            raise WrongValue(f"no output is called {name!r} in {system.name}; "
                             f"{checks.closest(name, system._names_of_quantities())}", "wrong-name")


def _units(system: BaseSystem, names: list[str]) -> dict[str, str]:
    """Units of these outputs, and of the parameters that have one."""
    variables = {variable.name: variable.unit
                 for group in (system.coordinates, system.velocities, system.constraints) for variable in group}
    return system._parameter_units() | {name: variables.get(name, system._watching.unit(name) or "") for name in names}


def _check_starts(runs: Runs, first: int, system: BaseSystem, t0: float) -> None:
    """Check sizes and names of starts, which each run would refuse; `first` is the run of this system."""
    for name, size in (("p0", system.nq), ("v0", system.nv)):
        array = runs.states.get(name)
        if array is not None and array.shape[-1] != size:
            raise WrongValue(f"{name} must have {size} entries for each run of {system.name}, not shape {array.shape}", "shape")
    errors = []
    for run in range(first, runs.count):
        try:
            runs.start(run, system if run == first else runs.system(run), t0)
        except ZerodriftError:      # its arguments were accepted
            return
        except Exception as error:
            errors.append(error)
        else:
            return
    raise errors[0]
