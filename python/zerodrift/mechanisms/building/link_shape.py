"""Shape of a link with several points from a sketch and lengths, and its mass distributed along its sides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...errors import WrongValue
from ..elements.bodies import MassProperties
from ..elements.frames import Pose

IN_LINE = 1e-12         # of the longest side: what three lengths may lack or have too much for three points in line
AGREED = 1e-9           # of a length: agreement required of lengths that the others determine

Lengths = Mapping[frozenset[str], float]


class Shape:
    """The places of a link's points in its frame, which begins at its first point and goes to its second.

    A point with two lengths to points that have their places is where two circles meet, on the side on which it is drawn. A
    point with one has it in the direction in which it is drawn, and a point with none is where it is drawn.

    Parameters
    ----------
    link : str
        Its name, for errors.
    names : sequence of str
        Names of its points, at least one.
    drawn : dict of str to array (2,)
        Positions of the points in the sketch.
    lengths : dict
        Between two points, by the set of their names; those of other links are not looked at.

    Attributes
    ----------
    pose : Pose
        Pose of the frame in the sketch.
    places : dict of str to array (2,)
        In the frame, in the order of the names.

    Raises
    ------
    ValueError
        If points are drawn in one place, lengths make no triangle or contradict each other, or a side is not given.
    """

    def __init__(self, link: str, names: Sequence[str], drawn: Mapping[str, np.ndarray], lengths: Lengths) -> None:
        self.link, self.lengths = link, lengths
        first = names[0]
        along = drawn[names[1]] - drawn[first] if len(names) > 1 else np.array([1.0, 0.0])
        if not np.hypot(*along) > 0:
            raise WrongValue(f"points {first!r} and {names[1]!r} of link {link!r} must be two places in the sketch, "
                             f"not both {tuple(map(float, drawn[first]))}", "geometry")
        self.pose = Pose(drawn[first], float(np.arctan2(along[1], along[0])))
        self.sketched = {name: self.pose.local(drawn[name]) for name in names}
        found = {first: np.zeros(2)}
        if len(names) > 1:
            found[names[1]] = np.array([lengths.get(frozenset(names[:2]), float(np.hypot(*along))), 0.0])
        waiting = list(names[2:])
        while waiting:
            name = max(waiting, key=lambda each: min(2, len(self._known(each, found))))      # of equals the first
            waiting.remove(name)
            found[name] = self._placed(name, found)
        self.places = {name: found[name] for name in names}

    def _known(self, name: str, found: Mapping[str, np.ndarray]) -> list[str]:
        """Points with known positions to which a length is given."""
        return [other for other in found if frozenset((name, other)) in self.lengths]

    def _placed(self, name: str, found: Mapping[str, np.ndarray]) -> np.ndarray:
        known, sketched = self._known(name, found), self.sketched
        if not known:
            return sketched[name]
        if len(known) == 1:
            along = sketched[name] - sketched[known[0]]
            if not np.hypot(*along) > 0:
                raise WrongValue(f"points {known[0]!r} and {name!r} of link {self.link!r} must be two places in the sketch",
                                 "geometry")
            return found[known[0]] + self.lengths[frozenset((name, known[0]))] * along / np.hypot(*along)
        place = self._on_two_circles(name, known[0], known[1], found)
        for other in known[2:]:
            wanted, has = self.lengths[frozenset((name, other))], float(np.hypot(*(place - found[other])))
            if abs(has - wanted) > AGREED * wanted:
                raise WrongValue(f"lengths of link {self.link!r} contradict each other: by the others, {other!r} and {name!r} "
                                 f"are {has:.12g} apart, not {wanted:.12g}", "geometry")
        return place

    def _on_two_circles(self, name: str, one: str, two: str, found: Mapping[str, np.ndarray]) -> np.ndarray:
        """Intersections of the circles about two points."""
        a, b = (self.lengths[frozenset((name, other))] for other in (one, two))
        along = found[two] - found[one]
        c = self.lengths.get(frozenset((one, two)), float(np.hypot(*along)))
        lacks = np.array([b + c - a, c + a - b, a + b - c])      # each is negative where one side is longer than the others
        if lacks.min() < -IN_LINE * max(a, b, c) or not c > 0:
            raise WrongValue(f"lengths of link {self.link!r} make no triangle: {one}{name} {a:.12g}, {two}{name} {b:.12g}, "
                             f"{one}{two} {c:.12g}", "geometry")
        along = along / np.hypot(*along)
        if lacks.min() <= IN_LINE * max(a, b, c):
            return found[one] + (-a if lacks.argmin() == 1 else a) * along
        x = ((a - b) * (a + b) + c * c) / (2 * c)
        y = np.sqrt((a + b + c) * lacks.prod()) / (2 * c)       # Heron's formula in factors, which loses no digits
        return found[one] + x * along + self._side(name, one, two) * y * np.array([-along[1], along[0]])

    def _side(self, name: str, one: str, two: str) -> float:
        """On which side of the line through two points the sketch has a third: 1 is left."""
        first, second = (self.sketched[other] - self.sketched[one] for other in (two, name))
        cross = first[0] * second[1] - first[1] * second[0]
        if not abs(cross) > IN_LINE * np.hypot(*first) * np.hypot(*second):
            raise WrongValue(f"point {name!r} of link {self.link!r} is drawn in line with {one!r} and {two!r}, and by its "
                             "lengths it is not: draw it on its side", "geometry")
        return float(np.sign(cross))


def on_sides(places: Sequence[np.ndarray], mass: float) -> MassProperties:
    """Mass properties of slender rods along the sides of a polygon, with the mass distributed by length."""
    corners = np.asarray(places)
    sides = np.roll(corners, -1, axis=0) - corners
    lengths = np.hypot(*sides.T)
    masses, middles = mass * lengths / lengths.sum(), corners + sides / 2
    com = lengths @ middles / lengths.sum()
    inertia = float(masses @ (lengths**2 / 12 + ((middles - com) ** 2).sum(axis=1)))
    return MassProperties(mass, inertia, com)
