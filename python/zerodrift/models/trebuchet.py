"""A trebuchet: an arm with a hinged counterweight, and a sling that is released."""

from __future__ import annotations

import math

import numpy as np

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def trebuchet(*, short_arm: float = 1.2, long_arm: float = 3.6, height: float = 2.6, sling_length: float = 2.8,
              arm_mass: float = 15.0, counterweight_mass: float = 150.0,
              projectile_mass: float = 12.0, friction: float = 0.2, release_angle: float = 0.2, stop_angle: float = 0.2,
              restitution: float = 0.3, gravity: float = 9.81) -> Mechanism:
    """A trebuchet, cocked and at rest, whose projectile lies in a trough on the ground.

    The arm drags the projectile along the trough until the sling lifts it off; the ring of the sling slips off its hook, the
    arm hits the beam, and the projectile lands. The bodies are ``arm``, ``weight`` and ``projectile``; ``sling`` is released by
    the latch ``ring``, ``trough`` is the contact of the projectile with the ground, and ``beam`` the stop of the arm.

    Parameters
    ----------
    short_arm, long_arm, height, sling_length : float
        From the axle to the counterweight's hinge and to the sling, height of the axle, and length of the sling, in m. The
        counterweight hangs five sixths of the short arm below its hinge.
    arm_mass, counterweight_mass, projectile_mass : float
        In kg; the arm is uniform.
    friction : float
        Coefficient of friction of the projectile on the ground.
    release_angle : float
        Angle of the sling behind the line of the arm at which the ring slips off, in rad.
    stop_angle : float
        Angle of the arm beyond the vertical at which it hits the beam, in rad.
    restitution : float
        Coefficient of restitution of the beam.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    D. B. Siano, Trebuchet Mechanics, 2001, for the design; the numbers are round ones of a small machine.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.trebuchet(), 5.0)
    >>> [name for phase in sol.phases[:3] for name in ("sling", "trough") if phase.state[name] in ("joined", "sliding")]
    ['sling', 'trough', 'sling']
    >>> bool(sol["projectile.position.x"].max() > 20)
    True
    """
    short, length, height, sling = (
        checks.number(name, value, above=0) for name, value in
        (("short_arm", short_arm), ("long_arm", long_arm), ("height", height), ("sling_length", sling_length)))
    hanger = short / 1.2
    masses = [checks.number(name, value, above=0) for name, value in
              (("arm_mass", arm_mass), ("counterweight_mass", counterweight_mass), ("projectile_mass", projectile_mass))]
    release = checks.number("release_angle", release_angle)
    tip_height = 0.05 * length
    if not tip_height < height < length:
        raise WrongValue(f"height must be between {tip_height:g} and long_arm, {length:g}, not {height:g}", "out-of-range")
    if not sling > tip_height:
        raise WrongValue(f"sling_length must be greater than {tip_height:g}, the height of the cocked arm's end, not {sling:g}",
                         "out-of-range")
    tilt = math.asin((height - tip_height) / length)
    along = np.array([math.cos(tilt), math.sin(tilt)])
    tip, end = np.array([0.0, height]) - length * along, np.array([0.0, height]) + short * along
    m = Mechanism("trebuchet", gravity=(0.0, -checks.number("gravity", gravity)))
    arm = m.link("arm", tuple(tip), tuple(end), mass=masses[0])
    axle = m.revolute("axle", m.ground, arm.point((length, 0.0)))
    weight = m.body("weight", masses[1], 0.1 * masses[1] * hanger**2, at=(end[0], end[1] - hanger))
    m.revolute("hanger", arm.end, weight.point((0.0, hanger)))
    projectile = m.particle("projectile", masses[2], at=(tip[0] + math.sqrt(sling**2 - tip_height**2), 0.0))
    rope = m.rod("sling", arm.start, projectile, active=True)
    m.contact("trough", projectile, m.ground.line((0, 0), (1, 0)), friction=friction)
    m.stop("beam", axle.angle, lower=-tilt - math.pi / 2 - checks.number("stop_angle", stop_angle), restitution=restitution)
    gone = sling * math.cos(release)
    hook = m.measure("hook", lambda angle, x, x0, y, y0: (x0 - x) * math.cos(angle) + math.sin(angle) * (y0 - y) - gone,
                     of={"angle": arm.angle, "x": projectile.position.x, "x0": arm.start.position.x,
                         "y": projectile.position.y, "y0": arm.start.position.y})
    m.latch("ring", rope, until=hook)
    return m
