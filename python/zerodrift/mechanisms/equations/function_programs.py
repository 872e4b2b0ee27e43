"""User functions as programs, which the core runs without Python: all but callables.

Parameters and the decimal numbers of an expression are arguments: functions that differ in these alone are written once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway.compiled import programs
from ...symbolics.elimination.steps import Unwritten
from ...symbolics.emit import program_writer
from ...symbolics.graph.law_terms import Leaves
from ...symbolics.graph.lowering import Lowering
from ...symbolics.graph.plain_functions import Plain

Program = tuple[tuple[Any, Any], np.ndarray]        # a `zd_expressions` with what it refers to, and its numbers

_programs: dict[Any, program_writer.Expressions] = {}   # by template and names


class Written(NamedTuple):
    """A user function as a program, its numbers, and splines by the places of those that stand for them."""

    program: program_writer.Expressions
    numbers: list[float]
    splines: dict[int, Any]


def program(row: Any, k: int) -> Program | None:
    """User function of k marker quantities as a program; None if it is known to Python only."""
    if not row.law.has_nodes:
        return None
    try:
        written, numbers, tables = program_of(row, k)
    except (Unwritten, TypeError, ValueError):      # a function that has no counterpart in C
        return None
    made, keep = programs.expressions(written)
    return (made, (keep, tables)), programs.with_addresses(np.array(numbers), tables)


def program_of(row: Any, k: int) -> Written:
    """Program of a user function that is not a callable.

    Raises
    ------
    Unwritten, TypeError, ValueError
        If it has a function that the core does not know.
    """
    key, equations, numbers = _equations(row, k)
    found = None if key is None else _programs.get(key)
    nodes = () if found else equations.results(row)
    first = len(numbers)
    numbers += [0.0] * (len(equations.splines) or not numbers)      # there is one at least
    if found is None:
        lowering = Lowering(equations.graph)
        found = program_writer.expressions(lowering, [lowering.lower(node) for node in nodes], len(numbers), k, k)
        if key is not None:
            _programs[key] = found
    return Written(found, [*numbers, *found.literals], dict(enumerate(equations.splines, first)))


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
        self._read, self._template = reader.read, template
        self.graph = reader.graph
        own = [self.graph.leaf("parameter", i) for i in range(len(names) + numbers)]
        self._size, self.splines = len(own), list[Any]()        # splines: those of which the numbers are the last ones
        self.parameters = dict(zip(names, own, strict=False))
        self._numbers = {_number(i): leaf for i, leaf in enumerate(own[len(names):])}
        self.leaves = Leaves(self.graph, k)
        self.t = self.leaves.t

    def read(self, what: str, expression: Any, known: Mapping[Any, Any]) -> Any:
        """Node of an expression."""
        return self._read(what, self._template, {**known, **self._numbers})

    def spline(self, table: Any) -> Any:
        """Node of the number that stands for a table."""
        self.splines.append(table)
        return self.graph.leaf("parameter", self._size + len(self.splines) - 1)

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
