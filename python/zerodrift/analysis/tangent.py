"""The tangent space of a system at a state: velocities and displacements that its constraints allow.

Displacements are quasi-coordinates: dp = A delta, which keeps the lengths of unit quaternions. With W a basis of the null space
of the holonomic rows of C and V one of all rows, both orthonormal in the mass metric,

    N = [ A W   0 ]         Y = -C^+ (C v + Phi_t)_p A W,   (C v + Phi_t)_p the derivative of (5) with respect to positions,
        [ Y     V ]

is a basis (nq + nv, k) of the tangent space of the manifold Phi = 0, C v + Phi_t = 0. Ranks are found by singular values, so that
redundant constraints count once and no coordinate is chosen as independent.
"""

from __future__ import annotations

import functools

import numpy as np

from ..errors import SingularSystem
from . import differences
from .state import State, scales, state

DEPENDENT = 1e-9        # of the largest singular value of scaled rows: what counts as dependent; rounding leaves 1e-13
MASSLESS = 1e-13        # of the largest: mass of a motion that counts as none


def scaled_rows(rows: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Rows in scaled velocities, each divided by its length; rows that are rounding beside the others stay negligible."""
    rows = rows * scale
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    return rows / np.maximum(length, max(DEPENDENT * length.max(initial=0.0), 1e-300))


def null_space(rows: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Orthonormal basis (nv, r), in scaled velocities, of the velocities that are allowed by rows (m, nv); returned unscaled."""
    nv = rows.shape[1]
    if not len(rows):
        return np.diag(scale)
    _, values, vectors = np.linalg.svd(scaled_rows(rows, scale))
    rank = int((values > DEPENDENT * max(values.max(initial=0.0), 1e-300)).sum())
    return scale[:, None] * vectors[rank:].T if rank < nv else np.zeros((nv, 0))


def mass_orthonormal(Z: np.ndarray, M: np.ndarray) -> np.ndarray:
    """The same space as Z (nv, r) with a basis that is orthonormal in the metric of M.

    Raises
    ------
    SingularSystem
        If a motion in it has no mass.
    """
    weights, axes = np.linalg.eigh(Z.T @ M @ Z)
    if weights.size and not weights[0] > MASSLESS * weights[-1]:
        raise SingularSystem("a motion that the constraints allow has no mass: give mass and inertia to the bodies that take "
                             "part in it, or constrain them")
    return Z @ (axes / np.sqrt(weights)) @ axes.T


class Tangent:
    """The tangent space at a state, parts of which are computed when they are first read.

    Parameters
    ----------
    at : State
    held : ndarray (k, nv), optional
        Rows of further constraints, which count as holonomic.
    """

    def __init__(self, at: State, held: np.ndarray | None = None) -> None:
        self.at, self.scale = at, scales(at.system, at.p).v
        self.held = np.zeros((0, at.system.nv)) if held is None else held

    @functools.cached_property
    def displacements(self) -> np.ndarray:
        """W (nv, k_p): mass-orthonormal basis of the displacements in quasi-coordinates."""
        return mass_orthonormal(null_space(np.vstack([self.at.holonomic, self.held]), self.scale), self.at.M)

    @functools.cached_property
    def velocities(self) -> np.ndarray:
        """V (nv, k_v): mass-orthonormal basis of the allowed velocity changes."""
        return mass_orthonormal(null_space(np.vstack([self.at.C, self.held]), self.scale), self.at.M)

    @functools.cached_property
    def followed(self) -> np.ndarray:
        """Y (nv, k_p): change of the velocities that a displacement along W requires."""
        at, W = self.at, self.displacements
        if not at.system.m:
            return np.zeros_like(W)
        columns = [differences.along(lambda h, dp=at.A @ w: _velocity_residual(at, at.p + h * dp), self._size(w)) for w in W.T]
        Psi_W = np.array(columns).reshape(W.shape[1], at.system.m).T
        return -self.solve_rows(Psi_W)

    def _size(self, delta: np.ndarray) -> float:
        """The size of a displacement in characteristic scales."""
        return float(np.abs(delta / self.scale).max(initial=0.0))

    def solve_rows(self, right: np.ndarray) -> np.ndarray:
        """Minimum-norm x, in scaled velocities, with C x = right."""
        rows = self.at.C * self.scale
        length = np.linalg.norm(rows, axis=1)
        length = np.maximum(length, max(DEPENDENT * length.max(initial=0.0), 1e-300))
        right = (right.T / length).T
        x = np.linalg.lstsq(rows / length[:, None], right, rcond=DEPENDENT)[0]
        return (x.T * self.scale).T

    @functools.cached_property
    def quasi(self) -> np.ndarray:
        """Basis (2 nv, k) of the tangent space in displacements and velocities, both (nv,)."""
        W, V = self.displacements, self.velocities
        return np.block([[W, np.zeros((len(W), V.shape[1]))], [self.followed, V]])

    @functools.cached_property
    def basis(self) -> np.ndarray:
        """N (nq + nv, k): basis of the tangent space in (p, v)."""
        nv = self.at.system.nv
        return np.vstack([self.at.A @ self.quasi[:nv], self.quasi[nv:]])


def _velocity_residual(at: State, p: np.ndarray) -> np.ndarray:
    """C v + Phi_t at another position."""
    there = state(at.system, at.t, p, at.v)
    return there.C @ at.v + there.Phi_t


def multipliers(at: State, right: np.ndarray, rows: np.ndarray | None = None) -> np.ndarray:
    """Multipliers with C^T lambda = right in the least-squares sense, of minimum ``sum(lambda**2 * s**2)``, s**2 = diag(C
    inv(M) C^T).

    `rows` are those of C, and of whatever else acts; where M is singular, s is the length of the row in characteristic scales.
    """
    rows = at.C if rows is None else rows
    if not len(rows):
        return np.zeros(0)
    scale = scales(at.system, at.p).v
    try:
        size = np.sqrt(np.maximum((rows * np.linalg.solve(at.M, rows.T).T).sum(axis=1), 0.0))
    except np.linalg.LinAlgError:
        size = np.linalg.norm(rows * scale, axis=1)
    size = np.maximum(size, max(DEPENDENT * size.max(initial=0.0), 1e-300))
    scaled = (rows / size[:, None] * scale).T
    return np.linalg.lstsq(scaled, scale * right, rcond=DEPENDENT)[0] / size
