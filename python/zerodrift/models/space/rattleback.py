"""The rattleback, or celt: a stone that turns one way only."""

from __future__ import annotations

import numpy as np

from ...mechanisms.elements.frames import about
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def rattleback(*, long: float = 0.2, wide: float = 0.03, deep: float = 0.02, lowered: float = 0.01, mass: float = 1.0,
               roll_inertia: float = 2e-4, pitch_inertia: float = 1.6e-3, yaw_inertia: float = 1.7e-3, product: float = -2e-5,
               spin: float = -5.0, tilt: float = 0.008726646259971648, gravity: float = 9.81) -> Mechanism:
    """Half an ellipsoid whose axes of inertia are rotated against those of its surface, spun in the unstable direction.

    It begins to rattle, stops, and reverses, without friction. Spun in the other direction it continues. The body is ``stone``,
    whose frame begins at the ellipsoid's centre; it rolls on the ``table``, and its centre of mass is below the middle.

    Parameters
    ----------
    long, wide, deep : float
        Semiaxes along x, y and z of the stone, in m.
    lowered : float
        By how much its centre of mass lies below the ellipsoid's centre, in m.
    mass : float
        In kg.
    roll_inertia, pitch_inertia, yaw_inertia : float
        About x, y and z through the centre of mass, in kg m^2.
    product : float
        Its entry [0, 1] of the tensor, in kg m^2: with zero both directions are alike.
    spin : float
        About the vertical at the start, in rad/s.
    tilt : float
        About both level axes at the start, first x, then y of the stone, in rad.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    T. R. Kane, D. A. Levinson, Realistic mathematical modeling of the rattleback, International Journal of Non-Linear Mechanics
    17 (1982), 175-186, whose numbers these are, without its friction.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.rattleback(), 6.0, step=2e-3)
    >>> spin = sol["stone.angular_velocity.z"]
    >>> bool(spin[0] < -4.9 and spin.max() > 1.0)
    True
    """
    semiaxes = np.array([long, wide, deep])
    turned = about((1, 0, 0), tilt) @ about((0, 1, 0), tilt)
    height = float(np.linalg.norm(semiaxes * turned[2]))        # where the plane touches that far below the centre
    m = Mechanism("rattleback", dimension=3, gravity=(0, 0, -gravity))
    inertia = [[roll_inertia, product, 0], [product, pitch_inertia, 0], [0, 0, yaw_inertia]]
    stone = m.body("stone", mass, inertia, at=(0, 0, height), rotation=turned, com=(0, 0, -lowered))
    m.rolling("table", m.ground, stone, semiaxes=semiaxes, normal=(0, 0, 1))
    m.start({"stone.angular_velocity": (0, 0, spin)})
    return m
