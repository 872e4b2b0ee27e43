"""Work in the threads of this process, which can be stopped."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from .. import _gateway

LOOK = 0.05     # s between looks at the keyboard and the progress; a join without an end is deaf to Ctrl-C on some machines


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Threads:
    """Threads that take part after part of some work; the first thing that goes wrong, or Ctrl-C, stops all of them.

    Parameters
    ----------
    work : callable
        ``work(part, stop)`` does one; what it does is of no use any more once ``stop()`` is true.
    parts : iterator
    """

    def __init__(self, work: Callable[[Any, _gateway.Stop], None], parts: Iterator[Any]) -> None:
        self._work, self._parts = work, parts
        self._lock, self._error, self._stop = threading.Lock(), None, _gateway.Stop()

    def run(self, count: int, look: Callable[[], None]) -> None:
        """All parts, in so many threads; meanwhile `look` is called now and then in this one."""
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
        except BaseException as error:      # of ensembles what is no failed run: a full disk, Ctrl-C within a user's function
            self._error = self._error or error
            self._stop.set()

    def _next(self) -> Any:
        with self._lock:
            return None if self._stop() else next(self._parts, None)


def side_by_side(work: Callable[[Any, _gateway.Stop | None], None], parts: Sequence[Any], look: Callable[[], None] = int, *,
                 in_threads: bool) -> None:
    """All parts in as many threads as this process may use; or one after the other here, as Python has to take turns in them."""
    if in_threads:
        Threads(work, iter(parts)).run(min(len(parts), processors()), look)
        return
    for part in parts:
        work(part, None)
        look()
