"""`ensemble`: many runs at once, in threads, processes, or on other machines."""

from __future__ import annotations

import threading
import time
import warnings
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from .. import _check, _gateway
from ..errors import Interrupted, WorkerLost
from ..runs.progress import progress_of
from ..runs.solution import Solution
from ..runs.threads import Threads, processors
from . import executors, memory
from . import store as stores
from .batch import batch_of
from .part import Part, filled
from .plan import Plan, checked
from .result import Ensemble
from .run_range import run_range
from .runs import Runs

SHARES = 16         # ranges for each thread, so that all end at about the same time
LONGEST = 1024      # runs of a range, at most; and at least, where they are made side by side: lanes stand still at its end
SHORTEST = 32
TOLD = 3            # doubtful runs that are looked at, to tell of the first that deserves it


def ensemble(system: Any, t_span: Any, *, parameters: Any = None, p0: Any = None, v0: Any = None, start: Any = None,
             outputs: Any = None, reduce: Callable[[Solution], Any] | None = None, assemble: bool = True, hold: Any = (),
             executor: Any = None, threads: int | None = None, chunk: int | None = None, store: Any = None,
             keep: str | None = None, progress: bool | Callable[[float], None] = False,
             **options: Any) -> Ensemble:
    """Simulate many times, with parameters or starts that differ from run to run.

    Runs go side by side in threads, or wherever an executor makes them, each with the bits that it has by itself. A run that
    fails is data: its rows end, `failed` says so, and `messages` why.

    Where direct functions serve a built-in system, or bodies in absolute coordinates are joined by pins alone and these have more
    than 40 rows, and outputs are coordinates, velocities and multipliers at times that are known before, several runs are made
    at once in the lanes of the processor's vector unit: those of `simulate` but for rounding, with their events where these are
    names or expressions. What a lane cannot make, callables as events, and a run whose elimination is not sound somewhere, is
    made by `simulate`'s own steps; `repr` says how many runs took which road.

    Of a mechanism in the plane whose numbers vary, and that has no laws, wishes or drives of constant speed, the core makes and
    assembles each by itself, and records measures: what `simulate` makes but for rounding of the start.

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
    executor : None, "processes" or Executor
        None: threads of this process; callables of Python then take turns. "processes": processes of this machine. Else
        whatever has ``submit`` as those of `concurrent.futures` have: also loky's, ``dask.distributed.Client().get_executor()``,
        ``mpi4py.futures.MPIPoolExecutor()``. Functions travel to them by the names that they have in their modules, and others,
        of notebooks or within functions, by cloudpickle, if that is installed. All runs take the vector unit of this process.
    threads : int, optional
        At most so many threads, or processes; left out: as many as this process may use processors.
    chunk : int, optional
        So many runs are handed out together; left out: some 16 portions for each thread or worker.
    store : str or Path, optional
        A folder that runs are written to when they are done, in files of `chunk` runs that appear as a whole. The same call goes
        on where it stopped, after Ctrl-C, a crash or a lost worker, also with another chunk, executor or number of threads, and
        makes no run twice. A folder that belongs to another study is refused, and one to which another ensemble writes;
        `zerodrift.load` opens it at any time. What functions read from global variables is not compared.
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
        Before anything runs: for arrays of different lengths, unknown parameters and outputs, wrong options, and parameters or
        starts that no run accepts. Also for a function that cannot travel to other processes; it is named with the object that
        it refers to.
    MemoryError
        If the outputs take more than the memory that is free: before anything runs where steps are of fixed size or times are
        given, else once they do; ``solution`` is then the Ensemble of what was done. With a store outputs that have no room in
        memory stay in its files, and each is read when it is asked for.
    OSError
        If a store cannot be written to, or its disk has no room for the outputs.
    InUse
        If another ensemble writes to the folder `store`.
    Interrupted
        After Ctrl-C; ``solution`` is the Ensemble of what was done.
    WorkerLost
        If an executor does not return some runs, as it cancelled them, its processes died, or are of a machine that gives other
        bits; ``solution`` is the Ensemble of what it did return.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> ens = zd.ensemble(zd.systems.four_bar(), 2.0, parameters={"gravity": np.linspace(9.7, 9.9, 5)}, step=0.01,
    ...                   t_eval=np.linspace(0, 2, 11), outputs=["alpha1"])
    >>> ens["alpha1"].shape, bool(ens.failed.any())
    ((5, 11), False)

    On a cluster, with a folder from which it goes on after whatever happens to the cluster or to this process::

        from dask.distributed import Client

        with Client("scheduler:8786") as client:
            ens = zd.ensemble(zd.models.hoecken, 1.0, parameters=zd.grid(ground=grounds, coupler=couplers), step=0.01,
                              outputs=["P.position"], executor=client.get_executor(), store="hoecken")
    """
    runs = Runs(system, parameters, p0, v0, start, hold, assembles=_check.instance("assemble", assemble, bool, "True or False"))
    keeps = keep is not None and bool(_check.choice("keep", keep, ("solutions",)))
    place = executors.checked(executor)
    threads = min(runs.count, processors() if threads is None else _check.count("threads", threads))
    chunk = None if chunk is None else _check.count("chunk", chunk)
    if store is not None and keeps:
        raise ValueError('keep="solutions" is for memory, and a store keeps outputs; ens[i] makes run i again, with the same '
                         "bits")
    if store is not None:
        options["vector"] = options.get("vector") or stores.vector_of(store)
    plan = checked(runs, t_span, options, outputs, reduce, keeps=keeps)
    memory.check(plan.sizes, runs.count, None if store is None else Path(store), stacklevel=2)
    with nullcontext() if store is None else stores.Store(store, plan) as kept:
        return _Work(plan, place, threads, chunk, kept).done(progress)


