"""The linearized flow on the tangent space: A = N^+ (dF N - N').

A steady motion carries the basis along. Elsewhere the basis stands still, N' = 0, and z = N^+ (p - p0, v - v0) are coordinates of
the constraint manifold near the state, with F = (A v, vdot) and, A^+ the left inverse of A in (1),

    N^+ (dp, dv) = (z1, z2),     z1 = W^T M A^+ dp,     z2 = V^T M (dv - Y z1).
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._private.gateway import acceleration
from .._private.rotations import rotation_of, turn
from ..runs.arguments import methods, settings
from ..runs.states.instant import KnownInstant
from ..systems.base import core_of
from . import differences
from .derivatives import Derivatives, sizes_of
from .frames import STEADY, frame_of
from .orbit import Orbit, changed
from .read_forces import Held
from .state import State, scales, state
from .tangent import Tangent

POSITION_ROUNDING = 1e-12    # of characteristic scales: displacements from a steady motion by rounding, times its stiffness


def accelerate(at: State) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations and multipliers, by the formulation that takes redundant constraints."""
    return acceleration(core_of(at.system), methods.row_of("formulations", "augmented"), settings.on_singular_row("stop"), at.t,
                        np.ascontiguousarray(at.p), np.ascontiguousarray(at.v))


class DerivativesAtRest(Derivatives):
    """Derivatives of accelerations at rest, with drives that stand still: C vdot = 0."""

    def __init__(self, tangent: Tangent, lam: np.ndarray, held: Held) -> None:
        super().__init__(tangent, np.zeros(tangent.at.system.nv), lam, held)
        self._jacobian = None

    def _of_residuals(self, dp: np.ndarray, dv: np.ndarray, dt: float) -> np.ndarray:
        found = super()._of_residuals(dp, dv, dt)
        found[self.at.system.nv:] = 0.0
        return found


