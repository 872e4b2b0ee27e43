"""Watt's governor: two balls that rise as a spindle turns faster, and lift a sleeve."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def flyball_governor(*, arm: float = 0.25, ball_mass: float = 2.0, ball_radius: float = 0.04, sleeve_mass: float = 5.0,
                     spindle_inertia: float = 0.02, speed: float = 14.0, damping: float = 0.0, lift: float = 0.0,
                     gravity: float = 9.81) -> Mechanism:
    """A Porter governor, started in the equilibrium of its speed.

    A spindle turns about the vertical. Two arms hang from a hinge on its axis, each with a ball at its end, and a rod of the
    same length goes from each ball to the sleeve, which slides on the spindle. The bodies are ``spindle``, ``ball 0``,
    ``ball 1``, whose massless arms are part of them, and ``sleeve``; the joints are ``bearing``, ``hinge 0``, ``hinge 1``,
    ``rod 0``, ``rod 1`` and ``slide``.

    Parameters
    ----------
    arm : float
        From the hinge to a ball's centre, in m.
    ball_mass, ball_radius : float
        Mass and radius of each solid ball, in kg and m.
    sleeve_mass : float
        In kg.
    spindle_inertia : float
        About its axis, the sleeve's included, in kg m^2.
    speed : float
        At the start, in rad/s.
    damping : float
        Damping of the sleeve, in N s/m.
    lift : float
        Speed of the sleeve at the start, in m/s, which makes it swing.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If it turns too slowly for the balls to fly out.

    Notes
    -----
    The balls hang at the angle theta from the spindle with
    ``cos(theta) = (ball_mass + sleeve_mass) gravity / (ball_mass arm speed^2)``.

    References
    ----------
    J. C. Maxwell, On governors, Proceedings of the Royal Society 16 (1868), 270-283; any textbook on the theory of
    machines for the governor of Porter. The numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.flyball_governor(), 1.0, step=2e-3)
    >>> bool(abs(sol["slide.displacement"]).max() < 1e-9)
    True
    """
    arm, radius = checks.number("arm", arm, above=0), checks.number("ball_radius", ball_radius, above=0)
    if not ball_mass * arm * speed**2 > (ball_mass + sleeve_mass) * gravity:
        least = np.sqrt(max((ball_mass + sleeve_mass) * gravity, 0.0) / (ball_mass * arm)) if ball_mass else np.inf
        raise WrongValue(f"speed must be more than {least:g} rad/s for the balls to fly out, not {speed:g}", "out-of-range")
    cosine = (ball_mass + sleeve_mass) * gravity / (ball_mass * arm * speed**2)
    down, out = arm * cosine, arm * np.sqrt(1 - cosine**2)
    m = Mechanism("flyball_governor", dimension=3, gravity=(0, 0, -gravity))
    spindle = m.body("spindle", 1.0, [spindle_inertia / 2] * 3)
    sleeve = m.body("sleeve", sleeve_mass, [spindle_inertia / 2] * 3, at=(0, 0, -2 * down))
    m.revolute("bearing", m.ground, spindle.point((0, 0, 0)), axis=(0, 0, 1))
    m.prismatic("slide", spindle, sleeve, axis=(0, 0, 1), damping=damping)
    for k, side in enumerate((1.0, -1.0)):
        ball = m.body(f"ball {k}", ball_mass, [0.4 * ball_mass * radius**2] * 3, at=(side * out, 0, -down))
        m.revolute(f"hinge {k}", spindle, ball, at=(0, 0, 0), axis=(0, -side, 0))
        m.rod(f"rod {k}", ball.center, sleeve.point((0, 0, 0)))
    m.start({"bearing.speed": speed, "slide.speed": lift})
    return m
