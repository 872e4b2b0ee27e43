"""Record that the core writes the samples of a run into: in memory or in a file."""

from __future__ import annotations

import importlib
from contextlib import AbstractContextManager, nullcontext
from typing import Any

FIRST_BLOCK = 1024  # samples of a new record if the number of steps is not known in advance
UNCHECKED_BYTES = 2**26  # bytes of a record below which free memory is not checked: the check takes as long as a short run


def check_memory(rows: int, row: int, stacklevel: int) -> None:
    """Check that memory has room for `rows` samples of `row` bytes; see `memory.check_memory`."""
    if rows * row > UNCHECKED_BYTES:
        from . import memory  # slow to import

        memory.check_memory(rows, row, stacklevel + 1)


def file_of_samples() -> Any:
    """Module of files of samples; imported at first use, as that is slow."""
    return importlib.import_module(".sample_file", __package__)


def locked(path: Any) -> AbstractContextManager:
    """Lock of a file of samples, held while a run writes to it; without effect for a record in memory (None)."""
    return nullcontext() if path is None else file_of_samples().locked(path)
