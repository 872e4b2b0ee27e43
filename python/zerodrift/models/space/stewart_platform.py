"""The Stewart platform: six cylinders that move a platform in all its freedoms."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked
from .._swing import swing_from


@checked
def stewart_platform(*, base_radius: float = 1.0, platform_radius: float = 0.6, height: float = 0.8, gap: float = 0.2,
                     platform_mass: float = 20.0, cylinder_mass: float = 2.0, piston_mass: float = 1.0, amplitude: float = 0.05,
                     rate: float = 3.0, gravity: float = 9.81) -> Mechanism:
    """A platform on six cylinders, each of which is driven by its own sine.

    The platform is ``top``; leg k from 0 to 5 has the bodies ``cylinder k`` and ``piston k``, a cross ``foot k`` on the ground, a
    ball ``head k`` at the platform, and the slider ``stroke k`` with the motor ``drive k``, which prescribes its displacement,
    amplitude (sin(rate t + k) - sin(k)).

    Parameters
    ----------
    base_radius, platform_radius : float
        Radii of the circles on which feet and heads are, in m.
    height : float
        Height of the platform over the base at the start, in m.
    gap : float
        Between two neighbours on a circle and the middle between them, in rad.
    platform_mass, cylinder_mass, piston_mass : float
        In kg; the platform is a disc of a twentieth of its radius.
    amplitude, rate : float
        Amplitude and rate of the drives, in m and rad/s.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    D. Stewart, A platform with six degrees of freedom, Proceedings of the Institution of Mechanical Engineers 180 (1965),
    371-386. The numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> platform = zd.models.stewart_platform()
    >>> len(platform.bodies), len(platform.joints), len(platform.motors)
    (13, 18, 6)
    >>> sol = zd.simulate(platform, 0.5, step=5e-3)
    >>> bool(abs(sol.position_violation).max() < 1e-11)
    True
    """
    base_radius = checks.number("base_radius", base_radius, above=0)
    platform_radius = checks.number("platform_radius", platform_radius, above=0)
    m = Mechanism("stewart_platform", dimension=3, gravity=(0, 0, -gravity))
    feet, heads = _circle(base_radius, gap, 0.0, 0.0), _circle(platform_radius, gap, np.pi / 3, height)
    heads = np.roll(heads, 1, axis=0)       # so that each leg goes to the nearer of two
    across, along = (platform_mass * platform_radius**2 * share for share in (0.25 + 0.05**2 / 12, 0.5))
    top = m.body("top", platform_mass, (across, across, along), at=(0, 0, height))
    for k, (foot, head) in enumerate(zip(feet, heads, strict=True)):
        middle = (foot + head) / 2
        cylinder = m.link(f"cylinder {k}", foot, middle, cylinder_mass)
        piston = m.link(f"piston {k}", middle, head, piston_mass)
        across_leg = np.cross((0, 0, 1), head - foot)
        m.universal(f"foot {k}", m.ground, cylinder.start, axes=(np.cross(across_leg, head - foot), across_leg))
        m.prismatic(f"stroke {k}", cylinder, piston, axis=head - foot)
        m.spherical(f"head {k}", piston.end, top)
        m.motor(f"drive {k}", f"stroke {k}", displacement=swing_from(amplitude, rate, float(k)))
    return m


def _circle(radius: float, gap: float, turned: float, height: float) -> np.ndarray:
    """Six places (6, 3), pair by pair."""
    angles = turned + np.repeat(np.arange(3) * 2 * np.pi / 3, 2) + np.tile([-gap, gap], 3)
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(6, height)], axis=1)

