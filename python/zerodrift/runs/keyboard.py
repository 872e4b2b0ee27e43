"""Ctrl-C during a run: it breaks into what users wrote and nowhere else, so that all that was computed stays intact."""

from __future__ import annotations

import signal
import threading
from types import CodeType, FrameType
from typing import Any

# Python's own functions, without what makes members of enumerations of their results: that takes longer than a short run.
_handler, _set_handler = (getattr(function, "__wrapped__", function) for function in (signal.getsignal, signal.signal))


class Keyboard:
    """While this context lasts, Ctrl-C raises KeyboardInterrupt below the code in `breakable` only; elsewhere it sets `pressed`.

    That is so in the main thread with Python's own handler; whoever has set another is left alone, and so are other threads,
    which hear nothing of the keyboard.
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
        if (threading.current_thread() is threading.main_thread()
                and _handler(signal.SIGINT) is signal.default_int_handler):
            _set_handler(signal.SIGINT, self._press)
            self._handles_signal = True
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: Any) -> None:
        if self._handles_signal:
            _set_handler(signal.SIGINT, signal.default_int_handler)
        if error is not None and self.pressed and not isinstance(error, KeyboardInterrupt):
            raise KeyboardInterrupt from error
