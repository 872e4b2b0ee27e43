"""Axes, lines and labels in one style; `zerodrift.plot` draws with them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.rcsetup import cycler

from .._private import checks
from .._private.gateway import Variable
from ..units import shown

# Okabe and Ito's colours, told apart with any colour vision, dark ones first; the last six are Tol's wine, olive, indigo, teal,
# green and purple. Each integrator has one; the last two are for those to come.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9", "#882255", "#999933", "#332288",
           "#44AA99", "#117733", "#AA4499")


def panels(rows: int, columns: int, width: float = 8.0, height: float = 5.0,
           **options: Any) -> tuple[Figure, np.ndarray]:
    """A figure of its own, outside pyplot, and its axes (rows, columns), in the style of this module.

    Examples
    --------
    >>> import zerodrift as zd
    >>> figure, axes = zd.plot.panels(1, 2)
    >>> ax = zd.plot.motion(zd.simulate(zd.systems.oscillator(), 2.0, step=0.1), ax=axes[0, 0])
    """
    figure = Figure(figsize=(width, height), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, **options)
    for ax in grid.flat:
        styled(ax)
    return figure, grid


def axes(ax: Axes | None) -> Axes:
    """The given axes, or those of a new figure."""
    return styled(plt.subplots(layout="constrained")[1]) if ax is None else given_axes(ax)


def given_axes(ax: Any, name: str = "ax") -> Axes:
    return checks.instance(name, ax, Axes, "matplotlib's Axes, or left out for a new figure")


def styled(ax: Axes) -> Axes:
    ax.set_prop_cycle(cycler(linestyle=["-", "--", ":"]) * cycler(color=COLOURS))     # later lines are dashed
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, alpha=0.3, linewidth=0.6)
    return ax


def time(sol: Any) -> np.ndarray:
    """Times of a solution or an ensemble in the unit of display."""
    return shown("s").factor * sol.t


def finished(ax: Axes, ylabel: str, *, legend: bool = True) -> Axes:
    ax.set_xlabel(f"t [{shown('s').unit}]")
    ax.set_ylabel(ylabel)
    if legend:
        legend_above(ax)
    return ax


def legend_above(ax: Axes) -> None:
    """Legend at the top of the axes; where limits are automatic, they leave room for it, so that it covers no curve."""
    names = ax.get_legend_handles_labels()[1]
    size = plt.rcParams["font.size"]
    width, height = (each * 72 / ax.figure.dpi for each in ax.get_window_extent().size)      # in points, as the size of the font
    columns = max(1, min(len(names), int(width / (0.6 * size * max(map(len, names), default=0) + 4 * size))))
    ax.legend(frameon=False, loc="upper center", ncols=columns)
    if not ax.get_autoscaley_on():
        return
    share = min(0.6, (1.6 * -(-len(names) // columns) + 0.8) * size / height)
    ax.autoscale_view(scalex=False)
    scale = ax.yaxis.get_transform()
    low, high = scale.transform(ax.get_ylim())
    ax.set_ylim(top=float(scale.inverted().transform(low + (high - low) / (1 - share))), auto=None)


def line(ax: Axes, t: np.ndarray, values: np.ndarray, log: bool, **style: Any) -> None:
    if log:
        log_line(ax, t, np.abs(values), **style)
    else:
        ax.plot(t, values, **style)


def log_line(ax: Axes, t: np.ndarray, magnitude: np.ndarray, **style: Any) -> None:
    """A line on a logarithmic scale: zeros as triangles on the lower edge, values between two zeros as dots."""
    ax.set_yscale("log")
    positive = np.isfinite(magnitude) & (magnitude > 0)
    (values,) = ax.plot(t, np.where(positive, magnitude, np.nan), **style)
    has_neighbour = np.concatenate([[False], positive[:-1]]) | np.concatenate([positive[1:], [False]])
    isolated, zero = positive & ~has_neighbour, magnitude == 0
    ax.plot(t[isolated], magnitude[isolated], ".", color=values.get_color(), markersize=3)
    if zero.any():
        ax.plot(t[zero], np.zeros(zero.sum()), "v", transform=ax.get_xaxis_transform(), clip_on=False,
                color=values.get_color(), markersize=4, markeredgewidth=0, zorder=3)
    if not any(np.any(np.asarray(other.get_ydata()) > 0) for other in ax.lines):
        ax.set_ylim(1e-17, 1)


def units(variables: Sequence[Variable]) -> list[str]:
    """The different units, in order of appearance."""
    return list(dict.fromkeys(variable.unit or "1" for variable in variables))


def labelled(variable: Variable, units: int = 2) -> str:
    """Name with the unit, or alone where all have one unit."""
    return f"{variable.name} [{variable.unit}]" if variable.unit and units > 1 else variable.name


def with_unit(symbol: str, variables: Sequence[Variable]) -> str:
    return f"{symbol} [{', '.join(units(variables))}]"


def edges(centres: np.ndarray, *, log: bool) -> np.ndarray:
    """The edges of cells halfway between their centres, geometrically on a logarithmic axis where all centres are positive."""
    forward, inverse = (np.log, np.exp) if log and (centres > 0).all() else (np.asarray, np.asarray)
    if len(centres) == 1:
        return inverse(forward(centres)[0] + np.array([-0.1, 0.1]))
    middle = forward(centres)[:-1] + np.diff(forward(centres)) / 2
    first, last = forward(centres)[[0, -1]] * 2 - middle[[0, -1]]
    return inverse(np.concatenate([[first], middle, [last]]))
