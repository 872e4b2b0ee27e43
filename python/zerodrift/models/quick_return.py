"""Whitworth's quick return: a crank drives a slotted lever, and this a ram, which returns faster than it cuts."""

from __future__ import annotations

import numpy as np

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def quick_return(*, ground: float = 0.025, crank: float = 0.010, lever: float = 0.065, rod: float = 0.030, height: float = 0.050,
                 speed: float = -15.0, mass: float = 0.1, ram_mass: float = 0.5, gravity: float = 0.0) -> Mechanism:
    """A crank above the lever's hinge, whose pin slides in the lever; a rod from the lever's end moves a ram along x.

    With a crank shorter than the distance of the hinges the lever swings, as in shapers; with a longer one it makes full turns,
    as Whitworth's does. The links are ``crank``, ``lever``, ``rod`` and ``ram``; the lever's slot is ``block``, the ram's guide
    ``guide``, and the motor ``drive``.

    Parameters
    ----------
    ground : float
        Height of the crank's hinge above the lever's, in m.
    crank, lever, rod : float
        Lengths in m.
    height : float
        Height of the ram's line above the lever's hinge, in m.
    speed : float
        Angular velocity of the crank, in rad/s.
    mass, ram_mass : float
        Mass of each of crank, lever and rod, and of the ram, in kg.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the rod is too short for the lever's swing, or crank and ground are equally long.

    References
    ----------
    M. Campbell, S. S. Nestinger, Computer-Aided Design and Analysis of the Whitworth Quick Return Mechanism, University of
    California, Davis, 2004: the class CQuickReturn, with these lengths and this speed in its example.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.quick_return(), 2 * np.pi / 15, step=1e-3)
    >>> bool((sol["guide.speed"] < 0).mean() < 0.4)       # it returns in less than two fifths of the time
    True
    """
    g, a, b, c = (checks.number(name, value, above=0) for name, value in
                  (("ground", ground), ("crank", crank), ("lever", lever), ("rod", rod)))
    height = checks.number("height", height)
    lowest = b * np.sqrt(1 - (a / g)**2) if a < g else -b
    reach = max(abs(b - height), abs(lowest - height))
    if a == g or not reach < c:
        raise WrongValue(f"rod must be longer than {reach:g} m, by which the lever's end moves off the ram's line at a "
                         f"height of {height:g} m, and crank other than ground, {g:g} m; rod is {c:g} m, and crank {a:g} m",
                         "geometry")
    m = Mechanism("quick_return", gravity=(0.0, -checks.number("gravity", gravity)))
    pin = np.array([a, g])
    end = b * pin / np.hypot(*pin)
    ram_at = (end[0] + np.sqrt(c**2 - (end[1] - height)**2), height)
    crank_link, lever_link = m.link("crank", (0, g), pin, mass), m.link("lever", (0, 0), end, mass)
    rod_link, ram = m.link("rod", end, ram_at, mass), m.body("ram", ram_mass, at=ram_at)
    m.revolute("O", m.ground, crank_link.start)
    m.revolute("A", m.ground, lever_link.start)
    m.slot("block", lever_link, crank_link.end, axis=pin)
    m.revolute("B", lever_link.end, rod_link.start)
    m.revolute("C", rod_link.end, ram)
    m.prismatic("guide", m.ground, ram, axis=(1, 0))
    m.motor("drive", "O", speed=speed)
    return m
