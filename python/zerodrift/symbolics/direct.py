"""Direct functions written from the operations of a system's terms."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import direct_emission, orders
from .direct_emission import Bounded
from .joint import elimination
from .lowering import Lowering
from .plain import NAMED, Function
from .restoring import restored

TERMS = ("A", "M", "d", "f", "Phi", "C", "Phi_t", "xi", "power")    # those that they follow from
HEADING = ["/* Written by zerodrift.symbolic. */", "#include <math.h>", "#include <zerodrift/system.h>",
           "#include <zerodrift/units.h>", "", "const int zd_interface_version = ZD_INTERFACE_VERSION;"]


def as_json(lowering: Lowering, outputs: dict[str, list[int]]) -> dict[str, Any] | str:
    """A program that can be kept; or why not: it is too large for direct functions, or has functions that are not SymPy's."""
    if len(lowering.operations) > direct_emission.MOST_OPERATIONS:
        return direct_emission.TOO_LARGE
    operations = []
    for code, arguments, _ in lowering.operations:
        if code == "call":
            name = arguments[0].__name__
            if not isinstance(arguments[0], Function) and getattr(_sympy(), name, None) is not arguments[0]:
                return f"{name} is no function of SymPy's"
            arguments = (name, *arguments[1:])
        operations.append([code, *arguments])
    return {"operations": operations, "terms": {name: outputs[name] for name in TERMS if name in outputs}}


def _function(name: str) -> Any:
    """The function of that name: where there is one without SymPy, that."""
    return NAMED.get(name) or getattr(_sympy(), name)


def _sympy() -> Any:
    import sympy

    return sympy


def write(program: dict[str, Any], sizes: tuple[int, int, int, int], parameters: np.ndarray, p0: np.ndarray | None,
          lengths: np.ndarray, *, offset: int, symbol: str, heading: list[str] | None = None,
          file: str = "system.c", lanes_header: str = "<zerodrift/lanes.h>", data: str = "data") -> tuple[str, int]:
    """The C source and its number of constants; raises `Unwritten` where no order serves, or there are too many operations."""
    lowering = Bounded(None)
    terms = restored(lowering, program["operations"], program["terms"], _function)
    chosen = orders.choose(lowering, terms, sizes, parameters, p0, lengths)
    eliminations = [elimination(lowering, terms, sizes, order) for order in chosen]
    functions = [{"accelerate": each.accelerations()} | ({"correct": each.corrections(), "land": each.landing()}
                                                         if each.order else {"correct": {}, "land": {}})
                 for each in eliminations]
    return direct_emission.source(lowering, functions, eliminations, offset=offset, symbol=symbol,
                                  heading=HEADING if heading is None else heading, file=file,
                                  lanes_header=lanes_header, data=data)
