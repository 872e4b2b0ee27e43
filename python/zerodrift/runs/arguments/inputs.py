"""The argument `inputs` of a run: numbers that are set between steps, by name."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, NoReturn

import numpy as np

from ..._private import checks, gateway
from ...errors import WrongName, WrongType, WrongValue
from ...systems.base import BaseSystem
from ...systems.defaults import WithInputs


def refuse_unknown(system: BaseSystem, name: Any, places: Mapping[str, Any]) -> NoReturn:
    """Refuse a name that a run cannot set; `places`: its inputs."""
    if name in system._names_of_inputs():
        raise WrongName(f"{name!r} must be declared as an input before it can be set: inputs=[{name!r}]", "wrong-name")
    known = f"; {checks.closest(name, places)}" if places else ""
    raise WrongName(f"a name to set must be that of an input, not {name!r}{known}", "wrong-name")


class Declared(NamedTuple):
    """Inputs of a run, checked."""

    names: tuple[str, ...]
    lower: np.ndarray       # (k,) limits
    upper: np.ndarray
    of: WithInputs          # the system that has them
    follows: gateway.Following     # way in which speeds reach their inputs

    def places(self) -> dict[str, int | np.ndarray]:
        """Index of each input by its name, and indices of each array all of whose entries are inputs, in its shape."""
        index: dict[str, Any] = {name: i for i, name in enumerate(self.names)}
        arrays = self.of.system._arrays_of_inputs().items()
        whole = {name: entries for name, entries in arrays if index.keys() >= set(entries.ravel().tolist())}
        return index | {name: np.vectorize(index.get, otypes=[int])(entries) for name, entries in whole.items()}

    def bound(self, *cores: Any, values: np.ndarray | None = None) -> tuple[gateway.Inputs, list[Any]]:
        """Inputs of one run, in given memory, and its own systems in the place of these; None stays."""
        found = [None if core is None else self.of.bound(core, self.names) for core in cores]
        if values is not None:
            values[:] = self.of.initial
        inputs = gateway.Inputs(self.names, np.array(self.of.initial), self.lower, self.upper, [each for each in found if each],
                                 values, self.follows)
        return inputs, [each and each.core for each in found]


class Speeds(NamedTuple):
    """Arguments on inputs that are speeds."""

    hold: Any = False
    ramp: Any = None

    def settings(self) -> dict[str, Any]:
        """Arguments that differ from the default, by name."""
        return {name: value for name, value in self._asdict().items() if value not in (None, False)}


FOLLOWED = Speeds()


def following(speeds: Speeds, names: Sequence[str], step: float | None) -> gateway.Following:
    """Check the arguments `hold` and `ramp` of a run with inputs of these names."""
    jumps = checks.instance("hold", speeds.hold, bool, "True or False")
    ramp = None if speeds.ramp is None else checks.number("ramp", speeds.ramp, above=0)
    first = next((name for name in names if name.endswith(".speed")), None)
    if first is None:
        if jumps or ramp is not None:
            raise WrongValue("hold and ramp must be left out if no input is a speed", "conflicting-arguments")
        return gateway.Following()
    if ramp is not None and (jumps or step is not None):
        raise WrongValue("ramp must be left out with hold=True, by which a speed jumps, and with fixed steps, over one of which "
                         "it is followed", "conflicting-arguments")
    if step is None and ramp is None and not jumps:
        raise WrongValue(f"input {first!r} must be followed over a given time in adaptive steps, ramp=, or over one fixed step, "
                         "step=, or jump, hold=True", "step-size")
    return gateway.Following(jumps, ramp or 0.0)


def declared(given: Any, system: BaseSystem, speeds: Speeds, step: float | None) -> Declared | None:
    """Check the argument `inputs`: None, names, or a dict of names to limits (lower, upper), None for no limits."""
    if given is None:
        following(speeds, (), step)
        return None
    limits = given if isinstance(given, Mapping) else dict.fromkeys(_names(given))
    names, listed = _entries(limits, system)
    if not names:
        raise WrongValue("inputs must name at least one input", "missing-argument")
    bounds = np.array([_limits(name, each) for name, each in zip(names, listed, strict=True)])
    lower, upper = (np.ascontiguousarray(column) for column in bounds.T)
    return Declared(names, lower, upper, system._with_inputs(names), following(speeds, names, step))


def _names(given: Any) -> Sequence[Any]:
    names = (given,) if isinstance(given, str) or hasattr(given, "name") else given
    if not isinstance(names, Sequence):
        raise WrongType(f"inputs must be names, or a dict of names to limits, not {checks.shown(given)}")
    listed = list(map(_name, names))
    _check_once(listed)
    return listed


def _check_once(names: Sequence[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise WrongValue(f"each input must be named once, and {name!r} is named more often", "duplicate-name")


def _entries(limits: Mapping[Any, Any], system: BaseSystem) -> tuple[tuple[str, ...], list[Any]]:
    """Names of inputs, arrays as their entries, and the limits of each."""
    arrays, found = system._arrays_of_inputs(), []
    for name, each in zip(map(_name, limits), limits.values(), strict=True):
        found += [(entry, each) for entry in (arrays[name].ravel().tolist() if name in arrays else [name])]
    names = tuple(name for name, _ in found)
    _check_once(names)
    return names, [each for _, each in found]


def _name(given: Any) -> str:
    name = getattr(given, "name", given)
    if not isinstance(name, str):
        raise WrongType(f"an input must be a measure or its name, not {checks.shown(given)}")
    return name


def _limits(name: str, given: Any) -> tuple[float, float]:
    if given is None:
        return -math.inf, math.inf
    bounds = checks.real(f"limits of input {name!r} must be (lower, upper)", given)
    if bounds.shape != (2,) or not bounds[0] <= bounds[1]:
        raise WrongValue(f"limits of input {name!r} must be (lower, upper), not {checks.shown(given)}", "shape")
    return float(bounds[0]), float(bounds[1])


class Jump(NamedTuple):
    """Impulses of motors whose speeds are inputs, when these or some of them jump.

    Attributes
    ----------
    t : float
        s
    impulses : dict of str to float
        Impulse of each motor, in N m s or N s, with the sign of its torque or force.
    works : dict of str to float
        Work of each motor, in J: the impulse times the mean of its speeds before and after.
    work : float
        J: of all motors, also of those whose speeds are not inputs: the change of the kinetic energy.
    """

    t: float
    impulses: dict[str, float]
    works: dict[str, float]
    work: float


class Drives:
    """Motors with speeds that jump."""

    def __init__(self, declared: Declared) -> None:
        names = [name.removesuffix(".speed") for name in declared.names if name.endswith(".speed")]
        constraints = [constraint.name for constraint in declared.of.system.constraints]
        self._rows = {name: constraints.index(name) for name in names}

    def jump(self, t: float, impulses: np.ndarray, works: np.ndarray) -> Jump:
        """The jump with these impulses (m,) and works (m,) of all constraints."""
        rows = self._rows.items()
        return Jump(t, {name: float(-impulses[row]) for name, row in rows}, {name: float(works[row]) for name, row in rows},
                    float(works.sum()))


class History:
    """Values of inputs over time, for a record: each from the time at which it was set; and jumps of speeds."""

    def __init__(self, t: float, values: np.ndarray, places: Mapping[str, Any]) -> None:
        self._t, self._values = [t], [values.copy()]
        self._arrays = {name: place for name, place in places.items() if np.ndim(place)}
        self.jumps: list[Jump] = []

    def note(self, t: float, values: np.ndarray) -> None:
        """Note the values with which the run advances from t."""
        if not np.array_equal(self._values[-1], values):
            if self._t[-1] == t:
                self._values[-1] = values.copy()
            else:
                self._t.append(t)
                self._values.append(values.copy())

    def columns(self, names: Sequence[str], t: np.ndarray) -> dict[str, np.ndarray]:
        """Values (len(t),) of each input by name, (len(t), size) of an array, and sums of jumps."""
        at = self.at(t)
        columns = {name: np.ascontiguousarray(values) for name, values in zip(names, at.T, strict=True)}
        arrays = {name: at[:, place.ravel()] for name, place in self._arrays.items()}
        return columns | arrays | self._columns_of_jumps(t)

    def _columns_of_jumps(self, t: np.ndarray) -> dict[str, np.ndarray]:
        """Sums (len(t),) of impulses and works since the sample before."""
        columns: dict[str, np.ndarray] = {}
        for jump in self.jumps:
            sample = np.searchsorted(t, jump.t, side="right")
            for what, values in (("impulse", jump.impulses), ("impulse_work", jump.works)):
                for name, value in values.items():
                    column = columns.setdefault(f"{name}.{what}", np.zeros(len(t)))
                    column[sample:sample + 1] += value
        return columns

    def at(self, t: np.ndarray) -> np.ndarray:
        """Values (len(t), k) in the steps that led to these times."""
        last = np.searchsorted(np.array(self._t), t, side="left") - 1
        return np.array(self._values)[np.maximum(last, 0)]
