"""Files of samples: a run appends them while it is running; opening such a file maps it instead of reading it.

``run.npy`` is an array of NumPy with a structured type, one field per column, which `numpy.load` opens, also with ``mmap_mode``.
Its header has room for the largest number of samples and is rewritten after each flush, so that a killed run leaves what it
flushed. After the array follow, once the run has ended, inputs and the other fields in the format of `Solution.save`.
``run.json`` has offset and shape of each column, recorded outputs, and the fields of the solution that are known at the start.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..._private import checks, gateway
from ..._private.locking import Lock
from ..._private.writing import temporary_beside, with_suffix
from ...errors import ExistingFile, FileInUse, MissingFile, WrongValue
from . import mapped_samples, memory
from .saving import EVENTS, described, packed
from .solution import FIELDS, Solution

SUFFIX = ".npy"
FORMAT = 2
MAX_ROWS = 2**63 - 1   # the header has room for this number
MAGIC = mapped_samples.MAGIC + bytes((1, 0))        # of NPY, version 1.0
ALIGNED = 64            # bytes: the samples begin at a multiple of this offset
BLOCK = 2**20           # bytes of samples buffered in memory before they are written; at least one sample
NOT_IN_ROWS = [name for name in FIELDS if name not in (
    "t", "p", "v", "multipliers", "position_violation", "velocity_violation", "kinetic_energy", "potential_energy",
    "energy_input", "energy_violation", "outputs", *gateway.COUNTS)]
AS_WINDOWS = os.name == "nt"        # files that are open, or mapped into memory, are neither removed nor replaced there


def checked(save_to: Any) -> Path | None:
    """Path from the argument `save_to`, checked: its folder must exist, and an existing file must be a file of samples."""
    if save_to is None:
        return None
    path = Path(checks.instance("save_to", save_to, str | Path, "the path of a file, or None"))
    if path.suffix == ".npz":
        raise WrongValue(f"save_to must not end in .npz, which is what Solution.save writes, but {str(path)!r} does")
    path = with_suffix(path, SUFFIX)
    if not path.parent.is_dir():
        raise MissingFile(f"save_to must be in a folder that is there, and {str(path.parent)!r} is not")
    beside = mapped_samples.description_of(path)
    for each, is_ours in ((path, mapped_samples.is_one), (beside, mapped_samples.is_description)):
        if each.exists() and not is_ours(each):
            raise ExistingFile(f"save_to must be a new file, or one that a run has written before, which {str(each)!r} is not")
    return path


class SampleFile:
    """Record of a run whose samples are written to a file."""

    def __init__(self, path: Path, core: gateway.CoreSystem, outputs: gateway.Outputs | None, rows: int | None) -> None:
        row = gateway.row_bytes(core, outputs)
        memory.check_disk(rows, row, path.parent)
        most = max(1, BLOCK // row)
        self._record = gateway.Record(core, most if rows is None else min(most, rows), outputs)
        self._path, self._row, self._begin, self.rows = path, row, 0, 0

    def begin(self, known: dict[str, Any], position_size: np.ndarray, outputs: Mapping[str, int]) -> None:
        """Write the header: fields of the solution that are known at the start, and the size of each recorded output by name."""
        layout = {mapped_samples.FORMAT: FORMAT, "row bytes": self._row, "byte order": sys.byteorder,
                  "columns": self._record.columns, "integers": gateway.COUNTS,
                  "position size": position_size.tolist(), "outputs": outputs,
                  "solution": described({"outputs": (), **dict.fromkeys(EVENTS), **known})}
        self._outputs = outputs
        names = {name: mapped_samples.NAMES.get(name, name) for name in self._record.columns}
        self._type = [*((names[name], "=f8", shape) for name, (_, shape) in self._record.columns.items()),
                      *((name, "=i4") for name in gateway.COUNTS)]
        self._begin = len(self._header(MAX_ROWS))
        self._begin += -self._begin % ALIGNED
        with _replacing(self._path, json.dumps(layout).encode()) as self._file:
            self._put(self._header(0))

    def _header(self, rows: int) -> bytes:
        """Header of an NPY file, version 1.0, filled with blanks up to the first sample."""
        text = repr({"descr": np.lib.format.dtype_to_descr(np.dtype(self._type)), "fortran_order": False, "shape": (rows,)})
        length = max(self._begin - len(MAGIC) - 2, len(text) + 1)
        return MAGIC + length.to_bytes(2, "little") + text.ljust(length - 1).encode() + b"\n"

    def _count(self) -> None:
        """Write the number of samples into the header."""
        self._file.seek(0)
        self._put(self._header(self.rows))
        self._file.seek(self._begin + self.rows * self._row)

    def _put(self, content: Any) -> None:
        """Write all bytes: one write to an unbuffered file may be partial."""
        left = memoryview(content).cast("B")
        while left:
            left = left[self._file.write(left):]

    next_rows = 0           # samples to allocate when the record is full: none, as it is written out

    @property
    def row_bytes(self) -> int:
        """Bytes of one sample."""
        return self._row

    @property
    def c(self) -> Any:
        """Record in memory that the core writes into, as a C structure."""
        return self._record.c

    def keep(self) -> None:
        """Write the samples that the core has recorded since the last call."""
        rows = self._record.pack()
        if len(rows):
            self._put(rows)
            self.rows += len(rows)
            self._count()

    grow = keep         # writing empties the buffer

    def join(self) -> None:
        """Map the written samples, without the partial one that a full disk may have left."""
        self._file.truncate(self._begin + self.rows * self._row)    # before it is mapped: Windows cannot truncate a mapped file
        self._opened = mapped_samples.columns(
            self._file, self._begin, self.rows, self._row, self._record.columns, gateway.COUNTS)

    def take(self) -> dict[str, np.ndarray]:
        """Columns by name, mapped from the file."""
        return self._opened

    def finish(self, solution: Solution) -> None:
        """Write the number of samples, and after the samples the fields of the solution that are not columns of them."""
        rest, inputs = io.BytesIO(), {name: values for name, values in solution.outputs.items() if name not in self._outputs}
        fields = packed({name: getattr(solution, name) for name in NOT_IN_ROWS} | {"outputs": inputs})
        np.savez(rest, **fields)        # type: ignore[arg-type]
        with self._file:
            self._file.seek(self._begin + self.rows * self._row)
            self._put(rest.getvalue())
            os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file without the remaining fields, before another one takes its place."""
        self._file.close()


