"""Closed-form functions written from the operations of a system's terms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..elimination import pivot_orders
from ..elimination.cramer import elimination
from ..elimination.steps import Elimination
from ..graph.lowering import Lowering
from ..graph.plain_functions import NAMED, Function, Plain
from ..graph.reemit import restored
from . import closed_form_writer, program_writer
from .closed_form_writer import Bounded
from .writers import mathematics

TERMS = ("A", "M", "d", "f", "Phi", "C", "Phi_t", "xi", "power")    # those that they follow from
HEADING = ["/* Written by zerodrift.symbolic. */", "#include <zerodrift/sines.h>", "#include <zerodrift/system.h>",
           "#include <zerodrift/units.h>"]
VERSION = ["", "const int zd_interface_version = ZD_INTERFACE_VERSION;"]


def as_json(lowering: Lowering, outputs: dict[str, list[int]]) -> dict[str, Any] | str:
    """Program as JSON; or the reason why it cannot be stored: too large for closed-form functions, or functions other than
    SymPy's.
    """
    if len(lowering.operations) > closed_form_writer.MAX_OPERATIONS:
        return closed_form_writer.TOO_LARGE
    operations = []
    for code, arguments, _ in lowering.operations:
        if code == "call":
            name = arguments[0].__name__
            if not isinstance(arguments[0], Function) and getattr(_sympy(), name, None) is not arguments[0]:
                return f"SymPy has no function {name}"
            arguments = (name, *arguments[1:])
        operations.append([code, *arguments])
    return {"operations": operations, "terms": {name: outputs[name] for name in TERMS if name in outputs},
            "exact": {number: fraction for number, fraction in lowering.exact.items() if fraction}}


def _projecting(of: Elimination) -> dict[str, dict[str, list[int]]]:
    """Outputs of an elimination order for formulations in dependent velocities."""
    return {"accelerate": of.accelerations()} | ({"correct": of.corrections(), "finish": of.landing()} if of.order else {})


def _embedding(of: Elimination) -> dict[str, dict[str, list[int]]]:
    """Outputs of an elimination order for formulations in independent velocities."""
    return ({"correct": of.corrections()} if of.order else {}) | {"embed": of.embedding()}


def _function(name: str) -> Any:
    """Function of that name; one that is independent of SymPy is preferred."""
    return NAMED.get(name) or getattr(_sympy(), name)


def _sympy() -> Any:
    import sympy

    return sympy


def write(program: dict[str, Any], sizes: tuple[int, int, int, int], parameters: np.ndarray, p0: np.ndarray | None,
          lengths: np.ndarray, *, offset: int, symbol: str, embeds: Sequence[bool] = (False,), heading: list[str] | None = None,
          file: str = "system.c", lanes_header: str = "<zerodrift/lanes.h>", data: str = "data") -> tuple[str, int]:
    """The C source and its number of constants; raises `Unwritten` where no order serves, or there are too many operations.

    They are for formulations in dependent velocities, or in independent ones where that is among `embeds`.
    """
    lowering, functions, eliminations = eliminated(program, sizes, parameters, p0, lengths, embeds)
    return closed_form_writer.source(lowering, functions, eliminations, offset=offset, symbol=symbol,
                                  heading=heading or [*HEADING, mathematics(lowering.operations), *VERSION], file=file,
                                  lanes_header=lanes_header, data=data)


def eliminated(program: dict[str, Any], sizes: tuple[int, int, int, int], parameters: np.ndarray, p0: np.ndarray | None,
               lengths: np.ndarray, embeds: Sequence[bool] = (False,)) -> tuple[
                   Lowering, list[dict[str, dict[str, list[int]]]], list[Elimination]]:
    """Operations, the outputs of the functions of each order, and the orders; raises `Unwritten` where no order serves."""
    lowering = Bounded(Plain().graph)
    terms = restored(lowering, program["operations"], program["terms"], _function)
    needed = {name: terms[name] for name in ("A", "Phi", "C") if name in terms}
    evaluate = program_writer.evaluator(lowering, needed, parameters, sizes[0])
    eliminations, functions = [], []
    for embedding in embeds:
        chosen = pivot_orders.choose(evaluate, sizes, p0, lengths, embedding)
        found = [elimination(lowering, terms, sizes, order) for order in chosen]
        functions += [(_embedding if embedding else _projecting)(each) for each in found]
        eliminations += found
    return lowering, functions, eliminations
