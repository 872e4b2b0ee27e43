"""User functions of a mechanism as the programs of a block: expressions, profiles and tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .._private.gateway.mechanisms.blocks import FUNCTIONS, OPERATIONS
from ..errors import WrongValue
from ..laws.table import Table
from ..mechanisms.equations import function_calls, function_programs
from ..symbolics.graph.lowering import Lowering

Instruction = tuple[float, float, float, float]


class Programs:
    """Programs of user functions, and the splines that they refer to.

    Attributes
    ----------
    laws, instructions, splines, knots : list of float
        Sections of a block.
    """

    def __init__(self) -> None:
        self.laws: list[float] = []
        self.instructions: list[float] = []
        self.splines: list[float] = []
        self.knots: list[float] = []

    def add(self, row: function_calls.Call, k: int, results: int) -> None:
        """Add the program of a user function of k marker quantities."""
        table = row.law._function
        program = self._of_table(row, table, k) if isinstance(table, Table) else _Program(*_nodes(row, k)).instructions
        self._append(program, k, results)

    def _append(self, program: list[Instruction], k: int, results: int) -> None:
        self.laws += [len(self.instructions) // 4, len(program), k, results]
        self.instructions += [number for instruction in program for number in instruction]

    def add_speed(self, number: int) -> int:
        """Index of a new law: the drive xdot - speed(t) = 0, whose speed is an input, value + rate (t - begin)."""
        program = _Instructions()
        value, rate, begin = (program.add("input", number, part) for part in range(3))
        elapsed = program.add("-", program.add("t"), begin)
        speed = program.add("+", value, program.add("*", rate, elapsed))
        results = [program.add("number", 0.0), program.add("number", 1.0), program.add("negative", speed),
                   program.add("negative", rate)]
        self._append(program.with_results(results), 1, 4)
        return len(self.laws) // 4 - 1

    def _of_table(self, row: function_calls.Call, table: Table, k: int) -> list[Instruction]:
        """Program of a table: its value, or the constraint that prescribes it."""
        spline, program = self._spline(table), _Instructions()
        rate = program.add("number", 1.0)
        if row.picks:
            (place, is_rate), = row.picks
            at = program.add("v" if is_rate else "p", place)
            rate = program.add("v", place)
        else:
            at = program.add("t")
        value, first, second = (program.add("spline", spline, at, order) for order in range(3))
        zero, one = program.add("number", 0.0), program.add("number", 1.0)
        if isinstance(row, function_calls.ForceLaw):
            results = [value]
        elif isinstance(row, function_calls.Motion):
            results = [program.add("-", program.add("p", 0), value), one, program.add("negative", first),
                       program.add("negative", second)]
        elif isinstance(row, function_calls.Speed):
            slope = program.add("*", first, rate)
            results = [zero, one, *[zero] * (k - 1), program.add("negative", value), program.add("negative", slope)]
        else:
            raise WrongValue(f"{row.law.what} is a table in a constraint, which a block cannot hold: give an expression of SymPy",
                             "not-portable")
        return program.with_results(results)

    def _spline(self, table: Table) -> int:
        pieces = [*zip(table.x[:-1], *table.coefficients, strict=True), (table.x[-1], 0.0, 0.0, 0.0, 0.0)]
        self.splines += [len(self.knots) // 5, len(pieces)]
        self.knots += [float(number) for piece in pieces for number in piece]
        return len(self.splines) // 2 - 1


class _Instructions:
    """Instructions, each of which computes one value."""

    def __init__(self) -> None:
        self.instructions: list[Instruction] = []

    def add(self, code: str | int, a: float = 0.0, b: float = 0.0, c: float = 0.0) -> int:
        """Number of the value that the new instruction computes."""
        number = OPERATIONS[code] if isinstance(code, str) else code
        self.instructions.append((float(number), float(a), float(b), float(c)))
        return len(self.instructions) - 1

    def with_results(self, values: Sequence[int]) -> list[Instruction]:
        """All instructions, the results written at last."""
        for i, value in enumerate(values):
            self.add("result", i, value)
        return self.instructions


class _Program:
    """Program that computes nodes of a graph, by the operations of their compiled function."""

    def __init__(self, what: str, graph: Any, nodes: Sequence[Any], numbers: Sequence[float]) -> None:
        self._what, self._numbers, self._program = what, numbers, _Instructions()
        lowering = Lowering(graph)
        results = [lowering.lower(node) for node in nodes]
        needed = _needed(lowering, results)
        values: dict[int, int] = {}
        for number, operation in enumerate(lowering.operations):
            if number in needed:
                values[number] = self._add(operation.code, operation.arguments, values)
        self.instructions = self._program.with_results([values[each] for each in results])

    def _add(self, code: str, arguments: tuple[Any, ...], values: dict[int, int]) -> int:
        add = self._program.add
        if code == "number":
            return add("number", arguments[0])
        if code == "leaf":
            kind, index = arguments
            return add("number", self._numbers[index]) if kind == "parameter" else add(kind, index)
        if code in ("call", "comparison", "logic"):
            first, *operands = arguments
            operands = [values[each] for each in operands]
            return self._chained(first, operands) if code == "logic" else add(self._code(code, first), *operands)
        operands = [values[each] for each in arguments]
        return self._choice(operands) if code == "choice" else add(code, *operands)

    def _code(self, code: str, function: Any) -> int | str:
        if code == "comparison":
            return function
        found = FUNCTIONS.get(function.__name__)
        if found is None:
            raise WrongValue(f"{self._what} has the function {function.__name__}, which a block does not know; there are "
                             f"{', '.join(FUNCTIONS)}", "not-portable")
        return found

    def _chained(self, word: str, operands: list[int]) -> int:
        if word == "not":
            return self._program.add("not", *operands)
        total = operands[0]
        for operand in operands[1:]:
            total = self._program.add(word, total, operand)
        return total

    def _choice(self, operands: list[int]) -> int:
        *cases, total = operands
        for condition, value in reversed(list(zip(cases[::2], cases[1::2], strict=True))):
            total = self._program.add("choose", condition, value, total)
        return total


def _needed(lowering: Lowering, results: Sequence[int]) -> set[int]:
    """Operations on which the results depend."""
    needed = set(results)
    for number in range(len(lowering.operations) - 1, -1, -1):
        if number in needed:
            needed.update(lowering.operands(lowering.operations[number]))
    return needed


def _nodes(row: function_calls.Call, k: int) -> tuple[str, Any, Any, Any]:
    """Name, graph, nodes of the results, and values of the parameters of a user function."""
    if not row.law.has_nodes:
        raise WrongValue(f"{row.law.what} is a callable, which a block cannot hold: give a number, an expression of SymPy "
                         "or zd.table(x, y)", "not-portable")
    return row.law.what, *function_programs.nodes_of(row, k)
