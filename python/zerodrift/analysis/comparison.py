"""Derivatives of accelerations beside differences of accelerations at states on the constraints."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..runs.operations import acceleration, project
from ..runs.settings import Projection
from ..systems.base import BaseSystem
from . import differences
from .derivatives import Derivatives, Direction
from .state import scales, state
from .tangent import Tangent

TIGHT = Projection(tol=1e-13, max_iterations=50)


class Compared(NamedTuple):
    """A derivative (nv,) of vdot along a tangent direction, the same by differences, and the estimated error of these."""

    given: np.ndarray
    expected: np.ndarray
    error: float


def derivatives_of_accelerations(system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray,
                                 random: np.random.Generator) -> Compared | None:
    """Both derivatives along one random tangent direction of a state on the constraints; None where nothing is free.

    The given one is that of `Derivatives`: from the Jacobian of the system, which Radau's method uses, where it has one,
    otherwise from its residuals. The other one needs nothing but accelerations and projections.

    Raises
    ------
    ZerodriftError
        If a state near this one has no acceleration.
    """
    at = state(system, t, p, v)
    tangent = Tangent(at)
    if not tangent.basis.shape[1]:
        return None
    column = tangent.basis @ random.standard_normal(tangent.basis.shape[1])
    dp, dv = np.split(column, [system.nq])
    given = Derivatives(tangent, *acceleration(system, p, v, t, "augmented")).of_accelerations(dp, dv)

    def along(h: float) -> np.ndarray:
        there = project(system, p + h * dp, v + h * dv, t, projection=TIGHT, formulation="augmented")
        return acceleration(system, *there, t, "augmented")[0]

    return Compared(given, *differences.with_error(along, Direction(dp=dp, dv=dv).size(scales(system, p), at)))
