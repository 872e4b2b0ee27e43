"""Parts of an ensemble in other processes, of this machine or of others: whatever has `submit`, as `concurrent.futures` has."""

from __future__ import annotations

import contextlib
import functools
import multiprocessing
import platform
import queue
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from .. import _check, _gateway
from ..errors import WorkerLost
from ..runs.settings import VECTOR_UNITS
from ..runs.threads import LOOK
from .identity import version
from .part import Part
from .plan import Plan
from .run_range import never, run_range
from .runs import named
from .transport import packed, unpacked

WINDOW = 256        # ranges that are submitted and not yet done, at most: more would only take memory
FORGETS = 4         # plans that a worker remembers

_is_cancelled: Callable[[], bool] = never       # of the processes that this module starts: whether anybody waits for them


def checked(executor: Any) -> Any:
    """The argument `executor` of `ensemble`."""
    if executor is None or executor == "processes" or callable(getattr(executor, "submit", None)):
        return executor
    raise TypeError('executor must be None, for the threads of this process, "processes", or an Executor, which has submit() as '
                    "those of concurrent.futures, loky, mpi4py.futures and dask's client.get_executor() have, not "
                    f"{_check.shown(executor)}")


def workers_of(executor: Any) -> int | None:
    """How many an executor has, if it says so."""
    count = getattr(executor, "_max_workers", None)
    return count if isinstance(count, int) else None


class Elsewhere:
    """An executor that is handed range after range."""

    def __init__(self, plan: Plan, ranges: Iterator[tuple[int, int]], finished: Callable[[int, Part], None],
                 executor: Any) -> None:
        self._runs, self._ranges, self._finished, self._executor = plan.runs, ranges, finished, executor
        stamp = {"vector": plan.options["vector"], "version": version()}
        without_table = plan.over(plan.runs.with_table(plan.runs.table(0, 0)))
        shares_main = executor == "processes" or isinstance(executor, ProcessPoolExecutor)
        self._head = packed((stamp, packed(without_table, "the ensemble", shares_main=shares_main)))
        self._done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._pending: dict[Any, tuple[int, int]] = {}
        self._lost: dict[tuple[int, int], Exception] = {}       # by the ranges, why they did not come back
        self._has_received = False

    def run(self, count: int, look: Callable[[], None]) -> None:
        """All ranges; `count` processes where they are this module's own. Meanwhile `look` is called now and then."""
        try:
            with self._opened(count) as self._executor:
                try:
                    self._all(look)
                except BaseException:       # Ctrl-C, or a full disk: nobody waits for what has not begun
                    self._cancel()
                    raise
        except KeyboardInterrupt:
            self._collect()
            raise
        if self._lost:
            raise self._error()

    def _opened(self, count: int) -> AbstractContextManager[Any]:
        return _Processes(count) if self._executor == "processes" else nullcontext(self._executor)

    def _all(self, look: Callable[[], None]) -> None:
        """Until all are done; or, once one is lost, until those are that have begun."""
        self._fill()
        while self._pending:
            look()
            with contextlib.suppress(queue.Empty):
                self._receive(self._done.get(timeout=LOOK))
                self._fill()
            if self._lost:
                self._cancel()
        look()

    def _collect(self) -> None:
        """What has come meanwhile; also what Ctrl-C came into while it was looked at."""
        for future in list(self._pending):
            if future.done():
                self._receive(future)

    def _fill(self) -> None:
        """Submits ranges until enough are under way."""
        while not self._lost and len(self._pending) < WINDOW and (taken := next(self._ranges, None)) is not None:
            try:
                future = self._executor.submit(_made, self._head, packed(self._runs.table(*taken)))
            except RuntimeError as error:       # it was shut down, or all its processes died
                self._lost[taken] = error
                return
            self._pending[future] = taken
            future.add_done_callback(self._done.put)

    def _receive(self, future: Any) -> None:
        """Hands on what a future has; or keeps why it has nothing. Only then is it no longer pending."""
        taken = self._pending.get(future)
        if taken is None:
            return
        part = _result(future)
        if isinstance(part, BaseException):
            self._lost[taken] = part
        else:
            self._has_received = True
            self._finished(taken[0], part)
        del self._pending[future]

    def _error(self) -> Exception:
        """What is raised of ranges that were lost: what our own workers say, else that of the first."""
        (first, last), error = min(self._lost.items(), key=lambda pair: pair[0])
        if isinstance(error, WorkerLost | TypeError):
            return error
        why = f"{type(error).__name__}: {error}".rstrip(": ")
        others = f", nor {len(self._lost) - 1} other portions" if len(self._lost) > 1 else ""
        hint = "" if self._has_received or not isinstance(error, BrokenExecutor) else (
            '; a script that starts processes needs `if __name__ == "__main__":` around what does')
        return WorkerLost(f"the executor did not return the runs {first} ... {last - 1}{others}: {why}{hint}")

    def _cancel(self) -> None:
        """What has not begun will not; what has is waited for by whoever called."""
        for future in list(self._pending):
            if not future.cancelled() and future.cancel():      # those that the executor has cancelled are lost
                self._pending.pop(future, None)


