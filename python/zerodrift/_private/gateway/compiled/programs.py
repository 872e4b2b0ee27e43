"""Programs of closed-form functions as structures of the core: csrc/laws/elimination.h."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from ...core import ffi, lib
from ..base import TERMS, Variable, doubles
from .native import NativeCore

END, SINES, SINES_AT_ONCE, FRAME = lib.ZD_CODE_END, lib.ZD_CODE_SINES, lib.ZD_SINES_AT_ONCE, lib.ZD_FRAME
BEYOND = lib.ZD_BEYOND_ERROR, lib.ZD_BEYOND_CONTINUES, lib.ZD_BEYOND_REPEATS
TIMES_PLUS, TIMES_MINUS, MINUS_TIMES = lib.ZD_CODE_TIMES_PLUS, lib.ZD_CODE_TIMES_MINUS, lib.ZD_CODE_MINUS_TIMES


def constants(programs: Any, parameters: np.ndarray) -> np.ndarray:
    """Constants of programs: the parameters, numbers, and what follows from these alone."""
    given = [*parameters, *programs.numbers]
    found = np.array([*given, *[0.0] * (programs.constants - len(given))])
    values = doubles(found, found.size)
    lib.zd_program_run(_instructions(programs.fixed), values, values + len(given))
    found.flags.writeable = False
    return found


def closed_forms(programs: Any, orders: Sequence[Any], sizes: tuple[int, int, int, int], embeds: bool) -> tuple[Any, Any]:
    """A `zd_closed_form` for each vector unit and number of lanes, and what they refer to."""
    keep: list[Any] = []
    described = [_described(each, order, programs.constants, sizes, keep) for each, order in
                 zip(programs.functions, orders, strict=True)]
    sets = [lib.zd_closed_forms_by_programs[i] for i in range(lib.zd_sets_of_programs)]
    member = "embedding" if embeds else "order"
    rows = []
    for row in (row for row in sets if not embeds or row.embeddings):
        functions = getattr(row, member)[0]
        made = ffi.new("zd_elimination[]", len(orders))
        for i, (of, has_constraints) in enumerate(described):
            made[i] = of
            for name in ("accelerate", "correct", "finish", "embed"):
                if has_constraints or name in ("accelerate", "embed"):
                    setattr(made[i], name, getattr(functions, name))
        keep.append(made)
        rows.append({"unit": row.unit, "lanes": row.lanes, f"{member}s": len(orders), member: made})
    return ffi.new("zd_closed_form[]", rows), keep


def expressions(written: Any) -> tuple[Any, Any]:
    """A `zd_expressions`, as `symbolics.emit.program_writer.expressions` writes it, and what it refers to."""
    instructions, results = _instructions(written.instructions), ffi.new("uint16_t[]", written.results)
    made = ffi.new("zd_expressions *", (instructions, written.numbers, written.terms, written.rates, len(written.results),
                                        written.frame, results))
    return made, (instructions, results)


def reader(program: tuple[Any, Any], numbers: Sequence[float], *states: np.ndarray) -> Callable[[], np.ndarray]:
    """Function that returns values (k, results) of `expressions` at the present t (k,), x (k, terms) and xdot (k, rates)."""
    shape = len(states[0]), program[0].results
    arrays = [np.ascontiguousarray(each, dtype=float) for each in ([*numbers, 0.0], *states)]
    given, *memory = (doubles(each, each.size) for each in arrays)
    evaluate = partial(lib.zd_expressions_evaluate_all, program[0], given, shape[0], *memory)

    def read(keep: Any = program) -> np.ndarray:
        evaluate(ffi.from_buffer("double[]", out := np.empty(shape)))
        return out

    return read


class ProgramCore(NativeCore):
    """A system whose terms are programs, as `symbolics.emit.program_writer.terms` writes them, of parameters in `numbers`."""

    def __init__(self, written: Any, numbers: np.ndarray, sizes: tuple[int, int, int, int], variables: Iterable[Variable],
                 **further: Any) -> None:
        groups, results, keep = [], [], []
        for terms, first, instructions in written.groups:
            keep.append(_instructions(instructions))
            groups.append((sum(TERMS[name].bit for name in terms), first, keep[-1]))
        for name, places in written.results.items():
            keep.append(ffi.new("uint16_t[]", places))
            results.append((TERMS[name].bit, TERMS[name].offset, len(places), keep[-1]))
        literals, group, term = (ffi.new(f"{kind}[]", each) for kind, each in (
            ("double", written.literals), ("zd_term_group", groups), ("zd_term_results", results)))
        programs = ffi.new("zd_term_programs *", (len(numbers), len(literals), *sizes[:2], len(groups), len(results), literals,
                                                  group, term))
        address = int(ffi.cast("intptr_t", ffi.addressof(lib, "zd_terms_by_programs")))
        super().__init__(sizes, written.results, address, None, variables, scratch=written.frame,
                         keep=(keep, literals, group, term, programs), **further)
        self._programs = programs
        self._read(numbers)

    def _read(self, numbers: np.ndarray) -> None:
        """Sets the numbers that functions read, parameters first."""
        self.numbers, self._memory = numbers, doubles(numbers, numbers.size)
        self._given = ffi.new("zd_terms_data *", (self._memory, self._programs))
        self.c.data = self._given

    def with_numbers(self, numbers: np.ndarray) -> ProgramCore:
        """Copy of the system with other numbers."""
        other = copy.copy(self)
        other.c = ffi.new("zd_system *", self.c[0])
        other._read(numbers)
        return other

    def with_closed_forms(self, forms: Any, keep: Any, numbers: np.ndarray) -> ProgramCore:
        """Copy of the system with closed-form functions, a `zd_closed_form[]`, and the numbers that these read."""
        other = self.with_numbers(numbers)
        other.c.closed_form, other.c.closed_forms = forms, len(forms)
        other._data = (*self._data, forms, keep)
        return other

    @property
    def lane_numbers(self) -> Any:
        return self._memory if self.has_closed_form else None


def spline(knots: np.ndarray) -> Any:
    """A `zd_spline` of knots (n, 5), and what it refers to."""
    numbers = doubles(np.ravel(knots), knots.size)
    return ffi.new("zd_spline *", (len(knots), numbers)), numbers


def address(spline: Any) -> float:
    """The number that stands for a spline in a program."""
    return float(int(ffi.cast("uintptr_t", spline[0])))


def spline_at(address: float, x: float) -> list[float]:
    """Value and two derivatives at x of the spline that a number stands for."""
    return [lib.zd_operation(lib.ZD_CODE_SPLINE, address, x, order) for order in range(3)]


def with_addresses(numbers: np.ndarray, tables: Mapping[int, Any]) -> np.ndarray:
    """Copy of numbers with those that stand for tables, given by their places."""
    found = np.array(numbers, dtype=float)
    for place, each in tables.items():
        found[place] = each.address
    return found


def _described(functions: Any, order: Any, constants: int, sizes: tuple[int, int, int, int], keep: list[Any]) -> tuple[Any, bool]:
    """A `zd_elimination` without functions, and whether there are constraints."""
    nq, nv, mh, mn = sizes
    m = mh + mn
    program = ffi.new("zd_order_program *", {"nq": nq, "nv": nv, "mh": mh, "m": m, "constants": constants})
    for name, parts in functions.items():
        to = getattr(program, name)
        for i, part in enumerate(parts):
            instructions, results = _instructions(part.instructions), ffi.new("uint16_t[]", part.results or [0])
            keep += [instructions, results]
            to.part[i], to.first[i], to.result[i] = instructions, part.first, results
            program.frame = max(program.frame, part.first + 2 * len(part.instructions))     # sines are two values each
    last = functions["embed" if "embed" in functions else "accelerate"]
    program.pivots = len(order) + nv - m
    program.D = len(last[lib.ZD_FOUND_PIVOTS].results) - program.pivots
    program.pdot = len(last[lib.ZD_FOUND_RATES].results) - nv
    tables = [ffi.new("int[]", list(each) or [0]) for each in (
        (i for i, solve in enumerate(order) for _ in solve.rows), (row for solve in order for row in solve.rows),
        (column for solve in order for column in solve.columns))]
    keep += [program, tables]
    described = {"solves": len(order), "program": program}
    described |= dict(zip(("solve", "row", "column"), tables, strict=True))
    return ffi.new("zd_elimination *", described)[0], bool(order)


def _instructions(written: Any) -> Any:
    return ffi.new("zd_instruction[]", [tuple(each) for each in written])
