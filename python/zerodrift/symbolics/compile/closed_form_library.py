"""Closed-form functions of a symbolic system: written and compiled at first use."""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Mapping, Sequence
from functools import cache, cached_property
from importlib import metadata
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ..._private.gateway import VERSION
from ..._private.gateway.compiled.programs import closed_forms, constants, with_addresses
from ..elimination.steps import Order, Solve
from ..emit.program_writer import Part, Programs
from ..graph.plain_functions import NAMED
from . import cache as kept
from . import shared_library

LANES = {"baseline": 2, "avx2": 4, "avx512": 8}
CLOSED_FORM = "zd_symbolic_closed_form"       # symbol of the functions in their library
NO_COMPILER = "there is no C compiler"      # reason why a system has no closed-form functions


def without_rows(program: Any, sizes: tuple[int, int, int, int], rows: Collection[int]) -> tuple[Any, tuple[int, int, int, int]]:
    """Program and sizes of a system without these constraints, as of contacts that are open."""
    nq, nv, mh, mn = sizes
    if not rows or isinstance(program, str):
        return program, sizes
    kept, terms = [row for row in range(mh + mn) if row not in rows], dict(program["terms"])
    for name, width in (("Phi", 1), ("Phi_t", 1), ("xi", 1), ("C", nv)):
        each = terms.pop(name, [])
        if found := [entry for row in kept for entry in each[row * width:(row + 1) * width]]:
            terms[name] = found
    holonomic = sum(row < mh for row in kept)
    return program | {"terms": terms}, (nq, nv, holonomic, len(kept) - holonomic)


