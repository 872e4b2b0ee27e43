"""User functions that are SymPy expressions, compiled, so that the core calls them without Python.

Parameters and the decimal numbers of an expression are arguments: functions that differ in these alone are compiled once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from ...errors import CompilationFailed

Compiled = tuple[int, np.ndarray, Any]      # address of a function, its numbers, and the library that contains it

_functions: dict[Any, tuple[int, Any] | None] = {}      # by template and names; None if C has no counterpart

_graphs: dict[Any, tuple[Any, Any]] = {}        # and graphs with the nodes of their results


def compiled(row: Any, k: int) -> Compiled | None:
    """Compiled user function of k marker quantities; None if it has no expression, or if there is no compiler."""
    if row.law.input is not None:
        return row.law.compiled
    expression = row.law.inner_expression
    if expression is None:
        return None
    template, numbers = _without_numbers(expression)
    names = names_of(row)
    key = type(row), row.law.kind, template, row.picks, names, k
    if key not in _functions:
        try:
            found = _Equations(template, names, len(numbers), k).function_of(row)
        except CompilationFailed:       # the function is called in Python instead, which is slower
            return None
        except (TypeError, ValueError):
            found = None
        else:
            if found is None:       # not stored, as a compiler may be installed later
                return None
        _functions[key] = found
    function = _functions[key]
    return function and (function[0], np.array([*(row.parameters[name] for name in names), *numbers], dtype=float), function[1])


def names_of(row: Any) -> tuple[str, ...]:
    """Names of the parameters that a user function reads, in the order of its numbers."""
    return tuple(sorted(name for name in row.parameters if name in row.law.names))


def nodes_of(row: Any, k: int) -> tuple[Any, Any, list[float]]:
    """Graph and nodes of a user function that has an expression, as they are compiled, and the values of its parameters."""
    template, numbers = _without_numbers(row.law.inner_expression)
    names = names_of(row)
    key = type(row), row.law.kind, template, row.picks, names, k
    if key not in _graphs:
        equations = _Equations(template, names, len(numbers), k)
        _graphs[key] = equations.graph, equations.results(row)
    return *_graphs[key], [*(float(row.parameters[name]) for name in names), *numbers]


class _Equations:
    """Equations into which a user function is written: `reads` its one expression; decimal numbers follow the parameters."""

    def __init__(self, template: Any, names: Sequence[str], numbers: int, k: int) -> None:
        from ...symbolics.compile.law_terms import Leaves
        from ...symbolics.graph.from_sympy import Reader  # slow to import, as it imports SymPy

        self._reader, self._template = Reader(), template
        self.graph = self._reader.graph
        own = [self.graph.leaf("parameter", i) for i in range(len(names) + numbers)]
        self.parameters = dict(zip(names, own, strict=False))
        self._numbers = {_number(i): leaf for i, leaf in enumerate(own[len(names):])}
        self.leaves = Leaves(self.graph, k)
        self.t = self.leaves.t

    def read(self, what: str, expression: Any, known: Mapping[Any, Any]) -> Any:
        """Node of an expression."""
        return self._reader.read(what, self._template, {**known, **self._numbers})

    def difference(self, a: Any, b: Any) -> Any:
        """Node of a - b."""
        return self.graph.plus(a, self.graph.minus(b))

    def results(self, row: Any) -> Any:
        """Nodes of what the user function gives."""
        return row.said(self.leaves, row.written(self, self.leaves.x, self.leaves.xdot))

    def function_of(self, row: Any) -> tuple[int, Any] | None:
        """Compiled function, or None without a compiler."""
        from ...symbolics.compile import law_terms

        return law_terms.compiled(self.graph, self.results(row))


def _without_numbers(expression: Any) -> tuple[Any, list[float]]:
    """Expression with a symbol for each decimal number, and these numbers; exponents stay, as C has roots but not such powers."""
    import sympy

    exponents = {power.exp for power in expression.atoms(sympy.Pow)}
    parts = dict.fromkeys(sympy.preorder_traversal(expression))     # this order hardly depends on the numbers
    numbers = [each for each in parts if each.is_Float and each not in exponents]
    return expression.xreplace({each: _number(i) for i, each in enumerate(numbers)}), [float(each) for each in numbers]


@cache
def _number(i: int) -> Any:
    """Symbol in the place of a number."""
    import sympy

    return sympy.Symbol(f"number {i}", real=True)
