"""Columns of a solution with names and units: for files of other programs, and for plots."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..._private.gateway import Variable
from ..._private.types import Names
from ..._private.writing import write_atomically
from ...errors import MissingPackage
from ...systems.measure_values import component_names


def columns(solution: Any, names: Any = None) -> list[tuple[Variable, np.ndarray]]:
    """Coordinates, velocities, multipliers and measures by name, a component each; left out: all but measures.

    A multiplier of an element, whose effort has the opposite sign, is "multiplier of" its name.

    Raises
    ------
    KeyError
        If nothing has a name.
    """
    if names is None:
        return [(Variable(f"multiplier of {name}" if solution.system._effort_of(name) else name, unit), array[:, i])
                for array, variables in solution._named() for i, (name, unit) in enumerate(variables)]
    several: Any = [names] if isinstance(names, str) or not isinstance(names, Sequence) else names
    return [column for name in several for column in _components(solution, getattr(name, "name", name))]


def _components(solution: Any, name: str) -> list[tuple[Variable, np.ndarray]]:
    values, unit = np.asarray(solution[name], dtype=float), unit_of(solution, name)
    entries = values.reshape(len(values), -1)
    return [(Variable(each, unit), entries[:, i]) for i, each in enumerate(component_names(name, values.shape[1:]))]


def unit_of(solution: Any, name: str) -> str:
    """The unit of a coordinate, a velocity, a multiplier or a measure; "" where it has none."""
    for _, variables in solution._named():
        for variable in variables:
            if variable.name == name:
                return variable.unit
    return solution.system._unit_of_measure(name)


def to_csv(self: Any, path: str | Path, names: Names | None = None) -> Path:
    """Write columns to a CSV file: the time, and what is named, a component each, with names and units in the first line.

    Parameters
    ----------
    path : str or Path
    names : str, measure, or sequence of these, optional
        Coordinates, velocities, constraints and measures, as in ``sol[name]``. Left out: all coordinates, velocities and
        multipliers. The multiplier of a drive or coupling is named so, as its force has the opposite sign.

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


def to_excel(self: Any, path: str | Path, names: Names | None = None) -> Path:
    """Write the same to an Excel file; pandas and openpyxl have to be installed: ``pip install 'zerodrift[excel]'``.

    Parameters
    ----------
    path : str or Path
    names : str, measure, or sequence of these, optional
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


def imported(name: str, method: str, extra: str) -> Any:
    """A package that a method needs, one of an extra of this package."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise MissingPackage(f"{method} needs {name}, which is not installed: pip install 'zerodrift[{extra}]'") from None


def _table(solution: Any, names: Any) -> tuple[list[str], np.ndarray]:
    found = [(Variable("t", "s"), solution.t), *columns(solution, names)]
    return [f"{variable.name} [{variable.unit}]" if variable.unit else variable.name for variable, _ in found], np.column_stack(
        [column for _, column in found])
