"""The curve of positions of a mechanism with one freedom, followed by predictor and corrector along its arc length.

n - 1 independent rows leave a curve in the n coordinates x, which are scaled so that lengths and angles compare. With the unit
tangent as the n-th row, Newton's matrix is regular wherever the curve is smooth, also where the measure turns back: there, at a
dead point, only the matrix with the measure's own row is singular.

E. L. Allgower, K. Georg, Introduction to Numerical Continuation Methods, SIAM, 2003.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .._private.gateway.mechanisms.geometry import Geometry
from ..errors import CorrectionFailed

FIRST_STEP = 0.02               # in rad or parts of the mechanism's length
LONGEST_STEP = 0.25
SHORTEST_STEP = 1e-8            # where shorter ones are needed, there is no curve any more
WANTED_TURN = 0.15              # of the tangent in a step, in rad
LARGEST_TURN = 0.4              # of the tangent in a step, in rad: one of more is made again, shorter
LARGEST_PREDICTOR_ERROR = 0.2   # of a step
LARGEST_LAST_CORRECTION = 1e-7  # of Newton's method: the next would be its square, which is rounding
ZERO_SLOPE = 1e-12              # of the measure's row: a smaller slope along the curve counts as none
LARGEST_RESIDUAL = 1e-12        # of a row in units of its size: what counts as closed
ITERATIONS = 12
INTERPOLATION_DISTANCE = 1e-3   # to both sides of a singular point, which is interpolated with an error of the fourth power
LARGEST_INVERSE = 1e5           # of Newton's matrix: beyond, it is nearly singular
EPS = 2.0**-52


class Knot(NamedTuple):
    """A point of the curve: coordinates, unit tangent, and the measure with its slope along the arc."""

    x: np.ndarray
    tangent: np.ndarray
    value: float
    slope: float

    def reversed(self) -> Knot:
        """The same point with the opposite direction."""
        return Knot(self.x, -self.tangent, self.value, -self.slope)


class Segment(NamedTuple):
    """A piece of the curve between two knots on which the measure is monotonic; `arc` is its length."""

    first: Knot
    last: Knot
    arc: float

    @property
    def sense(self) -> float:
        """Direction of the measure: 1 if it grows along the segment, -1 if it falls."""
        return float(np.sign(self.last.value - self.first.value))

    def reversed(self) -> Segment:
        """The same segment with the opposite direction."""
        return Segment(self.last.reversed(), self.first.reversed(), self.arc)


class Curve:
    """The curve: its points, and its consecutive segments.

    Parameters
    ----------
    geometry : Geometry
        The rows that are held at their values, and one component more, the measure.
    held : ndarray
        Target value of each row.
    scale : ndarray (n,)
        Characteristic scales of the coordinates.
    size : ndarray
        Sizes of the rows, and of the measure, in scaled coordinates.
    """

    def __init__(self, geometry: Geometry, held: np.ndarray, scale: np.ndarray, size: np.ndarray) -> None:
        self._geometry, self._held, self.scale, self._size = geometry, held, scale, size

    def evaluate(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, float, np.ndarray]:
        """Scaled residuals and gradients of the constraints; the measure and its gradient unscaled."""
        values, rows = self._geometry(x * self.scale)
        rows *= self.scale
        return (values[:-1] - self._held) / self._size[:-1], rows[:-1] / self._size[:-1, None], float(values[-1]), rows[-1]

    def knot(self, x: np.ndarray, along: np.ndarray) -> Knot | None:
        """Point of the curve found by Newton's method from x, orthogonal to a direction; None if it does not converge."""
        border = np.zeros(x.size)
        border[-1] = 1.0
        for _ in range(ITERATIONS):
            residual, rows, value, row = self.evaluate(x)
            matrix, right = np.vstack([rows, along]), np.column_stack([np.append(-residual, 0.0), border])
            try:
                step, tangent = np.linalg.solve(matrix, right).T
            except np.linalg.LinAlgError:
                return None
            if not np.isfinite(step).all() or (moved := np.abs(step).max()) > 1.0:
                return None
            if moved < 1e-15 or (np.abs(residual).max(initial=0.0) <= LARGEST_RESIDUAL and moved < LARGEST_LAST_CORRECTION):
                tangent = tangent / np.linalg.norm(tangent)
                return Knot(x + step, tangent, value + float(row @ step), self._slope(row, tangent))
            x = x + step
        return None

    @staticmethod
    def _slope(row: np.ndarray, tangent: np.ndarray) -> float:
        slope = float(row @ tangent)
        return slope if abs(slope) > ZERO_SLOPE * np.linalg.norm(row) else 0.0

    def segments(self, knot: Knot) -> Iterator[Segment]:
        """Segments of the curve from a knot on, on each of which the measure is monotonic, without end.

        Raises
        ------
        CorrectionFailed
            If the curve cannot be followed.
        """
        step, before, arc = FIRST_STEP, None, 0.0
        while True:
            bend = (knot.tangent - before.tangent) / (2 * arc) if before else 0.0
            found = self._step(knot, step, bend)
            if found is None:
                step /= 2
                if step < SHORTEST_STEP:
                    raise CorrectionFailed(f"the positions cannot be traced beyond {knot.value:.10g}: the constraints do not "
                                           "determine them there")
                continue
            turned = _angle(knot.tangent, found.tangent)
            before, arc = knot, _arc(knot, found)
            yield from self._pieces(knot, found)
            knot, step = found, min(LONGEST_STEP, step * min(2.0, WANTED_TURN / max(turned, 1e-9)))

    def _step(self, knot: Knot, step: float, bend: np.ndarray | float) -> Knot | None:
        """Knot at about the given distance along the curve; None if the step is too long to be reliable."""
        guess = knot.x + step * knot.tangent + step**2 * bend
        found = self.knot(guess, knot.tangent)
        if (found is None or _angle(knot.tangent, found.tangent) > LARGEST_TURN
                or np.linalg.norm(found.x - guess) > LARGEST_PREDICTOR_ERROR * step):
            return None
        return found

    def _pieces(self, first: Knot, last: Knot, depth: int = 0) -> Iterator[Segment]:
        """Segments between two knots, split where the measure has an extremum."""
        segment = Segment(first, last, _arc(first, last))
        if first.slope * last.slope < 0:
            dead = self._dead_point(segment)
            yield from (Segment(first, dead, _arc(first, dead)), Segment(dead, last, _arc(dead, last)))
        elif depth < 8 and _turns_inside(segment):
            middle = self.at(segment, segment.arc / 2)
            yield from self._pieces(first, middle, depth + 1)
            yield from self._pieces(middle, last, depth + 1)
        else:
            yield segment

    def at(self, segment: Segment, arc: float) -> Knot:
        """Point of the curve at a distance into a segment."""
        return self._at(segment, arc) or self._beside(segment, arc)

    def _at(self, segment: Segment, arc: float) -> Knot | None:
        along = segment.last.x - segment.first.x
        return self.knot(_between(segment, arc / segment.arc), along / np.linalg.norm(along))

    def _beside(self, segment: Segment, arc: float) -> Knot:
        """Point at a bifurcation, where Newton's matrix is singular: interpolated from points on both sides."""
        first, last = (self._at(segment, arc + aside) for aside in (-INTERPOLATION_DISTANCE, INTERPOLATION_DISTANCE))
        if first is None or last is None:
            raise CorrectionFailed(f"the positions cannot be traced beyond {segment.first.value:.10g}: the constraints do not "
                                   "determine them there")
        near = Segment(first, last, _arc(first, last))
        value, tangent = float(np.polyval(_cubic(near), 0.5)), last.x - first.x
        return Knot(_between(near, 0.5), tangent / np.linalg.norm(tangent), value, (first.slope + last.slope) / 2)

    def _dead_point(self, segment: Segment) -> Knot:
        """Point of a segment where the slope of the measure vanishes, by regula falsi (Illinois)."""
        (low, below), (high, above), found = (0.0, segment.first.slope), (segment.arc, segment.last.slope), segment.last
        for _ in range(60):
            arc = (low * above - high * below) / (above - below)
            found = self.at(segment, arc)
            if found.slope == 0 or abs(arc - high) < EPS * segment.arc:
                break
            if found.slope * above < 0:
                low, below = high, above
            else:
                below /= 2
            high, above = arc, found.slope
        return found._replace(slope=0.0)

    def positions(self, segments: list[Segment], values: np.ndarray,
                  aside: float = INTERPOLATION_DISTANCE) -> tuple[np.ndarray, np.ndarray]:
        """Positions x (k, n) at given values of the measure, each in its segment, and dx/dmeasure (k, n), which is infinite
        at dead points.
        """
        x = _guess(segments, values)
        best, slopes, inverse, error = x.copy(), np.full(x.shape, np.inf), np.full(len(x), np.inf), np.full(len(x), np.inf)
        active = np.arange(len(x))
        for _ in range(ITERATIONS):
            matrix, right = self._bordered(x[active], values[active])
            off = np.abs(right[:, :, 0]).max(axis=1)
            solved, better = _solved(matrix, right), off < error[active]
            moved = np.abs(solved[:, :, 0]).max(axis=1)
            improved = active[better]
            best[improved], slopes[improved] = x[improved], solved[better, :, 1]
            error[improved], inverse[improved] = off[better], np.abs(solved[better, :, 2]).max(axis=1)
            moving = better & (moved > EPS)
            active = active[moving]
            if not active.size:
                break
            x[active] += solved[moving, :, 0]
        self._take_dead_points(segments, values, best, slopes, error, inverse)
        by_dead = np.array([0.0 in (segment.first.slope, segment.last.slope) for segment in segments])      # singular, but known
        for i in np.flatnonzero(((inverse > LARGEST_INVERSE) & ~by_dead) | (error > LARGEST_RESIDUAL)):
            best[i], slopes[i] = self._between_values(segments[i], values[i], aside)
        return best, slopes

    def _between_values(self, segment: Segment, value: float, aside: float) -> tuple[np.ndarray, np.ndarray]:
        """Positions and derivatives where the matrix is singular, from values on both sides."""
        if not aside:
            raise CorrectionFailed(f"no position was found at {value:.10g}: the constraints do not determine it there")
        x, slopes = self.positions([segment, segment], value + np.array([-aside, aside]), aside=0.0)
        return (x[0] + x[1]) / 2 + aside / 4 * (slopes[0] - slopes[1]), 3 / (4 * aside) * (x[1] - x[0]) - slopes.sum(axis=0) / 4

    def _bordered(self, x: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Matrices (k, n, n) with the measure as the last row, and right sides (k, n, 3): of Newton's step, of the slope, and one
        that is in no special direction and so shows the size of the inverse.
        """
        n = x.shape[1]
        right, matrix = np.zeros((len(x), n, 3)), np.empty((len(x), n, n))
        right[:, :, 2] = np.cos(np.arange(n) ** 2)
        for i, (each, value) in enumerate(zip(x, values, strict=True)):
            residual, rows, measured, row = self.evaluate(each)
            right[i, :-1, 0], right[i, -1, 0] = -residual, (value - measured) / self._size[-1]
            matrix[i, :-1], matrix[i, -1] = rows, row / self._size[-1]
        right[:, -1, 1] = 1 / self._size[-1]
        return matrix, right

    @staticmethod
    def _take_dead_points(segments: list[Segment], values: np.ndarray, x: np.ndarray, slopes: np.ndarray,
                          *left: np.ndarray) -> None:
        """Use the dead points already found for values that equal theirs, and mark these as converged."""
        for i, (segment, value) in enumerate(zip(segments, values, strict=True)):
            for knot in (segment.first, segment.last):
                if knot.slope == 0 and touches(knot.value, value):
                    x[i], slopes[i] = knot.x, np.inf
                    for each in left:
                        each[i] = 0.0


def touches(dead: float, value: float) -> bool:
    """True if a value equals that of a dead point to rounding."""
    return abs(value - dead) <= 1e-13 * max(1.0, abs(dead))


def _angle(first: np.ndarray, second: np.ndarray) -> float:
    return float(2 * np.arcsin(min(1.0, float(np.linalg.norm(second - first)) / 2)))


def _arc(first: Knot, last: Knot) -> float:
    """Length of the curve between two knots, approximated by an arc of a circle."""
    return float(np.linalg.norm(last.x - first.x)) * (1 + _angle(first.tangent, last.tangent)**2 / 24)


def _between(segment: Segment, part: float) -> np.ndarray:
    """Cubic Hermite interpolant (n,) of a segment, at a fraction of its length."""
    first, last, h = segment.first, segment.last, segment.arc
    return (first.x * ((1 + 2 * part) * (1 - part)**2) + last.x * (part**2 * (3 - 2 * part))
            + h * part * (1 - part) * (first.tangent * (1 - part) - last.tangent * part))


def _cubic(segment: Segment) -> np.ndarray:
    """Cubic interpolant of the measure over the fraction of a segment; coefficients, highest power first."""
    first, last, h = segment.first, segment.last, segment.arc
    apart, a, b = last.value - first.value, h * first.slope, h * last.slope
    return np.array([a + b - 2 * apart, 3 * apart - 2 * a - b, a, first.value])


def _turns_inside(segment: Segment) -> bool:
    """True if the cubic interpolant of the measure has a turning point inside the segment."""
    a, b, c, _ = _cubic(segment)
    discriminant = b * b - 3 * a * c
    if discriminant <= 0 or a == 0:
        return False
    roots = (-b + np.array([-1.0, 1.0]) * np.sqrt(discriminant)) / (3 * a)
    return bool(((roots > 0) & (roots < 1)).any())


def _guess(segments: list[Segment], values: np.ndarray) -> np.ndarray:
    """Initial guesses (k, n) of the points at which the measure has given values, each in its segment, by bisection of its
    monotonic cubic.
    """
    a, b, c, d = np.array([_cubic(segment) for segment in segments]).T
    sense = np.array([segment.sense for segment in segments])
    low, high = np.zeros(len(values)), np.ones(len(values))
    for _ in range(50):
        part = (low + high) / 2
        is_behind = (((a * part + b) * part + c) * part + d - values) * sense < 0
        low, high = np.where(is_behind, part, low), np.where(is_behind, high, part)
    return np.array([_between(segment, part) for segment, part in zip(segments, low, strict=True)])


def _solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions for all right sides; minimum-norm ones for singular matrices."""
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        return np.array([np.linalg.lstsq(each, side, rcond=1e-13)[0] for each, side in zip(matrix, right, strict=True)])
