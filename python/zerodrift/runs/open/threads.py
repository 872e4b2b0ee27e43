"""Work distributed over threads of this process, with cancellation."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from ..._private import gateway, webassembly

LOOK = 0.05     # s between checks of keyboard and progress; on some systems a join without timeout ignores Ctrl-C


def processors() -> int:
    """Number of processors that this process may use."""
    if webassembly.IS_USED:
        return 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Threads:
    """Threads that work through a sequence of parts; the first error, or Ctrl-C, stops all of them.

    Parameters
    ----------
    work : callable
        ``work(part, stop)`` does one part; it may return early once ``stop()`` is true, as its result is then discarded.
    parts : iterator
    """

    def __init__(self, work: Callable[[Any, gateway.Stop], None], parts: Iterator[Any]) -> None:
        self._work, self._parts = work, parts
        self._lock, self._stop = threading.Lock(), gateway.Stop()
        self._error: BaseException | None = None

    def run(self, count: int, look: Callable[[], Any]) -> None:
        """Do all parts in `count` threads; meanwhile this thread calls `look` regularly. In WebAssembly this thread does them."""
        if webassembly.IS_USED:
            for part in self._parts:
                self._work(part, self._stop)
                look()
            return
        workers = [threading.Thread(target=self._take, daemon=True) for _ in range(count)]
        try:
            for worker in workers:
                worker.start()
            for worker in workers:
                while worker.is_alive():
                    worker.join(LOOK)
                    look()
            look()
        except BaseException:
            self._stop.set()
            for worker in workers:
                if worker.ident is not None:
                    worker.join()
            raise
        if self._error is not None:
            raise self._error

    def _take(self) -> None:
        try:
            while (taken := self._next()) is not None:
                self._work(taken, self._stop)
        except BaseException as error:      # in an ensemble: not a failed run, but a full disk or Ctrl-C within a user's function
            self._error = self._error or error
            self._stop.set()

    def _next(self) -> Any:
        with self._lock:
            return None if self._stop() else next(self._parts, None)


def side_by_side(work: Callable[[Any, gateway.Stop | None], None], parts: Sequence[Any], look: Callable[[], Any] = int, *,
                 in_threads: bool) -> None:
    """Do all parts in one thread per available processor, or one after the other if they call Python functions."""
    if in_threads and not webassembly.IS_USED:
        Threads(work, iter(parts)).run(min(len(parts), processors()), look)
        return
    for part in parts:
        work(part, None)
        look()
