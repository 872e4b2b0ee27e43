"""A disc cam and its follower, with a low and a high dwell."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import inertia
from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import sympy


@checked
def cam_follower(*, lift: float = 0.0254, base: float = 0.05, rise: float = np.pi / 2, dwell: float = np.pi / 2,
                 fall: float = np.pi / 2, speed: float = 2 * np.pi, cam_mass: float = 1.0, follower_mass: float = 0.5,
                 stiffness: float = 500.0, preload: float = 20.0, gravity: float = 9.81) -> Mechanism:
    """A cam that raises its follower by the 4-5-6-7 polynomial, holds it, and lowers it by the same.

    It begins in the middle of the low dwell. The follower, above the cam's shaft, is pressed down by a spring; the cam's coupling
    also pulls; a real follower would lift off where ``contact.force`` is negative. The bodies are ``cam`` and ``follower``, the
    joints ``shaft`` and ``guide``, the motor ``drive``.

    Parameters
    ----------
    lift : float
        In m.
    base : float
        Radius of the base circle in m.
    rise, dwell, fall : float
        Angles of the cam, in rad, over which the follower rises, dwells and falls.
    speed : float
        Angular velocity of the cam, in rad/s.
    cam_mass, follower_mass : float
        In kg; the cam is a disc of its base circle.
    stiffness, preload : float
        Stiffness of the spring, in N/m, and its force in the low dwell, in N.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If rise, dwell and fall are not positive, or more than a turn together.

    References
    ----------
    R. L. Norton, Design of Machinery, chapter on cam design, for cams of two dwells by polynomials. A lift of one inch, quarters
    of a turn and one turn in a second are round numbers in its manner.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.cam_follower(), 1.0, step=0.01)
    >>> bool(abs(np.ptp(sol["guide.displacement"]) - 0.0254) < 1e-12), bool(sol["contact.force"].min() > 0)
    (True, True)
    """
    base = checks.number("base", base, above=0)
    rise, dwell, fall = (checks.number(name, value, above=0) for name, value in
                         (("rise", rise), ("dwell", dwell), ("fall", fall)))
    if not rise + dwell + fall < 2 * np.pi:
        raise WrongValue(f"rise, dwell and fall must be less than a turn together, {2 * np.pi:g}, not {rise + dwell + fall:g}",
                         "out-of-range")
    m = Mechanism("cam_follower", gravity=(0.0, -checks.number("gravity", gravity)))
    cam = m.body("cam", *inertia.disc(mass=checks.number("cam_mass", cam_mass, above=0), radius=base))
    follower = m.body("follower", follower_mass, at=(0, base))
    m.revolute("shaft", m.ground, cam, at=(0, 0))
    m.prismatic("guide", m.ground, follower, axis=(0, 1))
    m.cam("contact", "shaft", "guide", profile=_profile(checks.number("lift", lift, above=0), rise, dwell, fall))
    top = m.ground.point((0, 2 * base + lift))
    if stiffness > 0:
        m.spring("spring", top, follower.point((0, 0)), stiffness=stiffness, length=base + lift + preload / stiffness)
    m.motor("drive", "shaft", speed=speed)
    return m


def _profile(lift: float, rise: float, dwell: float, fall: float) -> Any:
    """The lift over the cam's angle, as a SymPy expression."""
    sp = sympy()
    low = (2 * np.pi - rise - dwell - fall) / 2
    turned = sp.Mod(sp.Symbol("angle"), 2 * sp.pi)

    def up(x: Any) -> Any:
        return lift * (35 * x**4 - 84 * x**5 + 70 * x**6 - 20 * x**7)

    ends = np.cumsum([low, rise, dwell, fall]).tolist()
    return sp.Piecewise((0, turned < ends[0]), (up((turned - ends[0]) / rise), turned < ends[1]), (lift, turned < ends[2]),
                        (up((ends[3] - turned) / fall), turned < ends[3]), (0, True))
