"""A motion in double-double arithmetic: Taylor's method, with positions and velocities projected onto the constraints each step.

Steps are as long as the last two coefficients and the residual of the rates at the step's end allow. Residuals of the constraints
are computed in double-double arithmetic, and their corrections in double precision, which is enough as they are small.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .._private.gateway.compiled.precise import Precise
from ..errors import Diverged, StepFailed, of_code
from . import double_double as dd

ROUNDED = 2.0**-105     # relative rounding error of most operations, of which one or two perturb a run
RANK = 1e-10            # relative singular value below which constraints are redundant
CORRECTIONS = 4         # of the start, each of which gains the digits of a double
RESIDUAL = 10           # bound of h times the difference of rates, in units of the order times the tolerance
SHORTER = 0.5           # factor of a step that is made again
MAX_STEPS = 10_000     # attempts, each of which takes about a millisecond
Series = tuple[np.ndarray, np.ndarray]      # coefficients of p and v


class Settings(NamedTuple):
    """Settings of a run: order of the series, tolerance relative to the size of the motion, and part of the step it allows."""

    order: int
    tolerance: float
    share: float = 1.0


class Piece(NamedTuple):
    """Polynomial of a step: its beginning, and the coefficients of p and v."""

    t: float
    series: Series


class PreciseRun(NamedTuple):
    """Samples p (k, nq, 2) and v (k, nv, 2), the number of steps, and if requested, the polynomials of all steps."""

    p: np.ndarray
    v: np.ndarray
    steps: int
    pieces: tuple[Piece, ...] = ()


class PreciseMotion:
    """Runs of one system from one start.

    Parameters
    ----------
    functions : Precise
    p0, v0 : ndarray (nq, 2), (nv, 2)
    quaternions : sequence of int
    held : tuple of lists of int
        Coordinates and velocities that are exact at the start.
    size : float
        Largest coordinate of the motion, for tolerances.
    t0 : float
        Time of the start, in s.
    longest : float
        Largest step, in s.
    """

    def __init__(self, functions: Precise, p0: np.ndarray, v0: np.ndarray, quaternions: Sequence[int],
                 held: tuple[Sequence[int], Sequence[int]], size: float, t0: float, longest: float = math.inf) -> None:
        self.functions, self.start, self.quaternions, self.held = functions, (p0, v0), tuple(quaternions), held
        self.size, self.t0, self.longest = size, float(t0), longest

    def run(self, times: np.ndarray, settings: Settings, shift: int = 0, *, keeps_pieces: bool = False) -> PreciseRun:
        """Samples at increasing times from the start on.

        `shift` other than 0 perturbs numbers and start by rounding, by chance with this seed. With `keeps_pieces`, the
        polynomials of all steps are kept.
        """
        functions, (p, v) = self.functions, self.start
        p, v = self._assembled(functions, dd.of(self.t0), p, v)
        if shift:
            functions, p, v = self._shifted(shift, p, v)
        return _Run(self, functions, times, settings, keeps_pieces).made(self.t0, p, v)

    def _shifted(self, seed: int, p: np.ndarray, v: np.ndarray) -> tuple[Precise, np.ndarray, np.ndarray]:
        chance = np.random.default_rng(seed)

        def off(x: np.ndarray) -> np.ndarray:
            return dd.times(x, np.stack([np.ones(len(x)), ROUNDED * chance.choice([-2.0, -1.0, 1.0, 2.0], len(x))], axis=-1))

        return self.functions.with_numbers(off(self.functions.numbers)), off(p), off(v)

    def _assembled(self, functions: Precise, t: np.ndarray, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Start projected onto the constraints; held coordinates and velocities are unchanged."""
        for _ in range(CORRECTIONS):
            p = self._on_positions(functions, t, p, v, self.held[0])
        for _ in range(CORRECTIONS):
            v = self._on_velocities(functions, t, p, v, self.held[1])
        return p, v

    def projected(self, functions: Precise, t: np.ndarray, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """State projected onto the constraints, which it nearly satisfies: (25a) and (25b)."""
        if not functions.mh:
            return self._normalized(p), self._on_velocities(functions, t, p, v, ())
        found = functions.residuals(t, p, v)
        correction = _Correction(found["M"], found["C"][: functions.mh])
        p = self._normalized(dd.minus(p, dd.of(found["A"] @ correction.of(found["Phi"][:, 0]))))
        if functions.mn:
            return p, self._on_velocities(functions, t, p, v, ())
        return p, dd.minus(v, dd.of(correction.of(functions.residuals(t, p, v)["Psi"][:, 0])))

    def _on_positions(self, functions: Precise, t: np.ndarray, p: np.ndarray, v: np.ndarray,
                      held: Sequence[int]) -> np.ndarray:
        mh = functions.mh
        if mh:
            found = functions.residuals(t, p, v)
            p = dd.minus(p, dd.of(found["A"] @ _Correction(found["M"], found["C"][:mh], held).of(found["Phi"][:, 0])))
        return self._normalized(p)

    def _normalized(self, p: np.ndarray) -> np.ndarray:
        for first in self.quaternions:
            p = p.copy()
            p[first : first + 4] = _normalized(p[first : first + 4])
        return p

    def _on_velocities(self, functions: Precise, t: np.ndarray, p: np.ndarray, v: np.ndarray,
                       held: Sequence[int]) -> np.ndarray:
        if not functions.m:
            return v
        found = functions.residuals(t, p, v)
        return dd.minus(v, dd.of(_Correction(found["M"], found["C"], held).of(found["Psi"][:, 0])))


class _Run:
    """One run: its steps, and the samples within them."""

    def __init__(self, motion: PreciseMotion, functions: Precise, times: np.ndarray, settings: Settings,
                 keeps_pieces: bool) -> None:
        self.motion, self.functions, self.times, self.settings = motion, functions, times, settings
        self.p, self.v = np.empty((len(times), functions.nq, 2)), np.empty((len(times), functions.nv, 2))
        self.done, self.pieces, self.keeps_pieces = 0, list[Piece](), keeps_pieces
        self.scales = np.full(functions.nq, motion.size), np.full(functions.nv, motion.size)

    def made(self, t: float, p: np.ndarray, v: np.ndarray) -> PreciseRun:
        end, steps = float(self.times[-1]), 0
        series = self._series(t, p, v)
        self._sample(t, t, series)
        h = self._step(series)
        while self.done < len(self.times):
            t1, steps = min(t + h, end), steps + 1      # times are doubles, and their differences pairs
            if t1 <= t or steps > MAX_STEPS:
                raise of_code("step-underflow", StepFailed("step size underflow in double-double arithmetic"))
            by = dd.minus(dd.of(t1), dd.of(t))
            after = self.motion.projected(self.functions, dd.of(t1), *(self.functions.value(x, by) for x in series))
            following = self._series(t1, *after)
            if self._residual(series, following, by) > 1:
                h = SHORTER * by[0]
                continue
            self._sample(t, t1, series)
            if self.keeps_pieces:
                self.pieces.append(Piece(t, series))
            t, series, h = t1, following, self._step(following)
        return PreciseRun(self.p, self.v, steps, tuple(self.pieces))

    def _series(self, t: float, p: np.ndarray, v: np.ndarray) -> Series:
        return self.functions.series(self.settings.order, dd.of(t), p, v)

    def _step(self, series: Series) -> float:
        """Longest step for which the last two terms are as small as the tolerance."""
        order, tolerance, share = self.settings
        h = math.inf
        for k in (order - 1, order):
            size = max(float(np.abs(x[k, :, 0] / scale).max()) for x, scale in zip(series, self.scales, strict=True))
            if not size < math.inf:
                raise Diverged("the series in double-double arithmetic is not finite")
            h = min(h, (tolerance / size) ** (1 / k) if size else math.inf)
        return min(share * h, self.motion.longest)

    def _residual(self, series: Series, following: Series, h: np.ndarray) -> float:
        """Residual of the equations of motion at h, times h, relative to the tolerance."""
        order, tolerance, _ = self.settings
        k = np.arange(1, order + 1)[:, None]
        worst = 0.0
        for x, y, scale in zip(series, following, self.scales, strict=True):
            rates = np.ascontiguousarray(dd.times(x[1:], dd.of(np.broadcast_to(k, x[1:, :, 0].shape))))
            apart = dd.minus(self.functions.value(rates, h), y[1])
            worst = max(worst, float(np.abs(h[0] * apart[:, 0] / scale).max()))
        return worst / (RESIDUAL * order * tolerance)

    def _sample(self, t: float, t1: float, series: Series) -> None:
        """Store the samples from t to t1, from the polynomial of the step."""
        stop = int(np.searchsorted(self.times, t1, side="right"))
        for i in range(self.done, stop):
            h = dd.minus(dd.of(self.times[i]), dd.of(t))
            self.p[i], self.v[i] = (self.functions.value(x, h) for x in series)
        self.done = max(self.done, stop)


class _Correction:
    """Change of the velocities, shortest in the metric of M, that is subtracted to make up for residuals of constraints."""

    def __init__(self, M: np.ndarray, C: np.ndarray, held: Sequence[int] = ()) -> None:
        self.nv, self.free = len(M), np.setdiff1d(np.arange(len(M)), held) if len(held) else slice(None)
        M, C = M[self.free][:, self.free], C[:, self.free]
        W = np.linalg.solve(M, C.T)
        S = C @ W
        size = S.diagonal()
        scale = 1 / np.sqrt(np.where(size > 0, size, 1.0))
        values, axes = np.linalg.eigh(scale[:, None] * S * scale)
        axes, values = axes[:, values > RANK * values[-1]], values[values > RANK * values[-1]]
        self.matrix = (W * scale) @ (axes / values) @ (axes.T * scale)

    def of(self, residual: np.ndarray) -> np.ndarray:
        """Change (nv,) for residuals (m,)."""
        found = np.zeros(self.nv)
        found[self.free] = self.matrix @ residual
        return found


def _normalized(q: np.ndarray) -> np.ndarray:
    """Unit quaternion (4, 2) from one that is nearly normalized."""
    for _ in range(2):
        excess = dd.minus(dd.total(dd.times(q, q)), dd.of(1.0))[0]
        q = dd.times(q, np.broadcast_to(dd.minus(dd.of(1.0), dd.of(excess / 2)), q.shape))
    return q
