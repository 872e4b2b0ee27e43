"""A pantograph, whose pen draws the path of its tracer at another scale."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import swing, symbol

MIDDLE = np.array([1.0, 0.6])       # of the figure, in arms from O


@checked
def pantograph(*, arm: float = 0.2, ratio: float = 2.0, size: float = 0.05, rate: float = 2 * np.pi,
               mass: Mapping[str, float] | float = 0.1, gravity: ArrayLike | None = None) -> Mechanism:
    """Four bars about a parallelogram, such that ``O``, the tracer ``Q`` and the pen ``P`` are in line, and O P is ratio O Q.

    The tracer is driven along a horizontal figure of eight, size wide to each side and half as high: both freedoms are driven.
    The bars are ``main`` (O A B), ``pen`` (B C P), ``short`` (A Q) and ``side`` (C Q).

    Parameters
    ----------
    arm : float
        O A and A Q, in m.
    ratio : float
        Scale of the pen's path, above 1.
    size : float
        Half the width of the eight, in m, less than a third of the arm.
    rate : float
        Angular frequency of the figure, in rad/s.
    mass : float or dict of str to float
        In kg, of each bar, or by bar.
    gravity : array_like (2,), optional
        In m/s^2; left out: none.

    Returns
    -------
    Mechanism

    References
    ----------
    C. Scheiner, Pantographice seu ars delineandi, Rome, 1631.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.pantograph(ratio=3.0), 1.0, step=0.005)
    >>> bool(abs(sol["P.position"] - 3.0 * sol["Q.position"]).max() < 1e-12)
    True
    """
    a, k = checks.number("arm", arm, above=0), checks.number("ratio", ratio, above=1)
    if not 0 <= checks.number("size", size) < a / 3:
        raise WrongValue(f"size must be from 0 to less than a third of the arm, {a / 3:g}, not {size:g}", "geometry")
    Q = a * MIDDLE
    A = Q / 2 + np.sqrt(a**2 / (Q @ Q) - 1 / 4) * np.array([-Q[1], Q[0]])
    m = linkage({"O": (0, 0), "A": A, "B": k * A, "C": k * A + Q - A, "P": k * Q, "Q": Q},
                {"ground": "O", "main": "OAB", "pen": "BCP", "short": "AQ", "side": "CQ"}, mass=mass, gravity=gravity,
                name="pantograph")
    m.constraint("tracer along", symbol("Q.position.x") - Q[0] - swing(size, rate))
    m.constraint("tracer up", symbol("Q.position.y") - Q[1] - swing(size / 2, 2 * rate))
    return m