class ClosedFormFunctions:
    """Closed-form functions of a system, shared by all systems that differ only in parameters and start.

    They are written and compiled at first use. Orders of elimination are chosen with the values that the system was created with,
    so the source depends on these alone. The source is written before the object is pickled, as the other process may lack SymPy.
    """

    def __init__(self, program: Any, sizes: tuple[int, int, int, int], values: np.ndarray,
                 p0: np.ndarray | None, is_length: np.ndarray, offset: int, data: str = "data", embeds: bool = False,
                 inputs: Sequence[int] = (), splines: Mapping[int, Any] = MappingProxyType({})) -> None:
        self._splines = dict(splines)       # tables by the places of the values that stand for them
        self._inputs = inputs       # parameters that change within a run: programs compute what depends on them
        self._definition = program, sizes, values, p0, is_length
        self._embeds = embeds       # True: for formulations in independent velocities
        self._others: ClosedFormFunctions | None = None
        self._offset, self._data = offset, data     # `data` is C for the doubles of a system
        self._libraries: dict[str, ctypes.CDLL | None] = {}
        self._written: tuple[str, int] | None = None
        self.why_none = program if isinstance(program, str) else ""     # as far as is known before they are written
        self._is_written = bool(self.why_none)

    @property
    def _given(self) -> tuple[Any, ...]:
        """The definition with numbers that stand for tables."""
        program, sizes, values, *others = self._definition
        return program, sizes, with_addresses(values, self._splines), *others

    @property
    def embedding(self) -> ClosedFormFunctions:
        """Closed-form functions for formulations in independent velocities."""
        if self._others is None:
            self._others = ClosedFormFunctions(*self._definition, self._offset, self._data, embeds=True, inputs=self._inputs,
                                              splines=self._splines)
        return self._others

    def prepare(self) -> None:
        """Write the source, while a compiler of the terms is running; it is compiled at first use."""
        self._write()

    def _write(self) -> tuple[str, int] | None:
        """The C source and its number of constants; None: there are no closed-form functions."""
        if not self._is_written:
            key = self._key()
            found = kept.read(key, dict)
            if found is None:
                found = self._written_anew()
                kept.write(key, found)
            self._written = (found["source"], found["constants"]) if found["source"] else None
            self.why_none = found["why"]
            self._is_written = True
        return self._written

    @cached_property
    def programs(self) -> tuple[Programs, list[Order]] | None:
        """Programs of the functions, and their orders of elimination; None: there are none."""
        if self.why_none:
            return None
        key = self._key("programs")
        found = kept.read(key, dict)
        if found is None:
            found = self._programs_anew()
            kept.write(key, found)
        self.why_none = found["why"]
        if self.why_none:
            return None
        written = Programs(*found["programs"])
        functions = [{name: [Part(*part) for part in parts] for name, parts in of.items()} for of in written.functions]
        return written._replace(functions=functions), [tuple(Solve(*each) for each in order) for order in found["orders"]]

    def interpreted(self, values: np.ndarray) -> tuple[Any, Any, np.ndarray] | None:
        """Functions by programs, what they refer to, and the numbers that they read, parameters first; None: there are none."""
        found, sizes = self.programs, self._definition[1]
        return found and (*closed_forms(*found, sizes, self._embeds), constants(found[0], values))

    def _programs_anew(self) -> dict[str, Any]:
        from ..elimination.steps import Unwritten
        from ..emit import closed_form, program_writer
        program, sizes, values, p0, is_length = self._given
        try:
            lowering, functions, eliminations = closed_form.eliminated(program, sizes, values, p0, is_length, (self._embeds,))
            written = program_writer.programs(lowering, functions, sizes, len(values), self._inputs)
        except Unwritten as reason:
            return {"why": str(reason)}
        return {"programs": written, "orders": [each.order for each in eliminations], "why": ""}

    def _key(self, what: str = "closed-form functions") -> str:
        """Key of the source or of the programs in the cache: a digest of all data that they depend on."""
        from ..emit import closed_form_writer

        program, sizes, values, p0, is_length = self._definition
        calls = {operation[1] for operation in program["operations"] if operation[0] == "call"}
        limits = closed_form_writer.MAX_OPERATIONS, closed_form_writer.MAX_STATEMENTS
        return kept.digest_of(what, _writing_code(calls <= set(NAMED)), limits, program, sizes, values.tolist(),
                              None if p0 is None else p0.tolist(), is_length.tolist(), self._offset, self._data, self._embeds,
                              [*self._inputs], {place: table.knots.tolist() for place, table in self._splines.items()})

    def _written_anew(self) -> dict[str, Any]:
        from ..elimination.steps import Unwritten
        from ..emit import closed_form
        try:
            source, constants = closed_form.write(*self._given, offset=self._offset, symbol=CLOSED_FORM, data=self._data,
                                             embeds=(self._embeds,))
        except Unwritten as reason:
            return {"source": "", "constants": 0, "why": str(reason)}
        return {"source": source, "constants": constants, "why": ""}

    @property
    def in_words(self) -> str:
        """Reason why the system has no closed-form functions, as shown in its `repr`."""
        return f", no closed-form functions: {self.why_none}" if self.why_none else ""

    @property
    def constants(self) -> int:
        """Number of doubles that the functions need after the constants of the terms."""
        written = self._write()
        return written[1] if written else 0

    @property
    def source(self) -> str:
        """C source; empty if there are no closed-form functions."""
        written = self._write()
        return written[0] if written else ""

    def library(self, vector: str = "baseline") -> ctypes.CDLL | None:
        """Library of the functions for one trajectory and a vector unit; None: there are none."""
        return self.library_of(f"ZD_SET_{vector.upper()}_1", shared_library.QUICKLY)

    def library_in_lanes(self, vector: str) -> ctypes.CDLL | None:
        """Library of the functions for SIMD lanes, one trajectory per lane of the vector unit; None: there are none."""
        return self.library_of(f"ZD_SET_{vector.upper()}_{LANES[vector]}")

    def library_of(self, sets: str, optimized: tuple[str, ...] = shared_library.OPTIMIZED) -> ctypes.CDLL | None:
        """Library of some sets of functions, given as a C expression of the bits in zerodrift/units.h."""
        if sets not in self._libraries and self.source:
            symbols = CLOSED_FORM, f"{CLOSED_FORM}_constants"
            self._libraries[sets] = shared_library.library(self.source, symbols=symbols, defined=[f"ZD_SETS={sets}"],
                                                          optimized=optimized)
        return self._libraries.get(sets)

    def __getstate__(self) -> dict[str, Any]:
        if "programs" not in vars(self):
            self._write()
        return vars(self) | {"_libraries": {}, "_interface": VERSION}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """As pickled; a source for another version of the core's interface is written again."""
        vars(self).update(state)
        if vars(self).pop("_interface", None) != VERSION and self._written:
            self._written, self._is_written = None, False


@cache
def _writing_code(is_plain: bool) -> str:
    """Fingerprint of the code generator, with SymPy's version if it prints functions that are not in `plain_functions`."""
    files = sorted(Path(__file__).parents[1].rglob("*.py"))
    return kept.digest_of("" if is_plain else metadata.version("sympy"), [file.read_text(encoding="utf-8") for file in files])
