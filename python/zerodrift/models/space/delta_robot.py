"""Clavel's Delta robot: three arms that carry a platform which stays parallel to the base."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked
from .._swing import swing_from


@checked
def delta_robot(*, base_radius: float = 0.2, platform_radius: float = 0.05, arm: float = 0.3, forearm_length: float = 0.8,
                angle: float = 0.6, half_width: float = 0.04, arm_mass: float = 1.0, forearm_mass: float = 0.3,
                platform_mass: float = 0.8, amplitude: float = 0.4, rate: float = 6.0, gravity: float = 9.81) -> Mechanism:
    """A Delta robot whose arms swing to and fro, each a third of a turn ahead of the one before.

    The arms are ``arm 0`` to ``arm 2``, hinged to the ground in ``shoulder 0``, ...; two parallel rods, ``left 0`` and
    ``right 0``, go from each to the platform, ``platform``. Half of the forearms' mass is at the elbow, half at the
    platform, as is usual. The motors are ``drive 0``, ..., which prescribe the shoulders' angles,
    amplitude (sin(rate t + 2 pi k / 3) - sin(2 pi k / 3)).

    Parameters
    ----------
    base_radius, platform_radius : float
        Radii of the circles through the shoulders and through the middles of the rods' lower ends, in m.
    arm, forearm_length : float
        In m.
    angle : float
        Angle of the arms at the start, downwards from the level, in rad.
    half_width : float
        Half width of each pair of rods, in m.
    arm_mass, forearm_mass, platform_mass : float
        Mass of each arm, of each pair of rods, and of the platform, in kg.
    amplitude, rate : float
        Amplitude and rate of the drives, in rad and rad/s.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the forearms do not reach the platform.

    References
    ----------
    R. Clavel, Conception d'un robot parallele rapide a 4 degres de liberte, thesis 925, EPFL Lausanne 1991; A. Codourey, Dynamic
    modeling of parallel robots for computed-torque control implementation, International Journal of Robotics Research 17 (1998),
    for where the forearms' mass is. The numbers are round ones.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.delta_robot(), 1.0, step=5e-3)
    >>> bool(abs(sol["platform.rotation"] - np.eye(3)).max() < 1e-9)
    True
    """
    lengths = {"base_radius": base_radius, "platform_radius": platform_radius, "arm": arm, "forearm_length": forearm_length,
               "half_width": half_width}
    R, r, L, rod, w = (checks.number(name, length, above=0) for name, length in lengths.items())
    aside = R + L * np.cos(angle) - r
    if not abs(aside) < rod:
        raise WrongValue(f"forearm_length must be more than {abs(aside):g} m to reach the platform, not {rod:g}", "geometry")
    home = np.array([0.0, 0.0, -L * np.sin(angle) - np.sqrt(rod**2 - aside**2)])
    m = Mechanism("delta_robot", dimension=3, gravity=(0, 0, -gravity))
    disc = platform_mass * r**2 / 4
    platform = m.body("platform", platform_mass, (disc, disc, 2 * disc), at=home)
    for k in range(3):
        turned = 2 * np.pi * k / 3
        out, across = np.array([np.cos(turned), np.sin(turned), 0.0]), np.array([-np.sin(turned), np.cos(turned), 0.0])
        elbow, wrist = R * out + L * (np.cos(angle) * out - (0, 0, np.sin(angle))), home + r * out
        link = m.link(f"arm {k}", R * out, elbow, arm_mass)
        m.particle(f"elbow {k}", forearm_mass / 2, at=link.end)
        m.particle(f"wrist {k}", forearm_mass / 2, at=platform.point(at=wrist))
        m.revolute(f"shoulder {k}", m.ground, link.start, axis=across)
        for name, side in (("left", w), ("right", -w)):
            m.rod(f"{name} {k}", link.point(at=elbow + side * across), platform.point(at=wrist + side * across))
        m.motor(f"drive {k}", f"shoulder {k}", angle=swing_from(amplitude, rate, turned))
    return m
