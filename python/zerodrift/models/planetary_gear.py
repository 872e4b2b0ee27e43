"""A planetary gear: sun, planets on a carrier, and ring."""

from __future__ import annotations

import numpy as np

from .. import inertia
from .._private import checks
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

RPM = 2 * np.pi / 60


@checked
def planetary_gear(*, sun: int = 40, planet: int = 20, planets: int = 3, module: float = 0.005, carrier_speed: float = -200 * RPM,
                   sun_speed: float = -100 * RPM, density: float = 78.5, load: float = -10.0) -> Mechanism:
    """Planetary gear with two degrees of freedom: carrier and sun are driven, and the ring follows Willis's equation.

    Each planet beyond the first adds a redundant constraint; the smallest tooth forces are reported, in which all planets
    share the load equally. Bodies are ``carrier``, ``sun``, ``ring``, ``planet0``, ..., their axles ``sun axle``, ..., and the
    gears ``sun-planet0``, ``planet0-ring``, ...

    Parameters
    ----------
    sun, planet : int
        Numbers of teeth; the ring has sun + 2 planet.
    planets : int
        Number of planets, at least 1.
    module : float
        Diameter of a pitch circle by its teeth, in m.
    carrier_speed, sun_speed : float
        In rad/s.
    density : float
        Density of sun, planets and ring, discs of their pitch circles, in kg/m^2.
    load : float
        The moment on the ring, in N m.

    Returns
    -------
    Mechanism

    References
    ----------
    R. Willis, Principles of Mechanism, 1841. Teeth and speeds are round numbers; by his equation the ring turns at -250 rpm.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.planetary_gear(), 1.0, step=0.01)
    >>> print(round(sol["ring.angular_velocity"][-1] * 60 / (2 * np.pi), 9))
    -250.0
    """
    sun, planet, planets = (checks.count(name, value, least=1) for name, value in
                            (("sun", sun), ("planet", planet), ("planets", planets)))
    ring, density = sun + 2 * planet, checks.number("density", density, above=0)
    radius = {name: checks.number("module", module, above=0) * teeth / 2
              for name, teeth in (("sun", sun), ("planet", planet), ("ring", ring))}
    arm = radius["sun"] + radius["planet"]

    def disc(name: str) -> tuple[float, float]:
        return inertia.disc(mass=density * np.pi * radius[name]**2, radius=radius[name])

    m = Mechanism("planetary_gear")
    centre = (0.0, 0.0)
    carrier = m.body("carrier", *inertia.disc(mass=density * np.pi * arm**2 / 4, radius=arm))
    m.revolute("carrier axle", m.ground, carrier, at=centre)
    for name in ("sun", "ring"):
        m.revolute(f"{name} axle", carrier, m.body(name, *disc(name)), at=centre)
    for i, angle in enumerate(2 * np.pi * np.arange(planets) / planets):
        at = arm * np.array([np.cos(angle), np.sin(angle)])
        m.revolute(f"planet{i} axle", carrier, m.body(f"planet{i}", *disc("planet"), at=at), at=at)
        m.gear(f"sun-planet{i}", "sun axle", f"planet{i} axle", ratio=-sun / planet)
        m.gear(f"planet{i}-ring", f"planet{i} axle", "ring axle", ratio=planet / ring)
    m.torque("load", "ring", value=load)
    carrier_speed = checks.number("carrier_speed", carrier_speed)
    m.motor("drive", "carrier axle", speed=carrier_speed)
    m.motor("sun drive", "sun axle", speed=checks.number("sun_speed", sun_speed) - carrier_speed)
    return m
