"""Ctrl-C and progress while the core works: an interrupt reaches functions of the user alone, so that samples stay valid."""

from __future__ import annotations

# Functions of `signal` make members of enumerations of the results of these, which takes half of a short run's time.
import _signal  # type: ignore[import-not-found]
import signal
import threading
from collections.abc import Callable
from types import CodeType, FrameType
from typing import Any

from ..._private import webassembly
from ...errors import MissingPackage, WrongType

INTERRUPT = int(signal.SIGINT)


class Keyboard:
    """While this context lasts, Ctrl-C raises KeyboardInterrupt below the code in `breakable` only; elsewhere it sets `pressed`.

    This applies in the main thread with Python's default handler. A handler that a program has set is left in place, and other
    threads do not receive Ctrl-C.
    """

    def __init__(self, *breakable: CodeType) -> None:
        self.pressed, self._breakable, self._handles_signal = False, breakable, False

    def _press(self, number: int, frame: FrameType | None) -> None:
        self.pressed = True
        while frame is not None:
            if frame.f_code in self._breakable:
                raise KeyboardInterrupt
            frame = frame.f_back

    def __enter__(self) -> Keyboard:
        if (not webassembly.IS_USED and threading.current_thread() is threading.main_thread()
                and _signal.getsignal(INTERRUPT) is signal.default_int_handler):
            _signal.signal(INTERRUPT, self._press)
            self._handles_signal = True
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: Any) -> None:
        if self._handles_signal:
            _signal.signal(INTERRUPT, signal.default_int_handler)
        if error is not None and self.pressed and not isinstance(error, KeyboardInterrupt):
            raise KeyboardInterrupt from error


def progress_of(progress: Any) -> tuple[Callable[[float], None], Callable[[], None]]:
    """Two functions for the argument `progress` of `simulate`: show the completed fraction (0 ... 1), and close the display."""
    if progress is False or progress is None:
        return (lambda part: None), (lambda: None)
    if callable(progress):
        return progress, (lambda: None)
    if progress is not True:
        raise WrongType(f"progress must be True, False or a callable, not {progress!r}")
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise MissingPackage("progress=True shows a bar with tqdm, which is not installed: pip install tqdm") from None
    bar = tqdm(total=1.0, bar_format="{percentage:3.0f}%|{bar}| {elapsed}<{remaining}")

    def show(part: float) -> None:
        bar.n = part
        bar.refresh()

    return show, bar.close
