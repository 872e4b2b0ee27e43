"""The direct functions of a symbolic system: written and compiled when they are first wanted."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from . import compiling

DIRECT = "zd_symbolic_direct"       # what they are called in their library
NO_COMPILER = "there is no C compiler"      # why a system has none


class DirectFunctions:
    """The direct functions of a system, and of those that differ from it in parameters and start alone.

    They are written and compiled when they are first wanted. Orders of elimination are chosen with the values that the system was
    made with. So what is written depends on nothing else; it is written before it is sent to another process, where there need be
    no SymPy.
    """

    def __init__(self, program: dict[str, Any] | str, sizes: tuple[int, int, int, int], values: np.ndarray,
                 p0: np.ndarray | None, is_length: np.ndarray, offset: int, data: str = "data") -> None:
        self._definition = program, sizes, values, p0, is_length
        self._offset, self._data = offset, data     # `data` is C for the doubles of a system
        self._libraries: dict[str, ctypes.CDLL | None] = {}
        self._written: tuple[str, int] | None = None
        self.why_none = program if isinstance(program, str) else ""     # as far as is known before they are written
        self._is_written = bool(self.why_none)

    def _write(self) -> tuple[str, int] | None:
        """The C source and how many constants it has; None: there is none."""
        if not self._is_written:
            from . import direct
            from .elimination import Unwritten
            try:
                self._written = direct.write(*self._definition, offset=self._offset, symbol=DIRECT, data=self._data)
            except Unwritten as reason:
                self.why_none = str(reason)
            self._is_written = True
        return self._written

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
        return self.library_of(f"ZD_SET_{vector.upper()}_1")

    def library_of(self, sets: str) -> ctypes.CDLL | None:
        """The library of some sets of functions: C for their bits, as zerodrift/units.h names them."""
        if sets not in self._libraries and self.source:
            symbols = DIRECT, f"{DIRECT}_constants"
            self._libraries[sets] = compiling.library(self.source, symbols=symbols, defined=[f"ZD_SETS={sets}"])
        return self._libraries.get(sets)

    def __getstate__(self) -> dict[str, Any]:
        self._write()
        return vars(self) | {"_libraries": {}}
