"""Parts of an ensemble made by an executor with `submit`: in other processes, on this machine or on others."""

from __future__ import annotations

import concurrent.futures
import contextlib
import functools
import multiprocessing
import platform
import queue
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from .._private import checks, gateway, webassembly
from ..errors import WorkerLost, WrongType, described, sentence
from ..runs.arguments.settings import VECTOR_UNITS
from ..runs.open.identity import version
from ..runs.open.threads import LOOK
from .part import Part
from .plan import Plan
from .run_range import never, run_range
from .runs import named
from .transport import packed, unpacked

WINDOW = 256        # largest number of ranges in progress, which bounds memory
FORGETS = 4         # plans that a worker caches

_is_cancelled: Callable[[], bool] = never       # in processes that this module starts: true after a cancellation


def checked(executor: Any) -> Any:
    """Check the argument `executor` of `ensemble`."""
    if executor is None or executor == "processes" or callable(getattr(executor, "submit", None)):
        if executor is not None:
            webassembly.refuse("executor", "None", "there are no other processes")
        return executor
    raise WrongType('executor must be None, for the threads of this process, "processes", or an Executor, which has submit() as '
                    "those of concurrent.futures, loky, mpi4py.futures and dask's client.get_executor() have, not "
                    f"{checks.shown(executor)}")


def workers_of(executor: Any) -> int | None:
    """Number of workers of an executor; None if it is not known."""
    count = getattr(executor, "_max_workers", None)
    return count if isinstance(count, int) else None


class Elsewhere:
    """Runs of a plan made by an executor, range by range."""

    def __init__(self, plan: Plan, ranges: Iterator[tuple[int, int]], finished: Callable[[int, Part], None],
                 executor: Any) -> None:
        self._runs, self._ranges, self._finished, self._executor = plan.runs, ranges, finished, executor
        stamp = {"vector": plan.options["vector"], "version": version()}
        without_table = plan.over(plan.runs.with_table(plan.runs.table(0, 0)))
        shares_main = executor == "processes" or isinstance(executor, concurrent.futures.ProcessPoolExecutor)
        self._head = packed((stamp, packed(without_table, "the ensemble", shares_main=shares_main)))
        self._done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._pending: dict[Any, tuple[int, int]] = {}
        self._lost: dict[tuple[int, int], BaseException] = {}       # errors of the ranges that were not returned
        self._has_received = False

    def run(self, count: int, look: Callable[[], None]) -> None:
        """Make all ranges, with `count` processes if this module starts them, and call `look` regularly meanwhile."""
        try:
            with self._opened(count) as self._executor:
                try:
                    self._all(look)
                except BaseException:       # Ctrl-C, or a full disk: ranges that have not begun are cancelled
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
        """Wait until all ranges are done or, after one was lost, those that have begun."""
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
        """Receive all finished ranges, including one whose reception Ctrl-C interrupted."""
        for future in list(self._pending):
            if future.done():
                self._receive(future)

    def _fill(self) -> None:
        """Submit ranges until `WINDOW` of them are in progress."""
        while not self._lost and len(self._pending) < WINDOW and (taken := next(self._ranges, None)) is not None:
            try:
                future = self._executor.submit(_made, self._head, packed(self._runs.table(*taken)))
            except RuntimeError as error:       # the executor was shut down, or all its processes died
                self._lost[taken] = error
                return
            self._pending[future] = taken
            future.add_done_callback(self._done.put)

    def _receive(self, future: Any) -> None:
        """Pass on the part of a finished future, or record its error; then remove it from the pending ones."""
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
        """Error to raise for lost ranges: that of a worker of this module, else that of the first range."""
        (first, last), error = min(self._lost.items(), key=lambda pair: pair[0])
        if isinstance(error, WorkerLost | TypeError):
            return error
        why = described(error, code=False).rstrip(": ")
        others = f", nor {len(self._lost) - 1} other portions" if len(self._lost) > 1 else ""
        hint = "" if self._has_received or not isinstance(error, BrokenExecutor) else (
            '; a script must start processes below `if __name__ == "__main__":`')
        return WorkerLost(f"the executor did not return the runs {first} ... {last - 1}{others}: {why}{hint}")

    def _cancel(self) -> None:
        """Cancel ranges that have not begun; the caller waits for the others."""
        for future in list(self._pending):
            if not future.cancelled() and future.cancel():      # those that the executor itself cancelled count as lost
                self._pending.pop(future, None)


def _result(future: Any) -> Any:
    """Part of a finished future, or its error."""
    if future.cancelled():
        return CancelledError("cancelled by the executor")
    error = future.exception()
    return error if error is not None else unpacked(future.result())


class _Processes(AbstractContextManager):
    """Processes on this machine. A shared flag tells them of Ctrl-C, as the signal of a notebook does not reach them."""

    def __init__(self, count: int) -> None:
        context = multiprocessing.get_context("spawn")
        self._flag = context.Event()
        self._pool = concurrent.futures.ProcessPoolExecutor(count, context, initializer=_listen, initargs=(self._flag,))

    def __enter__(self) -> Executor:
        return self._pool

    def __exit__(self, kind: Any, *_: Any) -> None:
        if kind is not None:
            self._flag.set()
        self._pool.shutdown(wait=True, cancel_futures=True)


# ---- in the worker ----


def _listen(flag: Any) -> None:
    """Initializer of each process: ignore Ctrl-C, which the main process handles, and read the flag instead."""
    global _is_cancelled
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _is_cancelled = flag.is_set


def _made(head: bytes, table: bytes) -> bytes:
    """Runs of a table, pickled; or the error that prevents them on this worker, pickled."""
    try:
        plan = _plan(head)
        plan = plan.over(plan.runs.with_table(unpacked(table)))
        kept = "what is kept of a run" if plan.reduce is None else f"what {named(plan.reduce)} returned of a run"
        return packed(run_range(plan, 0, plan.runs.count, _is_cancelled), kept)
    except (ImportError, WorkerLost) as error:
        return packed(WorkerLost(f"{sentence(error)} (on {platform.node()})"))
    except TypeError as error:      # a value of reduce that cannot be pickled
        return packed(TypeError(str(error)))
    except KeyboardInterrupt:       # without its solution, which is not sent back
        raise KeyboardInterrupt from None


@functools.lru_cache(FORGETS)
def _plan(head: bytes) -> Plan:
    stamp, plan = unpacked(head)
    check_stamp(stamp)
    return unpacked(plan)


def check_stamp(stamp: dict[str, Any]) -> None:
    """Check that runs on this worker are bitwise those of the process that began the ensemble: version and vector unit."""
    if stamp["version"] != version():
        raise WorkerLost(f"this worker has another zerodrift, {version()}, than the process that began the ensemble, "
                         f"{stamp['version']}; install the same")
    unit, units = stamp["vector"], VECTOR_UNITS[:gateway.PROCESSOR_UNIT + 1]
    if unit not in units:
        raise WorkerLost(f'the processor of this worker has no {unit}, with which the ensemble began: vector="avx2" | '
                            f'"baseline" takes one that all have; here there is {" and ".join(units)}')
