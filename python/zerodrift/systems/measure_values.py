"""Measures of a solution, evaluated at all samples by the core."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from .._private import checks, gateway
from .._private.gateway import Acting, CoreSystem
from .._private.rotations import COMPONENTS, angles_of, is_order, quaternions_of
from ..errors import WrongName, WrongValue

AXES = COMPONENTS[3]    # names of components along axes
SAME = 1e-9             # of all changes by redundant multipliers: a reaction that changes by less is unique
PART = 2**28            # bytes of positions that a measure is evaluated at together


class Place(NamedTuple):
    """Index of a measure, and of one of its components, None: all; `form`: function of a rotation (k, 3, 3)."""

    number: int
    component: int | None
    form: Callable[[np.ndarray], np.ndarray] | None = None

    def pick(self, values: np.ndarray) -> np.ndarray:
        """Selected part of values (k, size): (k,) of a scalar or a component, (k, 3, 3) of a rotation, (k, size) of a vector."""
        if self.component is not None:
            return values[:, self.component]
        if self.form:
            return self.form(values.reshape(-1, 3, 3))
        return values[:, 0] if values.shape[1] == 1 else values


def find(name: Any, known: Mapping[str, tuple[int, int]]) -> Place | None:
    """A measure or a component of one by its name, among known ones, index and size of each; None: there is none."""
    if not isinstance(name, str):
        return None
    base, _, axis = name.rpartition(".")
    if name in known:
        return Place(known[name][0], None, np.asarray if axis == "rotation" else None)
    number, size = known.get(base, (-1, 0))
    parts = COMPONENTS.get(size, ())
    return Place(number, parts.index(axis)) if axis in parts else None


def view(name: Any, known: Mapping[str, tuple[int, int]]) -> Place | None:
    """As `find`; also "body.quaternion" and "body.euler.zyx", which are functions of "body.rotation"."""
    if (found := find(name, known)) or not isinstance(name, str):
        return found
    body, _, quantity = name.partition(".")
    word, _, order = quantity.partition(".")
    angles = partial(angles_of, order=order) if word == "euler" and is_order(order) else None
    form = quaternions_of if quantity == "quaternion" else angles
    rotation = None if form is None else find(f"{body}.rotation", known)
    return rotation and rotation._replace(form=form)


def component_names(name: str, shape: tuple[int, ...], *, has_axes: bool = True) -> list[str]:
    """Names of the entries of a value: "pin.force.x" along axes, else "u[0]" and "K[0, 1]"; of a number, its own."""
    if has_axes and len(shape) == 1 and shape[0] <= len(AXES):
        return [f"{name}.{axis}" for axis in AXES[:shape[0]]]
    return [f"{name}[{', '.join(map(str, place))}]" if place else name for place in np.ndindex(shape)]


class Watching:
    """Measures of a system by name, evaluated from solutions; `core` provides them, None if there are none."""

    def __init__(self, core: CoreSystem | None) -> None:
        self._core, self._measures = core, core.measures if core else ()
        self.known = {measure.name: (i, self.core.measure_size(i)) for i, measure in enumerate(self._measures)}
        self._accelerations: weakref.WeakKeyDictionary[Any, tuple[np.ndarray, np.ndarray]] = weakref.WeakKeyDictionary()

    @property
    def core(self) -> CoreSystem:
        """The core's system that provides the measures, where any is known."""
        assert self._core
        return self._core

    def find(self, name: Any) -> Place | None:
        """Index of a measure or of a component by its name, or None."""
        return find(name, self.known)

    def view(self, name: Any) -> Place | None:
        """Index of what is read by a name: of a measure, a component, or an orientation; or None."""
        return view(name, self.known)

    def unit(self, name: str) -> str | None:
        """Unit of a measure or of a component by its name, or None."""
        found = self.find(name)
        return None if found is None else self._measures[found.number].unit

    def size(self, name: str) -> int:
        """Number of components of what has that name, one if that is not a measure."""
        found = self.find(name)
        return 1 if found is None or found.component is not None else self.core.measure_size(found.number)

    def acting(self, names: Iterable[str], efforts: np.ndarray) -> Acting:
        """Efforts (k, n) along quantities. Those along coordinates that are not measures act in no reaction."""
        along: list[tuple[int, ...] | None] = []
        for name in names:
            place = self.find(name)
            along += [place and (place.number, place.component or i, self.core.joint_of(place.number))
                      for i in range(self.size(name))]
        return Acting(list(filter(None, along)), efforts[:, [each is not None for each in along]])

    def __reduce__(self) -> tuple[Any, ...]:
        return Watching, (self._core,)      # what is known of solutions is found again

    def values(self, name: Any, solution: Any) -> np.ndarray | None:
        """A measure at all rows, as `Place.pick` shapes it; None: there is none of that name."""
        found = self.view(name)
        if found is None:
            return None
        return found.pick(self._evaluate(found.number, solution))

    def _evaluate(self, number: int, solution: Any, wanted: str = "value") -> np.ndarray:
        values, is_dynamic = [], self.core.measure_depends(number) == "accelerations"
        for core, part in self._cores(solution, self._measures[number].name if is_dynamic else None):
            more, is_own = self._accelerate(number, core, solution, part) if is_dynamic else (), core is not self.core
            values.append(core.measure(number, *_states(solution, part), *more, is_own=is_own, wanted=wanted, is_least=True))
        return values[0] if len(values) == 1 else np.concatenate(values)

    def _accelerate(self, number: int, core: CoreSystem, solution: Any, part: slice) -> tuple[np.ndarray, np.ndarray]:
        """Accelerations (k, nv), least multipliers (k, m) at a range of samples; cached if it has all samples."""
        known = self._accelerations.get(solution)
        if known is None:
            formulation, states = _formulation(solution.settings["formulation"]), _states(solution, part)
            is_own = core is not self.core
            if core.c.groups and core.functions:
                return _in_phases(core, formulation, states, solution._state_of_groups[part], is_own=is_own), np.array(
                    solution.multipliers[part])
            if core.c.groups:
                return gateway.accelerations_with(core, formulation, *states, solution.multipliers[part]), np.array(
                    solution.multipliers[part])
            vdot, _, chosen = gateway.accelerations(core, formulation, 1, *states, is_own=is_own)
            known = vdot, np.array(solution.multipliers[part])
            if chosen.any():
                of_chosen = [each[chosen] for each in (*states, *known)]
                known[1][chosen] = core.measure(number, *of_chosen, is_own=is_own, wanted="least")
            if part.start == 0 and part.stop >= len(solution.t):
                self._accelerations[solution] = known
        return known

    def _cores(self, solution: Any, dynamic: str | None) -> Iterator[tuple[CoreSystem, slice]]:
        """The core's system for all rows in parts: in each of them, inputs have the values with which the run made these rows.

        `dynamic` names a measure of accelerations, which need the rate of a speed that is an input: it is not among the samples.
        """
        names = getattr(solution, "settings", {}).get("inputs")
        if not names:
            yield from ((self.core, part) for part in _parts(solution))
            return
        of = solution.system._with_inputs(names)
        bound = of.bound(of.system._watching.core, names)
        if dynamic and any(place.is_speed for place in bound.places):
            raise WrongValue(f"{dynamic!r} depends on accelerations, and a speed is an input: it must be recorded by the run, by "
                             f"outputs=[{dynamic!r}]", "not-available")
        if missing := [name for name in names if name not in solution.outputs]:
            raise WrongValue(f"a run must have ended before inputs are read from its file, and {missing[0]!r} is not in it yet",
                             "unreadable-file")
        given = np.column_stack([solution[name] for name in names])
        inputs = gateway.Inputs(names, given[0].copy(), given[0], given[0], [bound])
        ends = [*(np.flatnonzero((given[1:] != given[:-1]).any(axis=1)) + 1), len(given)]
        for first, end in zip([0, *ends], ends, strict=False):
            inputs.set_constant(given[first])
            yield bound.core, slice(first, end)

    def is_unique_at(self, place: Place, t: float, p: np.ndarray, v: np.ndarray) -> bool:
        """True if a scalar measure or component is the same for all admissible multipliers at a state."""
        state = [np.ascontiguousarray(each)[None] for each in (p, v, np.zeros(self.core.nv), np.zeros(self.core.m))]
        changes = self.core.measure(place.number, np.array([float(t)]), *state, wanted="redundant", is_least=True)
        return bool(_are_unique(changes)[0, place.component or 0])

    def unique(self, name: Any, solution: Any, body: Any = None) -> Any:
        """Components of a measure that are the same for all admissible multipliers at every sample; a bool of a scalar.

        Components are along the axes of a body at each sample; None: along those of the drawing.
        """
        found = self.find(name)
        if found is None:
            raise WrongName(f"no measure is called {name!r}; {checks.closest(name, self.known)}", "wrong-name")
        same: Any = np.ones(self._measures[found.number].size, dtype=bool)
        if self.core.measure_depends(found.number) == "accelerations" and self.core.m:
            changes = self._evaluate(found.number, solution, "redundant")
            if same.size > 1 and body not in (None, "ground"):
                changes = solution._axes_of(body, same.size) @ changes
            same = _are_unique(changes).all(axis=0)
        same = found.pick(same[None])[0]
        return bool(same) if same.ndim == 0 else same


