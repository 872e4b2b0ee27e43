"""Systems made from another: perturbed by errors of the size of rounding, or in one phase of constraints that switch."""

from __future__ import annotations

import copy
import functools
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core import ffi, lib
from .base import TERMS, doubles
from .measures import Acting
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


def gaps(core: CoreSystem, t: float, p: np.ndarray) -> dict[int, float]:
    """Gaps of one-sided groups by their indices, in units of their scales."""
    groups = core.c.group
    Phi = core.evaluate_states(("Phi",), np.array([float(t)]), p[None], np.zeros((1, core.nv)))["Phi"][0]
    length = core.c.length or 1.0
    return {g: groups[g].sign * (Phi[groups[g].first] - groups[g].value) / (groups[g].scale or length)
            for g in range(core.c.groups) if groups[g].kind == lib.ZD_ONE_SIDED}


def in_phase(core: CoreSystem, state: Sequence[int]) -> Any:
    """The core's system of one phase; its measures take the multipliers of its own constraints."""
    mine = copy.copy(core)
    mine.__class__ = _class_of(type(core))
    for name in [name for name in mine.__dict__ if isinstance(getattr(type(core), name, None), functools.cached_property)]:
        del mine.__dict__[name]
    c = ffi.gc(lib.zd_phase_new(core.c, list(state)), lib.zd_phase_free)
    CoreSystem.__init__(mine, c, (core, c))
    mine.__dict__ |= {"full": core, "state": tuple(state), "measures": core.measures,
                      "active": np.array(ffi.unpack(lib.zd_phase_rows(c), mine.m) if mine.m else [], dtype=int)}
    return mine


class _InPhase:
    """Methods of a phase beside those of its system."""

    full: Any
    state: tuple[int, ...]
    active: np.ndarray      # (m,): constraint of the full system that each one is
    c: Any

    def for_run(self) -> Any:
        own = self.full.for_run()
        return self if own is self.full else in_phase(own, self.state)

    def expanded(self, multipliers: np.ndarray) -> np.ndarray:
        """Multipliers (k, full m) of all constraints, from those (k, m) of the phase."""
        found = np.zeros((len(multipliers), self.full.m))
        found[:, self.active] = multipliers
        return found

    def friction_bound(self, group: int, multipliers: np.ndarray) -> float:
        """Bound of static friction in N or N m, from multipliers (full m,) of all constraints."""
        return lib.zd_friction_bound(self.full.c, group, 0, ffi.from_buffer("double[]", np.ascontiguousarray(multipliers)))

    def measure(self, index: int, t: np.ndarray, p: np.ndarray, v: np.ndarray, vdot: np.ndarray | None = None,
                multipliers: np.ndarray | None = None, *, is_own: bool = False, wanted: str = "value", is_least: bool = False,
                acting: Acting | None = None) -> np.ndarray:
        """As of any system; reactions that are not unique are those of the multipliers that are given."""
        if wanted == "least":
            return np.array(multipliers)
        given: Any = super()
        return given.measure(index, t, p, v, vdot, multipliers, is_own=is_own, is_least=True, acting=acting)


_classes: dict[type, type] = {}


def _class_of(of: type) -> type:
    return _classes.setdefault(of, type("InPhase", (_InPhase, of), {}))


def switch(core: CoreSystem, groups: Sequence[Any]) -> list[tuple[str, str]]:
    """Let these rows of a system switch; the names and kinds of their groups."""
    if groups:
        names = [ffi.new("char[]", group.name.encode()) for group in groups]
        c = ffi.new("zd_group[]", [
            {"name": name, "first": group.first, "rows": 1, "sign": 1, "normal": group.normal, "friction": group.friction,
             "restitution": group.restitution, "kind": lib.ZD_FRICTION if group.normal else lib.ZD_ONE_SIDED}
            for name, group in zip(names, groups, strict=True)])
        core.c.groups, core.c.group = len(groups), c
        core.__dict__["_switched"] = c, names
    return [(group.name, group.kind) for group in groups]


def switching_rows(core: CoreSystem) -> set[int]:
    """Constraints of groups."""
    groups = [core.c.group[g] for g in range(core.c.groups)]
    return {row for group in groups for row in range(group.first, group.first + group.rows)}
