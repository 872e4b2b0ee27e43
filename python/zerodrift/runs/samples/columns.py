"""Columns of a solution with names and units: for files of other programs, and for plots."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ... import units
from ..._private.gateway import Variable
from ..._private.types import Display, Names
from ..._private.writing import write_atomically
from ...errors import MissingPackage
from ...systems.measure_values import component_names
from ...units import displayed


def columns(solution: Any, names: Any = None) -> list[tuple[Variable, np.ndarray]]:
    """Columns by name in units of display, a component each; left out: coordinates, velocities and multipliers.

    A multiplier of an element, whose effort has the opposite sign, is "multiplier of" its name.

    Raises
    ------
    KeyError
        If nothing has a name.
    """
    if names is None:
        return [in_display(f"multiplier of {name}" if solution.system._effort_of(name) else name, unit, array[:, i])
                for array, variables in solution._named() for i, (name, unit) in enumerate(variables)]
    several: Any = [names] if isinstance(names, str) or not isinstance(names, Sequence) else names
    return [column for name in several for column in _components(solution, name)]


def _components(solution: Any, given: Any) -> list[tuple[Variable, np.ndarray]]:
    is_pair = isinstance(given, tuple) and len(given) == 2
    name, *body = (getattr(each, "name", each) for each in (given if is_pair else (given,)))
    values, unit = np.asarray(solution[given], dtype=float), unit_of(solution, name)
    entries, named = values.reshape(len(values), -1), component_names(name, values.shape[1:])
    return [in_display(f"{each} in {body[0]}" if body else each, unit, entries[:, i]) for i, each in enumerate(named)]


def in_display(name: str, unit: str, values: np.ndarray) -> tuple[Variable, np.ndarray]:
    """Values in an SI unit in that of display, with name and unit."""
    chosen = units.shown(unit)
    return Variable(name, chosen.unit), values if chosen.unit == unit else values * chosen.factor


def unit_of(solution: Any, name: str) -> str:
    """The unit of a coordinate, a velocity, a multiplier or a measure; "" where it has none."""
    for _, variables in solution._named():
        for variable in variables:
            if variable.name == name:
                return variable.unit
    return solution.system._unit_of_measure(name)


@displayed
def to_csv(self: Any, path: str | Path, names: Names | None = None, *,
           display: Display | None = None) -> Path:
    """Write columns to a CSV file: the time and the named quantities, one column for each component, with names and units
    in the first line.

    Parameters
    ----------
    path : str or Path
    names : str, measure, or sequence of these, optional
        Coordinates, velocities, constraints and measures, as in ``sol[name]``. Left out: all coordinates, velocities and
        multipliers. The multiplier of a drive or coupling is named so, as its force has the opposite sign.
    display : dict of str to str, optional
        Units by quantity, such as ``{"force": "kN", "angle": "deg"}``, as in `zerodrift.display_units`; left out: those of the
        session.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    KeyError
        If nothing has a name.

    Examples
    --------
    >>> import tempfile, zerodrift as zd
    >>> sol = zd.simulate(zd.models.slider_crank(), 0.1, step=0.01)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = sol.to_csv(folder + "/crank.csv", ["crank.angle", "slide.force"])
    ...     path.read_text().splitlines()[0]
    't [s],crank.angle [rad],slide.force.x [N],slide.force.y [N]'
    """
    path = Path(path)
    heading, values = _table(self, names)

    def write(file: Any) -> None:
        file.write((",".join(f'"{each}"' if "," in each else each for each in heading) + "\n").encode())
        file.writelines((",".join(map(repr, row)) + "\n").encode() for row in values.tolist())

    write_atomically(path, write)
    return path


@displayed
def to_excel(self: Any, path: str | Path, names: Names | None = None, *,
             display: Display | None = None) -> Path:
    """Write the same to an Excel file; pandas and openpyxl must be installed: ``pip install 'zerodrift[excel]'``.

    Parameters
    ----------
    path : str or Path
    names : str, measure, or sequence of these, optional
    display : dict of str to str, optional
        As in `to_csv`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ImportError
        If one of these packages is missing.
    KeyError
        If nothing has a name.
    """
    pandas, _ = (imported(name, "to_excel", "excel") for name in ("pandas", "openpyxl"))
    path = Path(path)
    heading, values = _table(self, names)
    write_atomically(path, lambda file: pandas.DataFrame(values, columns=heading).to_excel(file, index=False, engine="openpyxl"))
    return path


@displayed
def to_frame(self: Any, names: Names | None = None, *, display: Display | None = None) -> Any:
    """Return the same as a pandas DataFrame, whose index is the time: ``pip install 'zerodrift[excel]'``.

    Parameters
    ----------
    names : str, measure, or sequence of these, optional
    display : dict of str to str, optional
        As in `to_csv`.

    Returns
    -------
    pandas.DataFrame

    Raises
    ------
    ImportError
        If pandas is missing.
    KeyError
        If nothing has a name.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.slider_crank(), 0.1, step=0.01)
    >>> list(sol.to_frame("crank.angle", display={"angle": "deg", "time": "ms"}))       # doctest: +SKIP
    ['crank.angle [deg]']
    """
    pandas = imported("pandas", "to_frame", "excel")
    (time, *heading), values = _table(self, names)
    return pandas.DataFrame(values[:, 1:], columns=heading, index=pandas.Index(values[:, 0], name=time))


def imported(name: str, method: str, extra: str) -> Any:
    """A package that a method needs, one of an extra of this package."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise MissingPackage(f"{method} needs {name}, which is not installed: pip install 'zerodrift[{extra}]'") from None


def _table(solution: Any, names: Any) -> tuple[list[str], np.ndarray]:
    found = [in_display("t", "s", solution.t), *columns(solution, names)]
    return [f"{variable.name} [{variable.unit}]" if variable.unit else variable.name for variable, _ in found], np.column_stack(
        [column for _, column in found])