def _are_unique(changes: np.ndarray) -> np.ndarray:
    """Flags (k, size) of components whose changes (k, size, m) by redundant multipliers are rounding."""
    return np.linalg.norm(changes, axis=2) <= SAME


def _formulation(given: Any) -> int:
    """Index in the core of a formulation given by its name or its settings."""
    name = given if isinstance(given, str) else given.card.name
    return [card.name for card in gateway.cards("formulations")].index(name)


def _in_phases(core: CoreSystem, formulation: int, states: Sequence[np.ndarray], phases: np.ndarray, *,
               is_own: bool) -> np.ndarray:
    """Accelerations (k, nv) at states t, p, v, each in its phase (k, groups), where laws read reactions."""
    found = np.empty_like(states[2])
    every, which = np.unique(phases, axis=0, return_inverse=True)
    for i, phase in enumerate(every):
        own, within = which.reshape(-1) == i, gateway.in_phase(core, phase.tolist())
        found[own] = gateway.accelerations(within, formulation, 1, *(each[own] for each in states), is_own=is_own)[0]
    return found


def _parts(solution: Any) -> list[slice]:
    """Ranges of samples, as samples in a file may exceed the memory."""
    rows = max(1, PART // (solution.p.itemsize * max(1, solution.p.shape[1])))
    return [slice(first, first + rows) for first in range(0, max(1, len(solution.t)), rows)]


def _states(solution: Any, part: slice) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arrays t (k,), p (k, nq), v (k, nv) of a range of samples for the core."""
    t, p, v = (np.ascontiguousarray(array[part]) for array in (solution.t, solution.p, solution.v))
    return t, p, v
