"""Bennett's linkage: four hinges in space that move against the count of freedoms."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.elements.frames import about
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def bennett(*, first_length: float = 0.3, first_twist: float = 0.5, second_twist: float = 1.1, angle: float = 1.0,
            density: float = 2.0, speed: float = 2.0, gravity: float = 0.0) -> Mechanism:
    """Four links with four hinges whose axes are skew, and one freedom where the count gives none.

    Opposite links are alike: lengths a, b and twists alpha, beta, with a sin(beta) = b sin(alpha), from which b follows. The
    fixed link is on the x axis, of length a; the others are ``input`` (b), ``coupler`` (a) and ``output`` (b); the hinges are
    ``A`` to ``D``, where ``B`` joins the ground and the input, and ``A`` the output and the ground.

    Parameters
    ----------
    first_length : float
        a, in m.
    first_twist, second_twist : float
        alpha and beta, between 0 and pi, the angles between the axes at the ends of a link, in rad.
    angle : float
        Angle of the input at the start, from the fixed link about B's axis, in rad; neither 0 nor pi, where it lies flat.
    density : float
        Density of the links, in kg/m.
    speed : float
        Angular velocity of the input at the start, in rad/s.
    gravity : float
        Downwards, along -z, which is A's axis, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the twists are equal or do not make a linkage, or it would start flat.

    Notes
    -----
    With theta the angle of the input about B and phi that at A, both from the fixed link's line on,
    ``tan(theta / 2) tan(phi / 2) = sin((beta + alpha) / 2) / sin((beta - alpha) / 2)``. Three of the twenty rows follow from the
    others.

    References
    ----------
    G. T. Bennett, A new mechanism, Engineering 76 (1903), 777-778; J. Phillips, Freedom in Machinery, volume 2, Cambridge
    University Press 1990. The numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> print(zd.models.bennett())      # doctest: +ELLIPSIS
    <Mechanism bennett: space, 3 bodies, 4 joints; ...>
     freedom 1 (Gruebler -2); ...
    """
    a, alpha, beta = checks.number("first_length", first_length, above=0), first_twist, second_twist
    if not (0 < alpha < np.pi and 0 < beta < np.pi and abs(np.sin((beta - alpha) / 2)) > 1e-6):
        raise WrongValue("first_twist and second_twist must be two different angles between 0 and pi, "
                         f"not {alpha:g} and {beta:g}", "geometry")
    if abs(np.sin(angle)) < 1e-6:
        raise WrongValue(f"angle must be neither 0 nor pi, where the linkage lies flat, not {angle:g}", "geometry")
    b = a * np.sin(beta) / np.sin(alpha)
    other = 2 * np.arctan(np.sin((beta + alpha) / 2) / np.sin((beta - alpha) / 2) / np.tan(angle / 2))
    places, axes = _corners(a, b, alpha, beta, angle, -other)
    m = Mechanism("bennett", dimension=3, gravity=(0, 0, -gravity))
    names = ("input", "coupler", "output")
    links = [m.link(name, places[i + 1], places[(i + 2) % 4], density * length)
             for i, (name, length) in enumerate(zip(names, (b, a, b), strict=True))]
    m.revolute("B", m.ground, links[0].start, axis=axes[1])
    m.revolute("C", links[0].end, links[1].start, axis=axes[2])
    m.revolute("D", links[1].end, links[2].start, axis=axes[3])
    m.revolute("A", links[2].end, m.ground, axis=axes[0])
    m.start({"B.speed": speed})
    return m


def _corners(a: float, b: float, alpha: float, beta: float, second: float,
             third: float) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Places and axes of A, B, C, D by links along common normals, turned about B by `second` and about C by `third`."""
    place, axis, along = np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    places, axes = [place], [axis]
    for length, twist, turned in ((a, alpha, 0.0), (b, beta, second), (a, alpha, third)):
        along = about(axis, turned) @ along
        place, axis = place + length * along, about(along, twist) @ axis
        places.append(place)
        axes.append(axis)
    return places, axes
