"""User functions as programs, which the core runs without Python: all but callables.

Parameters and the decimal numbers of an expression are arguments: functions that differ in these alone are written once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from ...symbolics.elimination.steps import Unwritten
from ...symbolics.emit import program_writer
from ...symbolics.graph.law_terms import Leaves
from ...symbolics.graph.lowering import Lowering
from ...symbolics.graph.plain_functions import Plain

Program = tuple[tuple[Any, Any], np.ndarray]        # a `zd_expressions` with what it refers to, and its numbers

_graphs: dict[Any, tuple[Any, Any]] = {}            # graphs with the nodes of results, by template and names
_programs: dict[Any, tuple[Any, list[float]] | None] = {}   # with the literals of each; None: the core lacks a function


def program(row: Any, k: int) -> Program | None:
    """User function of k marker quantities as a program; None if it is known to Python only."""
    if not row.law.has_nodes:
        return None
    key, equations, numbers = _equations(row, k)
    if key is None or key not in _programs:
        try:
            made = _made(equations.graph, equations.results(row), len(numbers), k)
        except (Unwritten, TypeError, ValueError):      # a function that has no counterpart in C
            made = None
        if key is None:
            return made and (made[0], np.array([*numbers, *made[1]], dtype=float))
        _programs[key] = made
    found = _programs[key]
    return found and (found[0], np.array([*numbers, *found[1]], dtype=float))


def _made(graph: Any, results: Sequence[Any], numbers: int, k: int) -> tuple[Any, list[float]]:
    lowering = Lowering(graph)
    return program_writer.expressions(lowering, [lowering.lower(node) for node in results], numbers, k, k)


def nodes_of(row: Any, k: int) -> tuple[Any, Any, list[float]]:
    """Graph and nodes of a user function that is not a callable, and its numbers."""
    key, equations, numbers = _equations(row, k)
    if key is None:
        return equations.graph, equations.results(row), numbers
    if key not in _graphs:
        _graphs[key] = equations.graph, equations.results(row)
    return *_graphs[key], numbers


def _equations(row: Any, k: int) -> tuple[Any, Any, list[float]]:
    """Key by which functions of equal nodes share a program, None: they do not; equations, and the numbers."""
    law = row.law
    if law.inner_expression is None:
        numbers = row.law.numbers if law.input is not None else row.parameters
        return None, _Equations(Plain(), list(numbers), k), [float(each) for each in numbers.values()]
    from ...symbolics.graph.from_sympy import Reader  # slow to import, as it imports SymPy

    template, numbers = _without_numbers(law.inner_expression)
    names = tuple(sorted(name for name in row.parameters if name in law.names))
    return ((type(row), law.kind, template, row.picks, names, k), _Equations(Reader(), names, k, template, len(numbers)),
            [*(float(row.parameters[name]) for name in names), *numbers])


class _Equations:
    """Equations into which a user function is written: `read` takes its one expression; decimal numbers follow the parameters."""

    def __init__(self, reader: Any, names: Sequence[str], k: int, template: Any = None, numbers: int = 0) -> None:
        self.functions, self._template = reader, template
        self.graph = reader.graph
        own = [self.graph.leaf("parameter", i) for i in range(len(names) + numbers)]
        self.parameters = dict(zip(names, own, strict=False))
        self._numbers = {_number(i): leaf for i, leaf in enumerate(own[len(names):])}
        self.leaves = Leaves(self.graph, k)
        self.t = self.leaves.t

    def read(self, what: str, expression: Any, known: Mapping[Any, Any]) -> Any:
        """Node of an expression."""
        return self.functions.read(what, self._template, {**known, **self._numbers})

    def difference(self, a: Any, b: Any) -> Any:
        """Node of a - b."""
        return self.graph.plus(a, self.graph.minus(b))

    def results(self, row: Any) -> Any:
        """Nodes of what the user function gives."""
        return row.said(self.leaves, row.written(self, self.leaves.x, self.leaves.xdot))


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
