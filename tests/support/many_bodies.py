"""Components of measures without the zeros of their rows, as the assembly of many bodies reads them."""

from typing import NamedTuple

import numpy as np

from zerodrift._private.core import ffi
from zerodrift._private.gateway.base import doubles


class Components(NamedTuple):
    """Value (k,); first velocities of the two bodies that each touches, at (k, 2), -1: the ground; row (k, 2, width)."""

    value: np.ndarray
    at: np.ndarray
    row: np.ndarray


def components(core, p, v, which):
    """Components by (measure, component) indices, of measures of positions or velocities, at one state."""
    many, k, numbers = core.many_bodies(), len(which), np.array(which, dtype=np.int32).reshape(-1)
    found = Components(np.zeros(k), np.zeros((k, 2), dtype=np.int32), np.zeros((k, 2, many.width)))
    many.components(many.mechanism, doubles(p, core.nq), doubles(v, core.nv), k, ffi.from_buffer("int[]", numbers),
                    doubles(found.value, k, writable=True), ffi.from_buffer("int[]", found.at, require_writable=True),
                    doubles(found.row, found.row.size, writable=True), ffi.new("double[]", max(1, core.c.measures.scratch)))
    return found
