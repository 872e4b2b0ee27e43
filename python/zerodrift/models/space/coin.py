"""A coin that settles on a table, Euler's disc."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.elements.frames import about
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def coin(*, radius: float = 0.012, mass: float = 7.5e-3, incline: float = 0.3, damping: float = 0.0,
         gravity: float = 9.81) -> Mechanism:
    """A thin coin that rolls on its edge, as Euler's disc does, its centre at rest.

    It starts at an inclination at which its contact point circulates at ``sqrt(4 gravity / (radius sin(incline)))`` while the
    coin itself hardly turns. Without damping this motion is steady; with a torque that damps the change of its inclination, it
    sinks, and the contact point circulates ever faster. The body is ``coin``, whose z axis is its axis, and the contact
    ``table``.

    Parameters
    ----------
    radius : float
        In m.
    mass : float
        In kg.
    incline : float
        Inclination of the coin against the table at the start, in rad, more than 0 and less than a right angle.
    damping : float
        Torque on its angular velocity, in N m s, along the table.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If it would lie flat or stand upright.

    References
    ----------
    H. K. Moffatt, Euler's disk and its finite-time singularity, Nature 404 (2000), 833-834. The numbers are those of a euro.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.coin(), 0.1, step=2e-4)
    >>> bool(abs(sol["coin.position"] - sol["coin.position"][0]).max() < 1e-9)
    True
    """
    r = checks.number("radius", radius, above=0)
    if not 0 < incline < np.pi / 2:
        raise WrongValue(f"incline must be more than 0 and less than a right angle, {np.pi / 2:g}, not {incline:g}",
                         "out-of-range")
    if gravity < 0:
        raise WrongValue(f"gravity must be at least 0, not {gravity:g}: the coin lies on the table", "out-of-range")
    A, m = mass * r**2 / 4, Mechanism("coin", dimension=3, gravity=(0, 0, -gravity))
    turned = about((0, 1, 0), incline)
    body = m.body("coin", mass, (A, A, 2 * A), at=(0, 0, r * np.sin(incline)), rotation=turned)
    m.rolling("table", m.ground, body, radius=r, axle=turned[:, 2], normal=(0, 0, 1))
    if damping:
        for axis, word in (((1, 0, 0), "x"), ((0, 1, 0), "y")):
            m.torque(f"air {word}", body, axis=axis, value=_against(damping), of={"w": f"coin.angular_velocity.{word}"})
    whirring = np.sqrt(4 * gravity / (r * np.sin(incline)))
    diameter = -turned[:, 0]        # from the contact upwards
    m.start({"coin.angular_velocity": whirring * np.sin(incline) * diameter})
    return m


def _against(damping: float) -> Any:
    from .._swing import symbol

    return -damping * symbol("w")
