"""`ensemble`: many runs at once, in the threads of this process."""

from __future__ import annotations

import threading
import time
import warnings
from collections.abc import Callable
from typing import Any

from .. import _check
from ..errors import Interrupted
from ..runs.progress import progress_of
from ..runs.solution import Solution
from .part import NOT_STARTED, Part, joined, nothing
from .plan import Plan, checked
from .result import Ensemble
from .runs import Runs
from .threads import Threads, processors

SHARES = 16         # ranges for each thread, so that all end at about the same time
LONGEST = 1024      # runs of a range, at most
TOLD = 3            # doubtful runs that are looked at, to tell of the first that deserves it


def ensemble(system: Any, t_span: Any, *, parameters: Any = None, p0: Any = None, v0: Any = None, start: Any = None,
             outputs: Any = None, reduce: Callable[[Solution], Any] | None = None, assemble: bool = True, hold: Any = (),
             threads: int | None = None, keep: str | None = None, progress: bool | Callable[[float], None] = False,
             **options: Any) -> Ensemble:
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
    progress : bool or callable
        True: a progress bar (needs tqdm). A callable is handed the part of the runs that is done, 0 ... 1.
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
    runs = Runs(system, parameters, p0, v0, start, hold, assembles=_check.instance("assemble", assemble, bool, "True or False"))
    keeps = keep is not None and bool(_check.choice("keep", keep, ("solutions",)))
    threads = min(runs.count, processors() if threads is None else _check.count("threads", threads))
    plan = checked(runs, t_span, options, outputs, reduce, keeps=keeps)
    return _Work(plan).done(threads, progress)


class _Work:
    """The runs that are to be made, and the parts that are done."""

    def __init__(self, plan: Plan) -> None:
        self._plan, self._parts, self._lock, self._count = plan, {}, threading.Lock(), 0

    def done(self, threads: int, progress: Any) -> Ensemble:
        """All runs; after Ctrl-C an error that carries those that are done."""
        begin = time.perf_counter()
        show, close = progress_of(progress)
        runs = self._plan.runs.count
        length = min(LONGEST, -(-runs // (SHARES * threads)))
        ranges = ((first, min(runs, first + length)) for first in range(0, runs, length))
        try:
            Threads(self._plan, ranges, self._finished).run(threads, lambda: show(self._count / runs))
        except KeyboardInterrupt:
            done = self._ensemble(begin, threads)
            count = sum(message != NOT_STARTED for message in done.messages)
            raise Interrupted(f"the ensemble was interrupted: {count} of {len(done)} runs are done", done) from None
        finally:
            close()
        self._warn()
        return self._ensemble(begin, threads)

    def _warn(self) -> None:
        """What `simulate` warns of in the first of the runs that are doubtful, once for all of them."""
        doubtful = sorted(self._plan.remembered.get("doubtful", ()))
        for run in doubtful[:TOLD]:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                self._plan.solution(run, on_failure="return")
            for each in caught:
                warnings.warn(f"{len(doubtful)} of {self._plan.runs.count} runs are doubtful; run {run}: {each.message}",
                              each.category, stacklevel=4)
            if caught:
                return

    def _finished(self, first: int, part: Part) -> None:
        with self._lock:
            self._parts[first] = part
            self._count += len(part.rows)

    def _ensemble(self, begin: float, threads: int) -> Ensemble:
        return Ensemble(self._plan, filled(self._parts, self._plan.runs.count), time.perf_counter() - begin, threads)


def filled(parts: dict[int, Part], count: int) -> Part:
    """All runs, from parts by their first runs; what is missing was not started."""
    found, end = [], 0
    for first in sorted(parts):
        if first > end:
            found.append(nothing(first - end))
        found.append(parts[first])
        end = first + len(parts[first].rows)
    if end < count:
        found.append(nothing(count - end))
    return joined(found)
