"""A wheel on a trailing arm with bump stops, on a shaker that it may leave."""

from __future__ import annotations

import math

from .._private import checks
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def suspension(*, body_mass: float = 300.0, wheel_mass: float = 40.0, stiffness: float = 20e3, damping: float = 1200.0,
               arm_length: float = 0.5, wheel_radius: float = 0.3, droop: float = 0.16, bump: float = 0.14,
               restitution: float = 0.3, amplitude: float = 0.06, rate: float = 11.0, gravity: float = 9.81) -> Mechanism:
    """A wheel on a trailing arm under a body, which a plate shakes by amplitude (1 - cos(rate t)).

    It starts in static equilibrium. The wheel leaves the plate where the plate falls away, and the arm hits its stops. The
    bodies are ``plate``, ``body`` and ``arm``; ``tyre`` is the contact of the wheel with the plate, ``travel`` the stop of the
    arm, and ``strut`` the spring.

    Parameters
    ----------
    body_mass, wheel_mass : float
        In kg; the arm has none.
    stiffness, damping : float
        Stiffness and damping of the strut, in N/m and N s/m.
    arm_length, wheel_radius : float
        In m.
    droop, bump : float
        Angles of the arm below and above its start at which its stops are, in rad.
    restitution : float
        Coefficient of restitution of the stops; that of the wheel is zero.
    amplitude, rate : float
        Amplitude in m and angular frequency in rad/s of the plate.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    Round numbers of a small car.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.suspension(), 1.0)
    >>> sorted({str(name) for name in sol.impacts["name"]})
    ['travel lower', 'travel upper', 'tyre']
    """
    masses = [checks.number(name, value, above=0) for name, value in (("body_mass", body_mass), ("wheel_mass", wheel_mass))]
    stiffness = checks.number("stiffness", stiffness, above=0)
    length, radius = (checks.number(name, value, above=0) for name, value in
                      (("arm_length", arm_length), ("wheel_radius", wheel_radius)))
    limits = [checks.number(name, value, above=0) for name, value in (("droop", droop), ("bump", bump))]
    amplitude, rate, gravity = (checks.number(name, value) for name, value in
                                (("amplitude", amplitude), ("rate", rate), ("gravity", gravity)))
    m = Mechanism("suspension", gravity=(0.0, -gravity))
    plate, body = m.body("plate", 1.0), m.body("body", masses[0], at=(-0.5 * length, 1.5 * radius + 0.7 * length))
    arm = m.link("arm", (-0.5 * length, 1.5 * radius), (0.5 * length, radius), mass=0.0)
    m.particle("wheel", masses[1], at=arm.end)
    shaker = m.prismatic("shaker", m.ground, plate, axis=(0, 1))
    m.prismatic("guide", m.ground, body, axis=(0, 1))
    pivot = m.revolute("pivot", body, arm.start)
    mount = body.point((length, 0.2 * length))
    m.spring("strut", mount, arm.end, stiffness=stiffness, damping=checks.number("damping", damping, least=0),
             length=0.5 * radius + 0.9 * length + masses[0] * gravity / stiffness)
    m.stop("travel", pivot.angle, lower=-limits[0], upper=limits[1], restitution=restitution)
    m.contact("tyre", arm.end, plate.line((0, 0), (1, 0)), radius=radius)
    m.motor("drive", shaker, displacement=lambda t: amplitude * (1 - math.cos(rate * t)))
    return m
