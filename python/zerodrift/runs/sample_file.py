"""Files of rows: a run writes them as they come, and they are opened without being read.

A file begins with MAGIC, how many rows it has (-1 while they come) and the length of what follows, a text in JSON: where the
numbers of each column stand in a row, and all that was known of the run beforehand. Rows of one size come next, one behind the
other, and once the run has ended what is known only then, as `Solution.save` writes it. A run that was killed has left the
rows that it had.
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
UNKNOWN = -1            # rows, while they come
ALIGNED = 64            # bytes: where rows begin is a multiple
BLOCK = 2**20           # bytes of rows that are kept in memory before they are written, or one row
NAMES = {"kinetic": "kinetic_energy", "potential": "potential_energy", "input": "energy_input"}     # of a solution, by column
NOT_IN_ROWS = [name for name in FIELDS if name not in (
    "t", "p", "v", "multipliers", "position_violation", "velocity_violation", "kinetic_energy", "potential_energy",
    "energy_input", "energy_violation", "outputs", *_gateway.COUNTS)]
STOPPED = "stopped from outside, or has not ended yet"
AS_WINDOWS = os.name == "nt"        # files that are open, or mapped into memory, are neither removed nor replaced there


def checked(save_to: Any) -> Path | None:
    """The file that rows are to be written to: in a folder that is there, and in the place of no other kind of file."""
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
    """Whether a run has written this file."""
    path = Path(path)
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


class SampleFile:
    """What stands for the record of a run, whose rows it writes to a file."""

    def __init__(self, path: Path, core: _gateway.CoreSystem, outputs: _gateway.Outputs | None, rows: int | None) -> None:
        row = _gateway.row_bytes(core, outputs)
        memory.check_disk(rows, row, path.parent)
        most = max(1, BLOCK // row)
        self._record = _gateway.Record(core, most if rows is None else min(most, rows), outputs)
        self._path, self._row, self.rows = path, row, 0

    def begin(self, known: dict[str, Any], position_size: np.ndarray, outputs: Mapping[str, int]) -> None:
        """Writes what is known of the solution beforehand; outputs are the names of what is recorded, with their sizes."""
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
        """Writes all of it: a file that is not buffered takes as much as the system likes."""
        left = memoryview(content).cast("B")
        while left:
            left = left[self._file.write(left):]

    next_rows = 0           # none of them in memory

    @property
    def row_bytes(self) -> int:
        """Of one row."""
        return self._row

    @property
    def c(self) -> Any:
        """What the core writes into."""
        return self._record.c

    def keep(self) -> None:
        """Writes what has come."""
        rows = self._record.pack()
        if len(rows):
            self._put(rows)
            self.rows += len(rows)

    grow = keep         # what is written makes room

    def join(self) -> None:
        """Opens what has been written, without the part of a row that is there where the disk was full."""
        self._file.truncate(self._begin + self.rows * self._row)    # now, as Windows shortens no file that is mapped
        self._opened = _columns(self._file, self._begin, self.rows, self._row, self._record.columns, _gateway.COUNTS)

    def take(self) -> dict[str, np.ndarray]:
        """The columns, which are in the file."""
        return self._opened

    def finish(self, solution: Solution) -> None:
        """Writes how many rows there are, and behind them the fields of the solution that are not in rows."""
        rest = io.BytesIO()
        np.savez(rest, **packed({name: getattr(solution, name) for name in NOT_IN_ROWS} | {"outputs": {}}))
        with self._file:
            self._sync()        # a machine that stops leaves no header that counts rows which are not on the disk
            self._file.seek(0)
            self._put(HEADER.pack(MAGIC, self.rows, self._begin - HEADER.size))
            self._sync()
            self._file.seek(self._begin + self.rows * self._row)
            self._put(rest.getvalue())
            self._sync()

    def _sync(self) -> None:
        os.fsync(self._file.fileno())


def locked(path: Path) -> Lock:
    """The lock of a file, held by the run that writes to it."""
    return Lock(path.with_name(f".{path.name}.lock"), f"save_to must be a file that no other run writes to, and {str(path)!r} is "
                "being written by")


@contextlib.contextmanager
def _replacing(path: Path) -> Iterator[Any]:
    """A new file, which replaces an older one once its header is written; solutions that have that open keep its rows."""
    if AS_WINDOWS:      # where no file is renamed that is open
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
    """Removes an earlier file; a solution that reads its rows keeps the file from being removed on Windows."""
    try:
        path.unlink(missing_ok=True)
    except PermissionError as error:
        raise PermissionError(f"save_to cannot replace {str(path)!r} while its rows are in use: a solution that reads them, here "
                              "or in another process, has to go first; or take another name") from error


def _columns(file: Path | BinaryIO, begin: int, rows: int, row: int, columns: Mapping[str, Any],
             integers: Any) -> dict[str, np.ndarray]:
    """The columns of a file, by name, as memory that is read where it is looked at."""
    shape = rows, row // 8
    table = np.asarray(np.memmap(file, float, "r", begin, shape)) if rows else np.empty(shape)
    found = {name: table[:, start:start + int(np.prod(shape))].reshape(rows, *shape) for name, (start, shape) in columns.items()}
    counts = table.view(np.intc)
    return found | {name: counts[:, i - len(integers)] for i, name in enumerate(integers)}


def read(path: str | Path, rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> dict[str, Any]:
    """The fields of the solution in a file; its columns stay there. `rebuilt` makes the system of a mechanism."""
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
    """How many rows a file has, the length of its text, and that."""
    try:
        _, rows, length = HEADER.unpack(take(HEADER.size))
        return rows, length, json.loads(take(length))
    except (struct.error, ValueError) as error:
        raise ValueError(f"{path} cannot be read: its header must be whole ({error})") from None


def _rest(content: bytes) -> dict[str, np.ndarray]:
    """What stands behind the rows; nothing where it is not whole."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return dict(file)
    except (BadZipFile, EOFError, ValueError):
        return {}


def _stopped(t: np.ndarray) -> str:
    """What became of a run that did not end."""
    return f"{STOPPED}: there are " + (f"{len(t)} rows, the last at t = {t[-1]:.6g}" if len(t) else "no rows")


def _split(rows: np.ndarray | None, sizes: Mapping[str, int]) -> dict[str, np.ndarray]:
    """Each measure by its name, (k,), or (k, size) of a vector, from the rows of all."""
    ends = itertools.accumulate(sizes.values())
    parts = {name: rows[:, end - size:end] for (name, size), end in zip(sizes.items(), ends, strict=True)}
    return {name: part[:, 0] if part.shape[1] == 1 else part for name, part in parts.items()}
