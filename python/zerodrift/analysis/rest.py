"""Search for a position of rest: Newton's method on V^T (f - d) = 0 within a trust region, turned downhill.

The balance is that of the tangent space: V (nv, k) is a mass-orthonormal basis of the velocities that all constraints allow at
(t, p, v = 0) with drives at rest, Phi_t = 0. Its derivative along V, the stiffness K, has the curvature of the constraints
weighted by their multipliers. A step solves K z = V^T (f - d) where K is positive definite, and goes against the force and
along negative curvature reversed where it is not, so that the forces do positive work. Projection onto the constraints is the
retraction.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping

import numpy as np

from ..errors import ZerodriftError
from ..systems.base import BaseSystem, core_of
from .derivatives import FREE, of_residuals_along
from .quantities import rows_of
from .read_forces import Held
from .retraction import moved, onto
from .state import scales, state
from .tangent import Tangent, multipliers

ITERATIONS = 300
FIRST_RADIUS, LARGEST_RADIUS = 0.1, 0.3     # of the trust region, largest change of a coordinate in characteristic scales
SMALLEST_RADIUS = 1e-14
ROUGHLY_FLAT = 1e-7     # with the derivatives of an iteration, which are right to 1e-8
FLAT = 1e-9         # relative to the terms of the stiffness: a smaller one is rounding; differences have errors of 1e-12
BALANCED = 1e-13    # relative to the sum of magnitudes of the forces: a smaller resultant is rounding
SYMMETRIC = 1e-3    # of the stiffness: the directions without stiffness are those of its symmetric part
UPHILL, WANDERING = 1.2, 20     # towards any balance the residual may grow that much in a step, in so many first steps
SHORT_STEP = 1e-6   # characteristic scales: the step after it, with accurate derivatives, leaves rounding
DISTANT = 1e3       # characteristic lengths: a mechanism that went so far falls


class Balance:
    """The balance of forces at a position of rest, parts of which are computed when they are first read."""

    def __init__(self, system: BaseSystem, t: float, p: np.ndarray, held: Mapping[str, np.ndarray], *,
                 is_rough: bool = False) -> None:
        self.is_rough, self.zero = is_rough, ROUGHLY_FLAT if is_rough else FLAT
        self.at, self.names = state(system, t, p, np.zeros(system.nv)), held
        self.held = rows_of(self.at, held)
        self.rows = np.vstack([self.at.C, self.held])
        self.tangent = Tangent(self.at, self.held)
        self.hold = Held(held) if held else FREE
        if held and core_of(system).functions:
            self.at = self.at._replace(force=self.hold.motion(self.at)[1])

    @functools.cached_property
    def V(self) -> np.ndarray:
        """Basis (nv, k) of the free directions."""
        return self.tangent.velocities

    @functools.cached_property
    def force(self) -> np.ndarray:
        """V^T (f - d), (k,)."""
        return self.V.T @ self.at.force

    @functools.cached_property
    def rounding(self) -> float:
        """The size of the force that counts as zero: from its terms, and from the rounding of positions times the stiffness."""
        unit = float(np.abs(self.reach).max(initial=0.0)) or 1.0
        return BALANCED * float(np.linalg.norm(self.magnitudes) + self.stiffest / max(unit, 1e-300))

    @functools.cached_property
    def magnitudes(self) -> np.ndarray:
        """Sums (k,) of the magnitudes of the terms of the forces before they cancel, those of the constraints included."""
        return np.abs(self.V.T) @ (self.at.magnitudes + np.abs(self.rows.T) @ np.abs(self.multipliers))

    @functools.cached_property
    def stiffest(self) -> float:
        """The size of the stiffness before its terms cancel: forces that turn with the motion, and the stiffness itself."""
        return float(np.abs(self.stiffness).max(initial=0.0) + (self.magnitudes * np.abs(self.reach)).max(initial=0.0))

    @functools.cached_property
    def curvature(self) -> tuple[np.ndarray, np.ndarray]:
        """Eigenvalues (k,) and eigenvectors (k, k) of the symmetric part of the stiffness."""
        return np.linalg.eigh((self.stiffness + self.stiffness.T) / 2)

    @functools.cached_property
    def flat(self) -> float:
        """The curvature that counts as zero.

        Away from a balance the stiffness is symmetric up to the unbalanced force only.
        """
        return self.zero * self.stiffest + float(np.abs(self.stiffness - self.stiffness.T).max(initial=0.0))

    @property
    def is_stable(self) -> bool:
        """No curvature is negative."""
        return bool(self.curvature[0].min(initial=0.0) >= -self.flat)

    @functools.cached_property
    def multipliers(self) -> np.ndarray:
        """Multipliers of the constraints and of what is held, (m + held,)."""
        return multipliers(self.at, self.at.force, self.rows)

    @property
    def stiffness(self) -> np.ndarray:
        """K (k, k): the derivative of V^T (d - f + C^T lambda) along V, multipliers frozen."""
        return self._both[0]

    @property
    def damping(self) -> np.ndarray:
        """D (k, k): the derivative of V^T (d - f) with respect to the velocity along V; without rough derivatives only."""
        return self._both[1]

    @functools.cached_property
    def _both(self) -> tuple[np.ndarray, np.ndarray]:
        V = self.V
        if self.is_rough:
            return self._along(V, np.zeros((len(V), 0))), np.zeros((0, 0))
        K, D = np.split(self._along(V, V), 2, axis=1)
        return K, D

    def _along(self, displacements: np.ndarray, velocities: np.ndarray) -> np.ndarray:
        """Derivatives (k, i + j) of the projected force along displacements (nv, i) and velocities (nv, j)."""
        at, system, lam, m = self.at, self.at.system, self.multipliers, self.at.system.m
        i, j = displacements.shape[1], velocities.shape[1]
        dp, dv = np.zeros((i + j, system.nq)), np.zeros((i + j, system.nv))
        dp[:i], dv[i:] = (at.A @ displacements).T, velocities.T
        return self.V.T @ of_residuals_along(at, at.v, lam[:m], dp, dv, parts="r", is_rough=self.is_rough, held=self.hold)

    def family(self) -> np.ndarray:
        """Displacements (nv, j) along which a balance stays one, beyond what nonholonomic constraints allow."""
        W = self.tangent.displacements
        if not self.at.system.mn or W.shape[1] == self.V.shape[1]:
            return np.zeros((len(W), 0))
        _, values, vectors = np.linalg.svd(self._along(W, W[:, :0]))
        rank = int((values > ROUGHLY_FLAT * max(values.max(initial=0.0), 1e-300)).sum())
        return W @ vectors[rank:].T

    @functools.cached_property
    def residual(self) -> float:
        """Norm of the force in the mass metric."""
        return math.sqrt(self.force @ self.force)

    @functools.cached_property
    def reach(self) -> np.ndarray:
        """Changes (nq, k) of the coordinates along the basis, in characteristic scales."""
        return self.at.A @ self.V / scales(self.at.system, self.at.p).p[:, None]

    def size(self, z: np.ndarray) -> float:
        """Largest change of a coordinate by a step, in characteristic scales."""
        return float(np.abs(self.reach @ z).max(initial=0.0))

    def is_stationary(self) -> bool:
        """True if the projected force is zero to rounding."""
        return self.residual <= self.rounding

    def largest_force(self) -> str:
        """The velocity that the unbalanced force accelerates most."""
        share = np.abs(self.V @ self.force) / self.tangent.scale
        return self.at.system.velocities[int(share.argmax())].name if share.size else ""


def downhill(here: Balance) -> np.ndarray:
    """A step z (k,) along which the forces do work, Newton's where no curvature is negative and it is short."""
    curvature, axes = here.curvature
    if here.is_stable and here.size(step := nearest(here)) < FIRST_RADIUS and not _is_pushed(here, step, 0.5):
        return step
    along = axes.T @ here.force
    at_balance = np.abs(along) <= 10 * here.rounding
    along = np.where((curvature < -here.flat) & at_balance, np.abs(curvature), along)       # unstable: left along its curvature
    step = along / np.maximum(np.abs(curvature), max(here.zero * here.stiffest, 1e-300))
    return axes @ np.where((np.abs(curvature) <= here.flat) & at_balance, 0.0, step)


