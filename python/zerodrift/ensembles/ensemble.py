"""`ensemble`: many runs at once, in the threads of this process."""

from __future__ import annotations

import inspect
import itertools
import os
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .. import _check
from ..errors import Interrupted, ZerodriftError
from ..mechanisms.measures import name_of
from ..runs.simulate import simulate
from ..runs.solution import Solution
from ..systems.base import BaseSystem
from .result import NOTHING, Ensemble, Outcome
from .runs import Runs

OWN = ("system", "t_span", "p0", "v0", "outputs", "progress", "on_failure", "save_to")     # of `simulate`, what is not passed on


def ensemble(system: Any, t_span: Any, *, parameters: Any = None, p0: Any = None, v0: Any = None, start: Any = None,
             outputs: Any = None, reduce: Callable[[Solution], Any] | None = None, assemble: bool = True, hold: Any = (),
             threads: int | None = None, keep: str | None = None, **options: Any) -> Ensemble:
    """Simulate many times, with parameters or starts that differ from run to run.

    Runs go side by side in threads, each by `simulate` and with the bits that it has by itself. A run that fails is data: its
    rows end, `failed` says so, and `messages` why.

    Parameters
    ----------
    system : system, Mechanism or callable
        A callable gets one run's parameters by name and returns a system or a Mechanism.
    t_span : float or (float, float)
        As of `simulate`.
    parameters : dict, `grid`, or sequence of dicts, optional
        Values by name: an array has one for each run, a scalar is the same for all; of a parameter with several entries
        (n, size). `zerodrift.grid` takes the product.
    p0, v0 : array_like (nq,), (nv,) or (n, nq), (n, nv), optional
        Starts; left out: each system's own.
    start : dict of measure to value or array_like (n,), optional
        Of mechanisms: what their start holds besides.
    outputs : sequence of str or measures, optional
        What is kept of each run: measures, coordinates, velocities, multipliers. Left out: all coordinates.
    reduce : callable, optional
        ``reduce(solution)`` is kept of each run that succeeds, as `values`; then outputs are those asked for, and no others.
    assemble : bool
        Whether a start is made consistent after a change of parameters. Mechanisms always are.
    hold : sequence of str
        Coordinates and velocities that keep their values in that, as of `zerodrift.assemble`.
    threads : int, optional
        At most so many; left out: as many as this process may use processors.
    keep : {None, "solutions"}
        Whether all solutions stay in memory.
    **options
        As of `simulate`: ``step``, ``rtol``, ``t_eval``, ``events``, and so on.

    Returns
    -------
    Ensemble

    Raises
    ------
    ValueError, TypeError
        Before anything runs: for arrays of different lengths, parameters and outputs that nobody has, wrong options.
    Interrupted
        After Ctrl-C; ``solution`` is the Ensemble of what was done.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> ens = zd.ensemble(zd.systems.four_bar(), 2.0, parameters={"gravity": np.linspace(9.7, 9.9, 5)}, step=0.01,
    ...                   t_eval=np.linspace(0, 2, 11), outputs=["alpha1"])
    >>> ens["alpha1"].shape, bool(ens.failed.any())
    ((5, 11), False)
    """
    _check_options(options)
    runs = Runs(system, parameters, p0, v0, start, hold, assembles=_check.instance("assemble", assemble, bool, "True or False"))
    if reduce is not None and not callable(reduce):
        raise TypeError(f"reduce must be a function of a solution, not {_check.shown(reduce)}")
    keeps = keep is not None and bool(_check.choice("keep", keep, ("solutions",)))
    threads = min(runs.count, _processors() if threads is None else _check.count("threads", threads))
    names = _names(outputs, reduce)
    work = _Work(runs, t_span, options, names, reduce, keeps)
    return work.done(threads)


def _check_options(options: dict[str, Any]) -> None:
    known = [name for name in inspect.signature(simulate).parameters if name not in OWN]
    for name in options:
        if name not in known:
            raise TypeError(f"ensemble has no argument {name!r}; simulate, which has the options, takes {', '.join(known)}")


