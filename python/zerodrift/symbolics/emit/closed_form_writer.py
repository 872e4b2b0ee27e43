"""Closed-form functions as C in the core's interface: accelerations and corrections for each elimination order."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from ..elimination.steps import Elimination, Order, Unwritten
from ..graph.graph import FIXED
from ..graph.lowering import SIMPLE, Lowering
from .lane_writer import LaneWriter, for_each_set
from .writers import CWriter, indented

MAX_OPERATIONS = 4000      # of the functions of one order
TOO_LARGE = f"they would take more than {MAX_OPERATIONS} operations"
MAX_STATEMENTS = 1000      # of one function
AT = ("ZD_ON_UNIT static int ZD_NAMED({name})(const zd_elimination *self, const void *data, const double *at_inputs,"
      " const double *at_time, const double *at_p,")
ACCELERATE = (AT, "    const double *at_v, const double *with_added, double *to_pdot, double *to_vdot, double *to_lambda,",
              "    double *to_power, double *to_pivots)")
CORRECT = (AT, "    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)")
FINISH = (AT, "    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,",
          "    double *to_lambda, double *to_power, double *to_pivots)")
OPTIONAL = ("lambda", "power"), ("pivots", "D")     # outputs that may not be wanted, those together that share something
EMBED = (AT, "    double *to_v, const double *with_added, const double *where_allowed, double *to_Phi, double *to_dp,",
         "    double *to_D, double *to_pdot, double *to_vdot, double *to_lambda, double *to_power, double *to_pivots)")
EQUATIONS = {"Phi": "(3)", "dp": "(25a), (26a), (27a)", "dv": "(25b), (26b), (27b)", "pdot": "(1)", "vdot": "(17)", "D": "(16)",
             "lambda": "(8)", "power": "(28)"}      # of outputs; with independent velocities, these:
EQUATIONS_OF_EMBED = EQUATIONS | {"dp": "(18)", "dv": "(14), (16)"}
HEADS = {"accelerate": ACCELERATE, "correct": CORRECT, "finish": FINISH, "embed": EMBED}
FOR_ONE = "finish", "embed"     # of several trajectories, some may have to be iterated and others not


class Bounded(Lowering):
    """List of operations of bounded length; raises `Unwritten` beyond."""

    most = 8 * MAX_OPERATIONS      # of all orders together, and of what no function needs

    def emit(self, code: str, *arguments: Any) -> int:
        if len(self.operations) > self.most:
            raise Unwritten(TOO_LARGE)
        return super().emit(code, *arguments)


@dataclass
class Program:
    """Program of one function for a writer: its operations, and those whose values are stored with the parameters."""

    lowering: Lowering
    outputs: dict[str, list[int]]
    stored: dict[int, int]
    users: list[bool] = field(init=False)

    def __post_init__(self) -> None:
        self.users = [False] * len(self.lowering.operations)
        for number in self.needed(self.outputs):
            self.users[number] = True

    def needed(self, names: Iterable[str]) -> list[int]:
        """Operations that these outputs depend on, in order, except stored ones and the operands of these."""
        found, waiting = set[int](), [number for name in names for number in self.outputs[name]]
        while waiting:
            number = waiting.pop()
            if number in found:
                continue
            found.add(number)
            if number not in self.stored:
                waiting += self.lowering.operands(self.lowering.operations[number])
        return sorted(found)


def source(lowering: Lowering, functions: list[dict[str, dict[str, list[int]]]], eliminations: list[Elimination], *, offset: int,
           symbol: str, heading: list[str], file: str, lanes_header: str, data: str) -> tuple[str, int]:
    """C source and the number of its constants, which are stored after the first `offset` doubles.

    `functions` has, for each order, the outputs of "accelerate", "correct" and "finish", or of "correct" and "embed"; `data` is C
    for the doubles of a system, `file` what the source is called, which it includes again for each vector unit, and
    `lanes_header` where it finds zerodrift/lanes.h.
    """
    stored, orders = _constants(lowering, functions), [each.order for each in eliminations]
    outside = [heading[0], "#ifndef ZD_LANES", *heading[1:], "", *_constants_function(lowering, stored, offset, symbol), "",
               *_solves(orders)]
    inside = [f"#include {lanes_header}"]
    for i, of in enumerate(functions):
        for name, head in HEADS.items():
            if of.get(name):
                signature = [line.format(name=f"{name}_{i}") for line in head]
                program = Program(lowering, of[name], stored)
                lines = (_finishing if name in FOR_ONE else _function)(program, signature, offset, data)
                inside += ["", *(["#if ZD_LANES == 1", *lines, "#endif"] if "embed" in of or name in FOR_ONE else lines)]
    embed = [i for i, of in enumerate(functions) if "embed" in of]
    others = [i for i in range(len(functions)) if i not in embed]
    inside += ["", *_table(orders, others), *_embedding_table(orders, embed)]
    sets = for_each_set(lambda unit, lanes: [f"#define ZD_UNIT {unit}", f"#define ZD_LANES {lanes}", f'#include "{file}"'])

    def counted(name: str, numbers: list[int], unit: int, lanes: int) -> str:
        return f"{len(numbers)}, {name}_{unit}_{lanes}" if numbers and (lanes == 1 or name == "orders") else "0, NULL"

    rows = for_each_set(lambda unit, lanes: [f"    {{{unit}, {lanes}, {counted('orders', others, unit, lanes)}, "
                                             f"{counted('embeddings', embed, unit, lanes)}}},"])
    return "\n".join([*outside, "", "/* The functions below, for each vector unit. */", *sets, "",
                      f"const zd_closed_form {symbol}[] = {{", *rows, "};", "",
                      "#else", *inside, "", "#undef ZD_UNIT", "#undef ZD_LANES", "#endif", ""]), len(stored)


def _constants(lowering: Lowering, functions: list[dict[str, dict[str, list[int]]]]) -> dict[int, int]:
    """Operations on parameters alone that functions need, and where each is stored."""
    found: list[int] = []
    for outputs in (each for of in functions for each in of.values() if each):
        program = Program(lowering, outputs, {})
        needed = program.needed(outputs)
        if len(needed) > MAX_OPERATIONS:
            raise Unwritten(TOO_LARGE)
        outside = {number for numbers in outputs.values() for number in numbers}
        for number in needed:
            operation = lowering.operations[number]
            if operation.stage > FIXED:
                outside.update(lowering.operands(operation))
        found += [number for number in needed if number in outside and _is_constant(lowering, number)]
    return {number: place for place, number in enumerate(dict.fromkeys(found))}


def _is_constant(lowering: Lowering, number: int) -> bool:
    return lowering.operations[number].stage == FIXED and lowering.operations[number].code not in SIMPLE


def _constants_function(lowering: Lowering, stored: dict[int, int], offset: int, symbol: str) -> list[str]:
    program = Program(lowering, {"constants": list(stored)}, {})
    numbers = [number for number in program.needed(program.outputs) if lowering.operations[number].code not in SIMPLE]
    program.stored = stored     # from here on: each is assigned to, once
    writer = CWriter(program)

    def name(number: int) -> str:
        return f"k[{offset + stored[number]}]" if number in stored else f"x{number}"

    body = writer.statements(numbers, name, "const double ")
    return ["/* Constants computed from the parameters alone, stored after them. */", f"void {symbol}_constants(double *k)", "{",
            *indented(body or ["(void)k;"]), "}"]


def _equations(program: Program, names: Iterable[str]) -> list[str]:
    """A comment that cites the equations of these outputs."""
    of = EQUATIONS_OF_EMBED if "D" in program.outputs else EQUATIONS
    cited = [f"{name} {of[name]}" for name in names if name in of and program.outputs.get(name)]
    return [f"/* {'; '.join(cited)} */"] if cited else []


def _writer(program: Program, offset: int) -> LaneWriter:
    writer = LaneWriter(program)
    writer.names |= {number: f"k[{offset + place}]" for number, place in program.stored.items()}
    return writer


def _function(program: Program, head: list[str], offset: int, data: str) -> list[str]:
    writer = _writer(program, offset)
    first = [name for name in program.outputs if name not in (*OPTIONAL[0], *OPTIONAL[1])]
    done = program.needed(first)
    body = [*_equations(program, first), *_statements(writer, done)]
    body += [line for name in first for line in writer._entries(name, program.outputs[name])]
    body += _optional(program, writer, done)
    return _whole(head, [*_locals(program, data), *body])


def _whole(head: list[str], body: list[str]) -> list[str]:
    if sum(not line.lstrip().startswith("/*") for line in body) > MAX_STATEMENTS:
        raise Unwritten(f"a function would have more than {MAX_STATEMENTS} statements")
    return [*head, "{", *indented([*body, "return ZD_DONE;"]), "}"]


def _optional(program: Program, writer: LaneWriter, done: list[int]) -> list[str]:
    """Statements that store optional outputs, each inside a check of its pointer."""
    body = []
    for group in OPTIONAL:
        names = [name for name in group if program.outputs.get(name)]
        if names:
            more = _statements(writer, _without(program.needed(names), done))
            entries = [line if len(names) == 1 else f"if ({name}) {line}"
                       for name in names for line in writer._entries(name, program.outputs[name])]
            body += [*_equations(program, names), f"if ({' || '.join(names)}) {{", *indented([*more, *entries]), "}"]
    return body


def _finishing(program: Program, head: list[str], offset: int, data: str) -> list[str]:
    """Statements of `finish`: Phi first; if it is small, velocities are corrected and accelerations computed with them."""
    writer, outputs, lowering = _writer(program, offset), program.outputs, program.lowering
    done = program.needed(["Phi"])
    body = _equations(program, ["Phi"]) + _statements(writer, done) + writer._entries("Phi", outputs["Phi"])
    if outputs["Phi"]:
        aside = _apart(program, writer, done, ["dp"])
        large = " || ".join(f"!(fabs(Phi[{k}]) <= allowed[{k}])" for k in range(len(outputs["Phi"])))
        body += [f"if ({large}) {{", *indented([*_equations(program, ["dp"]), *aside, "return ZD_NO_CONVERGENCE;"]), "}"]
    more = _further(program, writer, done, ["dv"])
    velocities = [writer.value(number) for number in outputs["dv"]]
    is_kept = [lowering.operations[number].code == "number" for number in outputs["dv"]]    # which is then zero
    body += [*_equations(program, ["dv"]), *more, *(f"const zd_real v{i} = before{i}{'' if kept else f' - {value}'};"
                      for i, (value, kept) in enumerate(zip(velocities, is_kept, strict=True)))]
    rest = [name for name in ("pdot", "vdot") if outputs.get(name)]
    body += [*_equations(program, rest), *_further(program, writer, done, rest)]
    body += [f"v[{i}] = v{i};" for i in range(len(velocities))]
    body += [line for name in rest for line in writer._entries(name, outputs[name])] + _optional(program, writer, done)
    return _whole(head, [*_locals(program, data), *body])


def _further(program: Program, writer: LaneWriter, done: list[int], names: list[str]) -> list[str]:
    """Statements of the operations that these outputs need and that are not yet computed; marks them as computed."""
    more = _without(program.needed(names), done)
    done += more
    return _statements(writer, more)


def _apart(program: Program, writer: LaneWriter, done: list[int], names: list[str]) -> list[str]:
    """The same statements in a C block of their own, whose values are not visible after it."""
    known, turned = dict(writer.names), dict(writer.turned)
    lines = _further(program, writer, list(done), names)
    entries = [line for name in names for line in writer._entries(name, program.outputs[name])]
    writer.names, writer.turned = known, turned
    return lines + entries


def _without(numbers: list[int], done: list[int]) -> list[int]:
    known = set(done)
    return [number for number in numbers if number not in known]


def _statements(writer: LaneWriter, numbers: list[int]) -> list[str]:
    operations, stored = writer.operations, writer.blocks.stored
    return writer.statements([number for number in numbers if operations[number].code not in SIMPLE and number not in stored],
                             "x{}".format)


def _locals(program: Program, data: str) -> list[str]:
    used = [operation.arguments for number, operation in enumerate(program.lowering.operations)
            if operation.code == "leaf" and program.users[number]]
    finishes, embeds = ("Phi" in program.outputs and name in program.outputs for name in ("vdot", "D"))
    inputs = {"k": f"({data})", "input": "at_inputs", "time": "at_time", "p": "at_p"}
    inputs |= {"allowed": "where_allowed"} if finishes else {"v": "at_v"}
    if "vdot" in program.outputs and (embeds or not finishes):
        inputs["added"] = "with_added"
    outputs = ["v"] * finishes + ["Phi", "dp"] * ("Phi" in program.outputs) + ["D"] * embeds + (
        ["pdot", "vdot", "lambda", "power", "pivots"] if "vdot" in program.outputs else ["dv"])
    lines = [f"const zd_stored *restrict const {name} = (const zd_stored *){of};" for name, of in inputs.items()]
    lines += [f"zd_stored *restrict const {name} = (zd_stored *)to_{name};" for name in outputs]
    lines += ["const zd_real t = *time;", f"{', '.join(f'(void){name}' for name in ('self', 't', *inputs, *outputs))};"]
    for kind, value in (("p", "p[{0}]"), ("before" if finishes else "v", "v[{0}]"),
                        ("added", "added ? (zd_real)added[{0}] : ZD_SPLAT(0.0)")):
        indices = (range(len(program.outputs["dv"])) if kind == "before" else
                   sorted(index for leaf, index in used if leaf == kind))
        if indices:
            lines.append("const zd_real " + ", ".join(f"{kind}{i} = {value.format(i)}" for i in indices) + ";")
    return lines


def _solves(orders: list[Order]) -> list[str]:
    """C tables of the rows and velocities of each solve, for each order."""
    lines = []
    for i, order in enumerate(orders):
        columns = {"solve": [a for a, solve in enumerate(order) for _ in solve.rows],
                   "row": [row for solve in order for row in solve.rows], "column": [j for solve in order for j in solve.columns]}
        lines += [f"static const int {name}_{i}[] = {{{', '.join(map(str, values or [0]))}}};"
                  for name, values in columns.items()]
    return lines


def _table(orders: list[Order], numbers: list[int]) -> list[str]:
    """The descriptors of one set: in lanes there is no finish()."""
    if not numbers:
        return []
    lines = ["#if ZD_LANES == 1", "#define ZD_FINISH(name) ZD_NAMED(name)", "#else", "#define ZD_FINISH(name) NULL", "#endif",
             "static const zd_elimination ZD_NAMED(orders)[] = {"]
    lines += [f"    {_head(orders, i)}, ZD_NAMED(accelerate_{i}), "
              f"{f'ZD_NAMED(correct_{i}), ZD_FINISH(finish_{i})' if orders[i] else 'NULL, NULL'}, NULL, NULL}}," for i in numbers]
    return [*lines, "};", "#undef ZD_FINISH"]


def _embedding_table(orders: list[Order], numbers: list[int]) -> list[str]:
    """Descriptors of the orders for formulations in independent velocities."""
    lines = [f"    {_head(orders, i)}, NULL, {f'ZD_NAMED(correct_{i})' if orders[i] else 'NULL'}, NULL, ZD_NAMED(embed_{i}),"
             " NULL},"
             for i in numbers]
    head = ["#if ZD_LANES == 1", "static const zd_elimination ZD_NAMED(embeddings)[] = {"]
    return [*head, *lines, "};", "#endif"] if lines else []


def _head(orders: list[Order], i: int) -> str:
    return f"{{{len(orders[i])}, solve_{i}, row_{i}, column_{i}"
