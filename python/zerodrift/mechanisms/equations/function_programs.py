"""User functions as programs, which the core runs without Python: all but callables.

Parameters are arguments: functions that differ in these alone are written once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway.compiled import programs
from ...laws.formula import Formula
from ...symbolics.elimination.steps import Unwritten
from ...symbolics.emit import program_writer
from ...symbolics.graph.law_terms import Leaves
from ...symbolics.graph.lowering import Lowering
from ...symbolics.graph.plain_functions import Plain

Program = tuple[tuple[Any, Any], np.ndarray]        # a `zd_expressions` with what it refers to, and its numbers

_programs: dict[Any, program_writer.Expressions] = {}   # by formula and names


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
    law, own = row.law, row.numbers
    key = None if law.formula is None else (type(row), row.sign, law.formula, law.names, row.picks, tuple(own), k)
    equations, numbers = _Equations(list(own), k), [float(each) for each in own.values()]
    found = _programs.get(key)
    nodes = () if found else equations.results(row)
    first = len(numbers)
    splines = list(dict.fromkeys(law.tables))       # in the order in which they are first read, each once
    numbers += [0.0] * (len(splines) or not numbers)      # there is one at least
    if found is None:
        lowering = Lowering(equations.graph)
        found = program_writer.expressions(lowering, [lowering.lower(node) for node in nodes], len(numbers), k, k)
        if key is not None:
            _programs[key] = found
    return Written(found, [*numbers, *found.literals], dict(enumerate(splines, first)))


class Differences(NamedTuple):
    """Differences of the sides of comparisons at which a user function jumps."""

    program: Program
    places: list[int]           # among the numbers of the user function, of those that hold the comparisons


def differences(row: Any, k: int, formulas: Mapping[str, Formula]) -> Differences:
    """Differences in a user function of k marker quantities, by the names of the numbers that hold them."""
    own = row.numbers
    equations = _Equations([*own], k)
    lowering = Lowering(equations.graph)
    nodes = [lowering.lower(row.node(row.law.of_formula(each), equations, equations.leaves.x, equations.leaves.xdot))
             for each in formulas.values()]
    found = program_writer.expressions(lowering, nodes, len(own), k, k)
    return Differences((programs.expressions(found), np.array([*map(float, own.values()), *found.literals])),
                       [[*own].index(name) for name in formulas])


class _Equations:
    """Equations into which a user function is written; numbers that stand for tables follow the parameters."""

    def __init__(self, names: Sequence[str], k: int) -> None:
        self.graph = Plain().graph
        self.parameters = {name: self.graph.leaf("parameter", i) for i, name in enumerate(names)}
        self.leaves = Leaves(self.graph, k)
        self.t, self._splines = self.leaves.t, list[Any]()

    def spline(self, table: Any) -> Any:
        """Node of the number that stands for a table."""
        self._splines += [table] * (table not in self._splines)
        return self.graph.leaf("parameter", len(self.parameters) + self._splines.index(table))

    def difference(self, a: Any, b: Any) -> Any:
        """Node of a - b."""
        return self.graph.plus(a, self.graph.minus(b))

    def results(self, row: Any) -> Any:
        """Nodes of what the user function gives."""
        return row.said(self.leaves, row.written(self, self.leaves.x, self.leaves.xdot))
