"""Parts of an ensemble in the threads of this process."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from typing import Any

from .. import _gateway
from .part import Part
from .plan import Plan
from .run_range import run_range

LOOK = 0.05     # s between looks at the keyboard and the progress; a join without an end is deaf to Ctrl-C on some machines


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Threads:
    """Threads that take range after range; the first thing that goes wrong, or Ctrl-C, stops all of them."""

    def __init__(self, plan: Plan, ranges: Iterator[tuple[int, int]], finished: Callable[[int, Part], None]) -> None:
        self._plan, self._ranges, self._finished = plan, ranges, finished
        self._lock, self._error, self._stop = threading.Lock(), None, _gateway.Stop()

    def run(self, count: int, look: Callable[[], None]) -> None:
        """All ranges, in so many threads; meanwhile `look` is called now and then in this one."""
        workers = [threading.Thread(target=self._work, daemon=True) for _ in range(count)]
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

    def _work(self) -> None:
        try:
            while (taken := self._next()) is not None:
                self._finished(taken[0], run_range(self._plan, *taken, self._stop))
        except BaseException as error:      # what is no failed run: a full disk, or Ctrl-C within a user's function
            self._error = error
            self._stop.set()

    def _next(self) -> Any:
        with self._lock:
            return None if self._stop() else next(self._ranges, None)