def locked(path: Path) -> Lock:
    """Lock of a file of samples, held by the run that writes it."""
    return Lock(path.with_name(f".{path.name}.lock"), f"save_to must be a file that no other run writes to, and {str(path)!r} is "
                "being written by")


@contextlib.contextmanager
def _replacing(path: Path, description: bytes) -> Iterator[Any]:
    """New file and description, which replace older ones once they are written; solutions that map the older file stay valid."""
    beside = mapped_samples.description_of(path)
    if AS_WINDOWS:      # an open file cannot be renamed there
        _remove(path)
        beside.write_bytes(description)
        yield path.open("x+b", buffering=0)
        return
    temporary, temporary_description = temporary_beside(path), temporary_beside(path)
    file = temporary.open("x+b", buffering=0)
    try:
        temporary_description.write_bytes(description)
        yield file
        os.fsync(file.fileno())
        path.unlink(missing_ok=True)        # so that no samples are ever beside the description of others
        os.replace(temporary_description, beside)
        os.replace(temporary, path)
    except BaseException:
        file.close()
        for each in (temporary, temporary_description):
            each.unlink(missing_ok=True)
        raise


def _remove(path: Path) -> None:
    """Remove an earlier file. On Windows this fails while a solution maps it."""
    try:
        path.unlink(missing_ok=True)
    except PermissionError as error:
        raise FileInUse(f"save_to cannot replace {str(path)!r} while its samples are in use: a solution that "
                              "reads them, here or in another process, must be deleted first; or take another name") from error
