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
from ..systems.base import core_of
from .state import State, scales

DEPENDENT = 1e-9        # of the largest singular value of scaled rows: what counts as dependent; rounding leaves 1e-13
MASSLESS = 1e-13        # of the largest: mass of a motion that counts as none

NO_MASS = ("a motion that the constraints allow has no mass: give mass and inertia to the bodies that take part in it, or "
           "constrain them")


def not_negligible(sizes: np.ndarray) -> np.ndarray:
    """Sizes (m,), at least a share of the largest: what is rounding beside the others stays negligible when divided by them."""
    return np.maximum(sizes, DEPENDENT * (sizes.max(initial=0.0) or 1.0))


def null_space(rows: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Basis (nv, r) of the velocities x with rows x = 0, rows (m, nv); it is orthonormal in scaled velocities, x / scale."""
    nv = rows.shape[1]
    if not len(rows):
        return np.diag(scale)
    rows = rows * scale
    _, values, vectors = np.linalg.svd(rows / not_negligible(np.linalg.norm(rows, axis=1))[:, None])
    rank = int((values > DEPENDENT * max(values.max(initial=0.0), 1e-300)).sum())
    return scale[:, None] * vectors[rank:].T if rank < nv else np.zeros((nv, 0))


def mass_orthonormal(Z: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Basis of the space of the columns of Z (nv, r) that is orthonormal in the metric of M.

    Raises
    ------
    SingularSystem
        If a motion in it has no mass.
    """
    weights, axes = np.linalg.eigh(Z.T @ M @ Z)
    if weights.size and not weights[0] > MASSLESS * weights[-1]:
        raise SingularSystem(NO_MASS)
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
        return self._free(self.at.holonomic)

    @functools.cached_property
    def velocities(self) -> np.ndarray:
        """V (nv, k_v): mass-orthonormal basis of the allowed velocity changes."""
        return self._free(self.at.C)

    def _free(self, rows: np.ndarray) -> np.ndarray:
        return mass_orthonormal(null_space(np.vstack([rows, self.held]), self.scale), self.at.M)

    @functools.cached_property
    def followed(self) -> np.ndarray:
        """Y (nv, k_p): change of the velocities that a displacement along W requires."""
        at, W = self.at, self.displacements
        if not at.system.m:
            return np.zeros_like(W)
        k, sizes = W.shape[1], np.abs(W / self.scale[:, None]).max(axis=0, initial=0.0)
        directions = np.zeros(k), np.ascontiguousarray((at.A @ W).T), np.zeros((k, len(W))), sizes
        p, v = np.ascontiguousarray(at.p, dtype=float), np.ascontiguousarray(at.v, dtype=float)
        core, rest = core_of(at.system), (np.zeros(len(W)), np.zeros(at.system.m))
        return -self.solve_rows(core.residuals_along("Psi", (float(at.t), p, v), *rest, directions).T)

    def solve_rows(self, right: np.ndarray) -> np.ndarray:
        """Minimum-norm x, in scaled velocities, with C x = right."""
        rows = self.at.C * self.scale
        length = not_negligible(np.linalg.norm(rows, axis=1))
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


def multipliers(at: State, right: np.ndarray, rows: np.ndarray | None = None) -> np.ndarray:
    """Multipliers with C^T lambda = right, (nv,) or (nv, k), in the least-squares sense.

    They have the minimum ``sum(lambda**2 * s**2)``, s**2 = diag(C inv(M) C^T).
    `rows` are those of C, and of whatever else acts; where M is singular, s is the length of the row in characteristic scales.
    """
    rows = at.C if rows is None else rows
    scale = scales(at.system, at.p).v
    size = _sizes_by_mass(at, rows, scale)
    return (np.linalg.lstsq((rows * scale / size[:, None]).T, (scale * right.T).T, rcond=DEPENDENT)[0].T / size).T


def _sizes_by_mass(at: State, rows: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Square roots (m,) of the diagonal of rows M^-1 rows^T; where M is singular, lengths of the scaled rows."""
    try:
        size = np.sqrt(np.maximum((rows * np.linalg.solve(at.M, rows.T).T).sum(axis=1), 0.0))
    except np.linalg.LinAlgError:
        size = np.linalg.norm(rows * scale, axis=1)
    return not_negligible(size)
