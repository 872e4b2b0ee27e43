"""Least solutions of linear equations some of which may be redundant."""

from __future__ import annotations

import numpy as np

RANK = 1e-9             # of the largest singular value: smaller ones are those of redundant rows


def shortest(rows: np.ndarray, weight: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The x with rows @ x = right, or with the least squares of what is left in these units, for which weight * x is shortest."""
    unit = units(rows, weight)
    return np.linalg.lstsq(rows / weight * unit[:, None], right * unit, rcond=RANK)[0] / weight


def units(rows: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Factors (m,) with which rows keep their lengths when they are divided by weights.

    Without them the rows of light bodies would be so long that those of heavy ones seem redundant.
    """
    weighted = np.linalg.norm(rows / weight, axis=1)
    return np.where(weighted > 0, np.linalg.norm(rows, axis=1) / np.where(weighted > 0, weighted, 1.0), 1.0)


def least_along(rows: np.ndarray, free: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The least y with which rows @ free @ y is nearest to the right side; what moves the rows by rounding only is zero."""
    u, s, vt = np.linalg.svd(rows @ free, full_matrices=False)
    counts = s > RANK * np.linalg.norm(rows) * np.linalg.norm(free)
    return vt[counts].T @ ((u.T @ right)[counts] / s[counts])


def nullspace(rows: np.ndarray) -> np.ndarray:
    """An orthonormal basis (n, k) of what the rows leave free."""
    if not len(rows):
        return np.eye(rows.shape[1])
    _, s, vt = np.linalg.svd(rows)
    rank = int((s > RANK * s.max(initial=0.0)).sum())
    return vt[rank:].T
