"""Systems perturbed by relative errors of the size of rounding."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core import ffi, lib
from .base import TERMS, doubles
from .systems import CoreSystem

NAMES = ("A", "M", "d", "f", "C", "Phi_t", "xi")    # the terms that are perturbed: those the motion follows from


class PerturbedCore(CoreSystem):
    """System whose arguments t (1,), p (nq,), v (nv,) and terms are those of another one times a factor for each entry."""

    def __init__(self, inner: CoreSystem, factors: dict[str, np.ndarray],
                 series: tuple[int, np.ndarray, Any] | None = None) -> None:
        self.inner, self.factors, self._brought = inner, factors, series
        memory = {name: doubles(array, array.size) for name, array in factors.items()}
        terms = ffi.new("zd_terms *", {name: ffi.cast("double *", memory[name]) for name in NAMES if name in memory})
        self._kept = memory, inner
        self._perturbation = ffi.new("zd_perturbation *", {
            "system": inner.c, "t": factors["t"][0], "p": memory["p"], "v": memory["v"], "terms": terms[0]})
        if series:
            address, numbers, _ = series
            memory["numbers"] = self._perturbation.numbers = doubles(numbers, numbers.size)
            self._perturbation.series = ffi.cast("const zd_series *", address)
        super().__init__(ffi.new("zd_system *", lib.zd_perturbed(self._perturbation)), self._kept)

    def for_run(self) -> PerturbedCore:
        """Copy with the inner system for one run."""
        return PerturbedCore(self.inner.for_run(), self.factors, self._brought)

    @property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """Shapes of the factors; those of packed matrices are dense."""
        return {name: self._dense(name).shape for name in self.factors}

    def _dense(self, name: str) -> np.ndarray:
        packing, factors = self.inner.packing, self.factors[name]
        return packing.expand(name, factors) if packing and name in packing.shapes else factors

    def with_series(self, address: int, parameters: np.ndarray, keep: Any) -> PerturbedCore:
        """Copy with the Taylor series of its motion, a `zd_series` at `address` that reads the parameters and all factors."""
        numbers = np.concatenate([parameters, *(self._dense(name).ravel() for name in self.factors)])
        return PerturbedCore(self.inner, self.factors, (address, numbers, keep))

    @property
    def error(self) -> BaseException | None:
        """Exception raised by a callable, or None."""
        return self.inner.error


def perturbed(inner: CoreSystem, size: float, seed: int) -> PerturbedCore:
    """System whose arguments and terms have relative errors of one or two times `size`, of random sign."""
    chance = np.random.default_rng(seed)

    def draw(*shape: int) -> np.ndarray:
        return 1.0 + size * chance.choice([-2.0, -1.0, 1.0, 2.0], shape)

    shapes = {name: inner.stored(name) for name in NAMES if inner.provides & TERMS[name].bit}
    factors = {"t": draw(1), "p": draw(inner.nq), "v": draw(inner.nv), **{name: draw(*shape) for name, shape in shapes.items()}}
    factors["M"] = _paired(inner, factors["M"])
    return PerturbedCore(inner, factors)


def _paired(inner: CoreSystem, factors: np.ndarray) -> np.ndarray:
    """Factors of M, made symmetric from the upper triangle."""
    dense = inner.packing.expand("M", factors) if inner.packing else factors
    upper = np.triu(dense)
    paired = upper + np.triu(upper, 1).T
    return inner.packing.pack("M", paired) if inner.packing else paired
