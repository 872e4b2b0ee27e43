"""Shapes and paths of the samples of a solution, for pictures and films: independent of the plotting library."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._private import checks
from ..errors import WrongType, WrongValue
from ..systems.base import BaseSystem
from ..systems.shapes import Shape
from .samples.solution import Solution

GHOSTS = 8      # default number of faint positions of a motion
WHOLE = 100     # positions from which the travel of sliders is determined
JOINTS = 12     # the most points that are drawn as joints; more points are taken for a curve
RESTING = 1e-6  # of the drawing: what moves by less rests


def spread(sol: Solution, count: int) -> np.ndarray:
    """Indices of `count` + 1 samples evenly over the run, including the first."""
    return np.linspace(0, len(sol.t) - 1, count + 1).round().astype(int)


def is_nothing(value: Any) -> bool:
    return isinstance(value, tuple | list) and not value


def is_upside_down(system: Any) -> bool:
    """True if gravity acts along +z, as where z points down."""
    return float(getattr(system, "parameters", {}).get("gravity.z", 0.0)) > 0


def names_of_points(points: Any) -> list[str]:
    """Names of points, or of a single one, that are given as objects or by name."""
    found = []
    for point in points if isinstance(points, list | tuple) else [points]:
        name = point if isinstance(point, str) else getattr(point, "measured_name", None) or getattr(point, "name", None)
        if not isinstance(name, str):
            raise WrongType(f"each of path must be a point or its name, such as 'F' or rod.end, not {checks.shown(point)}")
        found.append(name)
    return found


def paths_of(sol: Any, points: Any) -> list[np.ndarray]:
    """Positions (k, 2) or (k, 3) in m of points at all samples of a solution or a trace."""
    found = []
    for name in names_of_points(points):
        places = np.asarray(sol[name if name.endswith(".position") else f"{name}.position"])
        if places.ndim != 2:
            raise WrongValue(f"path {name!r} must be of a point, not of the scalar {name}.position", "wrong-measure")
        found.append(places)
    return found


def moments_or_points(system: BaseSystem, positions: Any, sol: Solution | None, times: Any = None,
             **asked: Any) -> list[list[Shape]] | np.ndarray:
    """Shapes of each position, at times (k,) of a solution; for a system in space without shapes, its points (k, n, 3)."""
    if isinstance(system, BaseSystem):
        motion = () if sol is None else sol.p[spread(sol, WHOLE)]
        known = system._sketches([checks.vector("p", p, system.nq) for p in positions], motion)
        if known is not None:
            return known if sol is None or times is None else _as_joined(known, sol, times)
    for name, value in asked.items():
        if value is not False and not is_nothing(value):
            raise WrongValue(f"{name} must be left out for {system.name}, which is drawn from its points: it needs a Mechanism",
                             "not-available")
    points = points_at(system, positions)
    if points.shape[2] == 3:
        return points
    motion = points if sol is None else points_at(system, sol.p[spread(sol, GHOSTS)])
    return shapes_of(points, motion)


def _as_joined(moments: list[list[Shape]], sol: Solution, times: Any) -> list[list[Shape]]:
    """The shapes with rods shrunk to their first points while they are released."""
    changes, switched = sol.transitions, [(i, name) for i, (name, kind) in enumerate(sol.system._groups) if kind == "two-sided"]
    if not switched:
        return moments
    states = changes["state"][np.searchsorted(changes["t"], times, side="right") - 1]
    released = [{name for i, name in switched if not state[i]} for state in states]
    return [[shape._replace(points=shape.points[[0, 0]]) if shape.kind == "rod" and shape.name in names else shape
             for shape in shapes] for shapes, names in zip(moments, released, strict=True)]


def moments_of(sol: Solution, positions: Any, times: Any = None) -> list[list[Shape]]:
    """Shapes of the system of a solution at each of the positions (k, nq), at times (k,) in s.

    Raises
    ------
    ValueError
        If the system cannot be drawn.
    """
    moments = moments_or_points(sol.system, positions, sol, times)
    return list(map(_lines, moments)) if isinstance(moments, np.ndarray) else moments


def _lines(points: np.ndarray) -> list[Shape]:
    """Points (n, 3) joined by lines where they are not NaN."""
    return [Shape("rod" if len(run) > 1 else "dot", points[run]) for run in _runs(points)]


def points_at(system: BaseSystem, positions: Any) -> np.ndarray:
    """The points of each position, (positions, points, dimension)."""
    drawings = [system.points(p) for p in positions]
    if not drawings or drawings[0] is None:
        raise WrongValue(f"{system.name} has no drawing: it gives no points", "not-available")
    return np.array(drawings)


def shapes_of(drawings: np.ndarray, motion: np.ndarray) -> list[list[Shape]]:
    """The shapes of each drawing of the plane, (drawings, points, 2): bars and pins, and curves of many points. What rests in
    all drawings of a motion is held by the ground.
    """
    rests = at_rest(motion) if len(motion) > 1 else np.zeros(drawings.shape[1], dtype=bool)
    return [[shape for run in _runs(points) for shape in _run(points[run], rests[run])] for points in drawings]


def _run(points: np.ndarray, rests: np.ndarray) -> list[Shape]:
    """Shapes of joined points (n, 2)."""
    if len(points) > JOINTS:
        return [Shape("curve", points)]
    bars = [Shape("link", points[i:i + 2]) for i in range(len(points) - 1) if np.ptp(points[i:i + 2], axis=0).any()]
    ends = [Shape("particle", points)] if len(points) == 1 else []
    held = [Shape("ground", place[None]) for place in points[rests]]
    pins = [Shape("pin", place[None]) for i, place in enumerate(points) if rests[i] or 0 < i < len(points) - 1]
    return [*bars, *ends, *held, *pins]


def _runs(points: np.ndarray) -> list[np.ndarray]:
    """The numbers of the points of each line, which end where a point is NaN."""
    numbers = np.flatnonzero(~np.isnan(points).any(axis=1))
    return np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1) if numbers.size else []


def at_rest(drawings: np.ndarray) -> np.ndarray:
    """Mask of the points that are at rest in all drawings."""
    size = (np.nanmax(drawings, axis=(0, 1)) - np.nanmin(drawings, axis=(0, 1))).max()
    return np.ptp(drawings, axis=0).max(axis=1) <= RESTING * size
