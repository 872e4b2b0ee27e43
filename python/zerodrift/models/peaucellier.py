"""Peaucellier's and Lipkin's cell, which draws a straight line exactly."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.linkage import linkage
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import swing


@checked
def peaucellier(*, arm: float = 0.25, side: float = 0.12, crank: float = 0.1, amplitude: float = 1.2, rate: float = 2 * np.pi,
                mass: Mapping[str, float] | float = 0.2, gravity: ArrayLike | None = None) -> Mechanism:
    """A rhombus on two arms: its near corner ``Q`` moves on a circle through ``O``, and its far corner ``P`` on a line.

    O P is (arm^2 - side^2) / O Q, which is an inversion, and so the line is x = (arm^2 - side^2) / (2 crank). The crank ``AQ``
    swings: its motor, ``drive``, has it at amplitude sin(rate t) from the x axis.

    Parameters
    ----------
    arm, side, crank : float
        Lengths in m, of arms from O, sides of the rhombus, and the crank, whose fixed hinge A is as far from O as Q.
    amplitude : float
        Amplitude of the crank, in rad.
    rate : float
        In rad/s.
    mass : float or dict of str to float
        In kg, of each link, or by link.
    gravity : array_like (2,), optional
        In m/s^2; left out: none.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the arms cannot follow: O Q, which is 2 crank cos(angle / 2), has to stay between arm - side and arm + side.

    References
    ----------
    A. B. Kempe, How to Draw a Straight Line, Macmillan, 1877.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.peaucellier(), 1.0, step=0.002)
    >>> x, y = sol["P.position"].T
    >>> bool(np.ptp(y) > 0.3), bool(np.ptp(x) < 1e-12)
    (True, True)
    """
    arm, side, crank = (checks.number(name, value, above=0) for name, value in (("arm", arm), ("side", side), ("crank", crank)))
    amplitude = checks.number("amplitude", amplitude, least=0)
    near, far = 2 * crank * np.cos(min(amplitude, np.pi) / 2), 2 * crank
    if not (abs(arm - side) < near and far < arm + side):
        raise WrongValue(f"amplitude {amplitude:g} leads Q from {far:g} to {near:g} m from O, and arms of {arm:g} m with sides "
                         f"of {side:g} m reach from {abs(arm - side):g} to {arm + side:g} m", "geometry")
    x = (far**2 + arm**2 - side**2) / (2 * far)
    y = np.sqrt(arm**2 - x**2)
    m = linkage({"O": (0, 0), "A": (crank, 0), "Q": (far, 0), "S": (x, y), "R": (x, -y), "P": (2 * x - far, 0)},
                {"ground": "OA", **{link: link for link in ("AQ", "OS", "OR", "QS", "QR", "PS", "PR")}},
                lengths={"AQ": crank, "OS": arm, "OR": arm, "QS": side, "QR": side, "PS": side, "PR": side}, mass=mass,
                gravity=gravity, name="peaucellier")
    m.motor("drive", "A", angle=swing(amplitude, rate))
    return m
