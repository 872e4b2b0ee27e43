"""Files of samples: a run appends them while it is running; opening such a file maps it instead of reading it.

Layout: MAGIC, the number of samples (-1 while the run is writing), the length of a JSON text, and that text, which gives the
offset of each column within a sample and the fields of the solution that are known at the start. Samples of equal size follow,
then, after the run has ended, the other fields in the format of `Solution.save`. A killed run leaves the samples written so far.
"""

from __future__ import annotations

import contextlib
import io
import itertools
import json
import os
import struct
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import BadZipFile

import numpy as np

from .. import _check, _gateway
from .._locking import Lock
from .._writing import temporary_beside
from ..systems.base import BaseSystem
from . import memory
from .saving import EVENTS, described, packed, unpacked
from .solution import FIELDS, Solution

SUFFIX = ".zd"
MAGIC = b"zerodrift rows 1"
HEADER = struct.Struct("=16sqq")
UNKNOWN = -1            # number of samples while the run is writing
ALIGNED = 64            # bytes: the samples begin at a multiple of this offset
BLOCK = 2**20           # bytes of samples buffered in memory before they are written; at least one sample
NAMES = {"kinetic": "kinetic_energy", "potential": "potential_energy", "input": "energy_input"}     # of a solution, by column
NOT_IN_ROWS = [name for name in FIELDS if name not in (
    "t", "p", "v", "multipliers", "position_violation", "velocity_violation", "kinetic_energy", "potential_energy",
    "energy_input", "energy_violation", "outputs", *_gateway.COUNTS)]
STOPPED = "stopped from outside, or has not ended yet"
AS_WINDOWS = os.name == "nt"        # files that are open, or mapped into memory, are neither removed nor replaced there


def checked(save_to: Any) -> Path | None:
    """Path from the argument `save_to`, checked: its folder must exist, and an existing file must be a file of samples."""
    if save_to is None:
        return None
    path = Path(_check.instance("save_to", save_to, str | Path, "the path of a file, or None"))
    if path.suffix == ".npz":
        raise ValueError(f"save_to must not end in .npz, which is what Solution.save writes, but {str(path)!r} does")
    path = path if path.suffix == SUFFIX else path.with_name(path.name + SUFFIX)
    if not path.parent.is_dir():
        raise FileNotFoundError(f"save_to must be in a folder that is there, and {str(path.parent)!r} is not")
    if path.exists() and not is_one(path):
        raise FileExistsError(f"save_to must be a new file, or one that a run has written before, which {str(path)!r} is not")
    return path


def is_one(path: str | Path) -> bool:
    """Return whether a file exists and begins like a file of samples."""
    path = Path(path)
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


