"""`load`: whatever was saved."""

from __future__ import annotations

import importlib
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from . import _check
from .runs import sample_file
from .runs.saving import read
from .runs.solution import Solution


def load(path: str | Path) -> Any:
    """Read what was saved: a solution, `Solution.save`, an ensemble, `Ensemble.save`, or a mechanism, `Mechanism.save`.

    They are told apart by what is in the file. A folder is the ``store`` of an ensemble, of which what is done is there.

    The rows that a run wrote to a file, ``simulate(..., save_to=...)``, stay there: of its arrays, that part is read which is
    looked at, so that they may be larger than memory. A run that goes on yet, or that was killed, has the rows that came.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Solution, Ensemble or Mechanism

    Raises
    ------
    ValueError
        If the file is none of these, was not written to its end, or if there is something in a mechanism that this version does
        not know; the key and its place are named.

    Examples
    --------
    >>> import tempfile, zerodrift as zd
    >>> sol = zd.simulate(zd.systems.oscillator(), 1.0, step=0.1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     again = zd.load(sol.save(folder + "/motion"))
    >>> bool((again.p == sol.p).all())
    True
    """
    if Path(path).is_dir() or _is_zip(path):
        ensemble = _ensembles().read(path, lambda description: _system(description, str(path)))
        if ensemble is not None:
            return ensemble
    read_from = sample_file.read if sample_file.is_one(path) else read
    values = read_from(path, lambda description: _system(description, str(path)))
    if values is not None:
        _check_whole(path, values)
        return Solution(**values)
    content = Path(path).read_bytes()
    if b"zerodrift" in content and content.lstrip()[:1] == b"{":
        description = _module("files.from_json").parsed(content.decode(errors="replace"), str(path))
        if description is not None:
            return _mechanism(description, str(path))
    raise ValueError(f"{path} is no solution saved by zerodrift, no ensemble, and no mechanism")


def _check_whole(path: str | Path, values: dict[str, Any]) -> None:
    """Refuses a file in which fields of a solution are missing."""
    lacking = [each.name for each in fields(Solution)
               if each.name not in values and each.default is MISSING and each.default_factory is MISSING]
    if lacking:
        raise ValueError(f"{path} must contain a whole solution, and lacks {', '.join(lacking)}: it was not written to its end, "
                         "or was changed")


def _is_zip(path: str | Path) -> bool:
    """Whether it is of the kind that arrays are saved in."""
    with open(path, "rb") as file:
        return file.read(2) == b"PK"


def _ensembles() -> Any:
    """What reads ensembles; imported where there may be one."""
    return importlib.import_module(".ensembles.loading", __package__)


def _module(name: str) -> Any:
    """A module of `mechanisms`, imported when a file needs it."""
    return importlib.import_module(f".mechanisms.{name}", __package__)


def _mechanism(description: Any, where: str) -> Any:
    """The mechanism of a JSON description."""
    return _module("files.from_json").mechanism(_module("mechanism").Mechanism, description, where)


def _system(description: dict[str, Any], path: str) -> Any:
    """The system of a mechanism that was saved with a solution."""
    where, systems = f"{path}, mechanism", _module("system")
    drawing = _mechanism(description["mechanism"], where)._drawing()
    layout = _check.choice(f"layout of {where}", description["layout"], systems.LAYOUTS)
    return systems.MechanismSystem(drawing, layout, description["changed"])
