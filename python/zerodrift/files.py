"""`load`: solutions, ensembles and mechanisms from files."""

from __future__ import annotations

import importlib
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from ._private import checks
from .errors import WrongValue
from .runs.samples import mapped_samples
from .runs.samples.saving import is_zip, read
from .runs.samples.solution import Solution


def load(path: str | Path) -> Any:
    """Load a solution, an ensemble or a mechanism from a file written by its method `save`.

    The kind is recognized by the content. A folder must be the ``store`` of an ensemble, whose finished runs are loaded.

    The arrays of a file written by ``simulate(..., save_to=...)`` are mapped: only the parts that are used are read, so that
    they may exceed memory. A run that is still going on, or was killed, has the samples written so far.

    Parameters
    ----------
    path : str or Path
        File or folder.

    Returns
    -------
    Solution, Ensemble or Mechanism

    Raises
    ------
    ValueError
        If the file is of another kind, is incomplete, or has a key of a mechanism that this version does not know; the message
        gives its place.

    Examples
    --------
    >>> import tempfile, zerodrift as zd
    >>> sol = zd.simulate(zd.systems.oscillator(), 1.0, step=0.1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     again = zd.load(sol.save(folder + "/motion"))
    >>> bool((again.p == sol.p).all())
    True
    """
    path = Path(path)
    if path.is_dir() or is_zip(path):
        ensemble = _ensembles().read(path, lambda description: _system(description, str(path)))
        if ensemble is not None:
            return ensemble
    read_from = mapped_samples.read if mapped_samples.is_one(path) else read
    values = read_from(path, lambda description: _system(description, str(path)))
    if values is not None:
        _check_complete(path, values)
        return Solution(**values)
    content = Path(path).read_bytes()
    if b"zerodrift" in content and content.lstrip()[:1] == b"{":
        description = _module("files.from_json").parsed(content.decode(errors="replace"), str(path))
        if description is not None:
            return _mechanism(description, str(path))
    raise WrongValue(f"{path} must be a solution, an ensemble or a mechanism saved by zerodrift", "unreadable-file")


def _check_complete(path: str | Path, values: dict[str, Any]) -> None:
    """Check that a file has all fields of a solution."""
    lacking = [each.name for each in fields(Solution)
               if each.name not in values and each.default is MISSING and each.default_factory is MISSING]
    if lacking:
        raise WrongValue(f"{path} must contain a whole solution, and lacks {', '.join(lacking)}: it was not written to its end, "
                         "or was changed", "unreadable-file")


def _ensembles() -> Any:
    """Module that loads ensembles, imported at first use."""
    return importlib.import_module(".ensembles.loading", __package__)


def _module(name: str) -> Any:
    """Module of `mechanisms`, imported at first use."""
    return importlib.import_module(f".mechanisms.{name}", __package__)


def _mechanism(description: Any, where: str) -> Any:
    """Mechanism of a JSON description."""
    return _module("files.from_json").mechanism(_module("mechanism").Mechanism, description, where)


def _system(description: dict[str, Any], path: str) -> Any:
    """System of a mechanism that was saved with a solution."""
    where, systems = f"{path}, mechanism", _module("system")
    drawing = _mechanism(description["mechanism"], where)._drawing()
    layout = checks.choice(f"layout of {where}", description["layout"], systems.LAYOUTS)
    return systems.MechanismSystem(drawing, layout, description["changed"])
