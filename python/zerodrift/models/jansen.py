"""Jansen's leg, which walks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

SKETCH = {"Z": (0, 0), "Y": (-38, -7.8), "X": (15, 0), "V": (-19, 33), "U": (-15, -40), "W": (-72, 10), "T": (-60, -30),
          "F": (-20, -85)}
LINKS = {"ground": "ZY", "crank": "ZX", "j": "XV", "k": "XU", "bed": "YVW", "c": "YU", "f": "WT", "foot": "UTF"}
LENGTHS = {"ZX": 15, "XV": 50, "XU": 61.9, "YV": 41.5, "VW": 55.8, "YW": 40.1, "YU": 39.3, "WT": 39.4, "TU": 36.7, "TF": 65.7,
           "UF": 49}


@checked
def jansen(*, speed: float = -2 * np.pi, mass: Mapping[str, float] | float = 1.0, scale: float = 0.01,
           gravity: ArrayLike = (0.0, -9.81)) -> Mechanism:
    """The leg of Jansen's walking machines: one crank, seven links, and a foot whose path is flat below.

    The links are ``crank``, ``j``, ``k``, ``bed``, ``c``, ``f`` and ``foot``, the motor is ``drive``, and the toe is ``F``.

    Parameters
    ----------
    speed : float
        Angular velocity of the crank, in rad/s.
    mass : float or dict of str to float
        In kg, of each link, or by link.
    scale : float
        Metres in a unit of the published lengths.
    gravity : array_like (2,)
        In m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    T. Jansen, The Great Pretender, 010 Publishers, 2007.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.jansen(), 1.0, step=0.005)
    >>> toe = sol["F.position"]     # (201, 2) m
    >>> bool(np.ptp(toe[:, 0]) > 3 * np.ptp(toe[:, 1]))
    True
    """
    leg = linkage(SKETCH, LINKS, lengths=LENGTHS, scale=scale, mass=mass, gravity=gravity, name="jansen")
    leg.motor("drive", "Z", speed=speed)
    return leg
