"""Systems whose evaluation is compiled code: the core calls it directly, and Python is not involved."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ....errors import WrongValue
from ...core import ffi, lib
from ..base import MESSAGE_SIZE, TERMS, Variable, doubles, lengths, set_quaternions, text
from ..packed_layout import Packing, declare
from ..systems import CoreSystem, Kind

VERSION = lib.ZD_INTERFACE_VERSION
FAILURE = ffi.new("char[]", b"the native function reported a failure")
GUARD = 256         # doubles on either side of a term that is probed
UNWRITTEN = np.array([0x7FF8_5A5A_5A5A_5A5A], dtype=np.uint64).view(np.float64)[0]      # not a number, recognised by its bits


class NativeCore(CoreSystem):
    """A system whose terms the function at `address`, a `zd_evaluate`, computes.

    Its sizes are (nq, nv, mh, mn), its terms those named, its coordinates and velocities `variables`; the function receives
    `data`, and memory for `scratch` doubles of its own. `keep` is whatever must live as long as the system. `timeless` says
    that no term depends on t; unit quaternions begin in p at `quaternions`. With a `packing` the function writes
    A, M and C as that says.
    """

    def __init__(self, sizes: tuple[int, int, int, int], names: Iterable[str], address: int, data: np.ndarray | None,
                 variables: Iterable[Variable], *, scratch: int = 0, keep: Any = None, timeless: bool = False,
                 quaternions: Sequence[int] = (), packing: Packing | None = None) -> None:
        system = ffi.new("zd_system *")
        system.nq, system.nv, system.mh, system.mn = sizes
        system.provides = lib.ZD_TIMELESS if timeless else 0
        for name in names:
            system.provides |= TERMS[name].bit
        system.scratch, system.failure = scratch, FAILURE
        system.evaluate = ffi.cast("zd_evaluate *", address)
        memory = ffi.NULL if data is None else doubles(data, data.size)
        system.data = memory
        system.lengths = dimensions = lengths(variables)
        super().__init__(system, (memory, dimensions, set_quaternions(system, quaternions), declare(system, packing), keep))

    def with_data(self, data: np.ndarray) -> NativeCore:
        """Copy of the system whose function receives other data."""
        other = copy.copy(self)
        other.c = ffi.new("zd_system *", self.c[0])
        other.c.data = memory = doubles(data, data.size)
        other._data = (memory, *self._data[1:])
        return other

    def with_copied_data(self) -> tuple[NativeCore, Any, np.ndarray]:
        """Copy of the system with its own data, a pointer to the data, and their memory."""
        memory = np.array(np.frombuffer(ffi.buffer(self._data[0])))
        other = self.with_data(memory)
        return other, other._data[0], memory

    def with_closed_form(self, address: int, data: np.ndarray, keep: Any) -> NativeCore:
        """Copy of the system with closed-form functions, a `zd_closed_form` at `address`; all its functions receive `data`."""
        other = self.with_data(data)
        other.c.closed_form, other.c.closed_forms = ffi.cast("const zd_closed_form *", address), 1
        other._data = (*other._data, keep)
        return other

    def with_series(self, address: int, keep: Any) -> NativeCore:
        """Copy of the system with the Taylor series of its motion, a `zd_series` at `address`."""
        return self._with_more("series", address, keep)

    def with_jacobian(self, address: int, keep: Any) -> NativeCore:
        """Copy of the system with the Jacobian of its rates, a `zd_jacobian` at `address`."""
        return self._with_more("jacobian", address, keep)

    def _with_more(self, member: str, address: int, keep: Any) -> NativeCore:
        other = copy.copy(self)
        other.c = ffi.new("zd_system *", self.c[0])
        setattr(other.c, member, ffi.cast(f"const zd_{member} *", address))
        other._data = (*self._data, keep)
        return other


def probe(core: CoreSystem, p: np.ndarray, v: np.ndarray) -> str:
    """Error message for a compiled evaluation at (0, p, v); empty if it is correct.

    It must write all entries of the terms that it declares, and no other memory.
    """
    shapes = {name: core.stored(name) for name in TERMS} | {"scratch": (core.c.scratch,)}
    if core.c.structure:        # then there is no D, which would be dense
        shapes["D"] = (0,)
    memory = {name: np.full(int(np.prod(shape)) + 2 * GUARD, UNWRITTEN) for name, shape in shapes.items()}
    terms, inputs = ffi.new("zd_terms *"), core.initial_inputs()
    terms.inputs = inputs
    for name, array in memory.items():
        setattr(terms, name, doubles(array, array.size, writable=True) + GUARD)
    want = core.provides | lib.ZD_MOVED
    if core.c.evaluate(core.c.data, want, 0.0, doubles(p, core.nq), doubles(v, core.nv), terms):
        return "it reports a failure at the start"
    for name, array in memory.items():
        written = array.view(np.uint64) != UNWRITTEN.view(np.uint64)
        inside = written[GUARD:-GUARD]
        has = name == "scratch" or core.provides & TERMS[name].bit
        if written[:GUARD].any() or written[-GUARD:].any():
            return f"it writes beyond {name}, which is of shape {shapes[name]}"
        if inside.any() and not has:
            return f"it writes {name}, which is not among its terms"
        if name != "scratch" and has and not inside.all():
            where = [int(i) for i in np.unravel_index(np.argmin(inside), shapes[name])]
            return f"it leaves {name}{where if where else ''} unwritten, and {name} of shape {shapes[name]} is among its terms"
    return ""


def kind_at(address: int) -> Kind:
    """The `zd_kind` at an address; ValueError if a required member is missing."""
    c = ffi.cast("const zd_kind *", address)
    system = c.system
    sizes = (system.nq, system.nv, system.mh, system.mn)
    if min(sizes) < 0 or not system.nq or not system.nv:
        raise WrongValue(f"its sizes nq, nv, mh, mn cannot be {sizes}", "compiled-function")
    counts = {"parameter": c.parameters, "coordinate": system.nq, "velocity": system.nv, "constraint": system.mh + system.mn,
              "prepare": 1, "start": 1, "draw": c.points}
    for name in (name for name, count in counts.items() if count and not getattr(c, name)):
        raise WrongValue(f"its {name} is missing", "compiled-function")
    if not c.card.name or not system.evaluate:
        raise WrongValue(f"its {'evaluate' if c.card.name else 'name'} is missing", "compiled-function")
    if system.data:
        raise WrongValue("its system.data must be left out: the constants replace it", "compiled-function")
    message = ffi.new("char[]", MESSAGE_SIZE)
    if lib.zd_check_system(ffi.addressof(c, "system"), message, MESSAGE_SIZE):
        raise WrongValue(text(message), "compiled-function")
    return Kind(c)


def terms_of(system: CoreSystem) -> list[str]:
    """The names of the terms a system has."""
    return [name for name, term in TERMS.items() if system.provides & term.bit]
