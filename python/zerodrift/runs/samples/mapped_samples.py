"""Reading files of samples: their columns are mapped instead of read, so that they may exceed memory.

A run writes two files, see `sample_file`.
"""

from __future__ import annotations

import io
import itertools
import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import BadZipFile

import numpy as np

from ..._private import gateway
from ...errors import WrongValue, sentence
from ...systems.base import BaseSystem
from .saving import JUMPS, transitions, unpacked

FORMAT = "zerodrift samples"        # key of the description, with the number of the format
MAGIC = b"\x93NUMPY"
NAMES = {"kinetic": "kinetic_energy", "potential": "potential_energy", "input": "energy_input"}     # of a solution, by column
STOPPED = "stopped from outside, or has not ended yet"


def description_of(path: Path) -> Path:
    """Path of the JSON file that belongs to a file of samples."""
    return path.with_suffix(".json")


def is_one(path: Path) -> bool:
    """Return whether a file is a file of samples: NPY with a description beside it."""
    return _begins(path, MAGIC) and is_description(description_of(path))


def _begins(path: Path, text: bytes) -> bool:
    """Return whether there is a file that begins so, apart from leading blanks and braces of JSON."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(100).lstrip(b"{ \n").startswith(text)


def is_description(path: Path) -> bool:
    """Return whether a file describes samples."""
    return _begins(path, f'"{FORMAT}"'.encode())


def columns(file: Path | BinaryIO, begin: int, rows: int, row: int, of: Mapping[str, Any],
            integers: Any) -> dict[str, np.ndarray]:
    """Columns of a file by name, mapped into memory: only the parts that are used are read."""
    shape = rows, row // 8
    table = np.asarray(np.memmap(file, float, "r", begin, shape)) if rows else np.empty(shape)
    found = {name: table[:, start:start + int(np.prod(shape))].reshape(rows, *shape) for name, (start, shape) in of.items()}
    counts = table.view(np.intc)
    return found | {name: counts[:, i - len(integers)] for i, name in enumerate(integers)}


def read(path: str | Path, rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> dict[str, Any]:
    """Fields of the solution in a file, its columns mapped. `rebuilt` makes the system of a mechanism from JSON."""
    path = Path(path)
    with path.open("rb") as file:
        begin, rows, layout = _header(path, file)
        if layout["byte order"] != sys.byteorder:
            raise WrongValue(f"{path} was written by a machine of another byte order, {layout['byte order']}", "unreadable-file")
        row = layout["row bytes"]
        rows = min(rows, (path.stat().st_size - begin) // row)
        file.seek(begin + rows * row)
        rest = _rest(file.read())
    found = columns(path, begin, rows, row, layout["columns"], layout["integers"])
    description = json.loads(str(rest.pop("zerodrift"))) if rest else _unfinished(layout["solution"], found["t"])
    arrays = rest or {"position_size": np.array(layout["position size"]), "jumps": np.zeros(0, JUMPS),
                      "transitions": transitions()}
    solution, outputs = unpacked(description, arrays, rebuilt), _split(found.pop("outputs", None), layout["outputs"])
    energies = dict.fromkeys(("potential_energy", "energy_input", "energy_violation"))
    named = {NAMES.get(name, name): column for name, column in found.items()}
    return solution | energies | named | {"outputs": outputs | solution["outputs"]}


def _header(path: Path, file: BinaryIO) -> tuple[int, int, dict[str, Any]]:
    """Offset of the first sample, number of samples, and the description that lies beside the file."""
    beside = description_of(path)
    try:
        version = np.lib.format.read_magic(file)
        (rows,), _, sample = np.lib.format.read_array_header_1_0(file) if version == (1, 0) else ((0,), False, np.dtype(float))
        layout = json.loads(beside.read_bytes())
        if sample.itemsize != layout["row bytes"]:
            raise WrongValue(f"{beside.name} must describe samples of {sample.itemsize} bytes, not {layout['row bytes']}",
                             "unreadable-file")
    except (ValueError, KeyError) as error:
        raise WrongValue(f"{path} cannot be read: its header must be whole ({sentence(error)})", "unreadable-file") from None
    return file.tell(), rows, layout


def _rest(content: bytes) -> dict[str, np.ndarray]:
    """Fields written after the samples; empty if they are incomplete."""
    if content[:2] != b"PK":        # NumPy would take samples for other formats
        return {}
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return dict(file)
    except (BadZipFile, EOFError, ValueError):
        return {}


def _unfinished(description: dict[str, Any], t: np.ndarray) -> dict[str, Any]:
    """Description of a run that did not end."""
    message = f"{STOPPED}: there are " + (f"{len(t)} samples, the last at t = {t[-1]:.6g}" if len(t) else "no samples")
    return description | {"status": gateway.INTERRUPTED, "success": False, "message": message, "stats": {}}


def _split(rows: np.ndarray | None, sizes: Mapping[str, int]) -> dict[str, np.ndarray]:
    """Measures by name, (k,) or (k, size) each, from the samples (k, sum of sizes) of all of them."""
    if rows is None:
        return {}
    ends = itertools.accumulate(sizes.values())
    parts = {name: rows[:, end - size:end] for (name, size), end in zip(sizes.items(), ends, strict=True)}
    return {name: part[:, 0] if part.shape[1] == 1 else part for name, part in parts.items()}
