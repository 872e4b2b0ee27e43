"""`linkage`: a mechanism from points, links and lengths."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._private import checks
from .._private.types import ArrayLike
from ..errors import SingularSystem, WrongType, WrongValue
from .assembly.start import Starting
from .building.link_shape import Shape, on_sides
from .elements.bodies import Point
from .elements.numbers import AS_GIVEN
from .mechanism import Mechanism

GROUND = "ground"


def linkage(points: Mapping[str, ArrayLike], links: Mapping[str, str | Sequence[str]], *,
            lengths: Mapping[str, float] | Mapping[tuple[str, str], float] | None = None, mass: float | Mapping[str, float] = 1.0,
            scale: float = 1.0, gravity: ArrayLike | None = None, name: str = "linkage") -> Mechanism:
    """Mechanism of links and hinges, assembled from a sketch.

    Parameters
    ----------
    points : dict of str to array_like (2,)
        The sketch: approximate positions. Given lengths override it; the remaining dimensions are as close to it as
        possible.
    links : dict of str to points
        The points of each link: a string of one-letter names, or a sequence of names. The fixed points are those of ``"ground"``.
    lengths : dict of points to float, optional
        Distances of two points of one link: ``{"AB": 2.5}``, or ``{("A1", "B1"): 2.5}``. Distances that are left out are as
        drawn; a point of a link of three or more has them in the link's frame, which goes from its first point to its second.
        The first point of the ground, and the direction to its second, are as drawn.
    mass : float or dict of str to float
        In kg, of each link, or by link; those that a dict leaves out have none. A link of two points is a uniform slender rod;
        one of more has its mass in such rods along its sides, by their length.
    scale : float
        Metres in the unit of points and lengths.
    gravity : array_like (2,), optional
        In m/s^2; left out: none.
    name : str
        For tables and plots.

    Returns
    -------
    Mechanism
        A point at which two links meet is a hinge with the point's name. At a point where more meet, hinges join them to the
        one that was listed first, and to the ground where it is among them; they are named by the point and the link, ``"X
        crank"``, and the point has its name. Each point has a position, ``"X.position"``. To a link of two points,
        `Mechanism.link` applies; the inertia of others does not change with their mass.

    Raises
    ------
    ValueError, TypeError
        For points that are undefined or unused, links of one point, lengths between points of different links, lengths that
        form no triangle or contradict each other.
    CorrectionFailed
        If links cannot be joined; the message names the loop that stays open, and its gap.

    References
    ----------
    Jansen's leg, below: T. Jansen, *The Great Pretender*, 010 Publishers, 2007.

    Examples
    --------
    >>> import zerodrift as zd
    >>> leg = zd.linkage(
    ...     {"Z": (0, 0), "Y": (-38, -7.8), "X": (15, 0), "V": (-19, 33), "U": (-15, -40), "W": (-72, 10), "T": (-60, -30),
    ...      "F": (-20, -85)},
    ...     {"ground": "ZY", "crank": "ZX", "j": "XV", "k": "XU", "bed": "YVW", "c": "YU", "f": "WT", "foot": "UTF"},
    ...     lengths={"ZX": 15, "XV": 50, "XU": 61.9, "YV": 41.5, "VW": 55.8, "YW": 40.1, "YU": 39.3, "WT": 39.4, "TU": 36.7,
    ...              "TF": 65.7, "UF": 49},
    ...     scale=0.01, gravity=(0, -9.81))
    >>> drive = leg.motor("drive", "Z", speed=-6.0)
    >>> sol = zd.simulate(leg, 1.0, step=0.002)
    >>> sol["F.position"].shape, bool(abs(sol.position_violation).max() < 1e-12)
    ((501, 2), True)
    """
    scale = checks.number("scale", scale, above=0)
    drawn = _read_points(points, scale)
    links = _read_links(links, drawn)
    lengths = _read_lengths(lengths, links, scale)
    masses = _read_masses(mass, links)
    m = Mechanism(name, gravity=gravity)
    found: dict[str, dict[str, Point]] = {point: {} for point in drawn}
    for link, names in links.items():
        made = _make(m, link, Shape(link, names, drawn, lengths), drawn, masses[link])
        for point in names:
            found[point][link] = made[point]
    for point, sides in found.items():
        _join(m, point, sides)
    with contextlib.suppress(SingularSystem):       # massless links may get a drive that holds them
        Starting(m._drawing(), AS_GIVEN).assembled(0.0)
    return m


# ---- making ----


def _make(m: Mechanism, link: str, shape: Shape, drawn: Mapping[str, np.ndarray], mass: float) -> dict[str, Point]:
    """Add a link to the mechanism; returns its points by name."""
    names = list(shape.places)
    if link == GROUND:
        is_moved = any(pair <= set(names) for pair in shape.lengths)       # otherwise exactly at its drawn position
        return {name: m.ground.point(at=shape.pose.point(place) if is_moved else drawn[name])
                for name, place in shape.places.items()}
    if len(names) == 2:
        length = shape.places[names[1]][0] if frozenset(names) in shape.lengths else None
        made = m.link(link, drawn[names[0]], drawn[names[1]], mass, length=length)
        return dict(zip(names, (made.start, made.end), strict=True))
    _, inertia, com = on_sides(list(shape.places.values()), mass)
    body = m.body(link, mass, inertia, at=shape.pose.origin, angle=shape.pose.angle, com=com)
    return {name: body.point(place) for name, place in shape.places.items()}


def _join(m: Mechanism, name: str, sides: Mapping[str, Point]) -> None:
    """Join the links that meet at a point to the first of them."""
    (_, first), *others = sides.items()
    if len(others) == 1:
        m.revolute(name, first, others[0][1])
        return
    m.point(name, first.body, first.local)
    for link, second in others:
        m.revolute(f"{name} {link}", first, second)


# ---- reading arguments ----


def _read_points(points: Any, scale: float) -> dict[str, np.ndarray]:
    """Position of each point in the sketch, in m."""
    checks.instance("points", points, Mapping, "a dict of places by name")
    for name in points:
        if not isinstance(name, str):
            raise WrongType(f"points must have strings for names, not {checks.shown(name)}")
    return {name: scale * checks.vector(f"points[{name!r}]", place, 2) for name, place in points.items()}


def _read_links(links: Any, points: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Points of each link, the ground's first."""
    checks.instance("links", links, Mapping, "a dict of points by link")
    if GROUND not in links:
        raise WrongValue(f"links must have {GROUND!r}, the points that do not move; there are {', '.join(map(repr, links))}",
                         "missing-argument")
    read = {link: _names(f"links[{link!r}]", names, points) for link, names in links.items()}
    for link, names in read.items():
        if len(names) < 2 - (link == GROUND):
            raise WrongValue(f"links[{link!r}] must have two points or more, not {checks.shown(links[link])}", "shape")
        if len(set(names)) < len(names):
            raise WrongValue(f"links[{link!r}] must have each of its points once, not {checks.shown(links[link])}",
                             "duplicate-name")
        if link in points:
            raise WrongValue(f"{link!r} is a link and a point: each must have its own name", "duplicate-name")
    used = {name for names in read.values() for name in names}
    for name in points:
        if name not in used:
            raise WrongValue(f"point {name!r} belongs to no link: put it on one, or leave it out")
    return {GROUND: read.pop(GROUND), **read}


