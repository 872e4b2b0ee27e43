"""A chain of many links in space."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def chain(links: int = 1000, *, length: float = 10.0, mass: float = 10.0, incline: float = 0.3, coils: float = 3.0,
          gravity: float = 9.81) -> Mechanism:
    """A chain of round bars with balls between them, hung at one end and released.

    It is drawn as a coil whose axis slopes downwards. The bars are ``link 0``,
    ``link 1``, ..., the balls ``ball 0`` at the ground, ``ball 1``, ...

    Parameters
    ----------
    links : int
        At least 1. The cost of a step is proportional to it.
    length, mass : float
        Length and mass of the chain, in m and kg.
    incline : float
        At the start, downwards from the level, in rad.
    coils : float
        Number of turns; 0: the chain is straight, and falls in a plane.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    Notes
    -----
    The bars have a tenth of their length as diameter. The numbers are round ones.

    References
    ----------
    D. Baraff, Linear-time dynamics using Lagrange multipliers, SIGGRAPH 1996: chains are what the cost of methods is compared
    with.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.chain(100), 0.1, step=2e-3)
    >>> bool(abs(sol.position_violation).max() < 1e-9)
    True
    """
    n = checks.count("links", links, least=1)
    each = checks.number("length", length, above=0) / n
    turned = 2 * np.pi * coils * np.arange(n) / n
    level, down = each * np.cos(incline), np.full(n, -each * np.sin(incline))
    along = np.stack([level * np.cos(turned), level * np.sin(turned), down], axis=1)
    places = np.vstack([np.zeros(3), np.cumsum(along, axis=0)])
    m = Mechanism("chain", dimension=3, gravity=(0, 0, -gravity))
    last = m.ground.point((0, 0, 0))
    for i in range(n):
        link = m.link(f"link {i}", places[i], places[i + 1], mass / n, thickness=each / 10)
        m.spherical(f"ball {i}", last, link.start)
        last = link.end
    return m
