"""Closed-form functions as programs that the core runs, where no code is compiled: csrc/laws/elimination.h.

They have the operations of the compiled functions, hence their bits: a product that is used once, in a sum, is one instruction
with it, which rounds once on vector units that can, and sines are those of zerodrift/lanes.h.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Container, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway.compiled import programs as compiled_programs
from ..._private.gateway.compiled.programs import END, FRAME, MINUS_TIMES, SINES, SINES_AT_ONCE, TIMES_MINUS, TIMES_PLUS
from ..._private.gateway.mechanisms.blocks import FUNCTIONS, OPERATIONS
from ..elimination.steps import Unwritten
from ..graph.blocks import Blocks
from ..graph.graph import FIXED
from ..graph.lowering import Lowering
from .closed_form_writer import Program
from .lane_writer import products_in_sums
from .writers import count_uses, turn_of

MAX_PLACES = 2**16
MAX_OPERATIONS = 2000       # of a function: with more of them, matrices take less time
PARTS = ("Phi",), ("dp",), ("dv",), ("pdot", "vdot"), ("lambda", "power"), ("pivots", "D")   # as in enum zd_found
LEFT_OUT = 1, 4, 5          # parts that a call may leave out, so that the others cannot rely on them
Instruction = tuple[int, int, int, int]


class Part(NamedTuple):
    """Instructions of a part of a function, the place of their first value in the frame, and the places of its results."""

    instructions: list[Instruction]
    first: int
    results: list[int]


class Programs(NamedTuple):
    """Programs of closed-form functions.

    Attributes
    ----------
    parameters : int
        Number of parameters, with which the constants begin.
    numbers : list of float
        Constants after them.
    fixed : list of tuple of int
        Instructions that append what follows from these alone.
    constants : int
        Number of all constants.
    functions : list of dict
        For each order, the parts of its functions.
    """

    parameters: int
    numbers: list[float]
    fixed: list[Instruction]
    constants: int
    functions: list[dict[str, list[Part]]]

    @property
    def instructions(self) -> int:
        """Instructions of a corrected step of "rk4", which accelerates three times and finishes once."""
        counts = {name: sum(len(part.instructions) for part in parts) for name, parts in self.functions[0].items()}
        last = counts.get("finish") or counts.get("embed") or counts["accelerate"]
        return 3 * counts.get("accelerate", last) + last


def programs(lowering: Lowering, functions: Sequence[dict[str, dict[str, list[int]]]], sizes: tuple[int, int, int, int],
             parameters: int, inputs: Container[int] = ()) -> Programs:
    """Programs of functions, which are as in `closed_form_writer.source`; `inputs` are parameters that are not constant.

    Raises
    ------
    Unwritten
        If they would be too long, or have a function that the core does not know.
    """
    wanted = [Program(lowering, outputs, {}) for of in functions for outputs in of.values() if outputs]
    if any(sum(each.users) > MAX_OPERATIONS for each in wanted):
        raise Unwritten(f"they would take more than {MAX_OPERATIONS} operations")
    operations = lowering.operations
    moved: set[int] = set()     # by inputs
    for number, (code, arguments, _) in enumerate(operations):
        if (code == "leaf" and arguments[0] == "parameter" and arguments[1] in inputs) or not moved.isdisjoint(
                lowering.operands(operations[number])):
            moved.add(number)
    fixed = [number for number in range(len(operations)) if operations[number].stage == FIXED
             and (number not in moved or operations[number].code == "leaf") and any(each.users[number] for each in wanted)]
    numbers = [number for number in fixed if operations[number].code == "number"]
    places = {number: operations[number].arguments[1] for number in fixed if operations[number].code == "leaf"}
    places |= {number: parameters + i for i, number in enumerate(numbers)}
    first = parameters + len(numbers)
    writer = _Writer(Program(lowering, {"constants": fixed}, {}), places, first)
    of_fixed = writer.part([], [number for number in fixed if number not in places])
    leaves = _places_of_leaves(writer.place, *sizes)
    return Programs(parameters, [operations[number].arguments[0] for number in numbers], of_fixed.instructions, writer.place,
                    [{name: _parts(lowering, outputs, writer.places, leaves) for name, outputs in of.items() if outputs}
                     for of in functions])


def _places_of_leaves(constants: int, nq: int, nv: int, mh: int, mn: int) -> dict[str, int]:
    """Places at which leaves of each kind begin in a frame; "values": those of instructions."""
    sizes = {"t": 1, "p": nq, "v": nv, "before": nv, "added": mh + mn, "values": 0}
    return dict(zip(sizes, (constants + int(each) for each in np.cumsum([0, *sizes.values()])), strict=False))


def _parts(lowering: Lowering, outputs: dict[str, list[int]], constants: dict[int, int], leaves: dict[str, int]) -> list[Part]:
    """Parts of one function, in the order of the core."""
    program = Program(lowering, outputs, constants)
    places = dict(constants)
    for number, (code, arguments, _) in enumerate(lowering.operations):
        if code == "leaf" and program.users[number] and number not in places:
            places[number] = leaves[arguments[0]] + arguments[1]
    writer = _Writer(program, places, leaves["values"])
    found = []
    for part, names in enumerate(PARTS):
        results = [number for name in names for number in outputs.get(name, ())]
        is_apart = part in LEFT_OUT and "vdot" in outputs
        known = dict(writer.places), dict(writer.turned)
        found.append(writer.part(results, program.needed([name for name in names if outputs.get(name)])))
        if is_apart:
            writer.places, writer.turned = known
    if writer.place > FRAME:
        raise Unwritten(f"they would take more than {FRAME} values")
    return found


class Expressions(NamedTuple):
    """Program of expressions: numbers that follow those given, instructions, and the places of the results."""

    literals: list[float]
    instructions: list[Instruction]
    results: list[int]
    numbers: int                # those given, and these
    terms: int
    rates: int
    frame: int                  # values


class Terms(NamedTuple):
    """Programs of the terms of a system: csrc/laws/terms.h.

    Attributes
    ----------
    literals : list of float
        Numbers that follow the parameters.
    groups : list of tuple
        Terms of which one must be wanted, the place of the first value, and instructions.
    results : dict
        Places of the entries of each term.
    frame : int
        Values.
    """

    literals: list[float]
    groups: list[tuple[list[str], int, list[Instruction]]]
    results: dict[str, list[int]]
    frame: int


def terms(blocks: Blocks, parameters: int, nq: int, nv: int) -> Terms:
    """Programs of terms of p and v.

    Raises
    ------
    Unwritten
        If they would be too long, or have a function that the core does not know.
    """
    literals, writer = _begun(Program(blocks.lowering, blocks.outputs, {}), parameters, nq, nv)
    groups = []
    for terms, operations in [(list(blocks.outputs), blocks.constants), *(
            (sorted(block.terms), block.operations) for block in [*blocks.kept, *blocks.shared, *blocks.own])]:
        part = writer.part([], operations)
        groups.append((terms, part.first, part.instructions))
    if writer.place > MAX_PLACES:
        raise Unwritten(f"they would take more than {MAX_PLACES} values")
    return Terms(literals, groups, {name: [writer.places[number] for number in numbers]
                                    for name, numbers in blocks.outputs.items()}, writer.place)


def expressions(lowering: Lowering, results: list[int], numbers: int, terms: int = 0, rates: int = 0) -> Expressions:
    """Program of expressions of so many parameters, t, and entries of p and v, as csrc/laws/program.h has them.

    Raises
    ------
    Unwritten
        If it would be too long, or has a function that the core does not know.
    """
    program = Program(lowering, {"results": results}, {})
    literals, writer = _begun(program, numbers, terms, rates)
    part = writer.part(results, program.needed(["results"]))
    if writer.place > FRAME:
        raise Unwritten(f"it would take more than {FRAME} values")
    return Expressions(literals, part.instructions, part.results, numbers + len(literals), terms, rates, writer.place)


def _begun(program: Program, numbers: int, nq: int, nv: int) -> tuple[list[float], _Writer]:
    """Literals of a frame with so many numbers before them, then t, p and v, and the writer of what follows."""
    used = [(number, *operation[:2]) for number, operation in enumerate(program.lowering.operations) if program.users[number]]
    literals = {number: arguments[0] for number, code, arguments in used if code == "number"}
    t = numbers + len(literals)
    begin = {"parameter": 0, "t": t, "p": t + 1, "v": t + 1 + nq}
    places = {number: begin[arguments[0]] + arguments[1] for number, code, arguments in used if code == "leaf"}
    places |= {number: numbers + i for i, number in enumerate(literals)}
    return [*literals.values()], _Writer(program, places, t + 1 + nq + nv)


def evaluator(lowering: Lowering, outputs: Mapping[Any, list[int]], parameters: np.ndarray,
              nq: int) -> Callable[[np.ndarray, np.ndarray], dict[str, np.ndarray]]:
    """A function of t (k,) and p (k, nq) that gives (k, size) of each output, which depends on no velocity."""
    written = expressions(lowering, [number for numbers in outputs.values() for number in numbers], len(parameters), nq)
    program = compiled_programs.expressions(written)
    ends = np.cumsum([len(numbers) for numbers in outputs.values()])

    def evaluate(t: np.ndarray, p: np.ndarray) -> dict[str, np.ndarray]:
        found = compiled_programs.reader(program, [*parameters, *written.literals], t, p, t[:0])()
        return dict(zip(outputs, np.split(found, ends[:-1], axis=1), strict=True))

    return evaluate


def reader(lowering: Lowering, results: list[int], parameters: np.ndarray, t: np.ndarray, p: np.ndarray,
           v: np.ndarray) -> Callable[[], np.ndarray] | None:
    """Function that returns values (k, results) at the present t (k,), p (k, nq) and v (k, nv); None without a program."""
    try:
        written = expressions(lowering, results, len(parameters), p.shape[1], v.shape[1])
    except Unwritten:
        return None
    return compiled_programs.reader(compiled_programs.expressions(written), [*parameters[:, 0], *written.literals], t, p, v)


class _Writer:
    """Writer of the parts of one function.

    Attributes
    ----------
    places : dict
        Places in the frame of operations that are known.
    turned : dict
        Places of sines and cosines, by "sine" or "cosine" and the operation of the angle.
    place : int
        The next place.
    """

    def __init__(self, program: Program, places: dict[int, int], place: int) -> None:
        self._lowering, self._operations = program.lowering, program.lowering.operations
        self._products = products_in_sums(program, count_uses(program))
        self.places, self.turned, self.place = places, dict[tuple[str, int], int](), place
        self._instructions: list[Instruction] = []

    def part(self, results: Sequence[int], needed: Sequence[int]) -> Part:
        """Part that computes those of the needed operations, in order, that are not known."""
        self._instructions, first = [], self.place
        new = [number for number in needed if number not in self.places]
        waves: dict[int, int] = {}      # how many sines are on the way to each
        for number in new:
            behind = [waves.get(operand, 0) for operand in self._lowering.operands(self._operations[number])]
            waves[number] = max(behind, default=0) + bool(self._turn(number))
        for wave in range(1 + max(waves.values(), default=0)):
            here = [number for number in new if waves[number] == wave]
            self._find_sines([number for number in here if self._turn(number)])
            for number in here:
                if number not in self.places and number not in self._products:
                    self.places[number] = self._of(*self._operations[number][:2])
        return Part([*self._instructions, (END, 0, 0, 0)], first, [self.places[number] for number in results])

    def _turn(self, number: int) -> str:
        """"sine" or "cosine", if the operation is one; otherwise ""."""
        code, arguments, _ = self._operations[number]
        return turn_of(arguments[0]) if code == "call" else ""

    def _find_sines(self, numbers: list[int]) -> None:
        angles = [self._operations[number].arguments[1] for number in numbers]
        new = [angle for angle in dict.fromkeys(angles) if ("sine", angle) not in self.turned]
        for begin in range(0, len(new), SINES_AT_ONCE):
            group = new[begin:begin + SINES_AT_ONCE]
            self._instructions += [(SINES, self.places[angle], len(group), 0) for angle in group]
            for i, angle in enumerate(group):
                self.turned["sine", angle], self.turned["cosine", angle] = self.place + i, self.place + len(group) + i
            self.place += 2 * len(group)
        self.places |= {number: self.turned[self._turn(number), angle] for number, angle in zip(numbers, angles, strict=True)}

    def _of(self, code: str, arguments: tuple[Any, ...]) -> int:
        """Place of the value of an operation that is written now."""
        if code in "+-" and (product := next((each for each in arguments[::-1] if each in self._products), None)) is not None:
            a, b = (self.places[factor] for factor in self._operations[product].arguments)
            other = arguments[0] if product == arguments[1] else arguments[1]
            fused = TIMES_PLUS if code == "+" else MINUS_TIMES if product == arguments[1] else TIMES_MINUS
            return self._write(fused, a, b, self.places[other])
        if code in ("call", "comparison", "logic"):
            first, *rest = arguments
            operands = [self.places[each] for each in rest]
            if code == "logic" and first != "not":
                return functools.reduce(lambda a, b: self._write(OPERATIONS[first], a, b), operands)
            return self._write(self._function(first) if code == "call" else OPERATIONS[first], *operands)
        operands = [self.places[each] for each in arguments]
        if code != "choice":
            return self._write(OPERATIONS[code], *operands)
        *cases, chosen = operands
        for condition, value in reversed(list(zip(cases[::2], cases[1::2], strict=True))):
            chosen = self._write(OPERATIONS["choose"], condition, value, chosen)
        return chosen

    def _function(self, function: Any) -> int:
        if function.__name__ not in FUNCTIONS:
            raise Unwritten(f"the core has no function {function.__name__}")
        return FUNCTIONS[function.__name__]

    def _write(self, code: int, a: int, b: int = 0, c: int = 0) -> int:
        self._instructions.append((code, a, b, c))
        self.place += 1
        return self.place - 1
