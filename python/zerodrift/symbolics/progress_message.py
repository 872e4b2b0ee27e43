"""Progress messages of derivations and compilations that take long."""

from __future__ import annotations

import sys
import threading
import time
from types import TracebackType

PATIENCE = 2.0      # s


class Progress:
    """Report the current stage on stderr once it has taken two seconds; nothing if `shown` is False."""

    def __init__(self, name: str, shown: bool) -> None:
        self._name, self._shown, self._what = name, shown, ""
        self._start, self._over, self._said = time.monotonic(), threading.Event(), False
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Progress:
        return self

    def __call__(self, what: str) -> None:
        """Set the stage that is reported from now on."""
        first, self._what = not self._what, what
        if first and self._shown:
            self._thread.start()
        elif self._said:
            self._say()

    def _watch(self) -> None:
        if not self._over.wait(PATIENCE):
            self._said = True
            self._say()

    def _say(self) -> None:
        spent = time.monotonic() - self._start
        print(f"zerodrift: {self._name}: {self._what} ({spent:.0f} s so far)", file=sys.stderr, flush=True)

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._over.set()
        if self._what and self._shown:
            self._thread.join()
