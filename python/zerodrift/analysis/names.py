"""Names of directions: the coordinates and velocities that change most along them."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from .state import State, scales


def labelled(at: State) -> tuple[list[str], np.ndarray]:
    """Names, and the matrix (n, nq) of scaled changes of what they name, of quaternions rotations, by a displacement."""
    names, rows = [each.name for each in at.system.coordinates], np.diag(1 / scales(at.system, at.p).p)
    for first in at.system.quaternions:
        w, x, y, z = at.p[first:first + 4]
        base = names[first].rpartition(".")[0] or names[first]
        rows[first] = 0.0
        rows[first + 1:first + 4, first:first + 4] = 2 * np.array([[-x, w, -z, y], [-y, z, w, -x], [-z, -y, x, w]])
        names[first + 1:first + 4] = [f"{base} rotation about {axis}" for axis in "xyz"]
    return names, rows


def dominant(at: State, dp: np.ndarray, without: Collection[str] = ()) -> str:
    """The coordinate that moves most along dp (nq,), in characteristic scales; of a quaternion the axis; "" where none does."""
    names, rows = labelled(at)
    share = np.abs(rows @ dp) * [name not in without for name in names]
    return names[int(share.argmax())] if share.size and share.max() > 0 else ""


def pivots(at: State, basis: np.ndarray) -> list[str]:
    """One name for each of some independent directions (nq + nv, j): of coordinates first, then of velocities."""
    names, rows = labelled(at)
    nq = at.system.nq
    left = np.vstack([rows @ basis[:nq], basis[nq:] / scales(at.system, at.p).v[:, None]])
    names, found = [*names, *(each.name for each in at.system.velocities)], list[str]()
    for first, last in ((0, len(rows)), (len(rows), len(left))):
        while len(found) < basis.shape[1]:
            size = np.linalg.norm(left[first:last], axis=1)
            if size.max(initial=0.0) < 1e-6 * np.abs(basis).max():
                break
            best = first + int(size.argmax())
            found.append(names[best])
            along = left[best] / np.linalg.norm(left[best])
            left = left - np.outer(left @ along, along)
    return found
