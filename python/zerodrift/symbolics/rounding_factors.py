"""Programs whose arguments and terms are multiplied by factors near 1, to measure the effect of rounding."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

NUMBERS = "*(const double *const *)data"    # where the parameters and factors of such a system are: see zd_perturbation


def perturbed(program: dict[str, Any], shapes: Mapping[str, tuple[int, ...]], parameters: int) -> dict[str, Any]:
    """Program with its factors as additional parameters, concatenated arrays of these shapes.

    `shapes` has "t", "p", "v", and the terms that have factors.
    """
    sizes = [int(np.prod(shape)) for shape in shapes.values()]
    first = dict(zip(shapes, parameters + np.cumsum([0, *sizes[:-1]]), strict=True))
    made = _Perturbed(program["operations"], {name: int(place) for name, place in first.items()})
    terms = {name: [made.entry(name, place, number) for place, number in enumerate(numbers)]
             for name, numbers in program["terms"].items()}
    return program | {"operations": made.operations, "terms": terms}


class _Perturbed:
    """Operations of a program, each leaf and each entry of a term multiplied by its factor."""

    def __init__(self, operations: list[list[Any]], first: dict[str, int]) -> None:
        self.operations: list[list[Any]] = []
        self._first, self._at = first, dict[int, Any]()
        for number, (code, *arguments) in enumerate(operations):
            self._at[number] = self._translated(code, arguments)

    def _emit(self, *operation: Any) -> int:
        self.operations.append(list(operation))
        return len(self.operations) - 1

    def _translated(self, code: str, arguments: list[Any]) -> int:
        if code == "leaf" and arguments[0] in self._first:
            place = arguments[1] if len(arguments) > 1 else 0
            return self._times(self._emit(code, *arguments), self._first[arguments[0]] + place)
        if code in ("leaf", "number"):
            return self._emit(code, *arguments)
        names = 1 if code in ("call", "comparison", "logic") else 0
        return self._emit(code, *arguments[:names], *(self._at[number] for number in arguments[names:]))

    def _times(self, number: int, factor: int) -> int:
        return self._emit("*", self._emit("leaf", "parameter", factor), number)

    def entry(self, name: str, place: int, number: int) -> int:
        """Entry of a term times its factor; structural zeros stay zero."""
        mine = self._at[number]
        if name not in self._first or (self.operations[mine][0] == "number" and self.operations[mine][1] == 0):
            return mine
        return self._times(mine, self._first[name] + place)
