"""Measures of a solution: evaluated at all of its rows by the core."""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np

from .. import _check, _gateway
from .._gateway.mechanisms import MechanismCore

SAME = 1e-8             # of the largest: reactions that differ by less do not depend on which multipliers are taken
DEPENDENT = 1e-9        # of the largest singular value: rows that follow from others


class Watching:
    """Reads the measures of a mechanism, by their names, off solutions; `core` is the system with all of them."""

    def __init__(self, core: MechanismCore) -> None:
        self._core, self.names = core, tuple(row.name for row in core.measures)
        self.number = {name: i for i, name in enumerate(self.names)}
        self._accelerations: weakref.WeakKeyDictionary[Any, np.ndarray] = weakref.WeakKeyDictionary()

    def find(self, name: str) -> tuple[int, int | None] | None:
        """The number of a measure, and of the component that is meant."""
        if name in self.number:
            return self.number[name], None
        base, _, axis = name.rpartition(".")
        if base in self.number and axis in ("x", "y"):
            return self.number[base], "xy".index(axis)
        return None

    def values(self, name: str, solution: Any) -> np.ndarray | None:
        """A measure at all rows: (k,) of a scalar or a component, (k, 2) of a vector; None: there is none of that name."""
        found = self.find(name)
        if found is None:
            return None
        number, component = found
        return _component(self._evaluate(number, solution, solution.multipliers), component)

    def _evaluate(self, number: int, solution: Any, multipliers: np.ndarray) -> np.ndarray:
        core = self._core
        t, p, v = (np.ascontiguousarray(array) for array in (solution.t, solution.p, solution.v))
        if core.measure_depends(number) != "accelerations":
            return core.measure(number, t, p, v)
        return core.measure(number, t, p, v, self._accelerate(solution), np.ascontiguousarray(multipliers))

    def _accelerate(self, solution: Any) -> np.ndarray:
        """The accelerations (k, nv) at all rows."""
        known = self._accelerations.get(solution)
        if known is None:
            rows = [_acceleration(self._core, solution, row) for row in range(len(solution.t))]
            known = self._accelerations[solution] = np.array(rows).reshape(len(rows), self._core.nv)
        return known

    def unique(self, name: str, solution: Any) -> Any:
        """Which components of a measure are the same for all admissible multipliers at every row; a bool of a scalar."""
        found = self.find(name)
        if found is None:
            raise KeyError(f"nothing measured is called {name!r}; {_check.closest(name, self.number)}")
        number, component = found
        values = self._evaluate(number, solution, solution.multipliers)
        same = np.ones(values.shape[1], dtype=bool)
        if self._core.measure_depends(number) == "accelerations":
            for shift in _shifts(self._core, solution):
                moved = self._evaluate(number, solution, solution.multipliers + shift)
                same &= np.abs(moved - values).max(axis=0, initial=0.0) < SAME
        same = same if component is None else same[component : component + 1]
        return bool(same[0]) if same.size == 1 else same

    def at(self, name: str, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """A measure of positions or velocities at one state."""
        number, component = self.find(name)
        found = self._core.measure_at(number, t, np.ascontiguousarray(p), np.ascontiguousarray(v))
        return _component(found["value"][None], component)[0]


def _component(values: np.ndarray, component: int | None) -> np.ndarray:
    if component is not None:
        return values[:, component]
    return values[:, 0] if values.shape[1] == 1 else values


def _acceleration(core: MechanismCore, solution: Any, row: int) -> np.ndarray:
    formulation = [card.name for card in _gateway.cards("formulations")].index(solution.settings["formulation"])
    p, v = np.ascontiguousarray(solution.p[row]), np.ascontiguousarray(solution.v[row])
    return _gateway.acceleration(core, formulation, 1, float(solution.t[row]), p, v)[0]


def _shifts(core: MechanismCore, solution: Any) -> list[np.ndarray]:
    """Multipliers (k, m) that act on nothing: a basis of them at each row, filled up with zeros where there are fewer."""
    bases = []
    for t, p, v in zip(solution.t, solution.p, solution.v, strict=True):
        C = core.evaluate(float(t), np.ascontiguousarray(p), np.ascontiguousarray(v)).get("C")
        if C is None:
            return []
        u, s, _ = np.linalg.svd(C)
        bases.append(u[:, int((s > DEPENDENT * s.max(initial=0.0)).sum()):].T)
    most = max((len(basis) for basis in bases), default=0)
    filled = [np.vstack([basis, np.zeros((most - len(basis), core.m))]) for basis in bases]
    return [np.array([basis[i] for basis in filled]) for i in range(most)]
