"""Assembly branches: whether the samples of a solution lie on one, or a correction has led to another.

The minors of the holonomic rows of C of order mh keep their signs while a mechanism moves, except at dead points, where
one of them is zero. So signs are compared at both ends of the steps whose displacement agrees least with their
velocities, and signs that differ between the first and the last sample are followed to two samples in succession
between which they change. Either the motion passes a dead point there, or it is interrupted. A path along the
constraints decides which: from one sample, steps are made towards the other, each projected onto the constraints. It
arrives at a sample of the same branch, and is held up at a distance from one of another. Samples that do not satisfy the
constraints, as those of runs without position corrections, are on no branch and are not compared.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import gateway
from ...systems.base import core_of

LARGEST = 100           # velocities
NEGLIGIBLE = 1e-6       # of the pivot of its column: a smaller minor has no sign
SMALL_STEP = 0.05       # in characteristic scales: of a path along the constraints
ARRIVED, HELD_UP = 1e-3, 0.1    # of the distance at the beginning: smaller, larger distances at the end of a path
FEWEST, MOST, APPROACHES = 16, 400, 60     # steps of a path; further ones at its end
DETOUR, DETOURS = 0.02, 50      # of the mean displacement: a larger detour is checked; so many of them
NEWTON = 6              # iterations of a projection


def changed_at(solution: Any) -> float | None:
    """Time of the first of two samples between which the branch changes; None: no change was found.

    Only solutions with a sample of every step are checked, as others may move too far from sample to sample, and only up to
    `LARGEST` velocities, as the matrices are dense.
    """
    system, rows = solution.system, len(solution.t)
    if not 0 < system.mh <= system.nv <= LARGEST or rows < 2 or rows != solution.stats["steps"] + 1:
        return None
    branch = _Branch(solution)
    if branch.rank < 1:
        return None
    for at in sorted({*branch.detours(), *branch.between_ends()}):
        if (branch.signs(at) * branch.signs(at + 1) < 0).any() and branch.is_interrupted(at):
            return float(solution.t[at])
    return None


class _Branch:
    """Minors of the constraints of a solution, and paths along them."""

    def __init__(self, solution: Any) -> None:
        self.solution, self.core = solution, core_of(solution.system)
        system = solution.system
        self.of_p, self.of_v = (np.array([gateway.is_length(each) for each in group], dtype=bool)
                                for group in (system.coordinates, system.velocities))
        length = self.core.c.length or float(np.abs(solution.p[0][self.of_p]).max(initial=0.0)) or 1.0
        self.scale_p, self.scale_v = np.where(self.of_p, length, 1.0), np.where(self.of_v, length, 1.0)
        self.rows, self.columns = _pivots(self._terms(0)[1])
        self.rank = len(self.rows)
        self.others = np.setdiff1d(np.arange(system.nv), self.columns)

    def _terms(self, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self._terms_at(self.solution.t[k], self.solution.p[k])

    def _terms_at(self, t: float, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Phi (mh,), C (mh, nv) in scaled velocities, and A (nq, nv) in scaled coordinates and velocities."""
        terms = self.core.evaluate(t, np.ascontiguousarray(p), np.zeros(self.core.nv))
        A = terms.get("A", np.eye(self.core.nq, self.core.nv))
        C = self.core.rows_above_rounding(t, np.ascontiguousarray(p), np.zeros(self.core.nv), terms["C"][:self.core.mh])
        return terms["Phi"], C * self.scale_v, A * self.scale_v / self.scale_p[:, None]

    def signs(self, k: int) -> np.ndarray:
        """Signs of minors at sample k: of the pivots' columns, and with one of them replaced by one of the others."""
        C = self._terms(k)[1][self.rows]
        B = C[:, self.columns]
        sign = np.linalg.slogdet(B)[0]
        if not sign:
            return np.zeros(1 + B.shape[0] * len(self.others))
        replaced = np.linalg.solve(B, C[:, self.others]).ravel()
        return sign * np.append(1.0, np.sign(replaced) * (np.abs(replaced) > NEGLIGIBLE))

    def detours(self) -> list[int]:
        """Samples whose displacement to the next differs most from h (v0 + v1) / 2; none where rates are not velocities."""
        solution = self.solution
        if self.core.provides & gateway.TERMS["A"].bit:
            return []
        mean = (solution.v[1:] + solution.v[:-1]) / 2 * np.diff(solution.t)[:, None]
        missed = np.abs((np.diff(solution.p, axis=0) - mean) / self.scale_p).max(axis=1)
        large = np.flatnonzero(missed > DETOUR * np.abs(mean / self.scale_p).max(axis=1))
        return [int(k) for k in large[np.argsort(-missed[large], kind="stable")][:DETOURS]]

    def between_ends(self) -> list[int]:
        """Samples after which minors change their signs, of those whose signs differ at the ends of the motion."""
        last = len(self.solution.t) - 1
        first = self.signs(0)
        found = (self.change(int(minor), first[minor], last) for minor in np.flatnonzero(first * self.signs(last) < 0))
        return [k for k in found if k is not None]

    def change(self, minor: int, sign: float, end: int) -> int | None:
        """Sample after which the sign of a minor changes, by bisection; None if the minor is zero at a sample tried."""
        begin = 0
        while end - begin > 1:
            middle = (begin + end) // 2
            there = self.signs(middle)[minor]
            if not there:
                return None
            begin, end = (middle, end) if there == sign else (begin, middle)
        return begin

    def is_interrupted(self, k: int) -> bool:
        """True if the paths from sample k to k + 1 and back both end before they reach their targets."""
        return self._path(k, k + 1) > HELD_UP and self._path(k + 1, k) > HELD_UP

    def _path(self, begin: int, end: int) -> float:
        """Remaining distance at the end of a path from one sample towards another, relative to the initial one; 0 if unknown."""
        t, p = self.solution.t, self.solution.p[begin].copy()
        target = self.solution.p[end]
        distance = np.abs((target - p) / self.scale_p).max()
        steps = max(FEWEST, int(np.ceil(distance / SMALL_STEP)))
        if not distance > 0 or steps > MOST or self._off(t[end], target) > ARRIVED * distance:
            return 0.0
        for step in range(steps + APPROACHES):
            share = 1 / max(steps - step, 2)
            time = t[begin] + (t[end] - t[begin]) * min(1, (step + 1) / steps)
            try:
                moved = self._step(time, p, share * (target - p) / self.scale_p)
            except Exception:       # of the user's functions, which may be undefined beside the motion
                return 0.0
            if moved is None:
                return 0.0
            p = moved
            left = np.abs((target - p) / self.scale_p).max() / distance
            if left < ARRIVED:
                break
        return float(left)

    def _off(self, t: float, p: np.ndarray) -> float:
        """Distance of p from the constraints, in characteristic scales, to first order."""
        Phi, C, A = self._terms_at(t, p)
        return float(np.abs(A @ (np.linalg.pinv(C, rcond=NEGLIGIBLE) @ Phi)).max())

    def _step(self, t: float, p: np.ndarray, wanted: np.ndarray) -> np.ndarray | None:
        """The part of a displacement that constraints allow, and a projection onto them; None: it does not converge."""
        Phi, C, A = self._terms_at(t, p)
        delta = np.linalg.lstsq(A, wanted, rcond=None)[0]
        delta -= np.linalg.pinv(C, rcond=NEGLIGIBLE) @ (C @ delta)
        p = p + self.scale_p * (A @ delta)
        for _ in range(NEWTON):
            Phi, C, A = self._terms_at(t, p)
            correction = np.linalg.pinv(C, rcond=NEGLIGIBLE) @ Phi
            p = p - self.scale_p * (A @ correction)
            if np.abs(correction).max() < 1e-9:
                return p
        return None


def _pivots(C: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Independent rows of C, and as many columns, from an elimination with complete pivoting."""
    C = C.copy()
    pivots: list[tuple[int, int]] = []
    enough = NEGLIGIBLE * np.abs(C).max(initial=0.0)
    for _ in range(min(C.shape)):
        row, column = np.unravel_index(np.abs(C).argmax(), C.shape)
        if not abs(C[row, column]) > enough:
            break
        pivots.append((int(row), int(column)))
        C = C - np.outer(C[:, column], C[row]) / C[row, column]
        C[row], C[:, column] = 0, 0
    rows, columns = np.array(pivots, dtype=int).reshape(-1, 2).T
    return rows, columns
