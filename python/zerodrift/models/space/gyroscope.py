"""A gyroscope in two gimbals, which carries a weight and precesses."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def gyroscope(*, incline: float = 1.0, spin: float = 200.0, axial_inertia: float = 2e-3, transverse_inertia: float = 1.2e-3,
              weight: float = 0.2, arm: float = 0.15, inner_inertia: float = 4e-4, outer_inertia: float = 1e-3,
              mass: float = 1.0, gravity: float = 9.81) -> Mechanism:
    """A rotor in an inner gimbal in an outer gimbal, with a weight on its axle, started in steady precession.

    The outer gimbal turns about the vertical, the inner one about the outer one's x axis, which stays level, and the rotor
    about the inner one's y axis, its axle. The bodies are ``outer``, ``inner`` and ``rotor``, whose centres coincide,
    and the ``weight`` on the inner gimbal; the joints are ``pivot``, ``trunnion`` and ``axle``.

    Parameters
    ----------
    incline : float
        Inclination of the axle at the start, from the vertical, in rad.
    spin : float
        Angular velocity of the rotor in the inner gimbal, in rad/s.
    axial_inertia, transverse_inertia : float
        Moments of inertia of the rotor, in kg m^2.
    weight, arm : float
        In kg, and how far along the axle it hangs, in m.
    inner_inertia, outer_inertia : float
        Moments of inertia of the gimbals, about all axes alike, in kg m^2.
    mass : float
        Mass of the rotor and of each gimbal, which the bearings carry, in kg.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If it spins too slowly for a steady precession.

    Notes
    -----
    With C and A the moments of the rotor, B those of the inner gimbal with its weight, ``B_x`` across the axle, ``B_y`` along it,
    ``s`` the spin and ``theta`` the incline, steady precession at ``w`` needs
    ``(C - A - B_x + B_y) cos(theta) w^2 + C s w = weight * gravity * arm``; the slower of both is taken. The outer
    gimbal's inertia has no influence.

    References
    ----------
    H. Goldstein, Classical Mechanics, 2nd edition, Addison-Wesley 1980, section 5-7, for the top without gimbals; J. B.
    Scarborough, The Gyroscope, Interscience 1958. The numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.gyroscope(), 0.5, step=1e-3)
    >>> bool(abs(sol["trunnion.angle"]).max() < 1e-6)
    True
    """
    arm = checks.number("arm", arm, least=0)
    m = Mechanism("gyroscope", dimension=3, gravity=(0, 0, -gravity))
    axle = np.array([0.0, np.sin(incline), np.cos(incline)])
    turned = np.stack([(1.0, 0.0, 0.0), axle, np.cross((1, 0, 0), axle)], axis=1)
    outer = m.body("outer", mass, [outer_inertia] * 3)
    inner = m.body("inner", mass, [inner_inertia] * 3, rotation=turned)
    rotor = m.body("rotor", mass, (transverse_inertia, axial_inertia, transverse_inertia), rotation=turned)
    m.particle("weight", weight, at=inner.point((0, arm, 0)))
    m.revolute("pivot", m.ground, outer.point((0, 0, 0)), axis=(0, 0, 1))
    m.revolute("trunnion", outer, inner.point((0, 0, 0)), axis=(1, 0, 0))
    m.revolute("axle", inner, rotor.point((0, 0, 0)), axis=axle)
    excess = axial_inertia - transverse_inertia - weight * arm**2       # the gimbal's own moments cancel
    precession = _slow_precession(excess * np.cos(incline), axial_inertia * spin, weight * gravity * arm)
    m.start({"pivot.speed": precession, "trunnion.speed": 0.0, "axle.speed": spin})
    return m


def _slow_precession(a: float, b: float, c: float) -> float:
    """The root w of a w^2 + b w = c that is smaller."""
    square = b**2 + 4 * a * c
    if square < 0 or not b:
        raise WrongValue("spin must be faster for a steady precession: "
                         f"an angular momentum of at least {2 * np.sqrt(max(-a * c, 0.0)):g} N m s about the axle, not {b:g}",
                         "out-of-range")
    return 2 * c / (b + np.copysign(np.sqrt(square), b))
