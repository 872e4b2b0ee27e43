"""The start of mechanisms of many bodies: what is held, without dense matrices, by the core's own projection onto the rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .._gateway.consistent import nearest_velocities
from .._gateway.mechanisms import MechanismCore
from ..errors import InconsistentStart

LEAST_MASS = 1e-6       # of the largest, in the metric: what has no mass has so much
MET = 1e-9              # of what is held, and of the velocities: how nearly it is met
RANK = 1e-9             # of the largest singular value: what counts as dependent


class Target(NamedTuple):
    """A component of a measure, and the value it shall have."""

    name: str
    measure: int
    component: int
    value: float


def are_met(core: MechanismCore, t: float, p: np.ndarray, held: Sequence[Target], allowed: float) -> bool:
    """Whether positions that are held are met."""
    return all(abs(_measured(core, t, p, target)["value"][target.component] - target.value) <= allowed for target in held)


def least_velocities(core: MechanismCore, t: float, p: np.ndarray, held: Sequence[Target]) -> np.ndarray:
    """The least velocities, in the mass metric, with which all rows and held targets are met.

    They are the least that the rows allow, and a sum of what these leave of M^-1 times the row of each target.
    """
    mass = core.evaluate_stored(t, p, np.zeros(core.nv))["M"]      # of free bodies the diagonal
    mass = np.maximum(mass, LEAST_MASS * mass.max(initial=0.0))
    least = nearest_velocities(core, t, p, np.zeros(core.nv))
    rows, right = np.zeros((len(held), core.nv)), np.zeros(len(held))
    for i, target in enumerate(held):
        found = _measured(core, t, p, target)
        rows[i], right[i] = found["row"][target.component], target.value - found["value"][target.component]
    along = np.zeros_like(rows)
    for i, row in enumerate(rows):
        along[i] = nearest_velocities(core, t, p, least + row / mass) - least
    v = least + np.linalg.lstsq(rows @ along.T, right - rows @ least, rcond=RANK)[0] @ along
    left = np.abs(rows @ v - right)
    if left.max(initial=0.0) > MET * max(np.abs(right).max(), (np.abs(rows) @ np.abs(v)).max()):
        worst = int(left.argmax())
        raise InconsistentStart(f"start: {held[worst].name!r} asks for a velocity that the joints, or what else is held, do not "
                                f"allow in this pose; it is off by {left[worst]:.3g}")
    return v


def _measured(core: MechanismCore, t: float, p: np.ndarray, target: Target) -> dict[str, np.ndarray]:
    """What is held, at rest."""
    return core.measure_at(target.measure, t, p, np.zeros(core.nv))
