"""Programs as C in the core's interface."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

from ..._private.gateway import TERMS
from ..graph.lowering import Operation
from ..graph.plain_functions import SPLINE, Function

MANY = 16           # entries that are zero
LONGEST = 100       # characters of an expression that is written in place
MATH, WITH_SPLINE = "#include <math.h>", "#include <zerodrift/spline.h>"      # which has the former
# Which takes a compiler as long as a tenth of a small system: of most systems these are all that is needed of it.
WITHOUT_MATH = "double fabs(double), sqrt(double);"
TURNS = {"sin": "sine", "cos": "cosine"}    # what the core has functions of its own for, and its array of them


def count_uses(program: Any) -> list[int]:
    """Number of times that each operation of a program is an operand or an output."""
    uses = [0] * len(program.lowering.operations)
    for number, operation in enumerate(program.lowering.operations):
        if program.users[number]:
            for argument in program.lowering.operands(operation):
                uses[argument] += 1
    for numbers in program.outputs.values():
        for number in numbers:
            uses[number] += 1
    return uses


def turn_of(function: Any) -> str:
    """Name of the core's array of sines or cosines, for sin and cos; "" for others, a user's sin too."""
    return TURNS.get(function.__name__, "") if isinstance(function, Function) else ""


def mathematics(operations: Iterable[Operation]) -> str:
    """Include line of the C library functions that these operations call."""
    def is_called(operation: Operation) -> bool:
        code, (first, *_) = operation.code, operation.arguments
        return code == "power" or (code == "call" and not turn_of(first)) or (code == "number" and not math.isfinite(first))

    has_spline = any(operation.code == "call" and operation.arguments[0] is SPLINE for operation in operations)
    return WITH_SPLINE if has_spline else MATH if any(map(is_called, operations)) else WITHOUT_MATH


@cache
def _printer() -> Any:
    """SymPy's printer of C: only functions of expressions need it."""
    from sympy.printing.c import C99CodePrinter

    return C99CodePrinter({"strict": False})


def unwrapped(text: str) -> str:
    """Expression without its outer parentheses."""
    if not text.startswith("("):
        return text
    depth = 0
    for i, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if depth == 0:
            return text[1:-1] if i == len(text) - 1 else text
    return text