class SampleFile:
    """Record of a run whose samples are written to a file."""

    def __init__(self, path: Path, core: _gateway.CoreSystem, outputs: _gateway.Outputs | None, rows: int | None) -> None:
        row = _gateway.row_bytes(core, outputs)
        memory.check_disk(rows, row, path.parent)
        most = max(1, BLOCK // row)
        self._record = _gateway.Record(core, most if rows is None else min(most, rows), outputs)
        self._path, self._row, self.rows = path, row, 0

    def begin(self, known: dict[str, Any], position_size: np.ndarray, outputs: Mapping[str, int]) -> None:
        """Write the header: fields of the solution that are known at the start, and the size of each recorded output by name."""
        values = {"status": _gateway.INTERRUPTED, "success": False, "message": STOPPED, "stats": {}, "outputs": (),
                  **dict.fromkeys(EVENTS), **known}
        layout = {"row bytes": self._row, "byte order": sys.byteorder, "columns": self._record.columns,
                  "integers": _gateway.COUNTS, "solution": described(values), "position size": position_size.tolist(),
                  "outputs": outputs}
        content = json.dumps(layout).encode()
        content += b" " * (-(HEADER.size + len(content)) % ALIGNED)
        self._begin = HEADER.size + len(content)
        with _replacing(self._path) as self._file:
            self._put(HEADER.pack(MAGIC, UNKNOWN, len(content)) + content)

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

    grow = keep         # writing empties the buffer

    def join(self) -> None:
        """Map the written samples, without the partial one that a full disk may have left."""
        self._file.truncate(self._begin + self.rows * self._row)    # before it is mapped: Windows cannot truncate a mapped file
        self._opened = _columns(self._file, self._begin, self.rows, self._row, self._record.columns, _gateway.COUNTS)

    def take(self) -> dict[str, np.ndarray]:
        """Columns by name, mapped from the file."""
        return self._opened

    def finish(self, solution: Solution) -> None:
        """Write the number of samples, and after the samples the fields of the solution that are not columns of them."""
        rest = io.BytesIO()
        np.savez(rest, **packed({name: getattr(solution, name) for name in NOT_IN_ROWS} | {"outputs": {}}))
        with self._file:
            self._sync()        # samples reach the disk before the header that counts them
            self._file.seek(0)
            self._put(HEADER.pack(MAGIC, self.rows, self._begin - HEADER.size))
            self._sync()
            self._file.seek(self._begin + self.rows * self._row)
            self._put(rest.getvalue())
            self._sync()

    def _sync(self) -> None:
        os.fsync(self._file.fileno())


def locked(path: Path) -> Lock:
    """Lock of a file of samples, held by the run that writes it."""
    return Lock(path.with_name(f".{path.name}.lock"), f"save_to must be a file that no other run writes to, and {str(path)!r} is "
                "being written by")


@contextlib.contextmanager
def _replacing(path: Path) -> Iterator[Any]:
    """New file that replaces an older one once its header is written; solutions that map the older one stay valid."""
    if AS_WINDOWS:      # an open file cannot be renamed there
        _remove(path)
        yield path.open("x+b", buffering=0)
        return
    temporary = temporary_beside(path)
    file = temporary.open("x+b", buffering=0)
    try:
        yield file
        os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        file.close()
        temporary.unlink(missing_ok=True)
        raise


def _remove(path: Path) -> None:
    """Remove an earlier file. On Windows this fails while a solution maps it."""
    try:
        path.unlink(missing_ok=True)
    except PermissionError as error:
        raise PermissionError(f"save_to cannot replace {str(path)!r} while its samples are in use: a solution that "
                              "reads them, here or in another process, has to go first; or take another name") from error


def _columns(file: Path | BinaryIO, begin: int, rows: int, row: int, columns: Mapping[str, Any],
             integers: Any) -> dict[str, np.ndarray]:
    """Columns of a file by name, mapped into memory: only the parts that are used are read."""
    shape = rows, row // 8
    table = np.asarray(np.memmap(file, float, "r", begin, shape)) if rows else np.empty(shape)
    found = {name: table[:, start:start + int(np.prod(shape))].reshape(rows, *shape) for name, (start, shape) in columns.items()}
    counts = table.view(np.intc)
    return found | {name: counts[:, i - len(integers)] for i, name in enumerate(integers)}


def read(path: str | Path, rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> dict[str, Any]:
    """Fields of the solution in a file, its columns mapped. `rebuilt` makes the system of a mechanism from JSON."""
    path = Path(path)
    with path.open("rb") as file:
        rows, length, layout = _header(path, file.read)
        begin, row = HEADER.size + length, layout["row bytes"]
        if layout["byte order"] != sys.byteorder:
            raise ValueError(f"{path} was written by a machine of another byte order, {layout['byte order']}")
        if has_ended := rows != UNKNOWN:
            file.seek(begin + rows * row)
        else:
            rows = (path.stat().st_size - begin) // row
        rest = _rest(file.read()) if has_ended else {}
    columns = _columns(path, begin, rows, row, layout["columns"], layout["integers"])
    description = json.loads(str(rest.pop("zerodrift"))) if rest else layout["solution"] | {"message": _stopped(columns["t"])}
    arrays = rest or {"position_size": np.array(layout["position size"])}
    outputs = _split(columns.pop("outputs", None), layout["outputs"])
    energies = dict.fromkeys(("potential_energy", "energy_input", "energy_violation"))
    named = {NAMES.get(name, name): column for name, column in columns.items()}
    return unpacked(description, arrays, rebuilt) | energies | named | {"outputs": outputs}


def _header(path: Path, take: Callable[[int], bytes]) -> tuple[int, int, dict[str, Any]]:
    """Number of samples, length of the JSON text, and that text parsed."""
    try:
        _, rows, length = HEADER.unpack(take(HEADER.size))
        return rows, length, json.loads(take(length))
    except (struct.error, ValueError) as error:
        raise ValueError(f"{path} cannot be read: its header must be whole ({error})") from None


def _rest(content: bytes) -> dict[str, np.ndarray]:
    """Fields written after the samples; empty if they are incomplete."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return dict(file)
    except (BadZipFile, EOFError, ValueError):
        return {}


def _stopped(t: np.ndarray) -> str:
    """Message of a run that did not end."""
    return f"{STOPPED}: there are " + (f"{len(t)} samples, the last at t = {t[-1]:.6g}" if len(t) else "no samples")


def _split(rows: np.ndarray | None, sizes: Mapping[str, int]) -> dict[str, np.ndarray]:
    """Measures by name, (k,) or (k, size) each, from the samples (k, sum of sizes) of all of them."""
    ends = itertools.accumulate(sizes.values())
    parts = {name: rows[:, end - size:end] for (name, size), end in zip(sizes.items(), ends, strict=True)}
    return {name: part[:, 0] if part.shape[1] == 1 else part for name, part in parts.items()}
