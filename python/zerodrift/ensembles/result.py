"""`Ensemble`: the result of many runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .._private import checks
from .._private.writing import with_suffix
from ..errors import WrongIndex, WrongName, WrongType
from ..systems.measure_values import AXES
from . import exporting, saving
from .batch import made_again
from .part import NOT_STARTED, PATHS, Part
from .plan import Plan


class Ensemble:
    """Results of many runs: ``ens["crank.angle"]`` is an output of all runs, ``ens[17]`` the solution of one.

    Attributes
    ----------
    parameters : dict of str to ndarray (n,) or (n, size)
        Parameters of every run.
    shape : tuple of int
        (n,), or the shape of the grid, for ``ens["x"].reshape(*ens.shape, -1)``.
    t : ndarray (k,) or None
        Times of the samples in s; None if they differ between runs.
    failed : ndarray (n,)
        True for runs that reached neither their end nor a terminal event.
    messages : tuple of str
        Message of each run: "done", or the reason for its end.
    doubtful : ndarray (n,)
        True for runs with doubtful steps, corrections or energy balance. `simulate` would warn of most of these; `ensemble`
        warns of the first.
    values : ndarray (n, ...) or list
        Return values of `reduce`; NaN, or None in a list, for failed runs.
    t_events : list of tuple of ndarray
        Times of the events of each run; None without events, or for a run without result.
    units : dict of str to str
        Units of outputs and parameters, where known.
    seconds : float
        Duration of all runs together.
    """

    def __init__(self, plan: Plan | saving.Kept, part: Part, seconds: float, where: str) -> None:
        self.parameters, self.shape, self.seconds, self._where = plan.runs.parameters, plan.runs.shape, seconds, where
        self.units = plan.units
        self._plan, self._names, self._part = plan, plan.names, part
        self.failed = part.failed
        self.messages, self.doubtful = tuple(part.messages), part.doubtful
        self.t_events = part.t_events
        t = part.t if plan.t_eval is None else plan.t_eval
        self.t = checks.frozen(t) if part.is_shared else None
        self.values = _together(part.values)
        self._starts = np.concatenate([[0], np.cumsum(part.rows)])      # first sample of each run

    def __len__(self) -> int:
        return len(self.failed)

    def __getitem__(self, key: Any) -> Any:
        """An output of all runs, or one run.

        Parameters
        ----------
        key : str, measure or int
            Name of an output or of a component of one, ``"C.force.x"``; or the index of a run, which is repeated with bitwise
            the same result unless solutions were kept.

        Returns
        -------
        ndarray (n, k) or (n, k, size), list of ndarray, or Solution
            Samples after the end of a run are NaN; a list if times differ between runs.

        Raises
        ------
        KeyError
            If there is no output of that name.
        IndexError
            If there is no such run.
        ZerodriftError
            If that run fails.
        """
        name = getattr(key, "name", key)
        if isinstance(name, str):
            if (component := self._component(name)) is not None:
                return component
            if name not in self._names:
                raise WrongName(f"no output is called {name!r}; {checks.closest(name, self._names) if self._names else 'none'}",
                                "wrong-name")
            return self._stacked(name)
        if isinstance(key, bool | np.bool_) or not isinstance(key, int | np.integer):
            raise WrongType(f"the key of an ensemble must be an output's name or a run's index, not {checks.shown(key)}")
        if not -len(self) <= key < len(self):
            raise WrongIndex(f"the index of a run must be below {len(self)}, not {key}")
        run = int(key) % len(self)
        return self._part.solutions[run] or made_again(self._plan.to_run(run), run)

    def _component(self, name: str) -> Any:
        """A component of a vector output; None if the name is not one."""
        base, _, axis = name.rpartition(".")
        if name in self._names or base not in self._names or axis not in AXES:
            return None
        vectors = self._stacked(base)
        first = vectors[0]
        if first.ndim != 2 or AXES.index(axis) >= first.shape[1]:
            return None
        return [each[:, AXES.index(axis)] for each in vectors] if self.t is None else vectors[..., AXES.index(axis)]

    def _stacked(self, name: str) -> Any:
        rows, found = self._part.rows, self._part.arrays.get(name, np.zeros(0))
        if self.t is None:
            return np.split(found, self._starts[1:-1])
        if (rows == len(self.t)).all():
            return found.reshape(len(self), len(self.t), *found.shape[1:])
        stacked = np.full((len(self), len(self.t), *found.shape[1:]), np.nan)
        stacked[np.arange(len(self.t)) < rows[:, None]] = found
        return stacked

    def save(self, path: str | Path) -> Path:
        """Write everything to an NPZ file, without pickle; `zerodrift.load` reads it.

        Systems are saved as by `Solution.save`, functions and kept solutions are not. Without functions, runs can be repeated
        from the loaded ensemble.

        Parameters
        ----------
        path : str or Path
            The suffix ``.npz`` is added where it is missing.

        Returns
        -------
        Path
            Path of the written file.

        Raises
        ------
        TypeError
            If a value of `reduce` cannot be saved.

        Examples
        --------
        >>> import tempfile, zerodrift as zd
        >>> ens = zd.ensemble(zd.systems.oscillator(), 1.0, parameters={"mass": [1.0, 2.0]}, step=0.1)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     again = zd.load(ens.save(folder + "/study"))
        >>> bool((again["x"] == ens["x"]).all() and (again[1].p == ens[1].p).all())
        True
        """
        path = with_suffix(path, ".npz")
        saving.write(path, self._plan, self._part)
        return path

    def to_xarray(self) -> Any:
        """The ensemble as an xarray.Dataset with units.

        Outputs have the dimensions ``run`` and ``t``, and vectors ``component``; a grid has the dimensions of its parameters
        instead of ``run``. If times differ between runs, the dimension is ``row``, and ``t`` is a variable.

        Raises
        ------
        ImportError
            If xarray is not installed: ``pip install 'zerodrift[ensembles]'``.

        Examples
        --------
        With xarray, as that may be missing here::

            ens = zd.ensemble(zd.systems.oscillator(), 1.0, parameters=zd.grid(mass=[1.0, 2.0], stiffness=[3.0, 4.0]), step=0.1)
            ens.to_xarray()["x"].sel(mass=2.0, stiffness=3.0).plot()
        """
        return exporting.to_xarray(self, self.units, self._part)

    def to_pandas(self) -> Any:
        """The ensemble as a pandas.DataFrame: one line for each sample of each run, with the index ``(run, t)``.

        Columns are the parameters and the outputs, vectors by components. With `reduce` and no outputs there is one line for
        each run, with the index ``run`` and the columns of the parameters, ``value``, ``failed`` and ``message``.

        Raises
        ------
        ImportError
            If pandas is not installed: ``pip install 'zerodrift[ensembles]'``.

        Examples
        --------
        With pandas, as that may be missing here::

            ens = zd.ensemble(zd.systems.oscillator(), 1.0, parameters={"mass": [1.0, 2.0]}, step=0.1)
            ens.to_pandas().groupby("mass")["x"].max()
        """
        return exporting.to_pandas(self, self._part)

    def __iter__(self) -> Any:
        raise WrongType("an ensemble must not be iterated, which would repeat all runs: use ens['name'], or ens[i]")

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._names)

    def __repr__(self) -> str:
        count = " x ".join(map(str, self.shape))
        varied = f" over {', '.join(self.parameters)}" if self.parameters else ""
        rows = f"{len(self.t)} samples each" if self.t is not None else "times of their own"
        idle = ~self._done()
        broken = self.failed & ~idle
        failed = f"{int(broken.sum())} failed" if broken.any() else "none failed"
        failed += f", {int(idle.sum())} not started" if idle.any() else ""
        failed += f", {int(self.doubtful.sum())} doubtful" if self.doubtful.any() else ""
        first = f", the first because {self.messages[int(broken.argmax())]}" if broken.any() else ""
        return (f"<ensemble of {count} {'run' if count == '1' else 'runs'}{varied}: {rows}, {failed}{first}\n"
                f" {f'in {self.seconds:.3g} s ' if self.seconds else ''}{self._where}; {self._paths()}\n"
                f" outputs {', '.join(self._names) or 'none'}>")

    def _done(self) -> np.ndarray:
        """Mask (n,) of runs that were started."""
        return np.array([message != NOT_STARTED for message in self.messages])

    def _paths(self) -> str:
        """Number of runs by each entry of `PATHS`, in words."""
        done = self._done()
        return ", ".join(f"{count} {path}" for number, path in enumerate(PATHS)
                         if (count := int((self._part.paths[done] == number).sum()))) or "none was made"


def _together(values: list[Any]) -> Any:
    """One array if the values are numbers or arrays of equal shape, with NaN for missing ones; else the list."""
    known = [each for each in values if each is not None]
    if not known:
        return [None] * len(values)
    try:
        arrays = [np.asarray(each, dtype=float) for each in known]
    except (TypeError, ValueError):
        return values
    if any(each.shape != arrays[0].shape for each in arrays):
        return values
    return np.array([np.full(arrays[0].shape, np.nan) if each is None else np.asarray(each, dtype=float) for each in values])
