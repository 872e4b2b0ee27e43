"""Python in WebAssembly, such as Pyodide: it has neither threads and processes, nor signals, nor programs that compile."""

from __future__ import annotations

import sys

from ..errors import WrongValue

IS_USED = sys.platform == "emscripten"


def refuse(argument: str, value: str, hint: str) -> None:
    """Refuse a value of an argument in WebAssembly; elsewhere nothing happens.

    Raises
    ------
    ValueError
        In WebAssembly.
    """
    if IS_USED:
        raise WrongValue(f"{argument} must be {value} in WebAssembly: {hint}")
