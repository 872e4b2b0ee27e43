"""A thin disc that rolls on a plane, in a circle."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.elements.frames import about
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def rolling_disc(*, radius: float = 0.5, mass: float = 1.0, lean: float = 0.4, turning: float = 2.0, spin: float | None = None,
                 nudge: float = 0.0, gravity: float = 9.81) -> Mechanism:
    """A thin uniform disc on level ground, started in the steady motion of its lean and its turning.

    The body is ``disc``, whose x axis is its axle, and the contact ``floor``.

    Parameters
    ----------
    radius : float
        In m.
    mass : float
        In kg.
    lean : float
        Angle of its plane from the vertical, in rad, less than a right angle; the axle's far end is up where it is positive.
    turning : float
        Angular velocity of the contact about the vertical, in rad/s.
    spin : float, optional
        The disc's angular velocity about its axle at the start, in rad/s; left out: that of the steady motion. Has to be given
        where `turning` is zero.
    nudge : float
        Rate at which it falls over at the start, in rad/s: with it the motion is not steady.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If it would lie flat, or its spin is not determined.

    Notes
    -----
    With ``theta`` between axle and vertical, ``C = mass radius^2 / 2``, ``A = C / 2``, ``w`` the turning and ``s`` the spin, the
    motion is steady where ``s w sin(theta) (C + mass radius^2) = cos(theta) (A w^2 sin(theta) - mass gravity radius)``.

    References
    ----------
    E. J. Routh, The Advanced Part of a Treatise on the Dynamics of a System of Rigid Bodies, 6th edition, Macmillan 1905,
    article 244; O. M. O'Reilly, The dynamics of rolling disks and sliding disks, Nonlinear Dynamics 10 (1996).

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.rolling_disc(), 2.0, step=2e-3)
    >>> height = sol["disc.position.z"]
    >>> bool(abs(height - height[0]).max() < 1e-8)
    True
    """
    r, m = checks.number("radius", radius, above=0), Mechanism("rolling_disc", dimension=3, gravity=(0, 0, -gravity))
    c, s = np.sin(lean), np.cos(lean)       # of the angle between axle and vertical
    if not abs(lean) < np.pi / 2 - 1e-6:
        raise WrongValue(f"lean must be less than a right angle, {np.pi / 2:g}, to both sides, not {lean:g}", "out-of-range")
    if spin is None and not turning:
        raise WrongValue("spin must be given where turning is 0: then any is steady upright, and none with a lean",
                         "missing-argument")
    A = mass * r**2 / 4
    if spin is None:
        spin = c * (A * turning**2 * s - mass * gravity * r) / (turning * s * (2 * A + mass * r**2)) if mass else 0.0
    turned = about((0, 1, 0), -lean)
    disc = m.body("disc", mass, (2 * A, A, A), at=(0, 0, r * s), rotation=turned)
    m.rolling("floor", m.ground, disc, radius=r, axle=turned[:, 0], normal=(0, 0, 1))
    across = turning * s * turned[:, 2]     # what of the turning is about the diameter that goes upwards
    m.start({"disc.angular_velocity": spin * turned[:, 0] + across + np.array([0.0, -nudge, 0.0])})
    return m
