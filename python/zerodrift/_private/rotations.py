"""Rotations in space: matrices, unit quaternions (scalar first), turns by vectors, and angles."""

from __future__ import annotations

import numpy as np

AXES = "xyz"
COMPONENTS = {2: ("x", "y"), 3: ("x", "y", "z"), 9: tuple(row + column for row in AXES for column in AXES)}     # by number
CLOSED = 1e-12      # below it, the sine of a second angle is that of axes in line


def rotation_of(q: np.ndarray) -> np.ndarray:
    """The rotations (..., 3, 3) of quaternions (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=float), -1, 0)
    rows = [[w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1)) / (w * w + x * x + y * y + z * z)[..., None, None]


def quaternion_of(R: np.ndarray) -> np.ndarray:
    """Unit quaternion (4,) of a rotation matrix (3, 3); its scalar part is not negative.

    The matrix of products q q^T is linear in the entries of R. Its row with the largest diagonal entry, normalised, is q without
    loss of digits.
    """
    x, y, z = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    off = R + R.T
    d = np.diagonal(R)
    products = np.array([
        [1 + d[0] + d[1] + d[2], x, y, z],
        [x, 1 + d[0] - d[1] - d[2], off[0, 1], off[0, 2]],
        [y, off[0, 1], 1 - d[0] + d[1] - d[2], off[1, 2]],
        [z, off[0, 2], off[1, 2], 1 - d[0] - d[1] + d[2]]])
    q = products[int(np.argmax(np.diagonal(products)))]
    q = q / np.sqrt(q @ q)
    return -q if q[0] < 0 else q


def quaternions_of(R: np.ndarray) -> np.ndarray:
    """Unit quaternions (k, 4) of rotation matrices (k, 3, 3), with signs that make successive ones close."""
    q = np.array([quaternion_of(each) for each in R]).reshape(-1, 4)
    signs = np.cumprod(np.where((q[1:] * q[:-1]).sum(axis=1) < 0, -1.0, 1.0))
    q[1:] *= signs[:, None]
    return q


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Product a b of quaternions (..., 4): rotation b followed by rotation a."""
    scalar = a[..., :1] * b[..., :1] - (a[..., 1:] * b[..., 1:]).sum(axis=-1, keepdims=True)
    return np.concatenate([scalar, a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + np.cross(a[..., 1:], b[..., 1:])], axis=-1)


def turn(vector: np.ndarray) -> np.ndarray:
    """Quaternions (..., 4) of rotation vectors (..., 3) in rad."""
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.concatenate([np.cos(angle / 2), np.sinc(angle / (2 * np.pi)) / 2 * vector], axis=-1)


def is_order(axes: str) -> bool:
    """True for the axes of intrinsic angles, such as "zyx": three, no two neighbours alike."""
    return len(axes) == 3 and set(axes) <= set(AXES) and axes[0] != axes[1] != axes[2]


def angles_of(R: np.ndarray, order: str) -> np.ndarray:
    """Intrinsic angles (k, 3) in rad of rotations (k, 3, 3): turns about the body's own axes in this order, such as "zyx".

    Where the second angle makes the first and third axis parallel, these two are not determined: the third is 0 then.
    """
    i, j, k = (AXES.index(axis) for axis in order)
    if i == k:
        return _proper_angles(R, i, j)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    second = np.arctan2(sign * R[:, i, k], np.hypot(R[:, i, i], R[:, i, j]))
    is_open = np.hypot(R[:, i, i], R[:, i, j]) > CLOSED
    first = np.where(is_open, np.arctan2(-sign * R[:, j, k], R[:, k, k]), np.arctan2(sign * R[:, k, j], R[:, j, j]))
    third = np.where(is_open, np.arctan2(-sign * R[:, i, j], R[:, i, i]), 0.0)
    return np.stack([first, second, third], axis=1)


def _proper_angles(R: np.ndarray, i: int, j: int) -> np.ndarray:
    """Intrinsic angles (k, 3) in rad for orders such as "zxz", whose first and last axis are the same."""
    k = 3 - i - j
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    sine = np.hypot(R[:, i, j], R[:, i, k])
    second = np.arctan2(sine, R[:, i, i])
    is_open = sine > CLOSED
    first = np.where(is_open, np.arctan2(R[:, j, i], -sign * R[:, k, i]), np.arctan2(sign * R[:, k, j], R[:, j, j]))
    third = np.where(is_open, np.arctan2(R[:, i, j], sign * R[:, i, k]), 0.0)
    return np.stack([first, second, third], axis=1)
