"""Coordinates and velocities by name, and differences between a solution and a reference."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .._private import checks
from .._private.gateway import Variable
from ..errors import WrongType, WrongValue
from ..runs.samples.solution import A_SOLUTION, Solution
from .reference import Reference

__all__ = ["difference", "signals"]

SAME_TIME = 1e-9    # relative to max(|t|, 1 s): far above rounding, far below any step


def __dir__() -> list[str]:
    return __all__      # and not what is imported


def signals(solution: Solution, names: str | Sequence[str] | None = None) -> tuple[np.ndarray, tuple[Variable, ...]]:
    """Coordinates and velocities of a solution by name.

    Parameters
    ----------
    solution : Solution
        Data.
    names : str or sequence of str, optional
        Names of coordinates and velocities; by default all coordinates.

    Returns
    -------
    values : ndarray (k, n)
    variables : tuple of Variable(name, unit)

    Examples
    --------
    >>> import zerodrift as zd
    >>> from zerodrift.studies.compare import signals
    >>> values, variables = signals(zd.simulate(zd.systems.oscillator(), 1.0, step=0.1), "x_dot")
    >>> values.shape, variables[0].unit
    ((11, 1), 'm/s')
    """
    system = checks.instance("sol", solution, Solution, A_SOLUTION).system
    variables = (*system.coordinates, *system.velocities)
    known = [variable.name for variable in variables]
    if names is None:
        names = known[:len(system.coordinates)]
    names = [names] if isinstance(names, str) else names
    checks.instance("names", names, Sequence, "names of coordinates and velocities")
    columns = [known.index(checks.choice("names", name, known)) for name in names]
    return _states(solution)[:, columns], tuple(variables[column] for column in columns)


def difference(solution: Solution, reference: Solution | Reference | Callable[[float], Any],
               names: str | Sequence[str] | None = None) -> np.ndarray:
    """Difference of a solution from a reference, at the times of the solution.

    Parameters
    ----------
    solution : Solution
        Data.
    reference : Reference, Solution or callable
        Result of `zerodrift.reference`, a solution whose times contain those of `solution`, or a function of time that
        returns p (nq,).
    names : str or sequence of str, optional
        Names of coordinates and (if the reference is a Solution) velocities; by default all coordinates.

    Returns
    -------
    ndarray (k, n)

    Raises
    ------
    ValueError
        If the reference lacks a time or a name.

    Examples
    --------
    >>> import zerodrift as zd
    >>> from zerodrift.studies.compare import difference
    >>> bar = zd.systems.four_bar()
    >>> fine, coarse = zd.simulate(bar, 1.0, step=0.001), zd.simulate(bar, 1.0, step=0.01)
    >>> difference(coarse, fine, "alpha1").shape
    (101, 1)
    """
    values, variables = signals(solution, names)
    known = [*solution.system.coordinates, *solution.system.velocities]
    exact = states_of(reference, solution.t, len(solution.system.coordinates))
    columns = [known.index(variable) for variable in variables]
    if max(columns, default=0) >= exact.shape[1]:
        raise WrongValue("a callable reference gives coordinates only; names must be among "
                         + ", ".join(repr(coordinate.name) for coordinate in solution.system.coordinates), "wrong-measure")
    return values - exact[:, columns]


def states_of(reference: Solution | Reference | Callable[[float], Any], times: np.ndarray, nq: int) -> np.ndarray:
    """States of a reference at given times: p and v (k, nq + nv), or p (k, nq) if it is a callable."""
    if isinstance(reference, Reference):
        return _interpolated(reference.solution, times)
    if isinstance(reference, Solution):
        return _states(reference)[_rows_at(reference.t, times)]
    if not callable(reference):
        raise WrongType(f"reference must be a Reference, a Solution or a callable t -> p, not {checks.shown(reference)}")
    return _evaluated(reference, times, nq)


def _interpolated(solution: Solution, times: np.ndarray) -> np.ndarray:
    """States (k, nq + nv) at these times; if every step was saved, also between samples."""
    if "t_eval" in solution.settings:
        return _states(solution)[_rows_at(solution.t, times)]
    states = _states(solution)[nearest(solution.t, times)]
    without_row = _have_no_row(solution.t, times)
    if without_row.any():
        states[without_row] = np.hstack(solution(times[without_row]))
    return states


def _states(solution: Solution) -> np.ndarray:
    return np.hstack([solution.p, solution.v])


def _evaluated(reference: Callable[[float], Any], times: np.ndarray, size: int) -> np.ndarray:
    """Values (k, size) of a callable at given times."""
    exact = np.empty((len(times), size))
    for row, t in zip(exact, times, strict=True):
        value = _say_where(reference, float(t))
        value = np.ravel(checks.real("reference(t) must return", value, f" (at t = {t:g})", objects=True))
        if value.shape != (size,):
            raise WrongValue(f"reference(t) must return p of shape ({size},), not {value.shape}", "shape")
        row[:] = value
    return exact


def _say_where(reference: Callable[[float], Any], t: float) -> Any:
    """Value of a callable at t; an error gets a note with the time."""
    try:
        return reference(t)
    except BaseException as error:
        checks.tell(error, f"in reference, called at t = {t:g}")
        raise


def nearest(times: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Indices of the entries of `times` (ascending) nearest to the wanted times."""
    after = np.searchsorted(times, wanted).clip(max=len(times) - 1)
    before = (after - 1).clip(min=0)
    return np.where(np.abs(times[before] - wanted) < np.abs(times[after] - wanted), before, after)


def _rows_at(times: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Indices of the wanted times in `times`; ValueError if one is missing."""
    if not len(times):
        raise WrongValue("the reference solution must have samples", "not-available")
    missing = _have_no_row(times, wanted)
    if missing.any():
        raise WrongValue(f"the reference has no sample at t = {wanted[missing][0]:g} s; "
                         "its times must contain the solution's", "not-available")
    return nearest(times, wanted)


def _have_no_row(times: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Mask of the wanted times that are not among `times`."""
    return np.abs(times[nearest(times, wanted)] - wanted) > SAME_TIME * np.maximum(1, np.abs(wanted))
