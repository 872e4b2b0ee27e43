"""Laws of mechanisms that are written in Python: how the core calls them, and what becomes of what they raise."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .._core import ffi, lib
from .base import CALLBACK, DONE

Law = Callable[[int, float, np.ndarray, np.ndarray], Any]


class LawOwner:
    """Calls the laws of one run, and keeps what they raise."""

    def __init__(self, law: Law, sizes: dict[int, tuple[int, int]]) -> None:
        self.error: BaseException | None = None
        self._law, self._sizes = law, sizes

    def evaluate(self, law: int, t: float, x: Any, xdot: Any, out: Any) -> int:
        """The function that the core calls: `sizes` says how many gauges go in and how many numbers come out."""
        try:
            k, size = self._sizes[law]
            values = np.asarray(self._law(law, t, np.array(ffi.unpack(x, k)), np.array(ffi.unpack(xdot, k))), dtype=float)
            if values.shape != (size,):
                raise ValueError(f"law {law} must give {size} numbers, not an array of shape {values.shape}")
            for i, value in enumerate(values):
                out[i] = value
        except BaseException as error:      # raised again where the run was started
            self.error = error
            return CALLBACK
        return DONE


@ffi.def_extern(error=lib.ZD_CALLBACK)
def zd_law_in_python(owner, law, t, x, xdot, out):
    return ffi.from_handle(owner).evaluate(law, t, x, xdot, out)
