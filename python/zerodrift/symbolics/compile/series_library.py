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
    """A function of a system, and of those that differ from it in parameters and start alone."""

    symbol: ClassVar[str]
    _write: ClassVar[Callable[..., str]]

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
                self._source = self._write(*self._definition)
            except Unwritten as reason:
                self._source, self._why_none = "", str(reason)
        return self._source

    @property
    def why_none(self) -> str:
        """Why there is none that could be written; empty: there is."""
        return self._why_none if not self.source else ""

    def library(self, vector: str) -> ctypes.CDLL | None:
        """The library for a vector unit, whose bits are the same as those of any other; None: there is none."""
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
    """The derivatives of its rates."""

    symbol, _write = jacobian.JACOBIAN, staticmethod(jacobian.write)
