"""Positions tracked along prescribed quantities, each from the last, on one assembly branch.

A predictor follows the velocities that the prescribed rates determine, Newton's method corrects. A part of the way is refused,
and halved, where the corrector moves more than a fifth of the predictor, as it does where it leaves the branch, and where the
measure has no position any more. What remains after that is a dead point: the last position before it, which is never passed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..errors import CorrectionFailed, SingularSystem
from ..systems.base import BaseSystem
from .names import dominant
from .quantities import find, rows_of
from .retraction import moved, onto
from .state import State, scales, state
from .tangent import DEPENDENT, null_space, row_lengths, scaled_rows

LARGEST_STEP = 0.25         # of a part, in characteristic scales
LARGEST_CORRECTION = 0.2    # of the predictor's step
SMALLEST_PART = 1e-9        # of the way between two samples
NEAR_SINGULAR = 1e-3        # of the largest singular value: a dead point may be what ends the way
CONTRADICTING = 1e-3        # of the changes of targets
SINGULAR = 1e-6             # of the largest singular value of scaled rows: next to a dead point


class Target(NamedTuple):
    """A time and values (size,) of the prescribed quantities."""

    t: float
    values: dict[str, np.ndarray]


class DeadPoint(CorrectionFailed):
    """No position exists beyond a target; `reached` is the last target that was reached, `p` (nq,) the position there."""

    def __init__(self, reached: Target, p: np.ndarray) -> None:
        super().__init__("a dead point")
        self.reached, self.p = reached, p


class Tracker:
    """Positions of a system along targets.

    Parameters
    ----------
    system : BaseSystem
    names : list of str
        The prescribed quantities, of positions.
    """

    def __init__(self, system: BaseSystem, names: list[str]) -> None:
        self.system, self.names, self._rest = system, names, np.zeros(system.nv)

    def target(self, t: float, p: np.ndarray) -> Target:
        """Target whose values are those of the prescribed quantities at a position p (nq,)."""
        at = state(self.system, t, p, self._rest)
        return Target(t, {name: find(at, name, "prescribed").value for name in self.names})

    def check_determined(self, t: float, p: np.ndarray) -> None:
        """Refuses quantities that do not determine the positions.

        Raises
        ------
        SingularSystem
            Naming the coordinate that stays free.
        """
        at = state(self.system, t, p, self._rest)
        rows = np.vstack([at.holonomic, rows_of(at, self.names)])
        free = null_space(rows, scales(self.system, p).v)
        if free.shape[1]:
            names = ", ".join(sorted({dominant(at, at.A @ column) for column in free.T}))
            raise SingularSystem(f"the prescribed quantities must determine all positions of {self.system.name}, and leave "
                                 f"{free.shape[1]} free: {names}; prescribe more, or begin beside a singular position with near=")

    def follow(self, p: np.ndarray, here: Target, there: Target) -> np.ndarray:
        """The position at the next target.

        Raises
        ------
        DeadPoint
            If there is no position beyond a target between the two.
        """
        done, part = 0.0, 1.0
        while done < 1.0:
            part = min(part, 1.0 - done)
            now, then = _between(here, there, done), _between(here, there, done + part)
            found = self._part(p, now, then)
            if found is None:
                part /= 2
                if part < SMALLEST_PART:
                    raise DeadPoint(now, p)
                continue
            p, done, part = found, done + part, 2 * part
        return p

    def contradiction(self, p: np.ndarray, here: Target, there: Target) -> float:
        """Largest relative residual of the changes between two targets after the best displacement in the least-squares sense.

        Above 0, the prescribed quantities contradict each other or the constraints; 0 next to a dead point, where the rows are
        singular.
        """
        rows, change = self._rows(state(self.system, here.t, p, self._rest), here, there)
        scale = scales(self.system, p).v
        values = np.linalg.svd(scaled_rows(rows, scale), compute_uv=False)
        if len(rows) <= self.system.nv or values[self.system.nv - 1] < NEAR_SINGULAR * values[0]:
            return 0.0
        length = row_lengths(rows * scale)
        rows, change = rows * scale / length[:, None], change / length
        left = np.abs(rows @ np.linalg.lstsq(rows, change, rcond=DEPENDENT)[0] - change).max(initial=0.0)
        off = float(left / max(np.abs(change).max(initial=0.0), 1e-300))
        return off if off > CONTRADICTING else 0.0

    def _rows(self, at: State, here: Target, there: Target) -> tuple[np.ndarray, np.ndarray]:
        """Rows (mh + size, nv) of the constraints and prescribed quantities, and their changes between targets."""
        m, dt = self.system.mh, there.t - here.t
        found = [find(at, name, "prescribed") for name in self.names]
        changes = [there.values[name] - here.values[name] for name in self.names]
        return np.vstack([at.holonomic, *(each.row for each in found)]), np.concatenate([-at.Phi_t[:m] * dt, *changes])

    def _part(self, p: np.ndarray, here: Target, there: Target) -> np.ndarray | None:
        """The position after a part of the way; None where that is too long to be sure of it."""
        at, scale = state(self.system, here.t, p, self._rest), scales(self.system, p).p
        delta = self._predicted(at, here, there)
        if delta is None or (step := float(np.abs(at.A @ delta / scale).max(initial=0.0))) > LARGEST_STEP:
            return None
        guess = moved(at, delta)
        try:
            found = onto(self.system, there.t, guess, there.values)
        except CorrectionFailed:
            return None
        corrected = float(np.abs((found - guess) / scale).max(initial=0.0))
        return found if corrected <= LARGEST_CORRECTION * step + 1e-9 else None

    def _predicted(self, at: State, here: Target, there: Target) -> np.ndarray | None:
        """The displacement (nv,) that the rates of the targets determine; None where they do not."""
        rows, change = self._rows(at, here, there)
        scale = scales(self.system, at.p).v
        length = row_lengths(rows * scale)
        values = np.linalg.svd(scaled_rows(rows, scale), compute_uv=False)
        if len(values) < self.system.nv or values[self.system.nv - 1] < SINGULAR * values[0]:
            return None
        return scale * np.linalg.lstsq(rows * scale / length[:, None], change / length, rcond=DEPENDENT)[0]


def _between(here: Target, there: Target, part: float) -> Target:
    """The target at a part of the way."""
    if part >= 1.0:
        return there
    values: Mapping[str, np.ndarray] = {name: value + part * (there.values[name] - value) for name, value in here.values.items()}
    return Target(here.t + part * (there.t - here.t), dict(values))
