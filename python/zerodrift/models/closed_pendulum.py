"""The closed n-link pendulum: a chain of slender links between two pins."""

from __future__ import annotations

import numpy as np

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

LEAN = np.radians(75.0)     # initial inclination of the first link in rad


@checked
def closed_pendulum(links: int = 4, *, length: float = 1.0, mass: float = 1.0, gravity: float = 9.81,
                    span: float | None = None) -> Mechanism:
    """A chain of equal slender links, pinned at both ends on one level, and released from an arch above the pins.

    The links are ``link1``, ``link2``, ..., the joints ``pin0`` (at the ground), ``pin1``, ...

    Parameters
    ----------
    links : int
        Number of links, at least 3: with the ground between the pins, 3 make a four-bar.
    length, mass : float
        Length and mass of each link, in m and kg.
    gravity : float
        In m/s^2, downwards.
    span : float, optional
        Distance of the pins in m, less than all links together; left out: about half of that, at the largest distance from spans
        for which all links can line up with the pins.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the span is that of all links together, or more.

    Notes
    -----
    Where all links lie on the line through the pins, the constraints are dependent, and motions close to it depend strongly on
    the step. This can happen where ``span`` is a sum of the lengths with some signs reversed, as with ``links=4, span=2``.

    Examples
    --------
    >>> import zerodrift as zd
    >>> print(repr(zd.models.closed_pendulum(links=6)))
    <Mechanism closed_pendulum: plane, 6 bodies, 7 joints; no forces but gravity (0, -9.81)>
    """
    n = checks.count("links", links, least=3)
    length = checks.number("length", length, above=0)
    # A sum of n terms of plus or minus one is odd where n is. As `half` is not, the links cannot all line up with the pins.
    half = n // 2 + (n // 2 - n + 1) % 2
    span = half * length if span is None else checks.number("span", span, above=0)
    if span >= n * length:
        raise WrongValue(f"span must be less than {n} links of {length:g} m together, {n * length:g} m, not {span:g}", "geometry")
    steps = length * np.exp(1j * arch(n, span / length))
    places = np.concatenate([[0.0], np.cumsum(steps)])
    drawn = [(float(place.real), float(place.imag)) for place in places]
    m = Mechanism("closed_pendulum", gravity=(0.0, -checks.number("gravity", gravity)))
    last = m.ground.point(drawn[0])
    for i in range(n):
        link = m.link(f"link{i + 1}", drawn[i], drawn[i + 1], mass, length=length)
        m.revolute(f"pin{i}", last, link.start)
        last = link.end
    m.revolute(f"pin{n}", last, m.ground.point((span, 0)))
    return m


def arch(n: int, span: float) -> np.ndarray:
    """The angles (n,) of links of length one that end at (span, 0): those of an even arch, with the smallest turns."""
    angles = np.linspace(LEAN, -0.75 * LEAN, n)
    for _ in range(100):
        along, up = np.cos(angles), np.sin(angles)
        off = np.array([along.sum() - span, up.sum()])
        if np.abs(off).max() < 1e-14 * n:
            break
        angles = angles - np.linalg.lstsq(np.array([-up, along]), off, rcond=None)[0]
    return angles
