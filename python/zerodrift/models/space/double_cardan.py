"""A shaft with two universal joints, which transmits a constant speed if their forks are aligned."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.elements.frames import about
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def double_cardan(*, bend: float = 0.5, last_bend: float | None = None, phase: float = 0.0, length: float = 0.5,
                  mass: float = 1.0, speed: float = 10.0) -> Mechanism:
    """Input and output with a shaft between them, in one plane, and a universal joint at each of its ends.

    Where both bends are alike and the forks on the middle shaft are in one plane, the output turns as the input does; a phase
    between the forks makes the speed less uniform than with one joint. The shafts are ``input``, ``middle`` and ``output``, the
    crosses ``first`` and ``second``, the bearings ``bearing in`` and ``bearing out``, which lets the output slide, and the
    motor is ``drive``.

    Parameters
    ----------
    bend : float
        Between input and middle, in rad, less than a right angle.
    last_bend : float, optional
        Between middle and output, to the same side; left out: -bend, which makes the output parallel to the input.
    phase : float
        Phase of the middle shaft's forks against each other, in rad.
    length, mass : float
        Length and mass of each shaft, a round bar, in m and kg.
    speed : float
        Angular velocity of the input, in rad/s.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        For a bend of a right angle or more.

    Notes
    -----
    With input, middle and output turned by ``a``, ``c`` and ``b`` where the forks of the middle shaft are in one plane,
    ``tan(c) = tan(a) cos(bend)`` and ``tan(c) = tan(b) cos(last_bend)``.

    References
    ----------
    J. Denavit, R. S. Hartenberg, Kinematic Synthesis of Linkages, McGraw-Hill 1964, chapter 12. The numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.double_cardan(), 1.0, step=2e-3)
    >>> bool(abs(sol["bearing out.angle_speed"] - 10.0).max() < 1e-9)
    True
    """
    length, last_bend = checks.number("length", length, above=0), -bend if last_bend is None else last_bend
    for name, angle in (("bend", bend), ("last_bend", last_bend)):
        if not abs(angle) < np.pi / 2:
            raise WrongValue(f"{name} must be less than a right angle, {np.pi / 2:g}, not {angle:g}", "out-of-range")
    m, up = Mechanism("double_cardan", dimension=3), np.array([0.0, 0.0, 1.0])
    middle, out = (np.array([np.cos(angle), np.sin(angle), 0.0]) for angle in (bend, bend + last_bend))
    joints = np.zeros(3), length * middle
    m.link("input", (-length, 0, 0), joints[0], mass)
    m.link("middle", *joints, mass)
    m.link("output", joints[1], joints[1] + length * out, mass)
    m.revolute("bearing in", m.ground, "input.start", axis=(1, 0, 0))
    m.universal("first", "input.end", "middle.start", axes=(up, np.cross(up, middle)))
    own = about(middle, phase) @ np.cross(up, middle)       # the arm of the second cross on the middle shaft
    other = np.cross(own, out)
    m.universal("second", "middle.end", "output.start", axes=(own, other))
    m.cylindrical("bearing out", m.ground, "output.end", axis=out)
    m.motor("drive", "bearing in", speed=speed)
    return m