class Flow:
    """The linearized flow at a state, parts of which are computed when they are first read.

    z are coordinates on the tangent space, (p, v) = (p0, v0) + N z. Constant efforts act. Multipliers of rest are given where
    drives stand still, otherwise the state moves on by its own equations.
    """

    def __init__(self, at: State, rest: np.ndarray | None = None, efforts: Mapping[str, float] | None = None) -> None:
        self.at, self.tangent, self.frame = at, Tangent(at), frame_of(at.system)
        self.is_at_rest, self.efforts = rest is not None, efforts or {}
        held = Held(self.efforts, np.array(list(self.efforts.values())), is_moving=rest is None)
        if rest is None:
            self.vdot, self.lam = held.motion(at)[2][:2] if held.names else accelerate(at)
            self.derivatives = Derivatives(self.tangent, self.vdot, self.lam, held)
        else:
            self.vdot, self.lam = np.zeros(at.system.nv), rest
            self.tangent.followed = np.zeros_like(self.tangent.displacements)
            self.derivatives = DerivativesAtRest(self.tangent, rest, held)
        self.w = self.frame.rates(at)
        self.acc = self.frame.rows(at) @ self.vdot + self.frame.bias(at)

    @functools.cached_property
    def jerk(self) -> np.ndarray:
        """The derivative of the accelerations acc along the motion, (n,); zero at rest."""
        dp, dv = self.at.A @ self.at.v, self.vdot
        if not dp.any() and not dv.any():
            return np.zeros_like(self.acc)
        dvdot = self.derivatives.both(dp, dv, 1.0)[0]
        return self._changes(self.at.v[:, None], dp[None], dv[None], dvdot[:, None], 1.0)[1][self.w.size:, 0]

    @functools.cached_property
    def _fit(self) -> tuple[np.ndarray, np.ndarray]:
        """Omega (3,), with which acc = Omega x w and jerk = Omega x acc as nearly as can be, and what is left of both (2 n,)."""
        second = 1.0 / (1.0 + float(np.abs(self.w).max(initial=0.0)))       # time that makes both comparable
        Omega = self.frame.steady_rotation(np.stack([self.w, second * self.acc]), np.stack([self.acc, second * self.jerk]))
        turned = self.frame.rotation(Omega, self.w.size)
        return Omega, np.concatenate([self.acc - turned @ self.w, second * (self.jerk - turned @ self.acc)])

    @property
    def Omega(self) -> np.ndarray:
        """Angular velocity (3,) of the steady motion; zero where the motion is not steady."""
        return self._fit[0] if self.is_steady else np.zeros(3)

    @property
    def left(self) -> np.ndarray:
        """Differences of accelerations and their derivatives from a steady motion, (2 n,)."""
        return self._fit[1]

    @functools.cached_property
    def is_steady(self) -> bool:
        """All rates turn with one angular velocity, and go on to do so along the orbit that follows."""
        return self._is_small(self._fit[1]) and self.change is None

    def _is_small(self, left: np.ndarray) -> bool:
        """Differences of accelerations are rounding."""
        largest = float(np.abs(left).max(initial=0.0))
        return largest <= STEADY * max(self.size, self.frame.weight) or largest <= POSITION_ROUNDING * self._stiffness

    @functools.cached_property
    def change(self) -> str | None:
        """The action that changes along the orbit, so that the motion is steady for an instant only; None: none does."""
        orbit, n = Orbit(self.at, self.frame, self.w, self._fit[0]), self.w.size
        acc = self.frame.rotation(orbit.Omega, n) @ self.w
        for s in () if self.is_at_rest else orbit.times(STEADY * np.sqrt(self.size)):
            there, turned = Flow(orbit.state(s), efforts=self.efforts), orbit.turned(s)
            violations = [there.at.Phi, there.at.C @ there.at.v + there.at.Phi_t]
            unit = np.linalg.norm(there.at.C * there.tangent.scale, axis=1)
            unit[unit == 0] = 1.0       # rows of zeros constrain nothing
            apart = max(float(np.abs(each / unit[:each.size]).max(initial=0.0)) for each in violations)
            if apart > STEADY * (1 + np.abs(self.w).max()) or not self._is_small(there.acc - turned @ acc):
                return changed(self.instant, there.instant, rotation_of(turn(orbit.Omega * s)))
        return None

    @property
    def instant(self) -> KnownInstant:
        """Any quantity there, with these accelerations."""
        return self.held().instant(self.at, self.at.p, self.at.v, self.vdot, self.lam)

    @functools.cached_property
    def _stiffness(self) -> float:
        """Largest change of the accelerations by a displacement of one characteristic scale, with the velocities that follow."""
        at, k = self.at, self.tangent.displacements.shape[1]
        sizes = np.abs(self.tangent.basis[:at.system.nq, :k] / scales(at.system, at.p).p[:, None]).max(axis=0, initial=0.0)
        changes = np.abs(self.frame.rows(at) @ self.columns[2][:, :k]).max(axis=0, initial=0.0)
        return float((changes / np.maximum(sizes, 1e-300)).max(initial=0.0))

    @functools.cached_property
    def size(self) -> float:
        """The size of accelerations here: those there are, and those of the forces before they cancel."""
        largest = np.abs(self.acc).max(initial=0.0) + np.abs(self.w).max(initial=0.0)**2
        mass = np.maximum(np.diag(self.at.M), 1e-300)
        forces = (np.abs(self.at.force) + np.abs(self.at.C.T) @ np.abs(self.lam)) / mass
        caused = np.abs(self.frame.rows(self.at)) @ np.where(mass > 1e-12 * mass.max(initial=0.0), forces, 0.0)
        return float(largest + caused.max(initial=0.0))

    @functools.cached_property
    def columns(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Basis E (2 n, k) in the frame, its rate (2 n, k), and the changes of vdot (nv, k) and lambda (m, k) along it."""
        at, nv, quasi = self.at, self.at.system.nv, self.tangent.quasi
        dp, dv = (at.A @ quasi[:nv]).T, quasi[nv:].T
        dvdot, dlam = self.derivatives.both(dp, dv)
        if self.derivatives.is_exact:
            dvdot = self.derivatives.of_accelerations(dp, dv)
        return (*self._changes(quasi[:nv], dp, dv, dvdot), dvdot, dlam)

    def _changes(self, delta: np.ndarray, dp: np.ndarray, dv: np.ndarray, dvdot: np.ndarray,
                 dt: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Directions (eta, nu), (2 n, k), and their rates in the frame; delta and dvdot (nv, k), dp (k, nq), dv (k, nv)."""
        at, frame, n = self.at, self.frame, self.w.size
        J = frame.rows(at)

        def rates(which: np.ndarray, h: np.ndarray) -> np.ndarray:
            v = at.v + h[:, None] * dv[which]
            rows, bias = frame.each(at.system, at.t + h * dt, at.p + h[:, None] * dp[which], v)
            return np.hstack([np.einsum("kij,kj->ki", rows, v), rows @ self.vdot + bias])

        nu, dacc = np.split(differences.each(rates, sizes_of(at, dp, dv, dt), 2 * n).T, 2)
        eta = J @ delta
        return np.vstack([eta, nu]), np.vstack([nu + frame.commutator(self.w) @ eta, dacc + J @ dvdot])

    @functools.cached_property
    def A(self) -> np.ndarray:
        """A (k, k), z' = A z."""
        E, rate, dvdot, _ = self.columns
        if not self.is_steady:
            return self._in_basis(self._changes_of_pdot, dvdot)
        turned = self.frame.rotation(self.Omega, self.w.size)
        values = rate - np.vstack([turned @ part for part in np.split(E, 2)])
        return np.linalg.lstsq(E, values, rcond=1e-13)[0] if E.size else np.zeros((E.shape[1], E.shape[1]))

    @property
    def rate(self) -> np.ndarray:
        """The affine term (k,): z' at the state itself, zero in a steady motion."""
        if self.is_steady:
            return np.zeros(self.tangent.quasi.shape[1])
        return self._in_basis(self.at.A @ self.at.v, self.vdot)

    def _in_basis(self, dp: np.ndarray, dv: np.ndarray) -> np.ndarray:
        """N^+ (dp, dv): coordinates z (k, ...) of directions dp (nq, ...), dv (nv, ...)."""
        at, tangent = self.at, self.tangent
        first = tangent.displacements.T @ at.M @ np.linalg.lstsq(at.A, dp, rcond=None)[0]
        return np.concatenate([first, tangent.velocities.T @ at.M @ (dv - tangent.followed @ first)])

    @property
    def _changes_of_pdot(self) -> np.ndarray:
        """Changes (nq, k) of p' = A v along the basis."""
        at, nq = self.at, self.at.system.nq
        dp, dv = np.split(self.tangent.basis, [nq])

        def rates(which: np.ndarray, h: np.ndarray) -> np.ndarray:
            return np.array([state(at.system, at.t, at.p + by * dp[:, i], at.v).A @ at.v
                             for i, by in zip(which, h, strict=True)])

        return at.A @ dv + differences.each(rates, sizes_of(at, dp.T, np.zeros(dv.T.shape)), nq).T

    def response(self, names: Sequence[str], j: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Changes of z' (k, j), vdot (nv, j) and of lambda (m, j), by unit efforts along quantities of j components."""
        V, nv = self.tangent.velocities, self.at.system.nv
        n = V.shape[1]

        def motions(which: np.ndarray, h: np.ndarray) -> np.ndarray:
            return np.array([np.concatenate(self.held(names, efforts).motion(self.at)[2][:2])
                             for efforts in h[:, None] * np.eye(j)[which]])

        vdot, lam = np.split(differences.each(motions, np.ones(j), nv + self.at.system.m).T, [nv])
        return np.vstack([np.zeros((self.tangent.quasi.shape[1] - n, j)), V.T @ self.at.M @ vdot]), vdot, lam

    def held(self, names: Sequence[str] = (), efforts: Any = ()) -> Held:
        """Efforts along quantities, after those that act here."""
        held = self.derivatives.held
        return Held((*held.names, *names), np.concatenate([held.efforts, efforts]), is_moving=not self.is_at_rest)
