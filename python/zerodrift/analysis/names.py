"""Names of directions: the coordinate that moves most."""

from __future__ import annotations

import numpy as np

from .state import State, scales


def dominant(at: State, dp: np.ndarray) -> str:
    """The coordinate that moves most along dp (nq,), in characteristic scales; of a quaternion the axis of rotation."""
    share = np.abs(dp) / scales(at.system, at.p).p
    names = [each.name for each in at.system.coordinates]
    for first in at.system.quaternions:
        w, x, y, z = at.p[first:first + 4]
        rows = 2 * np.array([[-x, w, -z, y], [-y, z, w, -x], [-z, -y, x, w]])      # rotation vector in the first axes
        turn = rows @ dp[first:first + 4]
        share[first:first + 4] = [0.0, *np.abs(turn)]
        base = names[first].rpartition(".")[0]
        names[first + 1:first + 4] = [f"{base or names[first]} rotation about {axis}" for axis in "xyz"]
    return names[int(share.argmax())] if share.size and share.max() > 0 else ""
