"""A compass-gait walker, which walks down a slope without a drive."""

from __future__ import annotations

import math

import numpy as np

from .._private import checks
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

EARLY = 1e-12       # rad: feet are set down earlier, so that the start is not itself such an event


@checked
def compass_gait(*, leg_length: float = 1.0, foot_distance: float = 0.5, leg_mass: float = 5.0, hip_mass: float = 10.0,
                 slope: float = math.radians(3), angle: float = 0.27104, stance_speed: float = -1.0918,
                 swing_speed: float = -0.3772, gravity: float = 9.81) -> Mechanism:
    """Compass-gait walker: two legs without knees, hinged at the hip, on a slope that falls to the right.

    It starts just after its left foot was set down. A foot that meets the slope is joined to it by a plastic impact, and the
    other one is released at that instant; the swinging foot passes through the slope, as the model of the literature has it.
    The links are ``left`` and ``right``, the joints ``hip``, ``left foot`` and ``right foot``; the contact ``fall`` is that of
    the hip with the slope.

    Parameters
    ----------
    leg_length : float
        In m.
    foot_distance : float
        Distance of a leg's mass from its foot, in m.
    leg_mass, hip_mass : float
        Point masses, in kg.
    slope : float
        Angle of the slope, in rad.
    angle : float
        Angle of both legs from the slope's normal at the start, in rad: the left one leans back.
    stance_speed, swing_speed : float
        Angular velocities of the left and of the right leg at the start, in rad/s.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    A. Goswami, B. Espiau, A. Keramane, Limit cycles and their stability in a passive bipedal gait, ICRA 1996: masses, lengths and
    slope; the start is near their limit cycle.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.compass_gait(), 2.5)
    >>> [str(name) for name in sol.impacts["name"]]         # three steps
    ['right foot', 'left foot', 'right foot']
    """
    length = checks.number("leg_length", leg_length, above=0)
    distance, slope, angle = (checks.number(name, value) for name, value in
                              (("foot_distance", foot_distance), ("slope", slope), ("angle", angle)))
    masses = [checks.number(name, value, above=0) for name, value in (("leg_mass", leg_mass), ("hip_mass", hip_mass))]
    along, normal = np.array([math.cos(slope), -math.sin(slope)]), math.pi / 2 - slope
    top, half = length * math.cos(angle) * np.array([math.sin(slope), math.cos(slope)]), length * math.sin(angle) * along
    m = Mechanism("compass_gait", gravity=(0.0, -checks.number("gravity", gravity)))
    left, right = (m.link(name, tuple(foot), tuple(top), mass=0.0) for name, foot in (("left", half), ("right", -half)))
    for leg in (left, right):
        m.particle(f"{leg.name} mass", masses[0], at=leg.point((distance, 0.0)))
    m.particle("hip mass", masses[1], at=left.end)
    m.revolute("hip", left.end, right.end)
    of = {"left": left.angle, "right": right.angle}
    level = 2 * normal + EARLY
    strikes = {leg: m.measure(f"{leg.name} strike", law, of=of, unit="rad") for leg, law in (
        (left, lambda left, right: min(level - left - right, left - right)),
        (right, lambda left, right: min(level - left - right, right - left)))}
    for leg, other in ((left, right), (right, left)):
        foot = m.revolute(f"{leg.name} foot", m.ground, leg.start, active=leg is left)
        m.latch(f"{leg.name} step", foot, when=strikes[leg], until=strikes[other])
    m.contact("fall", left.end, m.ground.line((0, 0), tuple(along)))
    m.start({"left.angular_velocity": checks.number("stance_speed", stance_speed),
             "right.angular_velocity": checks.number("swing_speed", swing_speed)})
    return m
