"""The terms of a system at one (t, p, v), absent ones as zeros or identities, and the scales of its variables."""

from __future__ import annotations

import weakref
from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from .._private.gateway import CoreSystem, is_length
from ..errors import ZerodriftError
from ..systems.base import BaseSystem, core_of, system_of

LARGEST = 1000      # of dense matrices


class State(NamedTuple):
    """Terms of (1)-(6) at (t, p, v).

    A (nq, nv), M (nv, nv), force (nv,) = f - d, Phi (mh,), C (m, nv), Phi_t (m,), xi (m,).
    Rows of C that are rounding error are zero.
    """

    system: BaseSystem
    t: float
    p: np.ndarray
    v: np.ndarray
    A: np.ndarray
    M: np.ndarray
    force: np.ndarray
    Phi: np.ndarray
    C: np.ndarray
    Phi_t: np.ndarray
    xi: np.ndarray

    @property
    def magnitudes(self) -> np.ndarray:
        """Sums of the magnitudes of the terms of the generalized forces before they cancel, (nv,)."""
        found = core_of(self.system).force_magnitudes(self.t, self.p, self.v)
        return np.abs(self.force) if found is None else found

    @property
    def holonomic(self) -> np.ndarray:
        """Holonomic rows of C, (mh, nv)."""
        return self.C[:self.system.mh]


def small_core(system: BaseSystem) -> CoreSystem:
    """The core's system, whose matrices may be dense.

    Raises
    ------
    ZerodriftError
        If it is too large for that.
    """
    core = core_of(system)
    if max(core.nq, core.nv, core.m) > LARGEST:
        raise ZerodriftError(f"{system.name} must have at most {LARGEST} coordinates, velocities and constraints for this, not "
                             f"{max(core.nq, core.nv, core.m)}: its matrices are dense here")
    return core


def state(system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray) -> State:
    """Terms at (t, p, v)."""
    core, t = small_core(system), float(t)
    p, v = np.ascontiguousarray(p, dtype=float), np.ascontiguousarray(v, dtype=float)
    nv, m = core.nv, core.m
    absent = {"f": nv, "d": nv, "Phi": core.mh, "C": (m, nv), "Phi_t": m, "xi": m}
    at = {"A": np.eye(core.nq, nv)} | {name: np.zeros(shape) for name, shape in absent.items()} | core.evaluate(t, p, v)
    C = core.rows_above_rounding(t, p, v, at["C"])
    return State(system, t, p, v, at["A"], at["M"], at["f"] - at["d"], at["Phi"], C, at["Phi_t"], at["xi"])


class Scales(NamedTuple):
    """Characteristic scales: `length` in m, and those of the entries of p (nq,) and v (nv,), one for angles and pure numbers."""

    length: float
    p: np.ndarray
    v: np.ndarray


_known: weakref.WeakKeyDictionary[BaseSystem, Scales] = weakref.WeakKeyDictionary()


def scales(system: BaseSystem, p: np.ndarray) -> Scales:
    """Characteristic scales of a system near a position."""
    found = _known.get(system)
    if found is None:
        groups = (system.coordinates, system.velocities)
        of_p, of_v = (np.array([is_length(each) for each in group], dtype=bool) for group in groups)
        length = core_of(system).c.length
        if not length:
            start = p if system.p0 is None else np.asarray(system.p0)
            length = float(np.abs(start[of_p]).max(initial=0.0)) or 1.0
        found = Scales(length, np.where(of_p, length, 1.0), np.where(of_v, length, 1.0))
        if core_of(system).c.length or system.p0 is not None:
            _known[system] = found
    return found


def sizes_of(at: State, dp: np.ndarray, dv: np.ndarray, dt: float = 0.0) -> np.ndarray:
    """The sizes (k,) of directions dp (k, nq), dv (k, nv), dt in characteristic scales."""
    scale = scales(at.system, at.p)
    speed = np.maximum(scale.v, np.abs(at.v))
    return np.abs(np.hstack([dp / scale.p, dv / speed, np.full((len(dp), 1), dt)])).max(axis=1)


def arguments(given: Any, p: Any, v: Any, t: Any) -> tuple[BaseSystem, float, np.ndarray, np.ndarray]:
    """The system of an argument and a checked state of it; what is left out is its start."""
    system, t = system_of(given), checks.number("t", t)
    core_of(system)
    if p is None and v is None:
        p, v = system._state_or_start(None, None, "p", "v", t)
    else:
        p, v = system._state_or_start(p, v, "p", "v", t)
    return system, t, np.array(p), np.array(v)
