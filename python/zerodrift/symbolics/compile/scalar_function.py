"""A scalar expression compiled to a C function, which the core evaluates without Python."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ... import _gateway
from ..emit.writers import CWriter, indented, unwrapped
from ..graph.from_sympy import Reader
from ..graph.lowering import SIMPLE, Lowering
from . import shared_library

SYMBOL = "zd_symbolic_number"
HEADING = ["/* Written by zerodrift. */", "#include <math.h>", "#include <zerodrift/sines.h>", "#include <zerodrift/system.h>",
           "", "const int zd_interface_version = ZD_INTERFACE_VERSION;", ""]


class Program:
    """Program for a `CWriter`: all of its operations are needed, and none is stored between calls."""

    def __init__(self, lowering: Lowering, results: Sequence[int]) -> None:
        self.lowering, self.outputs, self.stored = lowering, {"results": list(results)}, dict[int, int]()
        self.users = [True] * len(lowering.operations)


def compiled(what: str, expression: Any, atoms: Sequence[Any]) -> tuple[int, Any] | None:
    """The address of ``double (*)(const double *)``, a function of the atoms' values, and what it lives in; None: no compiler.

    Raises
    ------
    ValueError
        If there is anything else in the expression, or a function that C does not have; `what` it is, is named.
    """
    key = expression, *atoms
    if key not in _compiled:
        reader = Reader()
        node = reader.read(what, expression, {atom: reader.graph.leaf("parameter", i) for i, atom in enumerate(atoms)})
        library = shared_library.library(_source(Lowering(reader.graph), node), symbols=(SYMBOL,))
        if library is None:
            return None
        _compiled[key] = _gateway.address_of(library, SYMBOL), library
    return _compiled[key]


_compiled: dict[tuple[Any, ...], tuple[int, Any]] = {}     # by expression and atoms: reading takes as long as a short run


def computed(writer: CWriter) -> list[str]:
    """The statements of all operations."""
    numbers = [number for number, operation in enumerate(writer.operations) if operation.code not in SIMPLE]
    return writer.statements(numbers, "x{}".format, "const double ")


def _source(lowering: Lowering, node: Any) -> str:
    result = lowering.lower(node)
    writer = CWriter(Program(lowering, [result]))
    body = ["(void)k;", *computed(writer), f"return {unwrapped(writer.value(result))};"]
    return "\n".join([*HEADING, f"double {SYMBOL}(const double *k)", "{", *indented(body), "}", ""])