class CWriter:
    """C99, one function in the core's interface, with the core's own sines."""

    words = {"and": "&&", "or": "||", "not": "!", "root": "sqrt", "power": "pow"}
    turns = ("const double angle{0}[{1}] = {{{2}}};", "double sine{0}[{1}], cosine{0}[{1}];",
             "zd_sines({1}, angle{0}, sine{0}, cosine{0});")

    def __init__(self, blocks: Any) -> None:
        """Program of a schedule, `Blocks`, or of one function."""
        self.blocks, self.operations = blocks, blocks.lowering.operations
        self.names: dict[int, str] = {}
        self.turned: dict[int, str] = {}        # sines and cosines that are computed already, and what they are called
        self._uses = count_uses(blocks)

    def value(self, number: int) -> str:
        """C of an operation's value: its name, or its expression if it is used only once."""
        operation = self.operations[number]
        if operation.code == "leaf":
            return self.leaf(*operation.arguments)
        if operation.code == "number":
            return self.number(operation.arguments[0])
        return self.names[number]

    def statements(self, numbers: list[int], name: Callable[[int], str], declare: str) -> list[str]:
        """Assignments of the operations of a block that are not written in place."""
        lines: list[str] = []
        for number in self.ordered(numbers, lines):
            text = self.turned.get(number) or self.expression(self.operations[number])
            stored = number in self.blocks.stored
            in_place = bool(declare) if number in self.turned else self._uses[number] == 1     # arrays end with their block
            if in_place and not stored and len(text) < LONGEST:
                self.names[number] = text
                continue
            self.names[number] = name(number)
            lines.append(f"{'' if stored else declare}{self.names[number]} = {unwrapped(text)};")
        return lines

    def expression(self, operation: Operation) -> str:
        """An operation as an expression, in parentheses where these may be needed."""
        code, arguments = operation.code, operation.arguments
        if code == "call":
            return self.call(arguments[0], [unwrapped(self.value(argument)) for argument in arguments[1:]])
        if code == "comparison":
            return f"({self.value(arguments[1])} {arguments[0]} {self.value(arguments[2])})"
        if code == "logic":
            return self.logic(arguments[0], [self.value(argument) for argument in arguments[1:]])
        values = [self.value(argument) for argument in arguments]
        if code == "choice":
            return self.choice(list(zip(values[:-1:2], values[1:-1:2], strict=True)), values[-1])
        if code in "+-*/":
            return self.binary(code, *values)
        return {"negative": f"(-{values[0]})"}.get(code) or self.named(code, *map(unwrapped, values))

    def leaf(self, kind: str, index: int) -> str:
        return {"parameter": f"k[{index}]", "t": "t"}.get(kind, f"{kind}{index}")

    def binary(self, sign: str, a: str, b: str) -> str:
        return f"({a} {sign} {b})"

    def named(self, code: str, *values: str) -> str:
        return f"{self.words.get(code, code)}({', '.join(values)})"

    def choice(self, cases: list[tuple[str, str]], otherwise: str) -> str:
        before = "".join(f"{condition} ? {value} : " for condition, value in cases)
        return f"({before}{otherwise})"

    def logic(self, word: str, parts: list[str]) -> str:
        said = self.words.get(word, word)
        return f"({said}{parts[0]})" if word == "not" else f"({f' {said} '.join(parts)})"

    def call(self, function: Any, values: list[str]) -> str:
        """Function call, printed by SymPy; its arguments are names and expressions of this writer."""
        if isinstance(function, Function):
            return f"{function.in_c}({', '.join(values)})"
        from sympy import Symbol

        return _printer().doprint(function(*(Symbol(value, real=True) for value in values), evaluate=False))

    def ordered(self, numbers: list[int], lines: list[str]) -> Iterable[int]:
        """Operations of a block in order; sines and cosines are postponed until needed and then computed together."""
        while numbers:
            turns, later, waiting = [], [], set[int]()
            for number in numbers:
                operation = self.operations[number]
                if not waiting.isdisjoint(self.blocks.lowering.operands(operation)):
                    later.append(number)
                    waiting.add(number)
                elif operation.code == "call" and turn_of(operation.arguments[0]):
                    turns.append(number)
                    waiting.add(number)
                else:
                    yield number
            if turns:
                lines += self._turns(turns)
            yield from turns
            numbers = later

    def _turns(self, numbers: list[int]) -> list[str]:
        """Statements that put the sines and cosines of all angles into arrays."""
        angles = list(dict.fromkeys(self.operations[number].arguments[1] for number in numbers))
        first, count = numbers[0], len(angles)
        for number in numbers:
            function, angle = self.operations[number].arguments
            self.turned[number] = f"{turn_of(function)}{first}[{angles.index(angle)}]"
        values = ", ".join(map(self.number_everywhere, angles))
        return [statement.format(first, count, values) for statement in self.turns]

    def number_everywhere(self, number: int) -> str:
        return unwrapped(self.value(number))

    def number(self, value: float) -> str:
        if not math.isfinite(value):
            return "NAN" if math.isnan(value) else "INFINITY" if value > 0 else "(-INFINITY)"
        return repr(value) if value >= 0 else f"({value!r})"

    def source(self, heading: list[str], parameters: int, data: str = "data") -> tuple[str, int, int]:
        """The C source, the number of constants it computes from the parameters, and of doubles it keeps.

        `data` is C for the doubles of a system.
        """
        blocks = self.blocks
        places = blocks.stored
        count = sum(number in places for number in blocks.constants)

        def constant(number: int) -> str:
            return f"k[{parameters + places[number]}]" if number in places else f"x{number}"

        constants = self.statements(blocks.constants, constant, "const double ")
        body = self._kept() + self._shared() + self._own()
        scratch = sum(number in places for block in blocks.kept for number in block.operations)
        text = self.text(heading, [], constants, [*self._locals(data), *body])
        return text, count, scratch + bool(blocks.kept)

    def text(self, heading: list[str], functions: list[str], constants: list[str], body: list[str]) -> str:
        """C source assembled from its parts."""
        return "\n".join([
            "/* Written by zerodrift.symbolic.", *(f" * {comment(line)}" for line in heading), " */",
            "#include <string.h>", "#include <zerodrift/sines.h>", "#include <zerodrift/system.h>", mathematics(self.operations),
            "", "const int zd_interface_version = ZD_INTERFACE_VERSION;", "", *functions,
            "/* Constants computed from the parameters alone, stored after them. */",
            "void zd_symbolic_constants(double *k)", "{", *indented(constants or ["(void)k;"]), "}", "",
            "int zd_symbolic_evaluate(const void *data, int want, double t, const double *restrict p, const double *restrict v,",
            "                         const zd_terms *out)",
            "{", *indented([*body, "return ZD_DONE;"]), "}", ""])

    def _locals(self, data: str) -> list[str]:
        used = {(operation.arguments[0], operation.arguments[1]) for number, operation in enumerate(self.operations)
                if operation.code == "leaf" and self.blocks.users[number]}
        lines = [f"const double *restrict const k = {data};", "(void)k, (void)t, (void)p, (void)v;"]
        for kind in "pv":
            indices = sorted(index for leaf, index in used if leaf == kind)
            if indices:
                lines.append("const double " + ", ".join(f"{kind}{i} = {kind}[{i}]" for i in indices) + ";")
        return lines

    def _kept(self) -> list[str]:
        if not self.blocks.kept:
            return []
        places = self.blocks.stored
        lines = ["double *restrict const s = out->scratch;", "unsigned known = want & ZD_MOVED ? 0 : (unsigned)s[0];"]
        for group, block in enumerate(self.blocks.kept):
            def name(number: int) -> str:
                return f"s[{1 + places[number]}]" if number in places else f"x{number}"

            lines += [f"if ((want & {wanted(block.terms)}) && !(known & {1 << group}u)) {{",
                      *indented(self.statements(block.operations, name, "const double ")), f"    known |= {1 << group}u;", "}"]
        return [*lines, "s[0] = known;"]

    def _shared(self) -> list[str]:
        declared, lines = [], []
        for block in self.blocks.shared:
            statements = self.statements(block.operations, "x{}".format, "")
            declared += [f"x{number}" for number in block.operations if self.names[number] == f"x{number}"]
            lines += [f"if (want & {wanted(block.terms)}) {{", *indented(statements), "}"]
        return [f"double {', '.join(declared)};", *lines] if declared else []

    def _own(self) -> list[str]:
        lines, blocks = [], {next(iter(block.terms)): block for block in self.blocks.own}
        for term, numbers in self.blocks.outputs.items():
            block = blocks.get(term)
            statements = self.statements(block.operations, "x{}".format, "const double ") if block else []
            entries = self._own_entries(term, statements, self._entries(term, numbers))
            lines += [f"if (want & {TERMS[term].symbol}) {{", *indented(entries), "}"]
        return lines

    def _own_entries(self, term: str, statements: list[str], entries: list[str]) -> list[str]:
        return [f"double *restrict const {term} = out->{term};", *statements, *entries]

    def _entries(self, term: str, numbers: list[int]) -> list[str]:
        """Assignments to the array of a term; where most are zero, all are set to zero first."""
        values = [unwrapped(self.value(number)) for number in numbers]
        zeros = sum(map(self.is_zero, values))
        sparse = zeros > MANY and 2 * zeros > len(values)
        head = [f"memset({term}, 0, {len(values)} * sizeof *{term});"] if sparse else []
        return head + [f"{self.entry(term, i)} = {value};" for i, value in enumerate(values)
                       if not (sparse and self.is_zero(value))]

    def entry(self, term: str, place: int) -> str:
        """An entry of a term."""
        return f"{term}[{place}]"

    def is_zero(self, value: str) -> bool:
        """True if the text of a value is that of zero."""
        return value == "0.0"


def wanted(terms: frozenset[str]) -> str:
    bits = [term.symbol for name, term in TERMS.items() if name in terms]
    return bits[0] if len(bits) == 1 else f"({' | '.join(bits)})"


def indented(lines: list[str]) -> list[str]:
    return [f"    {line}" for line in lines]


def comment(text: str) -> str:
    """A line that cannot end the comment it stands in."""
    return json.dumps(text)[1:-1].replace("*/", "* /").replace("/*", "/ *")
