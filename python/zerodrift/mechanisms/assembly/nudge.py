"""Positions near a singular pose, in which constraints are independent that are redundant in it."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from ...errors import CorrectionFailed, InconsistentStart
from .assembly import NUDGE, RANK, Assembly, Target, is_of_many, nullspace

NUDGED = "zd.assemble(m, nudge=True) starts beside it"
OTHERWISE = "start a little aside, or drive another joint"


def nudged(assembly: Assembly, p: np.ndarray, left_out: Collection[int] = (), far: float = NUDGE) -> np.ndarray:
    """Positions moved a little along a random free direction, ignoring the constraints left out, and assembled."""
    free = nullspace(np.delete(assembly.scaled_rows(p), sorted(left_out), axis=0))
    if not free.shape[1]:
        return p
    direction = free @ np.random.default_rng(0).standard_normal(free.shape[1])
    return assembly.nearby(_moved(assembly, p, far * direction / np.abs(direction).max()), left_out)


def aside(assembly: Assembly, p: np.ndarray, far: float, held: Sequence[Target]) -> np.ndarray:
    """Positions at a distance `far` from p that satisfy all constraints.

    They lie along the prescribed velocities, if any: branches cross in a singular pose, and not each allows these velocities.
    """
    found = _along(assembly, p, far, held)
    if found is None:
        found = nudged(assembly, p, far=far)
    if not assembly.is_closed(found, ()):
        raise CorrectionFailed(f"no positions in which all joints close were found {far:g} aside: take a smaller nudge")
    return found


def _along(assembly: Assembly, p: np.ndarray, far: float, held: Sequence[Target]) -> np.ndarray | None:
    """Positions along the prescribed velocities; None without such velocities, or if they lead back to p, as drives may."""
    try:
        v = assembly.velocities(p, held, ()) / assembly.scale
    except InconsistentStart:
        return None
    if not v.any():
        return None
    found = assembly.nearby(_moved(assembly, p, far * v / np.abs(v).max()))
    gone = np.abs(assembly.core.apart(found, p) / assembly.scale).max()
    return found if gone > far / 2 else None


def _moved(assembly: Assembly, p: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Positions after a step, given in rad and parts of the length."""
    return assembly.core.moved(p, step * assembly.scale)


def way_out(assembly: Assembly, p: np.ndarray, held: Sequence[Target]) -> str:
    """Advice for a singular pose: a nudge, if that leads to a regular pose whose velocities can be satisfied."""
    if is_of_many(assembly.core):       # without dense matrices, the nudge is not tried out
        return NUDGED
    try:
        found = aside(assembly, p, NUDGE, held)
        assembly.velocities(found, held, ())
    except (CorrectionFailed, InconsistentStart):
        return OTHERWISE
    return NUDGED if _rank(assembly, found) > _rank(assembly, p) else OTHERWISE


def _rank(assembly: Assembly, p: np.ndarray) -> int:
    s = np.linalg.svd(assembly.scaled_rows(p), compute_uv=False)
    return int((s > RANK * s.max(initial=0.0)).sum())
