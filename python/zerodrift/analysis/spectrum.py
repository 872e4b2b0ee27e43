"""Eigenvalues of a linearized motion, with exact zeros of ignorable coordinates removed before they are computed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

ZERO = 1e-9         # of the largest singular value of the scaled matrix: a direction that changes nothing
STILL = 1e-8        # relative to the largest magnitude: a smaller real part is rounding


class Spectrum(NamedTuple):
    """Eigenvalues (n,) in 1/s, eigenvectors (k, n) in the coordinates of the matrix, and the basis (k, j) of what was removed.

    Eigenvalues are sorted by magnitude; of a complex pair the one with positive imaginary part comes first.
    """

    eigenvalues: np.ndarray
    vectors: np.ndarray
    removed: np.ndarray

    @property
    def frequencies(self) -> np.ndarray:
        """Natural frequencies in Hz, ``abs(eigenvalues) / (2 pi)``."""
        return np.abs(self.eigenvalues) / (2 * np.pi)

    @property
    def dampings(self) -> np.ndarray:
        """Damping ratios, ``-real / abs``: 1 for a real eigenvalue that decays, negative for what grows."""
        size = np.abs(self.eigenvalues)
        return 0.0 - self.eigenvalues.real / np.where(size > 0, size, 1.0)

    @property
    def grows(self) -> bool:
        """An eigenvalue has a positive real part."""
        return bool((self.eigenvalues.real > STILL * self._largest).any())

    @property
    def decays(self) -> bool:
        """All eigenvalues that were not removed have negative real parts."""
        return bool((self.eigenvalues.real < -STILL * self._largest).all())

    @property
    def _largest(self) -> float:
        return float(np.abs(self.eigenvalues).max(initial=0.0))


def of_matrix(A: np.ndarray, *, has_vectors: bool = True) -> Spectrum:
    """The spectrum of a matrix (k, k), zeros of ignorable coordinates and of their speeds left out.

    Ignorable are directions z with A z = 0; the motion does not depend on them. Their speeds are directions that A turns into
    ignorable ones. Both span an invariant space, so that the other eigenvalues are those of A on the quotient.
    """
    removed = _ignorable(A)
    Q = complement(removed)
    values, vectors = np.linalg.eig(Q.T @ A @ Q) if Q.shape[1] else (np.zeros(0, complex), np.zeros((0, 0), complex))
    order = sorted(range(len(values)), key=lambda i: (round(float(np.abs(values[i])), 9), -values[i].imag, values[i].real))
    lifted = _lifted(A, Q, removed, values[order], vectors[:, order]) if has_vectors else np.zeros((len(A), 0), complex)
    return Spectrum(values[order].astype(complex), lifted, removed)


def _ignorable(A: np.ndarray) -> np.ndarray:
    """Orthonormal basis (k, j) of the null space of A, and of what A turns into it."""
    still = _null(A, ZERO * _size(A))
    if not still.shape[1]:
        return still
    Q = complement(still)
    speeds = Q @ _null(Q.T @ A @ Q, ZERO * _size(A))
    return np.linalg.qr(np.hstack([still, speeds]))[0]


def _size(A: np.ndarray) -> float:
    return float(np.abs(A).max(initial=0.0))


def _null(A: np.ndarray, below: float) -> np.ndarray:
    if not A.size or not np.any(A):
        return np.eye(A.shape[1])
    _, values, vectors = np.linalg.svd(A)
    return vectors[values <= below].T


def complement(basis: np.ndarray) -> np.ndarray:
    """Orthonormal basis of the orthogonal complement."""
    k, j = basis.shape
    return np.linalg.svd(basis, full_matrices=True)[0][:, j:] if j else np.eye(k)


def _lifted(A: np.ndarray, Q: np.ndarray, S: np.ndarray, values: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Eigenvectors of A (k, n) from those of the quotient: their parts in the removed space follow from (A - s) x = 0."""
    if not S.shape[1]:
        return Q @ vectors
    columns = [Q @ y + S @ np.linalg.lstsq(s * np.eye(S.shape[1]) - S.T @ A @ S, S.T @ A @ Q @ y, rcond=None)[0]
               for s, y in zip(values, vectors.T, strict=True)]
    return np.array(columns).reshape(len(values), len(A)).T
