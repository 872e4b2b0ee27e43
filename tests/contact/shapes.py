"""Shapes that points and discs touch, of the time stepping program: gaps and normals."""

import math
from typing import NamedTuple


class Contact(NamedTuple):
    """Point of a body, or disc around it, and a shape of another body, which starts or has its centre at `start`.

    A line, or a "segment" of the length `size`, has this direction angle, and a line is free on its left. A "circle" of the
    radius `size`, or an "arc" of it up to `half` on both sides of this direction, is touched from inside if it is negative.
    """

    body: int
    point: tuple[float, float]
    line: int
    start: tuple[float, float]
    angle: float
    radius: float
    e: float
    mu: float
    shape: str = "line"
    size: float = 0.0
    half: float = math.pi


def _arc(of, u, w):
    """Gap from the circle of an arc, its normal and True within its angles."""
    side, distance = math.copysign(1, of.size), math.hypot(u, w)
    normal = (side * u / distance, side * w / distance) if distance else (1.0, 0.0)
    return side * (distance - abs(of.size)) - of.radius, normal, abs(math.atan2(w, u)) <= of.half


def _ends(of):
    if of.shape == "segment":
        return (0.0, 0.0), (of.size, 0.0)
    x, y = abs(of.size) * math.cos(of.half), abs(of.size) * math.sin(of.half)
    return (x, -y), (x, y)


def _beside(of, u, w):
    if not of.radius:
        return math.inf, (0.0, 1.0)
    x, y = min(((u - a, w - b) for a, b in _ends(of)), key=lambda at: math.hypot(*at))
    distance = math.hypot(x, y)
    return distance - of.radius, (x / distance, y / distance)


def touch(of, u, w, side):
    """Gap, infinite beside the shape, and normal, of a point along and left of its direction, that came from this side."""
    if of.shape == "line":
        return w - of.radius, (0.0, 1.0)
    if of.shape == "segment":
        if not 0 <= u <= of.size:
            return _beside(of, u, w)
        here = math.copysign(1, w) if of.radius else side
        return here * w - of.radius, (0.0, here)
    gap, normal, within = _arc(of, u, w)
    return (gap, normal) if of.shape == "circle" or (within and side > 0) else _beside(of, u, w)


def zone_of(of, u, w):
    """Part of the shape that is nearest: of a segment 0 its start, 1 within it, 2 its end; of an arc True within its angles."""
    if of.shape == "segment":
        return int(u >= 0) + int(u > of.size)
    return of.shape != "arc" or _arc(of, u, w)[2]


def side_of(of, u, w, side):
    """Side from which it may touch: of a segment 1 left of it or on it, -1 right of it; of an arc 1 in front, -1 behind it."""
    if of.shape == "segment":
        return side if side and 0 <= u <= of.size else math.copysign(1, w if abs(w) > 1e-9 else 1)
    if of.shape != "arc":
        return 1
    gap, _, within = _arc(of, u, w)
    if within and side:
        return 1 if side > 0 or gap > 0 else -1
    return 1 if gap > -max(of.radius, 1e-9) else -1
