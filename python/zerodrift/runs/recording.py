"""What the core writes the rows of a run into: memory that there is, or a file."""

from __future__ import annotations

import importlib
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from .. import _gateway
from ..systems.base import BaseSystem
from .outputs import Recorded

FIRST_BLOCK = 1024  # rows of the record to begin with, where the number of steps is not known beforehand
SMALL = 2**26       # bytes of a record, for which nobody looks whether they are there: to look takes as long as a short run


def record_of(core: _gateway.CoreSystem, outputs: _gateway.Outputs | None, rows: int | None, path: Any) -> Any:
    """What the core writes rows into, in memory or in a file."""
    if path:
        return file_of_samples().SampleFile(path, core, outputs, rows)
    check_memory(rows or 0, _gateway.row_bytes(core, outputs), stacklevel=3)
    return _gateway.Record(core, rows or FIRST_BLOCK, outputs)


def check_memory(rows: int, row: int, stacklevel: int) -> None:
    """Whether memory has room for so many rows of so many bytes."""
    if rows * row > SMALL:
        from . import memory  # slow to import

        memory.check_memory(rows, row, stacklevel + 1)


def file_of_samples() -> Any:
    """The module of files that rows are written to; slow to import."""
    return importlib.import_module(".sample_file", __package__)


def locked(path: Any) -> AbstractContextManager:
    """The lock of a file of rows, held while a run writes to it; None: rows are in memory."""
    return nullcontext() if path is None else file_of_samples().locked(path)


def begin_file(record: Any, run: _gateway.Run, system: BaseSystem, span: tuple[float, float],
               chosen: dict[str, Any], recorded: Recorded | None) -> None:
    """What the file says of the run before it has ended."""
    sizes = dict(zip(recorded.names, recorded.core.sizes, strict=True)) if recorded and recorded.core else {}
    record.begin({"settings": chosen, "system": system, "t_span": span}, run.results().sizes, sizes)
