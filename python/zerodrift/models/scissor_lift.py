"""A scissor lift: crossed arms, stage above stage, under a platform."""

from __future__ import annotations

import numpy as np

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import swing


@checked
def scissor_lift(stages: int = 3, *, arm: float = 1.0, angle: float = 0.6, amplitude: float = 0.1, rate: float = np.pi,
                 mass: float = 2.0, platform: float = 10.0, load: float = 100.0, gravity: float = 9.81) -> Mechanism:
    """A lift of several stages, of which a motor moves one foot along the ground.

    The platform is stages arm sin(angle) high, and stays level. Its arms are ``rise0``, ``fall0``, ``rise1``, ..., which cross in
    ``cross0``, ``cross1``, ...; one foot is hinged, ``foot``, and the motor, ``drive``, moves the other, ``roller``, by
    amplitude sin(rate t).

    Parameters
    ----------
    stages : int
        At least 1.
    arm : float
        Length of an arm in m.
    angle : float
        Angle of the arms at the start, from the ground, in rad.
    amplitude : float
        Amplitude of the roller, in m.
    rate : float
        In rad/s.
    mass, platform, load : float
        Mass of each arm, of the platform, and of the load on its middle, in kg.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the roller would go further than the arms reach, or under the other foot.

    Notes
    -----
    By virtual work the roller's force is stages / tan(angle) times the weight of the platform, if arms are light; it is large
    where the lift is low. The numbers are round ones.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.scissor_lift(4), 2.0, step=0.01)
    >>> height = 4 * np.sqrt(1 - sol["roller.position.x"]**2)
    >>> bool(abs(sol["platform.position.y"] - height).max() < 1e-10)
    True
    """
    n, L = checks.count("stages", stages, least=1), checks.number("arm", arm, above=0)
    angle, amplitude = checks.number("angle", angle), checks.number("amplitude", amplitude)
    w, h = L * np.cos(angle), L * np.sin(angle)
    if not (0 < angle < np.pi / 2 and abs(amplitude) < min(w, L - w)):
        raise WrongValue(f"amplitude must be less than {max(0.0, min(w, L - w)):g} m with arms of {L:g} m at an angle of "
                         f"{angle:g}, which must be between 0 and a right angle, not {amplitude:g}", "geometry")
    m = Mechanism("scissor_lift", gravity=(0.0, -checks.number("gravity", gravity)))
    rises = [m.link(f"rise{i}", (0, i * h), (w, (i + 1) * h), mass) for i in range(n)]
    falls = [m.link(f"fall{i}", (0, (i + 1) * h), (w, i * h), mass) for i in range(n)]
    platform, load = checks.number("platform", platform, least=0), checks.number("load", load, least=0)
    deck = m.body("platform", platform, platform * w**2 / 12, at=(0, n * h), com=(w / 2, 0))
    m.particle("load", load, at=deck.point((w / 2, 0)))
    m.revolute("foot", m.ground, rises[0].start)
    m.point("roller", falls[0], (L, 0))
    m.slot("rail", m.ground, falls[0].end, axis=(1, 0))
    for i in range(n):
        m.revolute(f"cross{i}", rises[i].center, falls[i].center)
    for i in range(n - 1):
        m.revolute(f"left{i}", falls[i].start, rises[i + 1].start)
        m.revolute(f"right{i}", rises[i].end, falls[i + 1].end)
    m.revolute("head", falls[-1].start, deck)
    m.slot("deck rail", deck, rises[-1].end, axis=(1, 0))
    m.motor("drive", "rail", displacement=swing(amplitude, rate))
    return m
