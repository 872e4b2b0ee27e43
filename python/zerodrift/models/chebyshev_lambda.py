"""Chebyshev's lambda mechanism, which draws half of its path nearly straight."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks
from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def chebyshev_lambda(*, crank: float = 0.1, speed: float = 2 * np.pi, mass: Mapping[str, float] | float = 0.2,
                     gravity: ArrayLike | None = None) -> Mechanism:
    """The four-bar of Chebyshev's plantigrade machine: its ground is 2, coupler and rocker are 2.5 cranks long.

    The coupler extends beyond its hinge with the rocker by another 2.5 cranks, to ``P``. In the first half of a turn P moves on a
    nearly straight line, 4 cranks above the ground; then it returns on an arc. Hoecken's linkage has the same proportions. The
    links are ``crank``, ``coupler`` and ``rocker``, and the motor is ``drive``.

    Parameters
    ----------
    crank : float
        Its length in m.
    speed : float
        Angular velocity of the crank, in rad/s.
    mass : float or dict of str to float
        In kg, of each link, or by link.
    gravity : array_like (2,), optional
        In m/s^2; left out: none.

    Returns
    -------
    Mechanism

    References
    ----------
    P. L. Chebyshev's plantigrade machine, shown at the Exposition Universelle, Paris, 1878.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.chebyshev_lambda(), 1.0, step=0.005)
    >>> x, y = sol["P.position"][:101].T        # the straight half
    >>> bool(abs(np.ptp(x) - 0.4) < 0.1), bool(np.ptp(y) < 0.01 * np.ptp(x))
    (True, True)
    """
    crank = checks.number("crank", crank, above=0)
    m = linkage({"A": (0, 0), "B": (0, 1), "C": (2, 2.5), "D": (2, 0), "P": (4, 4)},
                {"ground": "AD", "crank": "AB", "coupler": "BCP", "rocker": "DC"},
                lengths={"AB": 1, "AD": 2, "BC": 2.5, "CP": 2.5, "BP": 5, "DC": 2.5}, scale=crank, mass=mass, gravity=gravity,
                name="chebyshev_lambda")
    m.motor("drive", "A", speed=speed)
    return m
