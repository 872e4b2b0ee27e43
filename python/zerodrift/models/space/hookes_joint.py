"""Hooke's joint, or Cardan's: two shafts that meet at an angle, joined by a cross."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def hookes_joint(*, bend: float = 0.6, length: float = 0.5, mass: float = 1.0, load: float = 0.0,
                 speed: float = 10.0) -> Mechanism:
    """A shaft that turns at constant speed, and one at an angle to it that does not.

    The shafts are ``input``, along x, and ``output``; they turn in ``bearing in`` and ``bearing out``, which lets the output
    slide, and meet in the cross, ``cross``, whose arm on the input is upright at the start. The motor is ``drive``; a load
    brakes the output.

    Parameters
    ----------
    bend : float
        Between the shafts, in rad, less than a right angle.
    length, mass : float
        Length and mass of each shaft, a round bar, in m and kg.
    load : float
        Torque against the output's turning, in N m.
    speed : float
        Angular velocity of the input, in rad/s.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        For a bend of a right angle or more, through which nothing is driven.

    Notes
    -----
    With input and output turned by ``a`` and ``b``, ``tan(a) cos(bend) = tan(b)``; the output's speed goes between ``cos(bend)``
    and ``1 / cos(bend)`` times the input's, twice a turn.

    References
    ----------
    R. Hooke, A Description of Helioscopes and Some Other Instruments, London 1676; J. Denavit, R. S. Hartenberg, Kinematic
    Synthesis of Linkages, McGraw-Hill 1964, chapter 12. The numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.hookes_joint(bend=0.5), 1.0, step=1e-3)
    >>> round(float(sol["bearing out.angle_speed"].max()), 3)
    11.395
    """
    length = checks.number("length", length, above=0)
    if not abs(bend) < np.pi / 2:
        raise WrongValue(f"bend must be less than a right angle, {np.pi / 2:g}, not {bend:g}", "out-of-range")
    m = Mechanism("hookes_joint", dimension=3)
    out = np.array([np.cos(bend), np.sin(bend), 0.0])
    shafts = [m.link("input", (-length, 0, 0), (0, 0, 0), mass), m.link("output", (0, 0, 0), length * out, mass)]
    m.revolute("bearing in", m.ground, shafts[0].start, axis=(1, 0, 0))
    m.universal("cross", shafts[0].end, shafts[1].start, axes=((0, 0, 1), (-out[1], out[0], 0)))
    m.cylindrical("bearing out", m.ground, shafts[1].end, axis=out)
    m.motor("drive", "bearing in", speed=speed)
    if load:
        m.torque("load", shafts[1], axis=out, value=-load)
    return m
