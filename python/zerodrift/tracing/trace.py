"""`trace`: the positions of a mechanism by the values of a measure."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, MeasureLike, Measures, SystemLike, Values
from ..errors import WrongType, WrongValue
from ..mechanisms.elements.measures import name_of
from ..mechanisms.system import MechanismSystem
from ..systems.base import unswitched
from . import walk
from .curve import Knot, Segment
from .motion import Motion
from .trace_result import DeadPoint, Reach, Trace


def trace(system: SystemLike, measure: MeasureLike, values: ArrayLike | None = None, *, hold: Values | Measures = (),
          through: bool = False, count: int = 361, forces: bool | Measures = False) -> Trace:
    """Positions of a mechanism at given values of a measure, such as the angles of its crank; without time.

    All positions lie on the branch on which the mechanism starts, as drawn or as `start` says: it is followed in small steps.
    Motors and actuators that prescribe a motion are left out, as the measure takes their place.

    Parameters
    ----------
    system : Mechanism or its system
        In the plane; mechanisms in space are refused. With the held measures it must have one freedom.
    measure : measure or str
        A scalar measure of positions: ``crank.angle``, ``"slide.displacement"``, ``"P.position.x"``.
    values : array_like (k,), optional
        In rad or m, in any order. Left out: `count` positions over a full turn of an angle that turns fully; for other measures,
        from the start through all dead points until the mechanism is back, evenly along its path.
    hold : dict of measure to value, or measures, optional
        Measures that stay at the given value, or at that of the start: one for each freedom beyond the first.
    through : bool
        True: the direction of travel never reverses: where values turn, the trace continues through the next dead point, and
        the values after it are on the branch beyond it. False: all values lie between the same two dead points.
    count : int
        Number of positions if values are left out, in addition to dead points.
    forces : bool or measures
        True: the trace also has the forces of the mechanism at rest in each position, ``trace["pin.force"]``, and the effort
        along `measure` that holds it there, ``trace["effort"]`` in N or N m. Measures, such as ``"cylinder.length"``: efforts
        along these hold it; ``trace["effort"]`` is the first.

    Returns
    -------
    Trace

    Raises
    ------
    ValueError
        If there is no such measure; if a value is out of reach, with the dead point in the message; if values turn back where no
        dead point follows.
    SingularSystem
        If the mechanism does not have one freedom; the message names measures to hold.

    Notes
    -----
    A dead point is a position in which a measure turns back while the mechanism continues to move: for a crank, one in which the
    links after it are in one line. `trace` steps along the arc of all coordinates, on which dead points are ordinary points.

    References
    ----------
    E. L. Allgower, K. Georg, Introduction to Numerical Continuation Methods, SIAM, 2003.

    Examples
    --------
    The path of the toe of Jansen's leg over a turn of its crank:

    >>> import numpy as np
    >>> import zerodrift as zd
    >>> turn = zd.trace(zd.models.jansen(), "crank.angle")
    >>> turn["F.position"].shape
    (361, 2)
    """
    system = _mechanism(system)
    motion = Motion(system, name_of(measure, "measure"), hold)
    checks.instance("through", through, (bool, np.bool_), "True or False")
    count = checks.count("count", count, least=2)
    along = [motion.measure, *hold] if isinstance(forces, bool | np.bool_) else [forces] if isinstance(forces, str) else forces
    traced = _whole(motion, count) if values is None else _at(motion, _values(values), through)
    return traced.with_forces([name_of(each, "forces") for each in along]) if forces else traced


def _at(motion: Motion, values: np.ndarray, through: bool) -> Trace:
    """Trace at given values."""
    met = (walk.through if through else walk.on_one_side)(motion, values)
    x, slopes = motion.curve.positions(met.segments, values)
    dead = [_dead_point(motion, knot, place) for knot, place in met.dead]
    return _traced(motion, values, x, slopes, dead)


def reach(system: SystemLike, measure: MeasureLike, *, hold: Values | Measures = ()) -> Reach:
    """Range of a measure on the assembly branch of the start: bounded by dead points, or a full turn.

    Parameters
    ----------
    system : Mechanism or its system
    measure : measure or str
        As in `zerodrift.trace`, such as the angle of a crank.
    hold : dict of measure to value, or measures, optional
        As there.

    Returns
    -------
    Reach

    Raises
    ------
    ValueError, SingularSystem
        As of `trace`.

    Examples
    --------
    >>> import zerodrift as zd
    >>> leg = zd.models.jansen()
    >>> zd.reach(leg, "crank.angle").turns_fully
    True
    >>> zd.reach(leg, "F.position.y")
    <reach of F.position.y: -0.9183 ... -0.6938 m, between dead points>
    """
    motion = Motion(_mechanism(system), name_of(measure, "measure"), hold)
    pieces, turned = walk.whole(motion)
    ends = np.array([segment.last.value for segment in pieces] + [motion.knot.value])
    dead = tuple(_dead_point(motion, knot) for knot in _dead_knots(pieces))
    return Reach(motion.measure, motion.unit, *((-np.inf, np.inf) if turned else (float(ends.min()), float(ends.max()))), dead)


def _mechanism(system: Any) -> MechanismSystem:
    system = unswitched(system, "a trace")
    if not isinstance(system, MechanismSystem):
        raise WrongType(f"system must be a mechanism of bodies and joints, or its system, not {checks.shown(system)}")
    if system._drawing.dimension == 3:
        raise WrongValue(f"{system.name!r} is in space, and curves of positions are traced in the plane, not yet in space",
                         "wrong-dimension")
    return system


def _values(given: Any) -> np.ndarray:
    array = checks.real("values must hold", given, ragged="values must be a regular array, not be")
    if array.ndim != 1 or not array.size:
        raise WrongValue(f"values must have shape (k,) and at least one entry, not shape {array.shape}", "shape")
    return checks.vector("values", array, array.size)


def _whole(motion: Motion, count: int) -> Trace:
    """Segments of the whole branch, or of one turn."""
    pieces, turned = walk.whole(motion)
    if turned:
        values = motion.knot.value + np.linspace(0, 2 * np.pi, count)
        x, slopes = motion.curve.positions(walk.pick(pieces, values), values)
        return _traced(motion, values, x, slopes, [])
    ends = np.cumsum([segment.arc for segment in pieces])
    dead = _dead_knots(pieces)
    places = [float(ends[i]) for i, segment in enumerate(pieces) if any(segment.last is knot for knot in dead)]
    arcs = np.sort(np.concatenate([np.linspace(0, ends[-1], count), places]))
    knots = []
    for arc in arcs:
        i = min(int(np.searchsorted(ends, arc)), len(pieces) - 1)
        is_dead = arc == ends[i] and any(pieces[i].last is knot for knot in dead)
        knots.append(pieces[i].last if is_dead else motion.curve.at(pieces[i], arc - ends[i] + pieces[i].arc))
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.array([knot.tangent / knot.slope if knot.slope else np.full(knot.x.size, np.inf) for knot in knots])
    after = [int(np.searchsorted(arcs, place)) for place in places]
    return _traced(motion, np.array([knot.value for knot in knots]), np.array([knot.x for knot in knots]), slopes,
                   [_dead_point(motion, knot, place) for knot, place in zip(dead, after, strict=True)])


def _dead_knots(pieces: list[Segment]) -> list[Knot]:
    """Knots at which the measure has an extremum."""
    return [first.last for first, second in itertools.pairwise(pieces) if first.sense != second.sense]


def _dead_point(motion: Motion, knot: Knot, place: int | None = None) -> DeadPoint:
    p, _ = motion.coordinates(knot.x[None], np.zeros((1, knot.x.size)))
    return DeadPoint(knot.value, p[0], place)


def _traced(motion: Motion, values: np.ndarray, x: np.ndarray, slopes: np.ndarray, dead: list[DeadPoint]) -> Trace:
    p, rates = motion.coordinates(x, slopes)
    return Trace(motion.system, motion.measure, motion.unit, values, p, rates, tuple(dead))
