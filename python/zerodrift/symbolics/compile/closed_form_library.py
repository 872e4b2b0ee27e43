"""The direct functions of a symbolic system: written and compiled when they are first wanted."""

from __future__ import annotations

import ctypes
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from ..graph.plain_functions import NAMED
from . import cache as kept
from . import shared_library

LANES = {"baseline": 2, "avx2": 4, "avx512": 8}
DIRECT = "zd_symbolic_direct"       # what they are called in their library
NO_COMPILER = "there is no C compiler"      # why a system has none


class DirectFunctions:
    """The direct functions of a system, and of those that differ from it in parameters and start alone.

    They are written and compiled when they are first wanted. Orders of elimination are chosen with the values that the system was
    made with. So what is written depends on nothing else; it is written before it is sent to another process, where there need be
    no SymPy.
    """

    def __init__(self, program: dict[str, Any] | str, sizes: tuple[int, int, int, int], values: np.ndarray,
                 p0: np.ndarray | None, is_length: np.ndarray, offset: int, data: str = "data", embeds: bool = False) -> None:
        self._definition = program, sizes, values, p0, is_length
        self._embeds = embeds       # whether they are for formulations in independent velocities
        self._others: DirectFunctions | None = None
        self._offset, self._data = offset, data     # `data` is C for the doubles of a system
        self._libraries: dict[str, ctypes.CDLL | None] = {}
        self._written: tuple[str, int] | None = None
        self.why_none = program if isinstance(program, str) else ""     # as far as is known before they are written
        self._is_written = bool(self.why_none)

    @property
    def embedding(self) -> DirectFunctions:
        """Those for formulations in independent velocities."""
        if self._others is None:
            self._others = DirectFunctions(*self._definition, self._offset, self._data, embeds=True)
        return self._others

    def prepare(self) -> None:
        """Write them, as long as there is nothing else to do; they are compiled when they are wanted."""
        self._write()

    def _write(self) -> tuple[str, int] | None:
        """The C source and how many constants it has; None: there is none."""
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

    def _key(self) -> str:
        """What is written is kept under: all that it depends on."""
        from ..emit import closed_form_writer

        program, sizes, values, p0, is_length = self._definition
        calls = {operation[1] for operation in program["operations"] if operation[0] == "call"}
        limits = closed_form_writer.MOST_OPERATIONS, closed_form_writer.MOST_STATEMENTS
        return kept.digest_of("direct functions", _writing_code(calls <= set(NAMED)), limits, program, sizes, values.tolist(),
                              None if p0 is None else p0.tolist(), is_length.tolist(), self._offset, self._data, self._embeds)

    def _written_anew(self) -> dict[str, Any]:
        from ..elimination.steps import Unwritten
        from ..emit import closed_form
        try:
            source, constants = closed_form.write(*self._definition, offset=self._offset, symbol=DIRECT, data=self._data,
                                             embeds=(self._embeds,))
        except Unwritten as reason:
            return {"source": "", "constants": 0, "why": str(reason)}
        return {"source": source, "constants": constants, "why": ""}

    @property
    def in_words(self) -> str:
        """For the `repr` of a system: why it has none."""
        return f", no direct functions: {self.why_none}" if self.why_none else ""

    @property
    def constants(self) -> int:
        """How many doubles they need behind those of the terms."""
        written = self._write()
        return written[1] if written else 0

    @property
    def source(self) -> str:
        """The C code; empty: there are no direct functions."""
        written = self._write()
        return written[0] if written else ""

    def library(self, vector: str = "baseline") -> ctypes.CDLL | None:
        """The library of those for one trajectory and a vector unit; None: there are none."""
        return self.library_of(f"ZD_SET_{vector.upper()}_1", shared_library.QUICKLY)

    def library_in_lanes(self, vector: str) -> ctypes.CDLL | None:
        """The library of those for as many trajectories at once as the vector unit has lanes; None: there are none."""
        return self.library_of(f"ZD_SET_{vector.upper()}_{LANES[vector]}")

    def library_of(self, sets: str, optimized: tuple[str, ...] = shared_library.OPTIMIZED) -> ctypes.CDLL | None:
        """The library of some sets of functions: C for their bits, as zerodrift/units.h names them."""
        if sets not in self._libraries and self.source:
            symbols = DIRECT, f"{DIRECT}_constants"
            self._libraries[sets] = shared_library.library(self.source, symbols=symbols, defined=[f"ZD_SETS={sets}"],
                                                          optimized=optimized)
        return self._libraries.get(sets)

    def __getstate__(self) -> dict[str, Any]:
        self._write()
        return vars(self) | {"_libraries": {}}


@cache
def _writing_code(is_plain: bool) -> str:
    """The fingerprint of the code that writes: of SymPy's version, too, whose printer writes what is no sine or cosine."""
    files = sorted(Path(__file__).parents[1].rglob("*.py"))
    return kept.digest_of("" if is_plain else metadata.version("sympy"), [file.read_text(encoding="utf-8") for file in files])
