"""`ensemble`: many runs at once, in threads, processes, or on other machines."""

from __future__ import annotations

import threading
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from pathlib import Path
from typing import Any, Literal, Unpack

import numpy as np

from .._private import checks, gateway, webassembly
from .._private.types import ArrayLike, EnsembleOptions, Measures, SystemLike, Values
from ..errors import DrawingWarning, Interrupted, NoMemory, WorkerLost, WrongValue
from ..runs.open.ending import with_solution
from ..runs.open.keyboard import progress_of
from ..runs.open.threads import Threads, processors
from ..runs.samples.solution import Solution
from . import executors, memory
from . import store as stores
from .batch import batch_of
from .part import Part, filled
from .plan import Plan, checked
from .result import Ensemble
from .run_range import run_range
from .runs import Runs

SHARES = 16         # ranges per thread, so that all threads end at about the same time
LONGEST = 1024      # largest number of runs in a range; SHORTEST: smallest in SIMD lanes, which idle at the end of a range
SHORTEST = 32
TOLD = 3            # doubtful runs that are repeated to find the first with a warning


def ensemble(system: SystemLike | Callable[..., SystemLike], t_span: float | tuple[float, float], *,
             parameters: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]] | None = None, p0: ArrayLike | None = None,
             v0: ArrayLike | None = None, start: Values | None = None, outputs: Measures | None = None,
             reduce: Callable[[Solution], Any] | None = None, assemble: bool = True, hold: Measures = (),
             executor: Literal["processes"] | Executor | None = None, threads: int | None = None, chunk: int | None = None,
             store: str | Path | None = None, keep: Literal["solutions"] | None = None,
             progress: bool | Callable[[float], object] = False, **options: Unpack[EnsembleOptions]) -> Ensemble:
    """Simulate many runs with varied parameters or initial states.

    Runs execute in threads, or in the workers of an executor. Results do not depend on their number or order. Failed runs are
    kept with their message: see `failed` and `messages` of the result.

    The core makes runs without Python where it can. Several at once in SIMD lanes: if the system is evaluated in closed form,
    outputs are coordinates, velocities and multipliers, output times are known in advance, and events are names or expressions;
    events that set inputs need `t_eval`, and a system of `symbolic`. A run leaves the lanes where a contact closes.
    Individually, assembly and measures included: planar mechanisms with varied numbers, without user functions, wishes and
    drives of constant speed. These results agree with `simulate` to rounding. All other runs are made by `simulate`; `repr`
    gives the number of each kind.

    Parameters
    ----------
    system : system, Mechanism or callable
        A callable receives the parameters of one run by name and returns a system or a Mechanism.
    t_span : float or (float, float)
        Time span in s, as in `simulate`.
    parameters : dict, `grid`, or sequence of dicts, optional
        Values by name: an array (n,) with one for each run, or a scalar for all; (n, size) for a parameter with several
        entries. `zerodrift.grid` makes all combinations.
    p0, v0 : array_like (nq,), (nv,) or (n, nq), (n, nv), optional
        Initial states; by default those of each system.
    start : dict of measure to value or array_like (n,), optional
        For mechanisms: measures and the values that they must have at the start, in addition to `Mechanism.start`.
    outputs : sequence of str or measures, optional
        Results to keep of each run: measures, coordinates, velocities, multipliers. By default all coordinates.
    reduce : callable, optional
        Function of the `Solution` of each successful run; its return values are `values` of the result. Outputs are then kept
        only if `outputs` is given.
    assemble : bool
        Make initial states consistent with the constraints after a change of parameters; always done for mechanisms.
    hold : sequence of str
        Coordinates and velocities that assembly does not change, as in `zerodrift.assemble`.
    executor : None, "processes" or Executor
        None: threads of this process, in which Python functions of the user take turns. "processes": processes on this
        machine. Otherwise an executor with ``submit`` as in `concurrent.futures`, such as those of loky,
        ``dask.distributed.Client().get_executor()`` and ``mpi4py.futures.MPIPoolExecutor()``. Functions are sent to other
        processes by name; those defined in notebooks or in functions need cloudpickle. All runs use the vector unit of this
        process.
    threads : int, optional
        Largest number of threads or processes; by default the number of processors that this process may use.
    chunk : int, optional
        Number of runs in one unit of work; by default there are about 16 units for each thread or worker.
    store : str or Path, optional
        Folder to which finished runs are written, in files of `chunk` runs. After Ctrl-C, a crash or a lost worker the same
        call resumes where it stopped, also with another chunk, executor or number of threads. The folder must be new, or
        belong to the same study and not be in use; values that functions read from global variables are not compared.
        `zerodrift.load` opens it at any time.
    keep : {None, "solutions"}
        "solutions": keep the solutions of all runs in memory.
    progress : bool or callable
        True: show a progress bar (needs tqdm). A callable receives the completed fraction of the runs, 0 ... 1.
    **options
        Further arguments of `simulate`: ``step``, ``rtol``, ``t_eval``, ``events``, and so on.

    Returns
    -------
    Ensemble

    Raises
    ------
    ValueError, TypeError
        Before any run: for arrays of different lengths, unknown parameters and outputs, wrong options, and parameters or starts
        that no run accepts; also for a function that cannot be sent to other processes, with the object that prevents it.
    MemoryError
        If the outputs exceed the free memory: before any run with fixed steps or `t_eval`, else when it happens, with the
        Ensemble of the finished runs as the attribute ``solution``. With a store, outputs that exceed memory remain in its
        files and are read at access.
    OSError
        If a store cannot be written, or the outputs exceed the free disk space.
    InUse
        If another ensemble writes to the folder `store`.
    Interrupted
        After Ctrl-C; ``solution`` is the Ensemble of the finished runs.
    WorkerLost
        If an executor does not return all runs, because it cancelled them, its processes died, or a worker would not give
        bitwise the same results; ``solution`` is the Ensemble of the runs that it did return.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> ens = zd.ensemble(zd.systems.four_bar(), 2.0, parameters={"gravity": np.linspace(9.7, 9.9, 5)}, step=0.01,
    ...                   t_eval=np.linspace(0, 2, 11), outputs=["alpha1"])
    >>> ens["alpha1"].shape, bool(ens.failed.any())
    ((5, 11), False)

    On a cluster, with a folder from which the same call resumes after a failure::

        from dask.distributed import Client

        with Client("scheduler:8786") as client:
            ens = zd.ensemble(zd.models.hoecken, 1.0, parameters=zd.grid(ground=grounds, coupler=couplers), step=0.01,
                              outputs=["P.position"], executor=client.get_executor(), store="hoecken")
    """
    runs = Runs(system, parameters, p0, v0, start, hold, assembles=checks.instance("assemble", assemble, bool, "True or False"))
    keeps = keep is not None and bool(checks.choice("keep", keep, ("solutions",)))
    place = executors.checked(executor)
    if threads not in (None, 1):
        webassembly.refuse("threads", "1", "runs are made one after the other")
    threads = min(runs.count, processors() if threads is None else checks.count("threads", threads))
    chunk = None if chunk is None else checks.count("chunk", chunk)
    if store is not None and keeps:
        raise WrongValue('keep must be left out with a store, which has outputs only; ens[i] repeats run i, with bitwise the '
                         "same result", "conflicting-arguments")
    if store is not None:
        options.update({"vector": options.get("vector") or stores.vector_of(store)})
    plan = checked(runs, t_span, outputs, reduce, keeps=keeps, **options)
    if said := plan.drawn_open:
        warnings.warn(said, DrawingWarning, stacklevel=2)
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
        except (MemoryError, WorkerLost) as error:
            with_solution(error, self._ensemble())
            if self._store and isinstance(error, WorkerLost):
                checks.tell(error, f"finished runs are in {self._store.folder}, and the same call continues them")
            raise
        finally:
            close()
        ensemble = self._ensemble()
        self._warn(ensemble)
        return ensemble

    def _warn(self, ensemble: Ensemble) -> None:
        """Warn once for all doubtful runs, with the warnings of the first that has one."""
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

    def _made(self, taken: tuple[int, int], stop: gateway.Stop) -> None:
        self._finished(taken[0], run_range(self._plan, *taken, stop))

    def _finished(self, first: int, part: Part) -> None:
        """Record a part, with outputs in memory or, if memory is short, in the store; without a store that is an error."""
        path = self._store.write(first, part) if self._store else None
        with self._lock:
            size = self._size + memory.size_of(part)
            if path and memory.exceeds(size, memory.IN_STORE):
                part = stores.in_file(part, path)
            self._size += memory.size_of(part)
            self._parts[first] = part
        if not path and self._plan.sizes is None and memory.exceeds(self._size, 1.0):      # no more than that can be joined
            raise NoMemory(memory.shortage(self._size, self._count()))

    def _count(self) -> int:
        """Number of finished runs."""
        with self._lock:
            return sum(len(part.rows) for part in self._parts.values())

    def _ensemble(self) -> Ensemble:
        return Ensemble(self._plan, filled(self._parts, self._plan.runs.count), time.perf_counter() - self._begin, self._where)


def _ranges(parts: dict[int, Part]) -> list[tuple[int, int]]:
    """Ranges (first, last + 1) of the runs of each part."""
    return [(first, first + len(part.rows)) for first, part in parts.items()]


def _where(executor: Any, threads: int) -> str:
    """Threads, processes or executor of the runs, for `repr`."""
    if executor is None:
        return f"on {checks.counted(threads, 'thread')}"
    return f"in {threads} processes" if executor == "processes" else f"by {type(executor).__name__}"
