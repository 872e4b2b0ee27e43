"""Pictures of ensembles: spread of outputs over time, and results over parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .. import units
from .._private import checks
from .._private.gateway import Variable
from .._private.types import ArrayLike, Display, MeasureLike
from ..ensembles.result import Ensemble
from ..errors import WrongValue
from . import style as _style

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
AN_ENSEMBLE = "what zd.ensemble returns"
CROSS: dict[str, Any] = {"color": "#B22222", "markersize": 3, "markeredgewidth": 0.8}      # of runs that failed


@units.displayed
def bands(ens: Ensemble, name: MeasureLike, quantiles: Sequence[float] = QUANTILES, ax: Axes | None = None, *,
          display: Display | None = None, **style: Any) -> Axes:
    """Draw the spread of an output over time: areas between quantiles of all runs, and a line at the middle one.

    Runs count as long as they have samples.

    Parameters
    ----------
    ens : Ensemble
        Runs to draw, with common times.
    name : str or measure
        A scalar output, or a component of one, such as ``"C.force.x"``.
    quantiles : sequence of float
        Between 0 and 1, increasing: areas lie between the first and the last, the second and the last but one, and so on; if
        their number is odd, the middle one is a line.
    ax : Axes, optional
        Left out: a new figure.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        For ``ax.plot`` of the line; ``color`` is that of the areas, too, and ``label`` names all of them.

    Returns
    -------
    Axes

    Raises
    ------
    KeyError
        If no output of that name was kept.
    ValueError
        If runs have times of their own, or the output is a vector.

    Examples
    --------
    >>> import numpy as np, zerodrift as zd
    >>> ens = zd.ensemble(zd.systems.pendulum(), 2.0, parameters={"gravity": np.linspace(9, 10, 20)}, step=0.01)
    >>> zd.plot.bands(ens, "x").get_ylabel()
    'x [m]'
    """
    values, variable = _output(ens, name)
    if ens.t is None:
        raise WrongValue("bands are over times that all runs have, and these have their own: t_eval gives them the same",
                         "not-available")
    levels = np.array([checks.number("quantiles", level, least=0) for level in quantiles])
    if not len(levels) or levels[-1] > 1 or (np.diff(levels) <= 0).any():
        raise WrongValue(f"quantiles must increase, between 0 and 1, not {checks.shown(quantiles)}", "not-increasing")
    some = np.isfinite(values).any(axis=0)
    found = np.full((len(levels), len(ens.t)), np.nan)
    found[:, some] = np.nanquantile(values[:, some], levels, axis=0)
    ax = _style.axes(ax)
    color = style.pop("color", None) or ax._get_lines.get_next_color()        # type: ignore[attr-defined]
    pairs, has_line = len(levels) // 2, len(levels) % 2
    labels: list[str | None] = [f"{100 * levels[i]:.3g} ... {100 * levels[-1 - i]:.3g} %" for i in range(pairs)]
    if "label" in style:        # which stands for all of it
        labels = [None if has_line or i else style["label"] for i in range(pairs)]
    for i, label in enumerate(labels):
        ax.fill_between(_style.time(ens), found[i], found[-1 - i], color=color, alpha=0.5 * (i + 1) / (pairs + 1) + 0.05,
                        linewidth=0, label=label)
    if has_line:
        ax.plot(_style.time(ens), found[pairs], **{"color": color, "label": _level(levels[pairs])} | style)
    return _style.finished(ax, _style.labelled(variable))


@units.displayed
def against(ens: Ensemble, parameter: str, of: MeasureLike | ArrayLike | None = None, ax: Axes | None = None, *,
            at: float | None = None, color_by: str | None = None, display: Display | None = None, **style: Any) -> Axes:
    """Draw a result of each run against one of its parameters; runs that failed are crosses on the lower edge.

    Parameters
    ----------
    ens : Ensemble
        Runs to draw.
    parameter : str
        A scalar one.
    of : str, measure or array_like (n,), optional
        An output, or a number of each run. Left out: what `reduce` returned.
    ax : Axes, optional
        Left out: a new figure.
    at : float, optional
        The time in s at which an output is taken; left out: the last row of each run.
    color_by : str, optional
        Another parameter, which colours the points.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        For ``ax.scatter``; ``label`` names a number of each run on the axis.

    Returns
    -------
    Axes

    Examples
    --------
    >>> import numpy as np, zerodrift as zd
    >>> ens = zd.ensemble(zd.systems.pendulum(), 2.0, parameters={"gravity": np.linspace(9, 10, 20)}, step=0.01)
    >>> ax = zd.plot.against(ens, "gravity", "y", at=0.5)
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('gravity [m/s^2]', 'y [m] at t = 0.5 s')
    """
    values, label = _numbers(ens, of, at, style)
    x = _parameter(ens, parameter)
    colors: dict[str, Any] = {} if color_by is None else {"c": _parameter(ens, color_by), "cmap": "viridis"}
    ax = _style.axes(ax)
    there = np.isfinite(values)
    colors |= {"c": colors["c"][there]} if colors else {"color": _style.COLOURS[0]}
    drawn = ax.scatter(x[there], values[there], **{"s": 12} | colors | style)
    if not there.all():
        ax.plot(x[~there], np.zeros((~there).sum()), "x", transform=ax.get_xaxis_transform(), clip_on=False, **CROSS)
    if color_by is not None:
        ax.figure.colorbar(drawn, ax=ax, label=_labelled(ens, color_by))
    ax.set(xlabel=_labelled(ens, parameter), ylabel=label)
    return ax


@units.displayed
def heat_map(ens: Ensemble, of: MeasureLike | ArrayLike | None = None, ax: Axes | None = None, *, at: float | None = None,
             display: Display | None = None, **style: Any) -> Axes:
    """Draw a result of each run over a grid of two parameters, as colours; runs that failed are crossed out.

    Parameters
    ----------
    ens : Ensemble
        Over ``zd.grid`` of two scalar parameters: the first is drawn to the right, the second upwards.
    of : str, measure or array_like (n,), optional
        An output, or a number of each run. Left out: what `reduce` returned.
    ax : Axes, optional
        Left out: a new figure.
    at : float, optional
        The time in s at which an output is taken; left out: the last row of each run.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        For ``ax.pcolormesh``; ``label`` names a number of each run beside the colours.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If the ensemble is not over such a grid.

    Examples
    --------
    >>> import zerodrift as zd
    >>> grid = zd.grid(mass=[1.0, 2.0, 3.0], stiffness=[10.0, 20.0])
    >>> ens = zd.ensemble(zd.systems.oscillator(), 2.0, parameters=grid, step=0.01, reduce=lambda sol: sol["x"].max())
    >>> ax = zd.plot.heat_map(ens, label="largest x [m]")
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('mass [kg]', 'stiffness [N/m]')
    """
    values, label = _numbers(ens, of, at, style)
    if len(ens.shape) != 2 or len(ens.parameters) != 2:
        raise WrongValue("a heat map is over zd.grid(...) of two parameters, and this ensemble is over "
                         f"{' x '.join(map(str, ens.shape))} runs of {len(ens.parameters)}: against() draws it", "not-available")
    names = list(ens.parameters)
    x, y = _parameter(ens, names[0]).reshape(ens.shape)[:, 0], _parameter(ens, names[1]).reshape(ens.shape)[0]
    columns, rows = np.argsort(x), np.argsort(y)
    cells = values.reshape(ens.shape)[np.ix_(columns, rows)].T
    ax = _style.axes(ax)
    ax.grid(False)
    ax.set_facecolor("#E8E8E8")
    edges = (_style.edges(centres, log=False) for centres in (x[columns], y[rows]))
    drawn = ax.pcolormesh(*edges, np.ma.masked_invalid(cells), **{"cmap": "viridis"} | style)
    row, column = np.nonzero(np.isnan(cells))
    ax.plot(x[columns][column], y[rows][row], "x", **CROSS)
    ax.figure.colorbar(drawn, ax=ax, label=label)
    ax.set(xlabel=_labelled(ens, names[0]), ylabel=_labelled(ens, names[1]))
    return ax


# ---- what is drawn ----


def _output(ens: Any, name: Any) -> tuple[Any, Variable]:
    """A scalar output of all runs, and its name with its unit."""
    checks.instance("ens", ens, Ensemble, AN_ENSEMBLE)
    values, name = ens[name], getattr(name, "name", name)
    if (values.ndim if ens.t is not None else values[0].ndim + 1) != 2:
        raise WrongValue(f"{name} is a vector, and only one of its components can be drawn: {name + '.x'!r}", "wrong-measure")
    of = units.shown(ens.units.get(name) or ens.units.get(name.rpartition(".")[0], ""))
    shown = values if of.factor == 1 else values * of.factor if ens.t is not None else [each * of.factor for each in values]
    return shown, Variable(name, of.unit)


def _numbers(ens: Any, of: Any, at: float | None, style: dict[str, Any]) -> tuple[np.ndarray, str]:
    """Number of each run, NaN if missing, and its label, which is removed from the style."""
    checks.instance("ens", ens, Ensemble, AN_ENSEMBLE)
    label = style.pop("label", "")
    if isinstance(of, str) or hasattr(of, "name"):
        values, variable = _output(ens, of)
        found = _at(ens, values, at)
        return found, label or _style.labelled(variable) + (" at the end" if at is None else _at_time(at))
    found = ens.values if of is None else checks.real("of must hold", of)
    if not isinstance(found, np.ndarray) or found.shape != (len(ens),):
        given = f"what reduce returned, {checks.shown(ens.values)}," if of is None else f"of, {checks.shown(of)},"
        raise WrongValue(f"{given} must be a number for each of {len(ens)} runs; or name an output", "shape")
    return found.astype(float), label


def _at(ens: Any, values: Any, at: float | None) -> np.ndarray:
    """Output at a time common to all runs, or in the last sample of each completed run."""
    if at is not None:
        if ens.t is None or not (here := np.flatnonzero(np.isclose(ens.t, at, rtol=1e-9, atol=0))).size:
            raise WrongValue(f"at must be one of the times that all runs have, not {checks.number('at', at):g}", "out-of-range")
        return values[:, here[0]]
    last = [each[np.isfinite(each)][-1:] for each in values]
    return np.array([each[0] if each.size and not failed else np.nan for each, failed in zip(last, ens.failed, strict=True)])


def _parameter(ens: Any, name: str) -> np.ndarray:
    values = ens.parameters[checks.choice("parameter", name, ens.parameters)]
    if values.ndim != 1:
        raise WrongValue(f"parameter {name!r} has several entries in each run, and only scalars can be drawn", "wrong-measure")
    return values * units.shown(ens.units.get(name, "")).factor


def _labelled(ens: Any, name: str) -> str:
    return _style.labelled(Variable(name, units.shown(ens.units.get(name, "")).unit))


def _at_time(at: float) -> str:
    of = units.shown("s")
    return f" at t = {at * of.factor:g} {of.unit}"


def _level(level: float) -> str:
    return "median" if level == 0.5 else f"{100 * level:.3g} %"
