"""Memory of the outputs of an ensemble: checked before the runs and as parts arrive; outputs that remain in files."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CostWarning, NoMemory, NoSpace, WrongName
from ..runs.samples import memory as free_space
from ..runs.samples.recording import UNCHECKED_BYTES
from ..runs.samples.saving import read_arrays

IN_STORE = 0.5      # outputs that take more than this part of the free memory stay in the files of a store
LESS = "keep fewer outputs or times (outputs, t_eval, save_every), or a value of each run (reduce)"


def check(sizes: Sequence[int] | None, runs: int, store: Path | None, stacklevel: int) -> None:
    """Check that outputs fit into memory, or on the disk of a store. `sizes` in bytes, None if not known in advance.

    Outputs are joined one after the other when all runs are done: memory for the largest of them is needed besides.
    """
    size = sum(sizes or ())
    if not sizes or size <= UNCHECKED_BYTES:
        return
    takes = f"the outputs of {runs} runs take {free_space.in_words(size)}"
    if store is not None:
        if size > (on_disk := free_space.free_disk(store)):
            raise NoSpace(f"{takes}, and {free_space.in_words(on_disk)} are free in {store}: {LESS}")
        return
    if (free := free_space.free_memory()) is None:
        return
    most = size + max(sizes)
    sentence = (f"{takes}, {free_space.in_words(most)} while they are joined, and {free_space.in_words(free)} of memory are "
                f"free: {LESS}, or write them to a folder (store)")
    if most > free:
        raise NoMemory(sentence)
    if most > free / 2:
        warnings.warn(sentence, CostWarning, stacklevel=stacklevel + 1)


def size_of(part: Any) -> int:
    """Bytes in memory of the outputs of a part, and of its times if they differ between runs."""
    times = 0 if part.is_shared else part.t.nbytes
    return times + (0 if isinstance(part.arrays, InFile) else sum(array.nbytes for array in part.arrays.values()))


def shortage(size: int, runs: int) -> str:
    """Message of the MemoryError that stops an ensemble."""
    free = free_space.in_words(free_space.free_memory() or 0)
    return (f"the outputs of {runs} runs, which are done, take {free_space.in_words(size)}, and {free} of memory are free: "
            f"{LESS}, or write them to a folder (store)")


def exceeds(size: int, part: float) -> bool:
    """True if outputs of `size` bytes in memory exceed the fraction `part` of the memory that is still free."""
    return size > UNCHECKED_BYTES and (free := free_space.free_memory()) is not None and size > part * free


class InFile(Mapping):
    """Outputs of a part in its file, read at access.

    Parameters
    ----------
    path : Path
    places : dict of str to str
        The array of each output in the file.
    rows : slice
        Rows of the file that belong to the part.
    """

    def __init__(self, path: Path, places: Mapping[str, str], rows: slice) -> None:
        self._path, self._places, self._rows = path, places, rows

    def __getitem__(self, name: str) -> np.ndarray:
        return read_arrays(self._path, (self._places[name],))[self._places[name]][self._rows]

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def between(self, begin: int, end: int) -> InFile:
        """The same outputs for a range of samples."""
        return InFile(self._path, self._places, slice(self._rows.start + begin, self._rows.start + end))


class Joined(Mapping):
    """Outputs of several parts, some in files: each output is joined in memory at access.

    Parameters
    ----------
    names : sequence of str
    parts : sequence of mappings of str to ndarray
    rows : int
        Number of rows of all parts together.
    """

    def __init__(self, names: Sequence[str], parts: Sequence[Mapping[str, np.ndarray]], rows: int) -> None:
        self._names, self._parts, self._rows = tuple(names), parts, rows

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._names:
            raise WrongName(f"no output is called {name!r}; there are {', '.join(self._names)}", "wrong-name")
        found: np.ndarray | None = None
        begin = 0
        for part in self._parts:
            array = part[name]
            if found is None:
                found = self._empty(name, array)
            found[begin:begin + len(array)] = array
            begin += len(array)
        assert found is not None        # as there are parts
        return found

    def _empty(self, name: str, like: np.ndarray) -> np.ndarray:
        """Uninitialized array for all samples of an output; MemoryError if it exceeds the free memory."""
        size = self._rows * int(np.prod(like.shape[1:])) * like.itemsize
        if size > UNCHECKED_BYTES and (free := free_space.free_memory()) is not None and size > free:
            raise NoMemory(f"output {name!r} of all runs takes {free_space.in_words(size)}, and {free_space.in_words(free)} "
                           "of memory are free: ens[i] makes a run again, and each file of the store has outputs of some runs")
        return np.empty((self._rows, *like.shape[1:]), like.dtype)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def some(arrays: Any, begin: int, end: int) -> Any:
    """Outputs of a part for a range of samples."""
    if isinstance(arrays, InFile):
        return arrays.between(begin, end)
    return {name: array[begin:end] for name, array in arrays.items()}


def together(names: Sequence[str], parts: Sequence[Any], rows: int, *, release: bool) -> Any:
    """Joined outputs of all parts. With `release`, each is removed from the parts after joining, so that it is in memory once."""
    if any(isinstance(part, InFile | Joined) for part in parts):
        return Joined(names, parts, rows)
    found = {}
    for name in names:
        found[name] = np.concatenate([part[name] for part in parts])
        for part in parts if release else ():
            del part[name]
    return found
