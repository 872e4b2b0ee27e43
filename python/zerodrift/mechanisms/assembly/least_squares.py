"""Minimum-norm solutions of linear equations, which may be redundant."""

from __future__ import annotations

import numpy as np

RANK = 1e-9             # of the largest singular value: bound below which rows are redundant


def shortest(rows: np.ndarray, weight: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution x of rows @ x = right, or of least squares, with the smallest norm of weight * x."""
    unit = units(rows, weight)
    return np.linalg.lstsq(rows / weight * unit[:, None], right * unit, rcond=RANK)[0] / weight


def units(rows: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Factors (m,) that preserve the lengths of rows when they are divided by the weights.

    Without them the rows of light bodies would be so long that those of heavy ones seem redundant.
    """
    weighted = np.linalg.norm(rows / weight, axis=1)
    return np.where(weighted > 0, np.linalg.norm(rows, axis=1) / np.where(weighted > 0, weighted, 1.0), 1.0)


def least_along(rows: np.ndarray, free: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Minimum-norm y with rows @ free @ y nearest to the right side, without directions that change rows by rounding only."""
    u, s, vt = np.linalg.svd(rows @ free, full_matrices=False)
    counts = s > RANK * np.linalg.norm(rows) * np.linalg.norm(free)
    return vt[counts].T @ ((u.T @ right)[counts] / s[counts])


def nullspace(rows: np.ndarray) -> np.ndarray:
    """Orthonormal basis (n, k) of the null space of the rows."""
    if not len(rows):
        return np.eye(rows.shape[1])
    _, s, vt = np.linalg.svd(rows)
    rank = int((s > RANK * s.max(initial=0.0)).sum())
    return vt[rank:].T
