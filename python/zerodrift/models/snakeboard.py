"""A snakeboard, which its rider drives by turning to and fro, without touching the ground."""

from __future__ import annotations

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import swing


@checked
def snakeboard(*, mass: float = 6.0, inertia: float = 0.016, rotor_inertia: float = 0.072, wheel_inertia: float = 0.0013,
               half: float = 0.2, rotor_swing: float = 0.7, wheel_swing: float = 0.3, rotor_rate: float = 1.0,
               wheel_rate: float = 1.0) -> Mechanism:
    """A board with a rotor on its middle, and at each end an axle that turns under it and does not slip sideways.

    The rider swings the rotor by rotor_swing sin(rotor_rate t) against the board, and turns the axles against each other by
    wheel_swing sin(wheel_rate t). With equal rates it drives forward. Its bodies are ``board``, ``rotor``, ``front`` and
    ``back``; the blades ``front blade`` and ``back blade``.

    Parameters
    ----------
    mass : float
        Mass of all parts together, whose centre is the board's middle, in kg.
    inertia, rotor_inertia, wheel_inertia : float
        Moments of inertia of the board, the rotor, and each axle, in kg m^2.
    half : float
        From the middle to an axle, in m.
    rotor_swing, wheel_swing : float
        In rad.
    rotor_rate, wheel_rate : float
        In rad/s.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the axles would turn by a right angle, where they do not determine the motion.

    References
    ----------
    J. Ostrowski, A. Lewis, R. Murray, J. Burdick, Nonholonomic mechanics and locomotion: the snakeboard example, Proceedings of
    the IEEE International Conference on Robotics and Automation, 1994. Masses and sizes here are those of a small board.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.snakeboard(), 10.0, step=0.05)
    >>> bool(abs(sol["board.position"][-1]).max() > 0.2), bool(abs(sol.velocity_violation).max() < 1e-12)
    (True, True)
    """
    half, wheel_swing = checks.number("half", half, above=0), checks.number("wheel_swing", wheel_swing)
    if not abs(wheel_swing) < 1.5:
        raise WrongValue(f"wheel_swing must be between -1.5 and 1.5, as axles across the board block it, not {wheel_swing:g}",
                         "out-of-range")
    m = Mechanism("snakeboard")
    board = m.body("board", mass, inertia)
    rotor = m.body("rotor", 0.0, rotor_inertia)
    m.revolute("rotor axle", board, rotor, at=(0, 0))
    for side, y in (("left", 1), ("right", -1)):
        m.point(f"{side} arm", rotor, (-0.2 * y * half, 0.6 * y * half))
    m.motor("rotor drive", "rotor axle", angle=swing(rotor_swing, rotor_rate))
    for name, x, way in (("front", half, 1), ("back", -half, -1)):
        axle = m.body(name, 0.0, wheel_inertia, at=(x, 0))
        m.revolute(f"{name} axle", board, axle, at=(x, 0))
        m.knife_edge(f"{name} blade", axle, along=(1, 0))
        for side, y in (("left", 1), ("right", -1)):
            m.point(f"{name} {side} wheel", axle, (0, 0.4 * y * half))
        m.motor(f"{name} drive", f"{name} axle", angle=swing(way * wheel_swing, wheel_rate))
    return m
