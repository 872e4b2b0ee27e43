"""Points that rigid bodies carry: a film stores the motion of two points of a body in the plane, of three in space, and
coordinates of the others in the axes that these span.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

TOLERANCE = 1e-6        # of the picture: points that move more in the axes of the body are not carried
SLIM = 0.05             # of the longest distance: a third point nearer to the line through the first two spans no axes
FEW = 6                 # points of a body are stored individually up to this number

Carried = dict[int, tuple[tuple[int, ...], np.ndarray]]


def carried(table: np.ndarray, bodies: Iterable[Sequence[int]], size: float) -> Carried:
    """Points at rest in the axes of their body.

    Parameters
    ----------
    table : ndarray (times, points, dimension)
    bodies : iterable of sequences of int
        Points of one body each.
    size : float
        Extent of the picture, m.

    Returns
    -------
    dict of int to (tuple of int, ndarray)
        For each such point: the points that span the axes, and its coordinates in them.
    """
    found: Carried = {}
    for body in bodies:
        base = _base(table[0], list(dict.fromkeys(body))) if len(set(body)) > FEW else None
        if base is None:
            continue
        origin, axes = table[:, base[0]], _axes(table[:, base])
        for number in set(body) - set(base):
            own = np.linalg.solve(axes[0], table[0, number] - origin[0])
            if np.abs(origin + axes @ own - table[:, number]).max() < TOLERANCE * size:
                found[number] = base, own
    return found


def _base(points: np.ndarray, body: list[int]) -> tuple[int, ...] | None:
    """Points of a body that are far apart: two in the plane, three in space, or None."""
    first = body[0]
    offsets = points[body] - points[first]
    distances = np.linalg.norm(offsets, axis=1)
    second = int(distances.argmax())
    if not distances[second] > 0:
        return None
    if points.shape[1] == 2:
        return first, body[second]
    beside = np.linalg.norm(np.cross(offsets, offsets[second] / distances[second]), axis=1)
    third = int(beside.argmax())
    return (first, body[second], body[third]) if beside[third] > SLIM * distances[second] else None


def _axes(base: np.ndarray) -> np.ndarray:
    """Matrices (times, d, d) whose columns are the axes that points (times, 2 or 3, d) span: their differences, and a normal
    as long as the first.
    """
    along = base[:, 1] - base[:, 0]
    if base.shape[2] == 2:
        return np.stack([along, along[:, ::-1] * (-1, 1)], axis=2)
    aside = base[:, 2] - base[:, 0]
    return np.stack([along, aside, np.cross(along, aside) / np.linalg.norm(along, axis=1)[:, None]], axis=2)