def _names(argument: str, given: Any, points: Mapping[str, Any]) -> tuple[str, ...]:
    """Names of points: the letters of a string, or a sequence of names."""
    if not isinstance(given, Sequence) or not all(isinstance(name, str) for name in given):
        raise WrongType(f"{argument} must be a string of one-letter points or a sequence of names, not {checks.shown(given)}")
    for name in given:
        if name not in points:
            raise WrongValue(f"{argument} names {name!r}, which is not one of the points; {checks.closest(name, points)}",
                             "wrong-name")
    return tuple(given)


def _read_lengths(lengths: Any, links: Mapping[str, tuple[str, ...]], scale: float) -> dict[frozenset[str], float]:
    """Lengths in m by pairs of points."""
    checks.instance("lengths", {} if lengths is None else lengths, Mapping, "a dict of lengths by pairs of points")
    read: dict[frozenset[str], float] = {}
    for given, length in (lengths or {}).items():
        pair = _pair(given, links)
        if pair in read:
            raise WrongValue(f"lengths has {' and '.join(map(repr, sorted(pair)))} twice", "duplicate-name")
        read[pair] = scale * checks.number(f"lengths[{given!r}]", length, above=0)
    return read


def _pair(given: Any, links: Mapping[str, tuple[str, ...]]) -> frozenset[str]:
    """Pair of points of a length."""
    points = dict.fromkeys(name for names in links.values() for name in names)
    if given in links and not set(given) <= set(points):
        raise WrongValue(f"lengths are between two points, and {given!r} is a link: it has {', '.join(links[given])}",
                         "wrong-name")
    pair = frozenset(_names("lengths", given, points))
    if len(pair) != 2 or len(given) != 2:
        raise WrongValue(f"lengths must be between two points, such as {''.join(list(points)[:2])!r}, not {checks.shown(given)}")
    if not any(pair <= set(names) for names in links.values()):
        raise WrongValue(f"lengths[{given!r}] must name two points of one link, and no link has both", "wrong-name")
    return pair


def _read_masses(mass: Any, links: Mapping[str, Any]) -> dict[str, float]:
    """Mass of each link; the ground has none."""
    if not isinstance(mass, Mapping):
        mass = checks.number("mass", mass, least=0)
        return {link: 0.0 if link == GROUND else mass for link in links}
    for link in mass:
        if link not in links or link == GROUND:
            raise WrongValue(f"mass names {link!r}, which is not a link that moves; "
                             f"{checks.closest(link, [each for each in links if each != GROUND])}", "wrong-name")
    return {link: checks.number(f"mass[{link!r}]", mass.get(link, 0.0), least=0) for link in links}
