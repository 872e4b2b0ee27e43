"""Pictures of studies: error over time of many settings, and maps of stability, for `zerodrift.plot`."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.lines import Line2D

from .. import units
from .._private import checks
from .._private.types import Display
from ..errors import WrongValue
from ..runs.arguments import methods
from ..runs.arguments.methods import Projection
from ..studies.stability_map import StabilityMap
from ..studies.work_precision import Row, Setting, WorkPrecision
from . import style as _style
from .style import COLOURS

MARKERS = "os^Dv<>pPX*"
LARGEST_ERROR = 1e30        # larger ones are not drawn, as no scale shows them beside the others


@units.displayed
def work_precision(result: WorkPrecision, ax: Axes | None = None, *, display: Display | None = None) -> Axes:
    """Draw error over time, on logarithmic scales: one line per method, and the Pareto front.

    Each integrator has a colour of its own in all such pictures, and is dashed with adaptive steps; the marker is that of the
    formulation and the corrections. Failed runs and those with an error of 1e30 or more are omitted; below the dotted line,
    errors are those of the reference.

    Parameters
    ----------
    result : WorkPrecision
        Result of `zerodrift.work_precision`.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    display : dict of str to str, optional
        Unit of the time, as in `zerodrift.display_units`; left out: that of the session, otherwise ms.

    Returns
    -------
    Axes

    Examples
    --------
    >>> import zerodrift as zd
    >>> ax = zd.plot.work_precision(zd.work_precision(zd.systems.pendulum(), 1.0, integrators=["rk4", "dop853"], rounds=1))
    >>> ax.get_xlabel()
    'time [ms]'
    """
    checks.instance("result", result, WorkPrecision, "what zd.work_precision returns")
    ax = _style.axes(ax)
    of = units.shown("s") if "time" in units.chosen() else units.Shown("ms", 1e3)
    ax.set(xscale="log", yscale="log", xlabel=f"time [{of.unit}]", ylabel="max |p - reference|")
    done = [row for row in result.rows if row.success and 0 < row.error < LARGEST_ERROR]
    measured = {row.setting.integrator for row in result.rows}
    integrators = {name: colour for name, colour in _assign(methods.integrators(), COLOURS).items() if name in measured}
    variants = _assign((_variant(row.setting) for row in result.rows), MARKERS)
    for _, rows in itertools.groupby(done, key=lambda row: row.setting.method):
        times, errors, first, *_ = _curve(rows, of.factor)
        ax.plot(times, errors, "--" if first.tolerance else "-", color=integrators[first.integrator], linewidth=1, alpha=0.6,
                marker=variants[_variant(first)], markersize=4)
    times, errors, *_ = _curve((row for row in result.pareto() if row.error > 0), of.factor)
    ax.plot(times, errors, color="#F0E442", linewidth=8, zorder=0, solid_capstyle="round")
    if result.reference_error > 0:
        ax.axhline(result.reference_error, color="grey", linestyle=":", linewidth=1)
    handles = [Line2D([], [], color=colour, label=name) for name, colour in integrators.items()]
    handles += [Line2D([], [], color="grey", marker=marker, linestyle="", label=name) for name, marker in variants.items()]
    handles += [Line2D([], [], color="#F0E442", linewidth=8, label="Pareto front"),
                Line2D([], [], color="grey", linestyle="--", label="steps chosen by error"),
                Line2D([], [], color="grey", linestyle=":", label="error of the reference")]
    ax.legend(handles=handles, frameon=False, fontsize="small", loc="center left", bbox_to_anchor=(1, 0.5))
    return ax


@units.displayed
def stability_map(result: StabilityMap, axes: Sequence[Axes] | None = None, *, display: Display | None = None) -> np.ndarray:
    """Draw the errors of all runs over step and parameter, one panel per method.

    Runs that did not reach their end are crossed out; errors above 1 have the colour of 1.

    Parameters
    ----------
    result : StabilityMap
        Result of `zerodrift.stability_map`.
    axes : sequence of Axes, optional
        One per method, of one figure; left out: a new figure.
    display : dict of str to str, optional
        Units of the step, and of a parameter whose name ends with its unit, as "mass [kg]"; as in `zerodrift.display_units`.

    Returns
    -------
    ndarray of Axes

    Examples
    --------
    >>> import zerodrift as zd
    >>> found = zd.stability_map(zd.systems.four_bar(), 1.0, steps=[0.01, 0.02], values=[1.0, 10.0, 100.0])
    >>> [ax.get_title() for ax in zd.plot.stability_map(found)]
    ['nothing', 'Baumgarte', 'projection', 'projection, energy']
    """
    checks.instance("result", result, StabilityMap, "what zd.stability_map returns")
    given: Any = axes
    if given is None:
        count = len(result.rows)
        given = plt.subplots(1, count, figsize=(2.7 * count + 1, 3.4), sharey=True, layout="constrained")[1]
    several = np.atleast_1d(given)
    if len(several) != len(result.rows):
        raise WrongValue(f"axes must be {len(result.rows)}, one for each way, not {len(several)}", "shape")
    for ax in several:
        _style.given_axes(ax, "each of axes")
    least = max(result.reference_error, 1e-12)
    scale, step, parameter = LogNorm(least, 1, clip=True), units.shown_label("step [s]"), units.shown_label(result.parameter)
    for ax, way in zip(several, result.rows, strict=True):
        errors = np.maximum(result.error(way), least)
        drawn = _draw_cells(ax, step.factor * result.steps, parameter.factor * result.values, errors, scale)
        ax.set(title=way, xlabel=step.unit)
    several[0].set_ylabel(parameter.unit)
    several[0].figure.colorbar(drawn, ax=list(several), label="max |p - reference|")
    return several


def _draw_cells(ax: Axes, x: np.ndarray, y: np.ndarray, values: np.ndarray, scale: LogNorm) -> Any:
    """Cells around (x, y) on logarithmic scales, crossed out where there is no value."""
    ax.set_xscale("log")
    ax.set_yscale("log" if (y > 0).all() else "linear")
    ax.set_facecolor("#E8E8E8")
    drawn = np.ma.masked_invalid(values)
    cells = ax.pcolormesh(_style.edges(x, log=True), _style.edges(y, log=True), drawn, norm=scale, cmap="viridis_r")
    row, column = np.nonzero(np.isnan(values))
    ax.plot(x[column], y[row], "x", color="#B22222", markersize=3, markeredgewidth=0.8)
    return cells


def _curve(rows: Iterable[Row], factor: float) -> tuple[Any, ...]:
    """Times in units of display, errors, and the settings of each row."""
    rows = list(rows)
    return [factor * row.seconds for row in rows], [row.error for row in rows], *(row.setting for row in rows)


def _variant(setting: Setting) -> str:
    """Formulation and corrections, in words; projection is not mentioned, as it is the default."""
    other = setting.stabilization != Projection()
    return setting.formulation + (f", {setting.stabilization}" if other else "") + (", energy" if setting.energy else "")


def _assign(names: Iterable[str], to: Sequence[str]) -> dict[str, str]:
    """Colours or markers by name, in order of appearance."""
    return dict(zip(dict.fromkeys(names), itertools.cycle(to), strict=False))
