"""What an ensemble of runs leaves: arrays over all runs, and what failed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .. import _check
from ..systems.measure_values import AXES
from . import exporting, saving
from .batch import made_again
from .part import NOT_STARTED, ROADS, Part
from .plan import Plan


class Ensemble:
    """Many runs; ``ens["crank.angle"]`` has an output of all of them, and ``ens[17]`` is one run by itself.

    Attributes
    ----------
    parameters : dict of str to ndarray (n,) or (n, size)
        Of every run.
    shape : tuple of int
        (n,), or that of the grid: ``ens["x"].reshape(*ens.shape, -1)``.
    t : ndarray (k,) or None
        The times of all rows; None where runs have different ones.
    failed : ndarray (n,)
        Which runs did not reach their end, nor a terminal event.
    messages : tuple of str
        What happened to each.
    doubtful : ndarray (n,)
        Whose steps, corrections or energy leave doubt: `simulate` warns of most of these, and the first is told of.
    values : ndarray (n, ...) or list
        What `reduce` returned of each; NaN, or None in a list, where it failed.
    t_events : list of tuple of ndarray
        Of each run; None where no events were asked for, or nothing came of it.
    units : dict of str to str
        Of outputs and parameters, as far as they are known.
    seconds : float
        How long all of them took together.
    """

    def __init__(self, plan: Plan, part: Part, seconds: float, where: str) -> None:
        self.parameters, self.shape, self.seconds, self._where = plan.runs.parameters, plan.runs.shape, seconds, where
        self.units = plan.units
        self._plan, self._names, self._part = plan, plan.names, part
        self.failed = part.failed
        self.messages, self.doubtful = tuple(part.messages), part.doubtful
        self.t_events = part.t_events
        t = part.t if plan.t_eval is None else plan.t_eval
        self.t = _check.frozen(t) if part.is_shared else None
        self.values = _together(part.values)
        self._starts = np.concatenate([[0], np.cumsum(part.rows)])      # of each run's rows

    def __len__(self) -> int:
        return len(self.failed)

    def __getitem__(self, key: Any) -> Any:
        """An output of all runs, or one run.

        Parameters
        ----------
        key : str, measure or int
            An output by its name, or a component of one, ``"C.force.x"``; or the number of a run, which is made again by
            itself, with the same bits, unless solutions were kept.

        Returns
        -------
        ndarray (n, k) or (n, k, size), list of ndarray, or Solution
            NaN where a run has no such row any more; a list where runs have different times.

        Raises
        ------
        KeyError
            If nothing of that name was kept.
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
                raise KeyError(f"no output is called {name!r}; {_check.closest(name, self._names) if self._names else 'none'}")
            return self._stacked(name)
        if isinstance(key, bool | np.bool_) or not isinstance(key, int | np.integer):
            raise TypeError(f"an ensemble takes the name of an output or the number of a run, not {_check.shown(key)}")
        if not -len(self) <= key < len(self):
            raise IndexError(f"there are {len(self)} runs, and none of number {key}")
        run = int(key) % len(self)
        return self._part.solutions[run] or made_again(self._plan.to_run(run), run)

    def _component(self, name: str) -> Any:
        """A component of an output that is a vector; None: it is something else."""
        base, _, axis = name.rpartition(".")
        if name in self._names or base not in self._names or axis not in AXES:
            return None
        vectors = self._stacked(base)
        first = vectors[0]
        if first.ndim != 2 or AXES[axis] >= first.shape[1]:
            return None
        return [each[:, AXES[axis]] for each in vectors] if self.t is None else vectors[..., AXES[axis]]

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

        A system is kept as far as `Solution.save` keeps it, functions are not: where there are none, runs can be made again of
        what was loaded, too. Solutions that stayed in memory are not written.

        Parameters
        ----------
        path : str or Path
            The suffix ``.npz`` is added where it is missing.

        Returns
        -------
        Path
            Where it was written.

        Raises
        ------
        TypeError
            If `reduce` returned what a file does not keep.

        Examples
        --------
        >>> import tempfile, zerodrift as zd
        >>> ens = zd.ensemble(zd.systems.oscillator(), 1.0, parameters={"mass": [1.0, 2.0]}, step=0.1)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     again = zd.load(ens.save(folder + "/study"))
        >>> bool((again["x"] == ens["x"]).all() and (again[1].p == ens[1].p).all())
        True
        """
        path = Path(path)
        path = path if path.suffix == ".npz" else path.with_name(path.name + ".npz")
        saving.write(path, self._plan, self._part)
        return path

    def to_xarray(self) -> Any:
        """Everything as an xarray.Dataset, with its units.

        Outputs have the dimensions ``run`` and ``t``, of a grid those of its parameters instead of ``run``, and vectors
        ``component``. Where runs have times of their own, ``row`` stands for ``t``, and ``t`` is among the variables.

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
        """Everything as a pandas.DataFrame: one line for each row of each run, with the index ``(run, t)``.

        Columns are the parameters, then the outputs, vectors by their components. Where only `reduce` was asked for, there is
        one line for each run, with the index ``run``, and columns are the parameters, ``value``, ``failed`` and ``message``.

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
        raise TypeError("an ensemble is not gone through, as that would make all runs again: take ens['name'], or ens[i]")

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._names)

    def __repr__(self) -> str:
        count = " x ".join(map(str, self.shape))
        varied = f" over {', '.join(self.parameters)}" if self.parameters else ""
        rows = f"{len(self.t)} rows each" if self.t is not None else "rows of their own"
        failed = f"{int(self.failed.sum())} failed" if self.failed.any() else "none failed"
        failed += f", {int(self.doubtful.sum())} doubtful" if self.doubtful.any() else ""
        first = f", the first because {self.messages[int(self.failed.argmax())]}" if self.failed.any() else ""
        return (f"<ensemble of {count} runs{varied}: {rows}, {failed}{first}\n"
                f" {f'in {self.seconds:.3g} s ' if self.seconds else ''}{self._where}; {self._roads()}\n"
                f" outputs {', '.join(self._names) or 'none'}>")

    def _roads(self) -> str:
        """How many runs took which."""
        done = np.array([message != NOT_STARTED for message in self.messages])
        return ", ".join(f"{count} {road}" for number, road in enumerate(ROADS)
                         if (count := int((self._part.roads[done] == number).sum()))) or "none was made"


def _together(values: list[Any]) -> Any:
    """An array where the values are numbers or arrays of one shape, with NaN for what is missing; else a list."""
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
