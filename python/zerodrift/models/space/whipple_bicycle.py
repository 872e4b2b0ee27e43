"""Whipple's bicycle: four rigid bodies on two thin wheels that roll, stable within a range of speeds."""

from __future__ import annotations

import numpy as np

from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def whipple_bicycle(*, speed: float = 4.6, roll_rate: float = 0.5, steer_rate: float = 0.0, gravity: float = 9.81) -> Mechanism:
    """The benchmark bicycle with its rigid rider, started upright and straight ahead, with a push.

    x is forward, y to the right, z down; the ground is at z = 0. The bodies are ``rear``, ``frame``, ``fork`` and ``front``, the
    joints ``rear axle``, ``steer`` and ``front axle``, and the contacts ``rear contact`` and ``front contact``.

    Parameters
    ----------
    speed : float
        Forwards, in m/s.
    roll_rate, steer_rate : float
        At the start, to the right, in rad/s.
    gravity : float
        Downwards, along z, in m/s^2.

    Returns
    -------
    Mechanism

    Notes
    -----
    Between 4.29 and 6.02 m/s it returns to upright without control.

    References
    ----------
    F. J. W. Whipple, The stability of the motion of a bicycle, Quarterly Journal of Pure and Applied Mathematics 30 (1899); J. P.
    Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Linearized dynamics equations for the balance and steer of a bicycle: a
    benchmark and review, Proceedings of the Royal Society A 463 (2007), whose numbers these are.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.whipple_bicycle(), 5.0, step=0.01)
    >>> steer = abs(sol["steer.angle"])
    >>> bool(steer[-1] < 0.1 * steer.max())
    True
    """
    m = Mechanism("whipple_bicycle", dimension=3, gravity=(0, 0, gravity))
    rear = m.body("rear", 2.0, (0.0603, 0.12, 0.0603), at=(0, 0, -0.3))
    front = m.body("front", 3.0, (0.1405, 0.28, 0.1405), at=(1.02, 0, -0.35))
    frame = m.body("frame", 85.0, [[9.2, 0, 2.4], [0, 11.0, 0], [2.4, 0, 2.8]], at=(0.3, 0, -0.9))
    fork = m.body("fork", 4.0, [[0.05892, 0, -0.00756], [0, 0.06, 0], [-0.00756, 0, 0.00708]], at=(0.9, 0, -0.7))
    m.revolute("rear axle", frame, rear.point((0, 0, 0)), axis=(0, 1, 0))
    m.revolute("front axle", fork, front.point((0, 0, 0)), axis=(0, 1, 0))
    axis = np.array([np.sin(np.pi / 10), 0.0, np.cos(np.pi / 10)])     # meets the ground at x = 1.1 m
    m.revolute("steer", frame, fork, at=np.array([1.1, 0.0, 0.0]) - 0.8 * axis, axis=axis)
    m.point("saddle", frame, (0.25, 0.0, -0.9))
    for name, side in (("left grip", -1.0), ("right grip", 1.0)):
        m.point(name, fork, (0.75, 0.25 * side, -0.95))
    m.rolling("rear contact", m.ground, rear, radius=0.3, axle=(0, 1, 0))
    m.rolling("front contact", m.ground, front, radius=0.35, axle=(0, 1, 0))
    m.start({"rear.velocity.x": speed, "frame.angular_velocity.x": roll_rate, "steer.speed": steer_rate})
    return m
