"""Large programs as C in functions of bounded length.

All values are in two arrays, constants after the parameters and the rest in the scratch of an evaluation, so that a function can
end between any two statements, and nothing is on the stack. Statements that are alike are loops: see `rolling`.
"""

from __future__ import annotations

from ..graph.blocks import Blocks
from .loops import element, number, plain, rolled
from .writers import LONGEST, CWriter, indented, turn_of, unwrapped, wanted

MAX_STATEMENTS = 400       # of one function: compilers take the square of it; a run with loops takes 0.96 to 1.06 of one without
FEWEST_STATEMENTS = 8       # statements alike that are worth a loop
PIECE = 250                 # of one function of a large program
ARGUMENTS = "const double *restrict k, double t, const double *restrict p, const double *restrict v,"
PIECES = ["#if defined(__GNUC__)", "#define PIECE static __attribute__((noinline)) void",     # or they are made one again
          "#else", "#define PIECE static void", "#endif", ""]


def source(blocks: Blocks, heading: list[str], parameters: int, data: str = "data") -> tuple[str, int, int]:
    """The C source, the number of constants it computes from the parameters, and of doubles it keeps.

    `data` is C for the doubles of a system.
    """
    written = CWriter(blocks).source(heading, parameters, data)
    is_large = written[0].count(";\n") > MAX_STATEMENTS
    return LargeWriter(blocks).source(heading, parameters, data) if is_large else written


class LargeWriter(CWriter):
    """Writer of C99 in functions of bounded length."""

    def __init__(self, blocks: Blocks) -> None:
        super().__init__(blocks)
        self._array = "k"
        self._ends = {"k": 0, "s": 1}       # where the next value of an array goes; which blocks are known is in s[0]
        self._pieces: list[str] = []

    def _new(self, count: int = 1) -> int:
        """Index of the first of `count` new values in the current array."""
        first = self._ends[self._array]
        self._ends[self._array] += count
        return first

    def leaf(self, kind: str, index: int) -> str:
        return "t" if kind == "t" else element({"parameter": "k"}.get(kind, kind), index)

    def number(self, value: float) -> str:
        return number(super().number(value))

    def statements(self, numbers: list[int], name: object = None, declare: str = "") -> list[str]:
        lines: list[str] = []
        for operation in self.ordered(numbers, lines):
            if operation in self.turned:
                self.names[operation] = self.turned[operation]
                continue
            text = self.expression(self.operations[operation])
            if self._uses[operation] == 1 and operation not in self.blocks.stored and len(text) < LONGEST:
                self.names[operation] = text
                continue
            self.names[operation] = element(self._array, self._new())
            lines.append(f"{self.names[operation]} = {unwrapped(text)};")
        return lines

    def _turns(self, numbers: list[int]) -> list[str]:
        angles = list(dict.fromkeys(self.operations[turn].arguments[1] for turn in numbers))
        array, count = self._array, len(angles)
        angle, sine, cosine = (self._new(count) for _ in range(3))
        place = {each: i for i, each in enumerate(angles)}
        for turn in numbers:
            function, of = self.operations[turn].arguments
            first = sine if turn_of(function) == "sine" else cosine
            self.turned[turn] = element(array, first + place[of])
        given = [f"{element(array, angle + i)} = {unwrapped(self.value(each))};" for i, each in enumerate(angles)]
        return [*given, f"zd_sines({count}, {array} + {angle}, {array} + {sine}, {array} + {cosine});"]

    def source(self, heading: list[str], parameters: int, data: str = "data") -> tuple[str, int, int]:
        self._ends["k"] = parameters
        constants = self._calls(self.statements(self.blocks.constants), "constants", "double *restrict k", "k")
        self._array = "s"
        body = [*self._kept(), *self._shared(), *self._own()]
        text = self.text(heading, [*PIECES, *self._pieces], constants, [
            f"const double *restrict const k = {data};", "double *restrict const s = out->scratch;",
            "unsigned known = want & ZD_MOVED ? 0 : (unsigned)s[0];", *body])
        return text, self._ends["k"] - parameters, self._ends["s"]

    def _calls(self, statements: list[str], name: str, takes: str, given: str) -> list[str]:
        """Statements moved to functions of bounded length; returns their calls."""
        items, calls = rolled(statements, FEWEST_STATEMENTS), []
        for i in range(0, len(items), PIECE):
            function = f"{name}_{i // PIECE}"
            lines = [line for item in items[i : i + PIECE] for line in item.splitlines()]
            self._pieces += [f"PIECE {function}({takes})", "{", *indented(lines), "}", ""]
            calls.append(f"{function}({given});")
        return calls

    def _evaluated(self, statements: list[str], name: str) -> list[str]:
        return self._calls(statements, name, f"{ARGUMENTS} double *restrict s", "k, t, p, v, s")

    def _kept(self) -> list[str]:
        lines = []
        for group, block in enumerate(self.blocks.kept):
            lines += [f"if ((want & {wanted(block.terms)}) && !(known & {1 << group}u)) {{",
                      *indented(self._evaluated(self.statements(block.operations), f"kept_{group}")),
                      f"    known |= {1 << group}u;", "}"]
        return [*lines, "s[0] = known;"]

    def _shared(self) -> list[str]:
        lines = []
        for i, block in enumerate(self.blocks.shared):
            calls = self._evaluated(self.statements(block.operations), f"shared_{i}")
            lines += [f"if (want & {wanted(block.terms)}) {{", *indented(calls), "}"]
        return lines

    def _own_entries(self, term: str, statements: list[str], entries: list[str]) -> list[str]:
        return self._calls([*statements, *entries], f"of_{term}", f"{ARGUMENTS} double *restrict s, double *restrict {term}",
                           f"k, t, p, v, s, out->{term}")

    def entry(self, term: str, place: int) -> str:
        return element(term, place)

    def is_zero(self, value: str) -> bool:
        return plain(value) == "0.0"
