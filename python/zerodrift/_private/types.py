"""Types of arguments: `types.pyi` declares them for type checkers and editors, and any of them is Any at run time."""

from typing import Any


def __getattr__(name: str) -> Any:
    if name.startswith("__"):
        raise AttributeError(name)
    return Any
