"""Pictures of linearizations: shapes of modes, and eigenvalues in the complex plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .. import units
from .._private import checks
from .._private.types import ArrayLike, Display
from ..analysis.linearization_result import EIGENVALUE_ROUNDING, Linearization
from ..analysis.retraction import onto
from ..errors import WrongValue
from . import style as _style
from .drawing import still_picture

EXTREMES = (0.0, 0.5)      # phases of a period
LOOKS = (("at rest", "black", "-", 1.0), ("one extreme", _style.COLOURS[1], "-", 1.4),
         ("other extreme", _style.COLOURS[0], "--", 1.4))       # label, colour, line and its width
STILL = 0.01        # of the amplitude: a displaced position that covers that of reference


def mode(lin: Linearization, index: int = 0, ax: Axes | None = None, *, amplitude: float = 0.2, **style: Any) -> Axes:
    """Draw the shape of a mode: the position at rest, and as lines the two extremes, half a period apart.

    Parameters
    ----------
    lin : Linearization
    index : int
        Index of the eigenvalue.
    ax : Axes, optional
        Left out: a new figure.
    amplitude : float
        The largest change of a coordinate, in rad or characteristic lengths.
    **style
        For ``ax.plot`` of the lines of the extremes.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If there is no such mode, or the system has no drawing.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.models.four_bar()
    >>> lin = zd.linearize(bar, zd.equilibrium(bar))
    >>> ax = zd.plot.mode(lin, 0)
    """
    checks.instance("lin", lin, Linearization, "what zd.linearize returns")
    count = len(lin.eigenvalues)
    if isinstance(index, bool) or not isinstance(index, int | np.integer) or not 0 <= index < count:
        raise WrongValue(f"index must be that of one of {count} eigenvalues, 0 to {count - 1}, not {checks.shown(index)}",
                         "out-of-range")
    reference = lin.system.points(lin.p)
    if reference is None:
        raise WrongValue(f"{lin.system.name} must have a drawing for its modes to be drawn, and has none", "not-available")
    amplitude = checks.number("amplitude", amplitude, above=0)
    positions = mode_positions(lin, int(index), amplitude, EXTREMES)
    ax = still_picture(lin.system, [lin.p, *positions], ax)
    for i, p in enumerate((lin.p, *positions)):
        label, colour, dashes, width = LOOKS[i]
        points = lin.system.points(p)
        if points is not None and (not i or np.abs(p - lin.p).max() > STILL * amplitude):
            look: dict[str, Any] = {"color": colour, "linestyle": dashes, "linewidth": width, "zorder": 20} | (style if i else {})
            ax.plot(*points.T, label=label, **look)
    _style.legend_above(ax)
    value = lin.eigenvalues[index]
    damping = lin.damping[index] if abs(lin.damping[index]) > EIGENVALUE_ROUNDING else 0.0
    pair = f"{lin.frequencies[index]:.4g} Hz, damping ratio {damping:.3g}"
    ax.set_title(pair if value.imag else f"{value.real:.4g} 1/s")
    return ax


def mode_positions(lin: Linearization, index: int, amplitude: float, phases: Sequence[float]) -> list[np.ndarray]:
    """Positions (nq,) of a mode at phases of its period, on the constraints, without its decay or growth."""
    direction = lin.modes[:lin.system.nq, index]
    if not np.abs(direction).max(initial=0.0):
        return [lin.p for _ in phases]
    direction = direction / direction[np.abs(direction).argmax()]
    moved = [np.real(direction * np.exp(2j * np.pi * phase)) for phase in phases]
    return [onto(lin.system, lin.t, lin.p + amplitude * dp) for dp in moved]


@units.displayed
def root_locus(lins: Sequence[Linearization], values: ArrayLike, ax: Axes | None = None, *, label: str = "",
               display: Display | None = None, **style: Any) -> Axes:
    """Draw the eigenvalues of several linearizations in the complex plane, coloured by a parameter.

    Parameters
    ----------
    lins : sequence of Linearization
    values : array_like (k,)
        The parameter, such as a speed.
    ax : Axes, optional
        Left out: a new figure.
    label : str
        Name and unit of the parameter, for the colour bar, such as "speed [m/s]".
    display : dict of str to str, optional
        Units of the time for the real part, of the angular velocity for the imaginary part, and of the parameter, as of
        `zerodrift.display_units`.
    **style
        For ``ax.scatter``.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If there are not as many values as linearizations.

    Examples
    --------
    >>> import zerodrift as zd
    >>> systems = [zd.systems.oscillator(stiffness=k) for k in (1.0, 2.0)]
    >>> ax = zd.plot.root_locus([zd.linearize(each, (0.0, [0.0], [0.0])) for each in systems], [1.0, 2.0])
    """
    lins = [checks.instance("lins", each, Linearization, "a sequence of what zd.linearize returns") for each in lins]
    values = checks.vector("values", values, len(lins))
    ax, parameter, time, rate = _style.axes(ax), units.shown_label(label), units.shown("s"), units.shown("rad/s")
    points = np.concatenate([each.eigenvalues for each in lins]) if lins else np.zeros(0)
    colours = np.repeat(parameter.factor * values, [len(each.eigenvalues) for each in lins])
    look: dict[str, Any] = {"s": 14.0, "cmap": "viridis"} | style
    drawn = ax.scatter(points.real / time.factor, rate.factor * points.imag, c=colours, **look)
    ax.axvline(0.0, color="0.4", linewidth=0.8)
    ax.set_xlabel(f"real part [1/{time.unit}]")
    ax.set_ylabel(f"imaginary part [{rate.unit}]")
    ax.figure.colorbar(drawn, ax=ax, label=parameter.unit)
    return ax
