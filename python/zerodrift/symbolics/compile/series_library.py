"""Taylor series, in both precisions, and Jacobian of a symbolic system: written and compiled at first use."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any, ClassVar

from ..elimination.steps import Unwritten
from ..emit import jacobian, series
from . import shared_library

OPTIMIZED = ("-O2",)      # with more, compilers take twice as long for the same speed
UNITS = {"baseline": 0, "avx2": 1, "avx512": 2}     # as zerodrift/series.h counts them


class WrittenFunctions:
    """C functions of a system, shared by all systems that differ only in parameters and start."""

    symbol: ClassVar[str]
    _write: ClassVar[Callable[..., str]]

    def __init__(self, program: dict[str, Any] | str, sizes: tuple[int, int, int, int], data: str = "data") -> None:
        self._definition = program, sizes, data
        self._source: str | None = None
        self._why_none = ""
        self._libraries: dict[str, ctypes.CDLL | None] = {}

    @property
    def source(self) -> str:
        """C source; empty if it could not be written."""
        if self._source is None:
            try:
                self._source = self._write(*self._definition)
            except Unwritten as reason:
                self._source, self._why_none = "", str(reason)
        return self._source

    @property
    def why_none(self) -> str:
        """Reason why no source could be written; empty if there is one."""
        return self._why_none if not self.source else ""

    def library(self, vector: str) -> ctypes.CDLL | None:
        """Library for a vector unit; its results are bitwise those of any other unit. None without source or compiler."""
        if vector not in self._libraries and self.source:
            self._libraries[vector] = shared_library.library(self.source, symbols=(self.symbol,), optimized=OPTIMIZED,
                                                        defined=[f"ZD_SERIES_UNIT={UNITS[vector]}"])
        return self._libraries.get(vector)

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"_libraries": {}}


class SeriesFunctions(WrittenFunctions):
    """The Taylor series of the motion."""

    symbol, _write = series.SERIES, staticmethod(series.write)


class PreciseFunctions(WrittenFunctions):
    """The Taylor series of the motion in double-double arithmetic, and the residuals of its constraints."""

    symbol, _write = series.PRECISE, staticmethod(series.write_precise)


class JacobianFunctions(WrittenFunctions):
    """Jacobian of the rates with respect to the state."""

    symbol, _write = jacobian.JACOBIAN, staticmethod(jacobian.write)
