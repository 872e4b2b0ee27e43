"""Positions with prescribed quantities, and the motion along them, found by the core."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core import ffi, lib
from .base import doubles, error_of
from .systems import CoreSystem


class Tracked(NamedTuple):
    """Positions (k, nq), velocities and accelerations (k, nv), NaN where they are unknown.

    `reached`: the last values (n,) before a dead point, and the time. `contradicting`: the first sample, or -1,
    at which quantities or their rates contradict each other or the constraints, and by how much, relative to their changes or
    rates. `is_determined`: they determine all positions where the tracking begins.
    """

    p: np.ndarray
    v: np.ndarray
    vdot: np.ndarray
    reached: np.ndarray | None
    contradicting: int
    contradiction: float
    is_determined: bool


class Prescribing:
    """Quantities that are prescribed for a system.

    Parameters
    ----------
    core : CoreSystem
    measured : CoreSystem or None
        The system that provides the measures.
    indices : sequence of int
        Measures, whose components follow one another.
    which : sequence of int
        Components, or -1 - i for coordinate i.
    scales : (ndarray (nq,), ndarray (nv,))
        Characteristic scales of p and v.
    """

    def __init__(self, core: CoreSystem, measured: CoreSystem | None, indices: Sequence[int], which: Sequence[int],
                 scales: tuple[np.ndarray, np.ndarray]) -> None:
        of = self._core = core.for_run()
        self._measured = of if measured in (core, None) else measured.for_run()
        self._kept = ffi.new("int[]", indices), ffi.new("int[]", which), 1 / scales[0], scales[1]
        self._c = ffi.new("zd_prescribed_motion *", {
            "system": of.c, "measured": self._measured.c, "measures": len(indices), "measure": self._kept[0],
            "components": sum(self._measured.measure_size(index) for index in indices), "quantities": len(which),
            "which": self._kept[1], "inverse_scale_p": doubles(self._kept[2], of.nq), "scale_v": doubles(scales[1], of.nv)})

    def _checked(self, status: int) -> int:
        if status not in (lib.ZD_DONE, lib.ZD_NO_CONVERGENCE):
            raise self._core.error or self._measured.error or error_of(status, "the system's evaluation failed")
        return status

    def find(self, p: np.ndarray, value: np.ndarray) -> tuple[np.ndarray, float | None]:
        """`zd_find_position`: a position (nq,) from a guess, and the last step where there is none; values, then the time."""
        found, step = np.array(p, dtype=float), ffi.new("double *")
        self._c.value = doubles(value, value.size)
        status = self._checked(lib.zd_find_position(self._c, doubles(found, found.size, writable=True), step))
        return found, step[0] if status else None

    def track(self, p: np.ndarray, value: np.ndarray, *rates: np.ndarray) -> Tracked:
        """`zd_kinematics`: the motion from a position on; values, then the time, (k, n + 1), and both rates (k, n)."""
        motion, sizes = self._c, {"p": self._core.nq, "v": self._core.nv, "vdot": self._core.nv}
        motion.samples, motion.value = len(value), doubles(value, value.size)
        if rates:
            motion.rate, motion.second = (doubles(each, each.size) for each in rates)
        arrays: dict[str, Any] = {name: np.full((len(value), size), np.nan) for name, size in sizes.items()}
        arrays["reached"] = np.zeros(motion.quantities + 1)
        found = ffi.new("zd_tracked *", {name: doubles(each, each.size, writable=True) for name, each in arrays.items()})
        self._checked(lib.zd_kinematics(motion, doubles(p, p.size), found))
        if found.dead < 0:
            arrays["reached"] = None
        return Tracked(**arrays, contradicting=found.contradicting, contradiction=found.contradiction,
                       is_determined=bool(found.is_determined))


def quintic_spline(t: np.ndarray, value: np.ndarray, rate: np.ndarray, second: np.ndarray) -> None:
    """`zd_quintic_spline`: t (k,), and value, rate and second (k, size), the last two of which are written between both ends."""
    to = (doubles(each, each.size, writable=True) for each in (np.zeros((len(t), 4)), rate, second))
    lib.zd_quintic_spline(*value.shape, doubles(t, len(t)), doubles(value, value.size), *to)
