"""The four-bar of Blajer's paper, released with its crank upright."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def four_bar(*, lengths: ArrayLike = (1.0, 0.3, 1.0, 0.6), masses: ArrayLike = (1.5, 5.0, 3.0), gravity: float = 9.81,
             crank_angle: float = np.pi / 2, crank_rate: float = 1.0) -> Mechanism:
    """The paper's first example: crank, coupler and rocker under gravity, from bodies and joints.

    The mechanism of `zerodrift.systems.four_bar`. The joints are ``A`` (ground and crank), ``B``, ``C`` and ``D`` (rocker and
    ground); the coupler starts above.

    Parameters
    ----------
    lengths : array_like (4,)
        Lengths of ground, crank, coupler and rocker, in m.
    masses : array_like (3,)
        Masses of crank, coupler and rocker, slender rods, in kg.
    gravity : float
        Downwards, in m/s^2.
    crank_angle, crank_rate : float
        Angle of the crank at the start, in rad from the ground, and its rate, in rad/s.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If coupler and rocker do not meet.

    References
    ----------
    W. Blajer, Elimination of Constraint Violation and Accuracy Aspects in Numerical Simulation of Multibody Systems, Multibody
    System Dynamics 7 (2002), section 4.1.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.four_bar(), 8.0, step=0.01, energy=True)
    >>> bool(abs(sol.position_violation).max() < 1e-12)
    True
    """
    given = checks.vector("lengths", lengths, 4).tolist()
    ground, crank, coupler, rocker = (checks.number(f"lengths[{i}]", length, above=0) for i, length in enumerate(given))
    masses = checks.vector("masses", masses, 3).tolist()
    at = crank * np.array([np.cos(crank_angle), np.sin(crank_angle)])
    apart = np.hypot(*(at - (ground, 0)))
    if not abs(coupler - rocker) < apart < coupler + rocker:
        raise WrongValue(f"coupler and rocker, of {coupler:g} and {rocker:g} m, do not meet: with the crank at {crank_angle:g} "
                         f"rad they begin {apart:g} m apart; lengths are {ground:g}, {crank:g}, {coupler:g}, {rocker:g} m",
                         "geometry")
    high = np.array([ground - 0.1 * rocker, rocker])        # roughly: lengths count
    m = Mechanism("four_bar", gravity=(0.0, -checks.number("gravity", gravity)))
    links = [m.link("crank", (0, 0), at, masses[0]), m.link("coupler", at, high, masses[1], length=coupler),
             m.link("rocker", high, (ground, 0), masses[2], length=rocker)]
    m.revolute("A", m.ground, links[0].start)
    m.revolute("B", links[0].end, links[1].start)
    m.revolute("C", links[1].end, links[2].start)
    m.revolute("D", links[2].end, m.ground.point((ground, 0)))
    m.start({"crank.angle": crank_angle, "crank.angular_velocity": crank_rate})
    return m
