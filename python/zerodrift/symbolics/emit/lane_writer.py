"""Writer of C source that serves one trajectory or several in SIMD lanes: see csrc/include/zerodrift/lanes.h."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..graph.lowering import Operation
from .writers import LONGEST, CWriter, unwrapped

REAL, CONDITION = "const zd_real ", "const zd_condition "
CONDITIONS = ("comparison", "logic")
# The bits of zerodrift/units.h: sets of functions of a vector unit, for so many trajectories at once
SETS = {(0, 1): "ZD_SET_BASELINE_1", (0, 2): "ZD_SET_BASELINE_2", (1, 1): "ZD_SET_AVX2_1", (1, 4): "ZD_SET_AVX2_4",
        (2, 1): "ZD_SET_AVX512_1", (2, 8): "ZD_SET_AVX512_8"}


def products_in_sums(program: Any, uses: Sequence[int]) -> set[int]:
    """Products of a program that are used once, in a sum, which are one instruction with it; one of each sum."""
    operations, found = program.lowering.operations, set()
    for number, (code, arguments, _) in enumerate(operations):
        if code in ("+", "-") and program.users[number]:
            found |= {*[each for each in arguments[::-1] if operations[each].code == "*" and uses[each] == 1
                        and each not in program.stored][:1]}
    return found


class LaneWriter(CWriter):
    """Statements of one function that are the same for any unit and number of lanes.

    A product that is used once, in a sum, becomes one fused multiply-add on vector units that have it. This class decides which
    products do, so that the bits do not depend on the compiler.
    """

    words = CWriter.words | {"and": "ZD_BOTH", "or": "ZD_EITHER", "root": "ZD_SQRT"}
    turns = ("const zd_real angle{0}[ZD_PADDED({1})] = {{{2}}};", "zd_real sine{0}[ZD_PADDED({1})], cosine{0}[ZD_PADDED({1})];",
             "ZD_SINES({1}, angle{0}, sine{0}, cosine{0});")

    def __init__(self, blocks: Any) -> None:
        super().__init__(blocks)
        self._in_sums = products_in_sums(blocks, self._uses)
        self._factors: dict[int, tuple[str, str]] = {}      # of these

    def statements(self, numbers: list[int], name: Callable[[int], str], declare: str = REAL) -> list[str]:
        lines: list[str] = []
        for number in self.ordered(numbers, lines):
            operation = self.operations[number]
            if number in self.turned:
                self.names[number] = self.turned[number]
            elif operation.code in ("call", "power"):
                lines += self._call_in_each_lane(operation, name(number))
                self.names[number] = name(number)
            else:
                lines += self._statement(number, operation, name(number))
        return lines

    def _statement(self, number: int, operation: Operation, name: str) -> list[str]:
        text = self.expression(operation)
        if number in self._in_sums:
            a, b = (unwrapped(self.value(factor)) for factor in operation.arguments)
            self._factors[number] = a, b
            return []
        if self._uses[number] == 1 and len(text) < LONGEST:
            self.names[number] = text
            return []
        self.names[number] = name
        return [f"{CONDITION if operation.code in CONDITIONS else REAL}{name} = {unwrapped(text)};"]

    def _call_in_each_lane(self, operation: Operation, name: str) -> list[str]:
        """Call of a C library function in each lane in turn."""
        arguments = operation.arguments[operation.code == "call":]
        before = [f"const zd_real {name}_{i} = {self.number_everywhere(argument)};" for i, argument in enumerate(arguments)]
        values = [f"ZD_LANE({name}_{i}, lane)" for i in range(len(arguments))]
        value = self.named("power", *values) if operation.code == "power" else self.call(operation.arguments[0], values)
        return [*before, f"zd_real {name};",
                f"for (int lane = 0; lane < ZD_LANES; lane++) ZD_LANE({name}, lane) = {unwrapped(value)};"]

    def number_everywhere(self, number: int) -> str:
        """Value broadcast to all lanes if it is a scalar."""
        text = unwrapped(self.value(number))
        return f"ZD_SPLAT({text})" if self.operations[number].code == "number" else text

    def expression(self, operation: Operation) -> str:
        if operation.code not in ("+", "-"):
            return super().expression(operation)
        a, b = operation.arguments
        product, other = (b, a) if b in self._factors else (a, b)
        if product not in self._factors:
            return super().expression(operation)
        name = "ZD_FMA" if operation.code == "+" else "ZD_FNMA" if product == b else "ZD_FMS"
        return f"{name}({', '.join(self._factors[product])}, {unwrapped(self.value(other))})"

    def choice(self, cases: list[tuple[str, str]], otherwise: str) -> str:
        for condition, value in reversed(cases):
            otherwise = f"ZD_WHERE({condition}, {value}, {otherwise})"
        return otherwise

    def logic(self, word: str, parts: list[str]) -> str:
        if word == "not":
            return f"ZD_NOT({parts[0]})"
        text = parts[0]
        for part in parts[1:]:
            text = f"{self.words[word]}({text}, {part})"
        return text

    def value(self, number: int) -> str:
        """Text of an operation's value; conditions on parameters are stored as numbers."""
        text = super().value(number)
        is_kept = number in self.blocks.stored and self.operations[number].code in CONDITIONS
        return f"({text} != 0)" if is_kept else text

    def _entries(self, term: str, numbers: list[int]) -> list[str]:
        return [f"{term}[{i}] = {self.number_everywhere(number)};" for i, number in enumerate(numbers)]


def for_each_set(lines: Callable[[int, int], list[str]]) -> list[str]:
    """Lines for each compiled set of functions, given its vector unit and number of lanes."""
    return [line for (unit, lanes), name in SETS.items() for line in (f"#if (ZD_SETS) & {name}", *lines(unit, lanes), "#endif")]
