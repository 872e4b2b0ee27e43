"""Klann's leg, which walks as a spider does."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

# The patent's numbers of its joints are beside their letters here.
SKETCH = {"O": (1.599, 0.750), "A": (1.366, 1.366), "B": (1.009, 0.574), "M": (1.331, 0.750), "C": (0.741, 0.750),
          "D": (0.232, 0.866), "E": (0.866, 1.500), "F": (0.0, 0.0)}         # 15, 9, 11, 29, 27, 35, 37, 33
LINKS = {"ground": "OAB", "crank": "OM", "connecting rod": "MCD", "lower rocker": "BC", "upper rocker": "AE", "leg": "EDF"}
LENGTHS = {"OM": 0.268, "MC": 0.590, "CD": 0.522, "MD": 1.105, "BC": 0.321, "AE": 0.518, "ED": 0.897, "DF": 0.897, "EF": 1.732}


@checked
def klann(*, speed: float = -2 * np.pi, mass: Mapping[str, float] | float = 1.0, scale: float = 0.4,
          gravity: ArrayLike = (0.0, -9.81)) -> Mechanism:
    """The leg of Klann's walking machines: a crank, two rockers, a connecting rod and the leg, six bars of Stephenson's kind.

    The foot, ``F``, is on the ground for half of a turn and lifted high in the other half. The links are ``crank``,
    ``connecting rod``, ``lower rocker``, ``upper rocker`` and ``leg``; the motor is ``drive``, at ``O``.

    Parameters
    ----------
    speed : float
        Angular velocity of the crank, in rad/s.
    mass : float or dict of str to float
        In kg, of each link, or by link.
    scale : float
        Metres in a unit of the patent's lengths.
    gravity : array_like (2,)
        In m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    J. C. Klann, Walking device, US patent 6,260,862 B1, 2001; lengths are rounded to a thousandth of its unit.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.klann(), 1.0, step=0.005)
    >>> foot = sol["F.position"]      # (201, 2) m
    >>> is_low = foot[:, 1] < foot[:, 1].min() + 0.15 * np.ptp(foot[:, 1])
    >>> bool(is_low.mean() > 0.4)
    True
    """
    leg = linkage(SKETCH, LINKS, lengths=LENGTHS, scale=scale, mass=mass, gravity=gravity, name="klann")
    leg.motor("drive", "O", speed=speed)
    return leg
