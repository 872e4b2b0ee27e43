"""Loci of vectors: forces of a bearing around its journal."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .._private import checks
from .._private.types import Display, MeasureLike
from ..errors import WrongValue
from ..runs.dense_samples import dense
from ..runs.samples.columns import columns
from ..runs.samples.solution import A_SOLUTION, Solution
from ..units import displayed
from . import style as _style


@displayed
def polar(sol: Solution, name: MeasureLike | tuple[MeasureLike, Any], ax: Axes | None = None, *, plane: str = "xy",
          display: Display | None = None, **style: Any) -> Axes:
    """Draw the tip of a vector from a common origin: the polar diagram of a bearing's load.

    Parameters
    ----------
    sol : Solution
        Data.
    name : str or measure, or (that, body)
        A vector, such as ``"main.force"``; ``("main.force", "crank")`` is in the axes of that body.
    ax : Axes, optional
        Left out: a new figure.
    plane : {"xy", "yz", "zx", ...}
        In space: the components that are drawn to the right and upwards.
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
        If the name is unknown.
    ValueError
        If it is not a vector of these components.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.slider_crank(), 1.0, step=1e-3)
    >>> zd.plot.polar(sol, "main.force", display={"force": "kN"}).get_xlabel()
    'main.force.x [kN]'
    """
    found = columns(dense(checks.instance("sol", sol, Solution, A_SOLUTION)), [name])
    if not 1 < len(found) < 4 or len(plane) != 2 or not {*plane} <= {*"xyz"[:len(found)]}:
        raise WrongValue(f"polar draws two components of a vector, and {checks.shown(name)} has {len(found)}, of which plane is "
                         f"{plane!r}", "wrong-measure")
    (across, x), (up, y) = (found["xyz".index(axis)] for axis in plane)
    ax = _style.axes(ax)
    ax.plot(x, y, **style)
    ax.plot(0, 0, "+", color="0.3", markersize=9)
    ax.plot(x[:1], y[:1], "o", color=ax.lines[-2].get_color(), markersize=4)
    limit = 1.08 * max(float(np.nanmax(np.hypot(x, y))), 1e-300)
    ax.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal", xlabel=_style.labelled(across), ylabel=_style.labelled(up))
    if "label" in style:
        _style.legend_above(ax)
    return ax