def _result(future: Any) -> Any:
    """The part that a future has, or the error for which it has none; `_cancel` keeps no future that it has cancelled."""
    if future.cancelled():
        return CancelledError("cancelled by the executor")
    error = future.exception()
    return error if error is not None else unpacked(future.result())


class _Processes(AbstractContextManager):
    """Processes of this machine's own, which hear of Ctrl-C by a flag: a notebook's does not reach them."""

    def __init__(self, count: int) -> None:
        context = multiprocessing.get_context("spawn")
        self._flag = context.Event()
        self._pool = ProcessPoolExecutor(count, context, initializer=_listen, initargs=(self._flag,))

    def __enter__(self) -> Executor:
        return self._pool

    def __exit__(self, kind: Any, *_: Any) -> None:
        if kind is not None:
            self._flag.set()
        self._pool.shutdown(wait=True, cancel_futures=True)


# ---- in the worker ----


def _listen(flag: Any) -> None:
    """What each process of this module's own begins with: Ctrl-C is heard where the ensemble is."""
    global _is_cancelled
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _is_cancelled = flag.is_set


def _made(head: bytes, table: bytes) -> bytes:
    """Some runs in bytes; or the error for which none can be made here."""
    try:
        plan = _plan(head)
        plan = plan.over(plan.runs.with_table(unpacked(table)))
        kept = "what is kept of a run" if plan.reduce is None else f"what {named(plan.reduce)} returned of a run"
        return packed(run_range(plan, 0, plan.runs.count, _is_cancelled), kept)
    except (ImportError, WorkerLost) as error:
        return packed(WorkerLost(f"{error} (on {platform.node()})"))
    except TypeError as error:      # what reduce returned may be anything
        return packed(TypeError(str(error)))
    except KeyboardInterrupt:       # an Interrupted, with its solution, does not travel
        raise KeyboardInterrupt from None


@functools.lru_cache(FORGETS)
def _plan(head: bytes) -> Plan:
    stamp, plan = unpacked(head)
    check_stamp(stamp)
    return unpacked(plan)


def check_stamp(stamp: dict[str, Any]) -> None:
    """Refuses to make runs whose bits would not be those of where the ensemble began."""
    if stamp["version"] != version():
        raise WorkerLost(f"this worker has another zerodrift, {version()}, than the process that began the ensemble, "
                         f"{stamp['version']}; install the same")
    unit, units = stamp["vector"], VECTOR_UNITS[:_gateway.PROCESSOR_UNIT + 1]
    if unit not in units:
        raise WorkerLost(f'the processor of this worker has no {unit}, with which the ensemble began: vector="avx2" | '
                            f'"baseline" takes one that all have; here there is {" and ".join(units)}')
