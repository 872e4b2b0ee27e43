"""Hoecken's linkage, whose coupler point moves on a nearly straight line, at nearly constant speed, in a part of the turn."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def hoecken(*, crank: float = 0.1, ground: float = 2.5, coupler: float = 3.25, speed: float = 2 * np.pi,
            mass: Mapping[str, float] | float = 0.2, gravity: ArrayLike | None = None) -> Mechanism:
    """A crank-rocker whose rocker and both halves of the coupler are equally long; its point ``P`` draws a line.

    The proportions are those that Norton tabulates as the straightest over 140 degrees of the crank: there, while the crank turns
    from 110 to 250 degrees, P moves 3.623 cranks along x, and deviates from its line by 0.023 % of that. With ``ground=2,
    coupler=2.5`` it is Chebyshev's lambda mechanism. The links are ``crank``, ``coupler`` and ``rocker``, and the motor is
    ``drive``.

    Parameters
    ----------
    crank : float
        Its length in m.
    ground, coupler : float
        Lengths in cranks: between the fixed hinges; of the rocker, and of the coupler to its hinge and from there to P.
    speed : float
        Angular velocity of the crank, in rad/s.
    mass : float or dict of str to float
        In kg, of each link, or by link.
    gravity : array_like (2,), optional
        In m/s^2; left out: none.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the crank cannot make full turns: the rocker has to be longer than half of ground and crank together, and the ground
        longer than the crank.

    References
    ----------
    K. Hoecken, Steigerung der Wirtschaftlichkeit durch zweckmaessige Anwendung der Getriebelehre, Werkstattstechnik, 1926;
    R. L. Norton, Design of Machinery, chapter 3, straight-line mechanisms.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.hoecken(), 1.0, step=0.0025)
    >>> is_straight = abs(sol["crank.angle"] - np.pi) < np.radians(70)
    >>> x, y = sol["P.position"][is_straight].T
    >>> bool(np.ptp(x) > 0.35), bool(np.ptp(y) < 0.0003 * np.ptp(x))
    (True, True)
    """
    g, c = checks.number("ground", ground, above=1), checks.number("coupler", coupler, above=0)
    if not c > (g + 1) / 2:
        raise WrongValue(f"coupler must be more than half of ground and crank, {(g + 1) / 2:g}, so that the crank can turn "
                         f"round, not {c:g}", "geometry")
    x = (g + 1) / 2
    y = np.sqrt(c**2 - (g - x)**2)
    m = linkage({"A": (0, 0), "B": (1, 0), "C": (x, y), "D": (g, 0), "P": (2 * x - 1, 2 * y)},
                {"ground": "AD", "crank": "AB", "coupler": "BCP", "rocker": "DC"},
                lengths={"AB": 1, "AD": g, "BC": c, "CP": c, "BP": 2 * c, "DC": c}, scale=checks.number("crank", crank, above=0),
                mass=mass, gravity=gravity, name="hoecken")
    m.motor("drive", "A", speed=speed)
    return m