def _is_pushed(here: Balance, step: np.ndarray, share: float) -> bool:
    """That share of the force remains after a step, as it does in a direction without stiffness."""
    left = here.force - here.stiffness @ step
    return math.sqrt(left @ left) > 10 * here.rounding + share * here.residual


def nearest(here: Balance) -> np.ndarray:
    """Newton's step z (k,), flat directions left out."""
    K, (curvature, axes), flat = here.stiffness, here.curvature, here.zero * here.stiffest
    if np.abs(K - K.T).max(initial=0.0) > max(SYMMETRIC * np.abs(K).max(initial=0.0), flat):
        return np.linalg.lstsq(K, here.force, rcond=min(float(flat / np.linalg.norm(K, 2)), 0.5))[0]
    U = axes[:, np.abs(curvature) > flat]
    return U @ np.linalg.solve(U.T @ K @ U, U.T @ here.force)


class Search:
    """Newton's method in a trust region.

    Parameters
    ----------
    system, t, held
        As of `Balance`.
    is_downhill : bool
        True: only a stable position is accepted; False: any equilibrium.
    """

    def __init__(self, system: BaseSystem, t: float, held: Mapping[str, np.ndarray], *, is_downhill: bool) -> None:
        self.system, self.t, self.held, self.is_downhill = system, t, held, is_downhill
        self.iterations, self.radius = 0, FIRST_RADIUS

    def run(self, p: np.ndarray) -> tuple[Balance, bool]:
        """The last balance from a position on, and whether it is an equilibrium."""
        self._last = Balance(self.system, self.t, p, self.held, is_rough=True)
        for short in (SHORT_STEP, 0.0):
            try:
                here, is_found = self._search(self._last, short)
            except (ZerodriftError, ArithmeticError):       # the system cannot be evaluated around the last position
                return self._last, False
            if not is_found:
                return here, False
            found = self._polished(here)
            if found.residual <= 10 * found.rounding:
                break
        return found, found.residual <= 10 * found.rounding

    def _polished(self, here: Balance) -> Balance:
        """The balance with accurate derivatives, after one more step of Newton's method where that is better."""
        try:
            if (np.abs(here.curvature[0]) <= here.flat).any():      # accurate derivatives tell soft directions from flat ones
                here = Balance(self.system, self.t, here.at.p, self.held)
            p = onto(self.system, self.t, moved(here.at, here.V @ nearest(here)), self.held)
            there = Balance(self.system, self.t, p, self.held)
            is_better = there.residual < here.residual
        except (ZerodriftError, ArithmeticError):      # also where the system cannot be evaluated
            is_better = False
        return there if is_better else Balance(self.system, self.t, here.at.p, self.held)

    def _search(self, here: Balance, short: float) -> tuple[Balance, bool]:
        """The balance with which iterations end, and whether an accurate step from there leads to an equilibrium."""
        start, self.radius, scale = here.at.p, FIRST_RADIUS, scales(self.system, here.at.p).p
        for _ in range(ITERATIONS):
            z = (downhill if self.is_downhill else nearest)(here)
            size = here.size(z)
            if size < 1e-13 or self._is_done(here):
                return here, here.residual <= 10 * here.rounding
            if size < short and (here.is_stable or not self.is_downhill) and not _is_pushed(here, z, 1e-3):
                return here, True
            there = self._step(here, z)
            if there is None or np.abs((there.at.p - start) / scale).max() > DISTANT:
                return here, here.residual <= 10 * here.rounding
            self._last = here = there
            self.iterations += 1
        return here, False

    def _is_done(self, here: Balance) -> bool:
        """The balance holds to rounding; at a saddle the search for a stable position goes on."""
        return here.is_stationary() and (here.is_stable or not self.is_downhill)

    def _step(self, here: Balance, z: np.ndarray) -> Balance | None:
        """The balance after a step that is accepted, as long as the trust region allows; None: no step is."""
        size = here.size(z)
        while self.radius > SMALLEST_RADIUS:
            part = min(1.0, self.radius / size)
            try:
                p = onto(self.system, self.t, moved(here.at, here.V @ (part * z)), self.held)
                there = Balance(self.system, self.t, p, self.held, is_rough=True)
                quality = self._quality(here, there, part * z)
            except (ZerodriftError, ArithmeticError):      # also where the system cannot be evaluated
                quality = -1.0
            if quality > 0:
                self.radius = min(LARGEST_RADIUS, self.radius * (2.0 if quality > 0.75 and part < 1 else 1.0))
                return there
            self.radius = min(self.radius, part * size) / 4
        return None

    def _quality(self, here: Balance, there: Balance, z: np.ndarray) -> float:
        """One for a step as the stiffness foretells, not positive for one that is refused."""
        if there.residual <= 0.5 * here.residual and (not self.is_downhill or here.is_stable):
            return 1.0
        if not self.is_downhill:
            return 0.5 if there.residual < (UPHILL if self.iterations < WANDERING else 1.0) * here.residual else -1.0
        step = here.V @ z
        work = float(step @ (here.at.force + there.at.force)) / 2
        foretold = float(z @ here.force - z @ here.stiffness @ z / 2)
        return 1.0 if abs(work) <= here.rounding * math.sqrt(z @ z) else work / max(abs(foretold), 1e-300)
