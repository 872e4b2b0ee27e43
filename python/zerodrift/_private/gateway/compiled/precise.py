"""Functions of a system in double-double arithmetic: Taylor coefficients of its motion, and residuals of its constraints.

Numbers are pairs of doubles in the last axis of an array: high and low part.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core import ffi
from ..base import doubles, error_of


class Precise:
    """A `zd_precise` at an address, with the numbers (k, 2) that it reads; `keep` is the library that it is in."""

    def __init__(self, address: int, numbers: np.ndarray, sizes: tuple[int, int, int, int], keep: Any) -> None:
        self._c, self._keep, self.numbers = ffi.cast("const zd_precise *", address), (keep, address), numbers
        self.nq, self.nv, self.mh, self.mn = self.sizes = sizes
        self.m = self.mh + self.mn

    def with_numbers(self, numbers: np.ndarray) -> Precise:
        """These functions with other numbers."""
        address = self._keep[1]
        return Precise(address, numbers, self.sizes, self._keep[0])

    def series(self, order: int, t: np.ndarray, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Taylor coefficients p (order + 1, nq, 2) and v (order + 1, nv, 2) of the motion from a state; raises if they do not
        exist.
        """
        found = np.zeros((order + 1, self.nq, 2)), np.zeros((order + 1, self.nv, 2))
        scratch = ffi.new("double[]", 2 * (order + 1) * self._c.scratch)
        to = [doubles(each, each.size, writable=True) for each in found]
        status = self._c.series(_pairs(self.numbers), order, _pairs(t), _pairs(p), _pairs(v), *to, scratch)
        if status:
            raise error_of(status, "the series in double-double arithmetic failed")
        return found

    def residuals(self, t: np.ndarray, p: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """Phi (mh, 2), Psi (m, 2), and M (nv, nv), C (m, nv), A (nq, nv) as doubles; A is the identity if the system has none."""
        found = {"Phi": np.zeros((self.mh, 2)), "Psi": np.zeros((self.m, 2)), "M": np.zeros((self.nv, self.nv)),
                 "C": np.zeros((self.m, self.nv)), "A": np.zeros((self.nq, self.nv))}
        to = [doubles(each, each.size, writable=True) for each in found.values()]
        self._c.residuals(_pairs(self.numbers), _pairs(t), _pairs(p), _pairs(v), *to)
        if self.nq == self.nv and not found["A"].any():
            found["A"] = np.eye(self.nq)
        return found

    def value(self, series: np.ndarray, h: np.ndarray) -> np.ndarray:
        """Value (n, 2) at h (2,) of a polynomial with coefficients (order + 1, n, 2)."""
        orders, n, _ = series.shape
        found = np.empty((n, 2))
        self._c.value(orders - 1, n, _pairs(series), _pairs(h), doubles(found, found.size, writable=True))
        return found


def _pairs(x: np.ndarray) -> Any:
    return doubles(x, x.size)
