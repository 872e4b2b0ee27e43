"""Selection of segments of the curve of positions: up to given values, for a whole turn, or back to the start."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..errors import CorrectionFailed, WrongValue
from .curve import Curve, Knot, Segment, touches
from .motion import Motion

LARGEST_COUNT = 1_000               # pieces: a curve that has neither turned nor closed by then, a hundred turns, has no end
LARGEST_COUNT_TO_A_VALUE = 5_000    # pieces: no value is farther from the start


class Met(NamedTuple):
    """Segments of the curve of positions, for each given value of the measure the one that contains it.

    `dead`: dead points passed on the way, each with the index of the first value behind it.
    """

    segments: list[Segment]
    dead: list[tuple[Knot, int]]


def on_one_side(motion: Motion, values: np.ndarray) -> Met:
    """Values in any order between the dead points on both sides of the start."""
    check_start(motion)
    forward = _as_far_as(motion, motion.knot, values.max(), values)
    backward = _as_far_as(motion, motion.knot.reversed(), values.min(), values)
    return Met(pick([segment.reversed() for segment in backward[::-1]] + forward, values), [])


def pick(pieces: list[Segment], values: np.ndarray) -> list[Segment]:
    """For each value, the segment that contains it, among segments in which the measure grows."""
    ends = np.array([segment.last.value for segment in pieces])
    return [pieces[place] for place in np.minimum(np.searchsorted(ends, values), len(pieces) - 1)]


def check_start(motion: Motion) -> None:
    """Refuse a start at which the measure is stationary."""
    if motion.knot.slope == 0:
        raise WrongValue(f"{motion.system.name} starts in a dead point of {motion.measure!r}, at {_shown(motion.knot.value)}, or "
                         "that does not change with its positions: start aside (m.start), or trace another measure")


def _as_far_as(motion: Motion, knot: Knot, last: float, values: np.ndarray) -> list[Segment]:
    """Segments from a knot to a value, at least one; a dead point before the value is an error."""
    pieces: list[Segment] = []
    for segment in itertools.islice(motion.curve.segments(knot), LARGEST_COUNT_TO_A_VALUE):
        if pieces and segment.sense != pieces[0].sense:
            break
        pieces.append(segment)
        if (segment.last.value - last) * segment.sense >= 0:
            return pieces
    else:
        raise WrongValue(f"values go too far from {_shown(knot.value)}, where {motion.measure!r} starts, to be followed: to "
                         f"{_shown(last)} {motion.unit}", "out-of-range")
    dead = pieces[-1].last.value
    if touches(dead, last):
        return pieces
    raise _beyond(motion, dead, last, values)


def _beyond(motion: Motion, dead: float, value: float, values: np.ndarray) -> ValueError:
    """Error that names the value that cannot be reached and the dead point."""
    place, side = int(np.flatnonzero(values == value)[0]), "least" if value < dead else "largest"
    return WrongValue(f"values[{place}] = {_shown(value)} is out of reach: the {side} value of {motion.measure!r}, at a dead "
                      f"point, is {_shown(dead)} {motion.unit}", "out-of-range")


def through(motion: Motion, values: np.ndarray) -> Met:
    """Segments for successive values without reversing: where values turn, the curve continues through a dead point."""
    check_start(motion)
    pieces = motion.curve.segments(_first(motion, values))
    segment, found, dead = next(pieces), [], []
    for i, value in enumerate(values):
        if i and (value - values[i - 1]) * segment.sense < 0:
            segment = _after_dead_point(motion, segment, pieces, i, values)
            dead.append((segment.first, i))
        while (value - segment.last.value) * segment.sense > 0 and not _ends_at(segment, value):
            following = next(pieces)
            if following.sense != segment.sense:
                raise _beyond(motion, segment.last.value, value, values)
            segment = following
        found.append(segment)
    return Met(found, dead)


def _first(motion: Motion, values: np.ndarray) -> Knot:
    """The first value on the branch of the start, in the sense of the values; a dead point is left towards the start."""
    first = on_one_side(motion, values[:1]).segments[0]
    if _ends_at(first, values[0]):
        return first.last.reversed()
    if first.first.slope == 0 and touches(first.first.value, values[0]):
        return first.first
    x, _ = motion.curve.positions([first], values[:1])
    knot = motion.curve.knot(x[0], first.last.x - first.first.x)
    if knot is None:
        raise CorrectionFailed(f"the positions cannot be traced from {values[0]:.10g}: the constraints do not determine them "
                               "there")
    differences = np.diff(values)[np.diff(values) != 0]
    return knot if not differences.size or differences[0] > 0 else knot.reversed()


def _ends_at(segment: Segment, value: float) -> bool:
    """True if a segment ends at a dead point of that value."""
    return segment.last.slope == 0 and touches(segment.last.value, value)


def _after_dead_point(motion: Motion, segment: Segment, pieces: Iterator[Segment], place: int, values: np.ndarray) -> Segment:
    """First segment after the next dead point."""
    for following in itertools.islice(pieces, LARGEST_COUNT):
        if following.sense != segment.sense:
            return following
        if motion.is_angle and abs(following.last.value - values[place - 1]) > 2 * np.pi:
            break
    raise WrongValue(f"values turn back at values[{place}] = {_shown(values[place])}, and the branch does not, as "
                     f"{motion.measure!r} goes on without a dead point; without through=True, values may come in any order",
                     "not-increasing")


def whole(motion: Motion) -> tuple[list[Segment], bool]:
    """Segments of one turn of the measure, or of the closed curve, and a flag of a full turn."""
    start, pieces = motion.knot, []
    angles = motion.turns()
    for segment in itertools.islice(motion.curve.segments(start), LARGEST_COUNT):
        pieces.append(segment)
        if motion.is_angle and segment.last.value - start.value >= 2 * np.pi and all(each.sense > 0 for each in pieces):
            return pieces, True
        if len(pieces) > 2 and (closing := _closing(motion.curve, segment, start, angles)) is not None:
            pieces[-1] = Segment(segment.first, closing, float(np.linalg.norm(closing.x - segment.first.x)) or segment.arc)
            return pieces, False
    raise WrongValue(f"{motion.measure!r} has no end that was found: it neither turns fully, nor do the positions come back to "
                     "their start; give values", "missing-argument")


def _closing(curve: Curve, segment: Segment, start: Knot, angles: np.ndarray) -> Knot | None:
    """Starting point plus whole turns, if a segment passes it."""
    turns = np.where(angles, 2 * np.pi * np.round((segment.last.x - start.x) / (2 * np.pi)), 0.0)
    before, behind = ((knot.x - turns - start.x) @ start.tangent for knot in (segment.first, segment.last))
    near = np.linalg.norm(segment.last.x - turns - start.x) <= 1.5 * segment.arc
    if not (near and before < 0 <= behind and segment.last.tangent @ start.tangent > 0.5):
        return None
    return curve.knot(start.x + turns, start.tangent)


def _shown(value: float) -> str:
    return f"{value:.10g}"
