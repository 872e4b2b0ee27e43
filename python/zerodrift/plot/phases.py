"""Chart of the phases of a run with contacts, for `zerodrift.plot`."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .._private import checks
from .._private.types import Display
from ..errors import WrongValue
from ..runs.samples.solution import A_SOLUTION, Solution
from ..units import displayed, shown
from . import style as _style

# Colours of bars by state; a contact that is open, and a joint that is released, have a thin line.
COLOURS = {"closed": "#0072B2", "joined": "#0072B2", "sticking": "#0072B2", "sliding": "#E69F00"}
HATCHES = {"sliding": "////"}       # so that no information is in a colour alone
HALF = 0.3              # half the height of a bar, in lanes


@displayed
def phases(sol: Solution, ax: Axes | None = None, *, display: Display | None = None) -> Axes:
    """Draw the states of contacts, stops and joints over time: closed, sticking, sliding or open; and their impacts.

    Each has a lane: a bar while it is closed, joined, sticking or sliding, a thin line while it is open or released, and a
    triangle at each impact.

    Parameters
    ----------
    sol : Solution
        Solution of a mechanism with contacts, stops, latches or dry friction.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If no element of the system switches.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("ball", gravity=(0, -9.81))
    >>> ball = m.particle("ball", 1.0, at=(0, 1))
    >>> floor = m.contact("floor", ball, m.ground.line((0, 0), (1, 0)), restitution=0.5)
    >>> ax = zd.plot.phases(zd.simulate(m, 2.0))
    >>> [label.get_text() for label in ax.get_yticklabels()]
    ['floor']
    """
    found = checks.instance("sol", sol, Solution, A_SOLUTION).phases
    if not found:
        raise WrongValue(f"sol must be of a system with contacts, stops, latches or dry friction, and {sol.system.name} has none",
                         "not-available")
    ax, scale, names = _style.axes(ax), shown("s").factor, list(found[0].state)
    for lane, name in enumerate(names):
        for state, group in itertools.groupby(found, key=lambda phase: phase.state[name]):
            several = list(group)
            start, end = scale * several[0].t0, scale * several[-1].t1
            if state in COLOURS:
                ax.broken_barh([(start, end - start)], (lane - HALF, 2 * HALF), facecolor=COLOURS[state],
                               hatch=HATCHES.get(state), edgecolor="white", linewidth=0.0)
            else:
                ax.plot([start, end], [lane, lane], color="0.6", linewidth=1.0, linestyle="-", solid_capstyle="butt")
    impacts = np.unique(sol.impacts[["t", "name"]])
    ax.plot(scale * impacts["t"], [names.index(name) - HALF for name in impacts["name"]], "v", color="#D55E00", markersize=5,
            markeredgewidth=0, clip_on=False, zorder=3)
    ax.set(yticks=range(len(names)), yticklabels=names, ylim=(len(names) - 0.5, -0.6),
           xlim=(scale * found[0].t0, scale * max(found[-1].t1, found[0].t0 + 1e-300)))
    ax.grid(False, axis="y")
    words = dict.fromkeys(word for phase in found for word in phase.state.values())
    handles = [_handle(word) for word in words]
    if len(impacts):
        handles.append(Line2D([], [], color="#D55E00", marker="v", markersize=5, markeredgewidth=0, linestyle="", label="impact"))
    ax.legend(handles=handles, frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=min(len(handles), 4))
    return _style.finished(ax, "", legend=False)


def _handle(state: str) -> Patch | Line2D:
    """Entry of the legend."""
    if state in COLOURS:
        return Patch(facecolor=COLOURS[state], hatch=HATCHES.get(state), edgecolor="white", linewidth=0.0, label=state)
    return Line2D([], [], color="0.6", linewidth=1.0, label=state)
