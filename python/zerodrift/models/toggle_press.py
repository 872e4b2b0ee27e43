"""A toggle press: a crank straightens a knee, whose force grows as it becomes straight."""

from __future__ import annotations

import numpy as np

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def toggle_press(*, link: float = 0.3, crank: float = 0.05, rod: float = 0.3, distance: float = 0.352, speed: float = 2 * np.pi,
                 mass: float = 1.0, ram_mass: float = 20.0, load: float = 1000.0, gravity: float = 9.81) -> Mechanism:
    """Two equal links between the frame's head and the ram, and a crank with a rod that pushes the knee between them.

    The knee is nearly straight where crank and rod are in line. The links are ``crank``, ``rod``, ``upper``, ``lower`` and
    ``ram``; the knee is ``K``, the ram's guide ``guide``, the motor ``drive``.

    Parameters
    ----------
    link, crank, rod : float
        Lengths of upper and lower link, crank and rod, in m.
    distance : float
        Distance of the crank's hinge from the ram's line, at the height of a straight knee, in m; above crank and rod together.
    speed : float
        Angular velocity of the crank, in rad/s.
    mass, ram_mass : float
        Mass of each link, and of the ram, in kg.
    load : float
        Force that presses against the ram, in N.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the crank would push the knee through, or pull it further than the links reach.

    Notes
    -----
    The ram's way follows from the law of cosines, the crank's moment from virtual work. The numbers are round ones.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.toggle_press(), 1.0, step=0.002)
    >>> bool(sol["upper.angle"].min() > -np.pi / 2)       # it is never quite straight
    True
    """
    a, r, c = (checks.number(name, value, above=0) for name, value in (("link", link), ("crank", crank), ("rod", rod)))
    d = checks.number("distance", distance)
    if not (r + c < d and np.hypot(d, a) + r < a + c):
        raise WrongValue(f"distance must be above crank and rod together, {r + c:g} m, so that the knee is not pushed "
                         f"through, and below {np.sqrt(max(0.0, (a + c - r)**2 - a**2)):g} m, so that the rod reaches, not {d:g}",
                         "geometry")
    head, B = np.array([0.0, 2 * a]), np.array([d + r, a])
    apart = np.hypot(*(B - head))
    along = (apart**2 + a**2 - c**2) / (2 * apart)
    across = np.sqrt(a**2 - along**2)
    towards = (B - head) / apart
    knee = head + along * towards + across * np.array([towards[1], -towards[0]])
    foot = np.array([0.0, knee[1] - np.sqrt(a**2 - knee[0]**2)])
    m = Mechanism("toggle_press", gravity=(0.0, -checks.number("gravity", gravity)))
    m.link("crank", (d, a), B, mass)
    m.link("rod", B, knee, mass)
    m.link("upper", head, knee, mass)
    m.link("lower", knee, foot, mass)
    ram = m.body("ram", ram_mass, at=foot)
    m.point("K", m["upper"], (a, 0))
    m.revolute("O", m.ground, "crank.start")
    m.revolute("B", "crank.end", "rod.start")
    m.revolute("head", m.ground, "upper.start")
    m.revolute("knee", "upper.end", "lower.start")
    m.revolute("pushed", "K", "rod.end")
    m.revolute("C", "lower.end", ram)
    m.prismatic("guide", m.ground, ram, axis=(0, 1))
    m.force("load", ram, along=(0, 1), value=load)
    m.motor("drive", "O", speed=speed)
    return m