class _Work:
    """The runs that are to be made, and the parts that are done."""

    def __init__(self, plan: Plan, executor: Any, threads: int, chunk: int | None, store: stores.Store | None) -> None:
        self._plan, self._store, self._threads = plan, store, threads
        self._lock, self._begin = threading.Lock(), time.perf_counter()
        self._parts = {} if store is None else store.parts()
        self._size = sum(memory.size_of(part) for part in self._parts.values())      # bytes of outputs in memory
        runs = plan.runs.count
        workers = threads if executor is None or executor == "processes" else executors.workers_of(executor) or SHARES
        least = SHORTEST if batch_of(plan) else 1
        ranges = stores.missing(_ranges(self._parts), runs, chunk or min(LONGEST, max(-(-runs // (SHARES * workers)), least)))
        maker = Threads(self._made, ranges) if executor is None else (
            executors.Elsewhere(plan, ranges, self._finished, executor))
        self._make, self._where = maker.run, _where(executor, threads)

    def done(self, progress: Any) -> Ensemble:
        """All runs; after Ctrl-C, or where some were lost, an error that carries those that are done."""
        show, close = progress_of(progress)
        try:
            self._make(self._threads, lambda: show(self._count() / self._plan.runs.count))
        except KeyboardInterrupt:
            done = self._ensemble()
            raise Interrupted(f"the ensemble was interrupted: {self._count()} of {len(done)} runs are done", done) from None
        except MemoryError as error:
            error.solution = self._ensemble()
            raise
        except WorkerLost as error:
            error.solution = self._ensemble()
            if self._store:
                _check.tell(error, f"what was done is in {self._store.folder}, and the same call goes on with it")
            raise
        finally:
            close()
        ensemble = self._ensemble()
        self._warn(ensemble)
        return ensemble

    def _warn(self, ensemble: Ensemble) -> None:
        """What `simulate` warns of in the first of the runs that are doubtful, once for all of them."""
        doubtful = np.flatnonzero(ensemble.doubtful)
        for run in doubtful[:TOLD].tolist():
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                self._plan.solution(run, on_failure="return")
            for each in caught:
                warnings.warn(f"{len(doubtful)} of {len(ensemble)} runs are doubtful; run {run}: {each.message}", each.category,
                              stacklevel=4)
            if caught:
                return

    def _made(self, taken: tuple[int, int], stop: _gateway.Stop) -> None:
        self._finished(taken[0], run_range(self._plan, *taken, stop))

    def _finished(self, first: int, part: Part) -> None:
        """Keeps a part: its outputs in memory, or in the store where memory gets short; without a store that is an error."""
        path = self._store.write(first, part) if self._store else None
        with self._lock:
            size = self._size + memory.size_of(part)
            if path and memory.exceeds(size, memory.IN_STORE):
                part = stores.in_file(part, path)
            self._size += memory.size_of(part)
            self._parts[first] = part
        if not path and self._plan.sizes is None and memory.exceeds(self._size, 1.0):      # no more than that can be joined
            raise MemoryError(memory.shortage(self._size, self._count()))

    def _count(self) -> int:
        """How many runs are done."""
        with self._lock:
            return sum(len(part.rows) for part in self._parts.values())

    def _ensemble(self) -> Ensemble:
        return Ensemble(self._plan, filled(self._parts, self._plan.runs.count), time.perf_counter() - self._begin, self._where)


def _ranges(parts: dict[int, Part]) -> list[tuple[int, int]]:
    """The runs of each part: the first, and the one after the last."""
    return [(first, first + len(part.rows)) for first, part in parts.items()]


def _where(executor: Any, threads: int) -> str:
    """Where runs are made, in the words of `repr`."""
    if executor is None:
        return f"on {threads} threads"
    return f"in {threads} processes" if executor == "processes" else f"by {type(executor).__name__}"
