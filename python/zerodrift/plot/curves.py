"""Curves of solutions over time, for `zerodrift.plot`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .. import units
from .._private import checks
from .._private.gateway import Variable
from .._private.types import Display, Names
from ..errors import WrongValue
from ..runs.dense_samples import dense
from ..runs.samples.columns import columns, in_display
from ..runs.samples.solution import A_SOLUTION, Solution
from ..studies.compare import difference, signals
from ..studies.reference import Reference
from . import style as _style

APART = 100.0           # ratio of the energy violations of runs from which their axis is logarithmic


@units.displayed
def motion(sol: Solution, names: str | Sequence[str] | None = None, ax: Axes | None = None, *, display: Display | None = None,
           **style: Any) -> Axes:
    """Draw coordinates and velocities over time.

    Parameters
    ----------
    sol : Solution
        Data.
    names : str or sequence of str, optional
        Names of coordinates and velocities; by default all coordinates.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        Further arguments of ``ax.plot``.

    Returns
    -------
    Axes

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.systems.four_bar(), 2.0, step=0.01)
    >>> ax = zd.plot.motion(sol, ["alpha1", "alpha2"])
    >>> ax.get_ylabel()
    'rad'
    """
    sol = _with_samples_of_lines(checks.instance("sol", sol, Solution, A_SOLUTION), style)
    values, variables = signals(sol, names)
    return _drawn(sol, [in_display(*variable, column) for variable, column in zip(variables, values.T, strict=True)], ax,
                  style)


def _drawn(sol: Solution, found: list[tuple[Variable, np.ndarray]], ax: Axes | None, style: dict[str, Any]) -> Axes:
    """Lines over time, in units of display."""
    ax, t = _style.axes(ax), _style.time(sol)
    variables = [variable for variable, _ in found]
    different = _style.units(variables)
    for variable, values in found:
        ax.plot(t, values, **{"label": _style.labelled(variable, len(different))} | style)
    if len(found) == 1 and "label" not in style:
        return _style.finished(ax, _style.labelled(variables[0]), legend=False)
    return _style.finished(ax, ", ".join(different))


def _with_samples_of_lines(sol: Solution, style: dict[str, Any]) -> Solution:
    """The samples between which lines are drawn; markers are at those of the solution."""
    return sol if style.get("marker") else dense(sol)


@units.displayed
def measures(sol: Solution, names: Names, ax: Axes | None = None, *, display: Display | None = None, **style: Any) -> Axes:
    """Draw measures, coordinates, velocities or multipliers over time, a line for each component; reactions, for example.

    Parameters
    ----------
    sol : Solution
        Data.
    names : str, measure, or sequence of these
        As in ``sol[name]``: ``["pin.force", crank.angle]``; ``[("pin.force", "crank")]`` is a vector in the axes of a body.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        Further arguments of ``ax.plot``.

    Returns
    -------
    Axes

    Raises
    ------
    KeyError
        If a name is unknown.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.slider_crank(), 1.0, step=0.01)
    >>> ax = zd.plot.measures(sol, ["main.force", "crank.angle"])
    >>> ax.get_ylabel()
    'N, rad'
    """
    sol = _with_samples_of_lines(checks.instance("sol", sol, Solution, A_SOLUTION), style)
    return _drawn(sol, columns(sol, names), ax, style)


@units.displayed
def violation(sol: Solution, ax: Axes | None = None, *, positions: bool = True, velocities: bool = True,
              display: Display | None = None, **style: Any) -> Axes:
    """Draw the largest position and velocity violation over time, on a logarithmic scale.

    Exact zeros, which a logarithmic scale cannot show, are triangles at its lower edge.

    Parameters
    ----------
    sol : Solution
        Data.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    positions, velocities : bool
        Violations to draw.
    display : dict of str to str, optional
        Units of the time by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        Further arguments of ``ax.plot``.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If the system has no constraints of the requested kind.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.systems.four_bar(), 2.0, step=0.01, stabilization="baumgarte")
    >>> zd.plot.violation(sol).get_yscale()
    'log'
    """
    checks.instance("sol", sol, Solution, A_SOLUTION)
    constraints, mh = sol.system.constraints, sol.position_violation.shape[1]
    rates = [Variable(c.name, f"{c.unit}/s" if c.unit else "1/s") for c in constraints[:mh]] + list(constraints[mh:])
    lines = []
    if positions and mh:
        lines.append((sol.position_violation, _style.with_unit("position violation |Φ|", constraints[:mh])))
    if velocities and constraints:
        lines.append((sol.velocity_violation, _style.with_unit("velocity violation |Ψ|", rates)))
    if not lines:
        raise WrongValue(f"the system must have these constraints, of which {sol.system.name} has none", "not-available")
    ax = _style.axes(ax)
    for values, label in lines:
        _style.log_line(ax, _style.time(sol), np.abs(values).max(axis=1), **{"label": label} | style)
    several = len(lines) > 1
    return _style.finished(ax, "constraint violation" if several else lines[0][1], legend=several or "label" in style)


@units.displayed
def energy(sol: Solution, ax: Axes | None = None, *, display: Display | None = None) -> Axes:
    """Draw kinetic and potential energy, their sum, and the energy input, if any.

    Parameters
    ----------
    sol : Solution
        Data.
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
        If the system declares no potential.

    Examples
    --------
    >>> import zerodrift as zd
    >>> ax = zd.plot.energy(zd.simulate(zd.systems.four_bar(), 2.0, step=0.01))
    >>> [line.get_label() for line in ax.lines]
    ['T', 'V', 'E = T + V']
    """
    potential, put_in, _ = _energies(sol)
    ax, t, of = _style.axes(ax), _style.time(sol), units.shown("J")
    ax.plot(t, of.factor * sol.kinetic_energy, label="T")
    ax.plot(t, of.factor * potential, label="V")
    ax.plot(t, of.factor * (sol.kinetic_energy + potential), label="E = T + V")
    if put_in.any():
        ax.plot(t, of.factor * put_in, "--", label="energy input")
    return _style.finished(ax, f"energy [{of.unit}]")


@units.displayed
def energy_violation(sol: Solution | Sequence[Solution], ax: Axes | None = None, *, log: bool | None = None,
                     display: Display | None = None, **style: Any) -> Axes:
    """Draw the violation of the energy balance, (28), over time, of one run or of several.

    Parameters
    ----------
    sol : Solution, or sequence of these
        Data. Several are named by their integrators.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    log : bool, optional
        True: draw its magnitude on a logarithmic scale, exact zeros as triangles on the lower edge. Left out: True if the
        largest magnitudes of several runs differ by more than a factor of 100.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        For ``ax.plot``; a label adds a legend.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If the system declares no potential.

    Examples
    --------
    >>> import zerodrift as zd
    >>> ax = zd.plot.energy_violation(zd.simulate(zd.systems.oscillator(), 2.0, step=0.1))
    >>> ax.get_ylabel()
    'energy violation [J]'
    """
    several: list[Any] = list(sol) if isinstance(sol, list | tuple) else [sol]
    values = [_energies(each)[2] for each in several]
    sizes = [float(np.abs(each).max(initial=0.0)) for each in values]
    if log is None:
        log = len(several) > 1 and max(sizes) > APART * min(sizes)
    ax, of = _style.axes(ax), units.shown("J")
    for each, violation in zip(several, values, strict=True):
        label = {"label": str(each.settings["integrator"])} if len(several) > 1 else {}
        _style.line(ax, _style.time(each), of.factor * violation, log, **label | style)
    has_legend = len(several) > 1 or "label" in style
    return _style.finished(ax, f"{'|energy violation|' if log else 'energy violation'} [{of.unit}]", legend=has_legend)


@units.displayed
def error(sol: Solution, reference: Solution | Reference | Callable[[float], Any],
          names: str | Sequence[str] | None = None, ax: Axes | None = None, *, log: bool = False,
          display: Display | None = None, **style: Any) -> Axes:
    """Draw solution minus reference over time.

    Parameters
    ----------
    sol : Solution
        Data.
    reference : Reference, Solution or callable
        Result of `zerodrift.reference`, a solution whose times contain those of `sol`, or a function of the time that returns p
        (nq,).
    names : str or sequence of str, optional
        Names of coordinates and (with a Solution as reference) velocities; left out: all coordinates.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    log : bool
        True: draw magnitudes on a logarithmic scale, exact zeros as triangles on the lower edge.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **style
        Further arguments of ``ax.plot``.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If the reference does not have the times or the names.

    Examples
    --------
    >>> import numpy as np, zerodrift as zd
    >>> sol = zd.simulate(zd.systems.oscillator(mass=1.0, stiffness=4.0, x0=0.1), 2.0, step=0.1)
    >>> ax = zd.plot.error(sol, lambda t: 0.1 * np.cos(2 * t))
    >>> ax.get_ylabel()
    'error of x [m]'
    """
    values, of = difference(sol, reference, names), signals(sol, names)[1]
    found = [in_display(*variable, column) for variable, column in zip(of, values.T, strict=True)]
    ax, t, variables = _style.axes(ax), _style.time(sol), [variable for variable, _ in found]
    different = _style.units(variables)
    for variable, column in found:
        _style.line(ax, t, column, log, **{"label": _style.labelled(variable, len(different))} | style)
    subject = f" of {_style.labelled(variables[0])}" if len(variables) == 1 else f" [{', '.join(different)}]"
    return _style.finished(ax, ("|error|" if log else "error") + subject, legend=len(variables) > 1 or "label" in style)


def _energies(sol: Solution) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Potential energy, energy input and energy violation of a solution that has them."""
    checks.instance("sol", sol, Solution, A_SOLUTION)
    potential, put_in, violation = sol.potential_energy, sol.energy_input, sol.energy_violation
    if potential is None or put_in is None or violation is None:
        raise WrongValue(f"{sol.system.name} must declare a potential energy for its energy balance to be drawn", "not-available")
    return potential, put_in, violation
