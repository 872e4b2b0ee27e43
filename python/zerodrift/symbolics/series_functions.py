"""The Taylor series of a symbolic system's motion: written and compiled when they are first wanted."""

from __future__ import annotations

import ctypes
from typing import Any

from . import compiling, series
from .elimination import Unwritten

OPTIMIZED = ("-O2",)      # with more, compilers take twice as long for the same speed
UNITS = {"baseline": 0, "avx2": 1, "avx512": 2}     # as zerodrift/series.h counts them


class SeriesFunctions:
    """The series of a system, and of those that differ from it in parameters and start alone."""

    def __init__(self, program: dict[str, Any] | str, sizes: tuple[int, int, int, int], data: str = "data") -> None:
        self._definition = program, sizes, data
        self._source: str | None = None
        self._why_none = ""
        self._libraries: dict[str, ctypes.CDLL | None] = {}

    @property
    def source(self) -> str:
        """The C code; empty: there is none."""
        if self._source is None:
            try:
                self._source = series.write(*self._definition)
            except Unwritten as reason:
                self._source, self._why_none = "", str(reason)
        return self._source

    @property
    def why_none(self) -> str:
        """Why the motion has no series that could be written; empty: it has."""
        return self._why_none if not self.source else ""

    def library(self, vector: str) -> ctypes.CDLL | None:
        """The library for a vector unit, whose bits are the same as those of any other; None: there is none."""
        if vector not in self._libraries and self.source:
            self._libraries[vector] = compiling.library(self.source, symbols=(series.SERIES,), optimized=OPTIMIZED,
                                                        defined=[f"ZD_SERIES_UNIT={UNITS[vector]}"])
        return self._libraries.get(vector)

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"_libraries": {}}