def _names(outputs: Any, reduce: Any) -> list[str] | None:
    """The names of outputs; None: all coordinates."""
    if outputs is None:
        return None if reduce is None else []
    several = [outputs] if isinstance(outputs, str) or not isinstance(outputs, Sequence) else outputs
    return [name_of(each, "each of outputs") for each in several]


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Cancelled(Exception):
    """Raised in a run that nobody waits for any more."""


class _Work:
    """The runs that are to be made, and the threads that make them."""

    def __init__(self, runs: Runs, t_span: Any, options: dict[str, Any], names: list[str] | None, reduce: Any,
                 keeps: bool) -> None:
        self._runs, self._t_span, self._options, self._reduce, self._keeps = runs, t_span, options, reduce, keeps
        self._outcomes, self._cancelled, self._numbers = [NOTHING] * runs.count, False, itertools.count(1)
        self._names = names

    def done(self, threads: int) -> Ensemble:
        """All runs, the first alone: what is wrong with arguments shows there."""
        begin = time.perf_counter()
        workers = [threading.Thread(target=self._work, daemon=True) for _ in range(threads if self._runs.count > 1 else 0)]
        try:
            self._first()
            for worker in workers:
                worker.start()
            for worker in workers:
                while worker.is_alive():        # a join without an end is deaf to Ctrl-C on some machines
                    worker.join(0.1)
        except KeyboardInterrupt:
            self._cancelled = True
            for worker in workers:
                if worker.ident is not None:
                    worker.join()
            done = self._ensemble(begin, threads)
            count = int((~done.failed).sum())
            raise Interrupted(f"the ensemble was interrupted: {count} of {len(done)} runs are done", done) from None
        return self._ensemble(begin, threads)

    def _ensemble(self, begin: float, threads: int) -> Ensemble:
        return Ensemble(self._runs, self._names or [], self._outcomes, self._solution, time.perf_counter() - begin, threads)

    def _first(self) -> None:
        """The first run; what is wrong with arguments is an error, and not a failed run."""
        try:
            system = self._runs.system(0)
        except Exception as error:
            if isinstance(self._runs.made, BaseSystem):
                raise
            self._outcomes[0] = _failed(error)
            return
        self._check_names(system)
        try:
            self._outcomes[0] = self._outcome(0)
        except Exception as error:
            if isinstance(error, TypeError | ValueError) and not isinstance(error, ZerodriftError):
                raise
            self._outcomes[0] = _failed(error)

    def _check_names(self, system: BaseSystem) -> None:
        known = [variable.name for group in (system.coordinates, system.velocities, system.constraints) for variable in group]
        for name in self._names or []:
            if name not in known and system._watching.find(name) is None:
                raise ValueError(f"no output is called {name!r} in {system.name}; "
                                 f"{_check.closest(name, [*system._names_of_measures(), *known])}")

    def _work(self) -> None:
        """Takes runs until there are none."""
        while not self._cancelled and (run := next(self._numbers)) < self._runs.count:
            try:
                self._outcomes[run] = self._outcome(run)
            except _Cancelled:
                return
            except Exception as error:      # the others go on
                self._outcomes[run] = _failed(error)

    def _progress(self, _: float) -> None:
        if self._cancelled:
            raise _Cancelled

    def _solution(self, run: int, **options: Any) -> Solution:
        system = self._runs.system(run)
        p, v = self._runs.start(run, system)
        return simulate(system, self._t_span, p, v, **self._options, **options)

    def _outcome(self, run: int) -> Outcome:
        solution = self._solution(run, on_failure="return", progress=self._progress)
        if self._names is None:
            self._names = [variable.name for variable in solution.system.coordinates]
        outputs = {name: np.array(solution[name]) for name in self._names}
        value = self._reduce(solution) if self._reduce is not None and solution.success else None
        return Outcome(np.array(solution.t), outputs, value, solution.t_events, solution if self._keeps else None,
                       solution.message, solution.success)


def _failed(error: Exception) -> Outcome:
    """A run that did not begin, or whose own functions raised."""
    return NOTHING._replace(message=f"{type(error).__name__}: {error}")
