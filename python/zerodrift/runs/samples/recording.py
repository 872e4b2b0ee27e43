"""Record that the core writes the samples of a run into: in memory or in a file."""

from __future__ import annotations

import importlib
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from ... import _gateway
from ...systems.base import BaseSystem
from ..arguments.outputs import Recorded

FIRST_BLOCK = 1024  # samples of a new record if the number of steps is not known in advance
UNCHECKED_BYTES = 2**26  # bytes of a record below which free memory is not checked: the check takes as long as a short run


def record_of(core: _gateway.CoreSystem, outputs: _gateway.Outputs | None, rows: int | None, path: Any) -> Any:
    """Record for the samples of a run: in the file `path`, or in memory if that is None."""
    if path:
        return file_of_samples().SampleFile(path, core, outputs, rows)
    check_memory(rows or 0, _gateway.row_bytes(core, outputs), stacklevel=4)
    return _gateway.Record(core, rows or FIRST_BLOCK, outputs)


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


def begin_file(record: Any, run: _gateway.Run, system: BaseSystem, span: tuple[float, float],
               chosen: dict[str, Any], recorded: Recorded | None) -> None:
    """Write the header of the file: settings, system, time span and recorded outputs."""
    sizes = dict(zip(recorded.names, recorded.core.sizes, strict=True)) if recorded and recorded.core else {}
    record.begin({"settings": chosen, "system": system, "t_span": span}, run.results().sizes, sizes)
