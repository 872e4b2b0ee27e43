"""Pictures of traces: measures by the one that was traced, and a mechanism in several of its positions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .. import units
from .._private import checks
from .._private.types import ArrayLike, Display, Names, Points
from ..errors import WrongIndex, WrongType, WrongValue
from ..mechanisms.elements.measures import name_of
from ..runs.shapes_of_samples import paths_of
from ..tracing.trace_result import Trace
from . import style as _style
from .drawing import drawing_axes
from .mechanism import Extras, Picture

A_TRACE = "a Trace, as zd.trace returns it"
OTHERS = 8              # positions besides the first


@units.displayed
def trace(traced: Trace, names: Names, ax: Axes | None = None, *, degrees: bool = False,
          display: Display | None = None, **style: Any) -> Axes:
    """Draw measures over the traced measure; passed dead points are circles.

    Parameters
    ----------
    traced : Trace
        Result of `zerodrift.trace`.
    names : str or measure, or a sequence of them
        Scalar measures of positions; of a trace with forces also components of these, and "effort".
    ax : Axes, optional
        Left out: a new figure.
    degrees : bool
        True: draw angles in degrees.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        For ``ax.plot``.

    Returns
    -------
    Axes

    Raises
    ------
    KeyError
        If there is no such measure of positions.
    ValueError
        If one of them has components: `zerodrift.plot.positions` draws paths.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.models.chebyshev_lambda()
    >>> ax = zd.plot.trace(zd.trace(m, "crank.angle"), ["rocker.angle", zd.transmission_angle(m, "C")], degrees=True)
    >>> ax.get_xlabel()
    'crank.angle [°]'
    """
    checks.instance("traced", traced, Trace, A_TRACE)
    checks.instance("degrees", degrees, bool, "True or False")
    different, ax, along = [], _style.axes(ax), _shown(traced.unit, degrees)
    several = [names] if isinstance(names, str) or not isinstance(names, Sequence) else list(names)
    for name in several:
        called = name_of(name, "each of names")
        of, values = _shown(traced.unit_of(name), degrees), traced[name]
        if values.ndim != 1:
            raise WrongValue(f"each of names must be a scalar, and {called!r} has components; plot.positions "
                             "draws paths", "wrong-measure")
        (line,) = ax.plot(traced.values * along.factor, values * of.factor, **{"label": called} | style)
        dead = np.array([point.before for point in traced.dead_points], dtype=int)
        ax.plot(np.array([point.value for point in traced.dead_points]) * along.factor, values[dead] * of.factor, "o",
                color=line.get_color(), markerfacecolor="white")
        different.append(of.unit)
    all_units = f"[{', '.join(dict.fromkeys(different))}]"
    label = f"{name_of(several[0], 'names')} {all_units}" if len(several) == 1 else all_units
    _style.finished(ax, label, legend=len(several) > 1)
    ax.set_xlabel(f"{traced.measure} [{along.unit}]")
    return ax


def positions(traced: Trace, at: ArrayLike | None = None, ax: Axes | None = None, *, names: bool = False,
              path: Points = ()) -> Axes:
    """Draw a mechanism in several traced positions: the first as it is, the others faintly, with the paths of points.

    Parameters
    ----------
    traced : Trace
        Result of `zerodrift.trace`.
    at : array_like of int, optional
        Numbers of the positions; left out: the first, and eight others along the way.
    ax : Axes, optional
        Left out: a new figure.
    names : bool
        True: label the parts with their names.
    path : str, point or measure, or a sequence of them
        Points whose paths through all traced positions are drawn.

    Returns
    -------
    Axes

    Raises
    ------
    IndexError
        If there are fewer positions.
    KeyError
        If there is no such point.

    Examples
    --------
    >>> import zerodrift as zd
    >>> turn = zd.trace(zd.models.jansen(), "crank.angle")
    >>> ax = zd.plot.positions(turn, path="F")
    """
    checks.instance("traced", traced, Trace, A_TRACE)
    chosen = np.linspace(0, len(traced), OTHERS + 1, endpoint=False).astype(int) if at is None else _places(at, len(traced))
    picture = Picture(drawing_axes(ax, 2), traced.system._sketches([traced.p[place] for place in chosen]),
                      Extras(checks.instance("names", names, bool, "True or False"), paths_of(traced, path)))
    picture.faintly(range(1, len(chosen)))
    picture.show(0)
    return picture.ax


def _places(at: Any, count: int) -> np.ndarray:
    """Numbers of positions."""
    places = np.atleast_1d(checks.real("at must hold", at))
    if places.dtype.kind not in "iu" or places.ndim != 1 or not places.size:
        raise WrongType(f"at must be numbers of positions, not {checks.shown(at)}")
    if places.min() < -count or places.max() >= count:
        raise WrongIndex(f"at must be numbers of {count} positions, not {checks.shown(at)}")
    return places


def _shown(unit: str, degrees: bool) -> units.Shown:
    return units.Shown("°", 180 / np.pi) if degrees and unit == "rad" else units.shown(unit)
