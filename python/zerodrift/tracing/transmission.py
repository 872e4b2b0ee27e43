"""`transmission_angle`: how well a link pushes the next one."""

from __future__ import annotations

from typing import Any

from .._private import checks
from ..errors import WrongType
from ..mechanisms.elements.joints import Joint
from ..mechanisms.elements.measures import Measure
from ..mechanisms.equations import transmission
from ..mechanisms.mechanism import Mechanism


def transmission_angle(m: Mechanism, joint: Joint | str) -> Measure:
    """The measure of the transmission angle at a hinge of two moving links: in a four-bar, between coupler and rocker.

    It is the angle between two lines through the hinge. The line of a link goes to its other joint; where it has several, to that
    on the ground. If a link ends in a slider there, its line is the normal of the slide. At pi / 2 the push of one link
    turns the other best; at 0 and at pi it does not turn it at all. Common design rules keep it within 40 to 140 degrees.

    Parameters
    ----------
    m : Mechanism
    joint : joint or str

    Returns
    -------
    Measure
        ``"C.transmission_angle"``, in rad: for `trace`, as an output of `simulate`, for events and laws. In the drawing it is
        between 0 and pi; from there on it is smooth, and what it does beyond 0 and pi are positions in which the links have gone
        through one line. The acute angle of some textbooks is ``np.arcsin(abs(np.sin(angle)))``.

    Raises
    ------
    ValueError
        If the joint is not a hinge of two moving links, or a link has several other joints and the choice is ambiguous.

    References
    ----------
    R. L. Norton, Design of Machinery, McGraw-Hill, section 3.3; J. J. Uicker, G. R. Pennock, J. E. Shigley, Theory of Machines
    and Mechanisms, Oxford University Press, section 1.10.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> m = zd.models.chebyshev_lambda()
    >>> mu = zd.trace(m, "crank.angle")[zd.transmission_angle(m, "C")]
    >>> np.degrees([mu.min(), mu.max()]).round(2)
    array([23.07, 73.74])
    """
    checks.instance("m", m, Mechanism, "a Mechanism")
    m._in_the_plane("transmission_angle")
    found: Any = m[joint] if isinstance(joint, str) else joint
    if not isinstance(found, Joint) or m._elements.get(found.name) != found:
        raise WrongType(f"joint must be a joint of {m.name!r}, or its name, not {checks.shown(found)}")
    transmission.lines(found, transmission.joints_by_body(m._elements))
    return Measure(f"{found.name}.transmission_angle")
