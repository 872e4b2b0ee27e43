"""A six-bar linkage of Stephenson's third kind: a four-bar, whose coupler drives a second rocker."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

TURN = np.radians(20.0)     # of the coupler's side BE from BC, and of AF from AD the other way
CE = np.sqrt(0.105**2 + 0.225**2 - 2 * 0.105 * 0.225 * np.cos(TURN))
LENGTHS = {"AB": 0.080, "BC": 0.105, "DC": 0.120, "AD": 0.135, "BE": 0.225, "CE": CE, "EG": 0.180, "FG": 0.180}
SKETCH = {"A": (0, 0), "D": (0.135, 0), "F": (0.195 * np.cos(TURN), -0.195 * np.sin(TURN)), "B": (0.08, 0), "C": (0.08, 0.1),
          "E": (0, 0.2), "G": (0.15, 0.1)}
LINKS = {"ground": "ADF", "crank": "AB", "coupler": "BCE", "rocker": "DC", "link": "EG", "output": "FG"}


@checked
def stephenson(*, speed: float = 2 * np.pi, mass: Mapping[str, float] | float = 0.2, scale: float = 1.0,
               gravity: ArrayLike | None = None) -> Mechanism:
    """A crank ``AB``, a coupler with three hinges, ``BCE``, two rockers on the ground, ``DC`` and ``FG``, and a link ``EG``.

    The shortest bar of the four-bar A B C D is the crank and makes full turns; the second rocker follows the coupler's curve. The
    links are ``crank``, ``coupler``, ``rocker``, ``link`` and ``output``, and the motor is ``drive``.

    Parameters
    ----------
    speed : float
        Angular velocity of the crank, in rad/s.
    mass : float or dict of str to float
        In kg, of each link, or by link.
    scale : float
        By which the textbook's metres are multiplied.
    gravity : array_like (2,), optional
        In m/s^2; left out: none.

    Returns
    -------
    Mechanism

    References
    ----------
    Lengths and angles are those that D. Ziolkowski's programs for this linkage have, 2020, which are written in the manner of
    E. Constans, K. B. Dyer, Introduction to Mechanism Design, CRC Press, 2018.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.stephenson(), 1.0, step=0.005)
    >>> bool(np.ptp(sol["crank.angle"]) > 6.2), bool(np.ptp(sol["output.angle"]) < np.pi)
    (True, True)
    """
    m = linkage(SKETCH, LINKS, lengths=LENGTHS, scale=scale, mass=mass, gravity=gravity, name="stephenson")
    m.motor("drive", "A", speed=speed)
    return m
