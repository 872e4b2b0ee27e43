"""User functions of a mechanism as the programs of a block: expressions, profiles and tables."""

from __future__ import annotations

from ..errors import WrongValue
from ..mechanisms.elements.user_functions import InputLaw
from ..mechanisms.equations import function_calls, function_programs
from ..symbolics.elimination.steps import Unwritten


class Programs:
    """Programs of user functions, their numbers, and the splines that they refer to.

    Attributes
    ----------
    laws, instructions, results, numbers, splines, knots : list of float
        Sections of a block.
    """

    def __init__(self) -> None:
        self.laws: list[float] = []
        self.instructions: list[float] = []
        self.results: list[float] = []
        self.numbers: list[float] = []
        self.splines: list[float] = []
        self.knots: list[float] = []

    def add(self, row: function_calls.Call, k: int) -> None:
        """Add the program of a user function of k marker quantities."""
        row.law.check_written()
        try:
            program, numbers, tables = function_programs.program_of(row, k)
        except Unwritten as reason:
            raise WrongValue(f"{row.law.what} cannot be held by a block: {reason}", "not-portable") from None
        for place, table in tables.items():
            numbers[place] = len(self.splines) // 2
            self.splines += [len(self.knots) // 5, len(table.knots)]
            self.knots += table.knots.ravel().tolist()
        self.laws += [len(self.instructions) // 4, len(program.instructions), k, len(self.results), len(program.results),
                      len(self.numbers), len(numbers)]
        self.instructions += [number for instruction in program.instructions for number in instruction]
        self.results += program.results
        self.numbers += numbers

    def add_speed(self, name: str) -> int:
        """Index of a new law: the drive xdot - speed(t) = 0, whose speed is an input."""
        self.add(function_calls.Speed(InputLaw(name, 0.0, is_speed=True), (), {}), 1)
        return len(self.laws) // 7 - 1
