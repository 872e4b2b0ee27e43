"""Watt's linkage, whose coupler's middle moves on a nearly straight line."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import swing


@checked
def watt(*, rocker: float = 0.5, coupler: float = 0.2, amplitude: float = 0.35, rate: float = 2 * np.pi,
         mass: Mapping[str, float] | float = 0.2, gravity: ArrayLike | None = None) -> Mechanism:
    """Two equal rockers, level in the middle position, and an upright coupler between them, whose middle ``P`` moves up and down.

    P stays on Watt's curve, an eight with a nearly straight piece through the middle. The links are ``left``, ``coupler`` and
    ``right``; the motor, ``drive``, has the left rocker at amplitude sin(rate t) from the x axis.

    Parameters
    ----------
    rocker, coupler : float
        Lengths in m.
    amplitude : float
        Amplitude of the left rocker, in rad.
    rate : float
        In rad/s.
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
        If the other rocker cannot follow so far.

    References
    ----------
    J. Watt, British patent 1432, 1784; E. S. Ferguson, Kinematics of Mechanisms from the Time of Watt, 1962. The curve:
    J. D. Lawrence, A Catalog of Special Plane Curves, Dover, 1972.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.watt(), 1.0, step=0.005)
    >>> x, y = sol["P.position"].T
    >>> bool(np.ptp(y) > 0.3), bool(np.ptp(x) < 0.02 * np.ptp(y))
    (True, True)
    """
    b, c = checks.number("rocker", rocker, above=0), checks.number("coupler", coupler, above=0)
    amplitude = checks.number("amplitude", amplitude, least=0)
    # The left rocker's end is farthest from the right rocker's hinge at the upper end of its swing, and has to be in reach.
    up = min(amplitude, np.pi - np.arctan(c / (2 * b)))
    apart = np.hypot(2 * b - b * np.cos(up), c + b * np.sin(up))
    if not apart < b + c:
        raise WrongValue(f"amplitude {amplitude:g} leads the left rocker's end {apart:g} m from the right rocker's hinge, and "
                         f"coupler and rocker together reach {b + c:g} m", "geometry")
    m = linkage({"A": (0, 0), "B": (b, 0), "C": (b, -c), "D": (2 * b, -c), "P": (b, -c / 2)},
                {"ground": "AD", "left": "AB", "coupler": "BPC", "right": "DC"}, mass=mass, gravity=gravity, name="watt")
    m.motor("drive", "A", angle=swing(amplitude, rate))
    return m
