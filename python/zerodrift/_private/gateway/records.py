"""Records of runs: the arrays that the core writes samples into."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...errors import NoMemory
from ..core import ffi
from .measures import Outputs
from .systems import CoreSystem

# Types that every record needs: their names are read once.
RECORD, DOUBLES, INTEGERS = map(ffi.typeof, ("zd_record *", "double[]", "int *"))
COUNTS = ("iterations", "energy_skipped")     # the integers of a row


class _Layout(NamedTuple):
    """Layout of the columns of a record in one array, one after the other; counts are last, two per double."""

    shapes: dict[str, tuple[int, ...]]      # of a sample's numbers
    starts: dict[str, int]                  # doubles of a sample before those of this column
    width: int                              # doubles of a sample


@functools.lru_cache
def _layout(nq: int, nv: int, mh: int, m: int, has_energy: bool, outputs: int | None) -> _Layout:
    energies = {"potential": (), "input": (), "energy_violation": ()} if has_energy else {}
    shapes = {"t": (), "p": (nq,), "v": (nv,), "multipliers": (m,), "position_violation": (mh,), "velocity_violation": (m,),
              "kinetic": (), **energies, **({} if outputs is None else {"outputs": (outputs,)})}
    ends = list(itertools.accumulate(map(math.prod, shapes.values()), initial=0))
    return _Layout(shapes, dict(zip(shapes, ends, strict=False)), ends[-1] + 1)


def row_bytes(core: CoreSystem, outputs: Outputs | None = None) -> int:
    """Bytes of a sample of the record."""
    return 8 * _layout_of(core, outputs).width


def _layout_of(core: CoreSystem, outputs: Outputs | None) -> _Layout:
    return _layout(core.nq, core.nv, core.mh, core.m, core.has_energy, outputs.width if outputs else None)


class Record:
    """The arrays a run writes into, one row per saved instant: a block of them, and further ones as long as they are needed.

    The columns of the first block are views of one array, which takes a fraction of the time of as many arrays: most runs are
    short, and need no other. Those of further blocks are arrays of their own, which can be let go one by one.
    """

    def __init__(self, core: CoreSystem, capacity: int, outputs: Outputs | None = None) -> None:
        self._layout = _layout_of(core, outputs)
        self._memory = self._taken(capacity, np.empty, self._layout.width * capacity)
        c = self.c = self._first = ffi.new(RECORD)
        self._further: list[tuple[Any, dict[str, np.ndarray]]] = []
        self._joined: dict[str, np.ndarray] = {}
        c.capacity, start = capacity, ffi.from_buffer(DOUBLES, self._memory)
        for name, doubles_before in self._layout.starts.items():
            setattr(c, name, start + doubles_before * capacity)
        c.iterations = ffi.cast(INTEGERS, start + (self._layout.width - 1) * capacity)
        c.energy_skipped = c.iterations + capacity

    def _taken(self, capacity: int, take: Callable[..., Any], *given: Any) -> Any:
        """Allocate memory for this number of samples."""
        try:
            return take(*given)
        except (MemoryError, ValueError):
            size = capacity * (self._layout.width - 0.5) * 8 / 2**30
            raise NoMemory(f"{capacity} samples need {size:.3g} GiB; save fewer with save_every, or write them to a file "
                              "with save_to") from None

    def keep(self) -> None:
        """Do nothing, as the samples are in memory already."""

    def grow(self) -> None:
        """Add a block as large as all blocks before it."""
        capacity = self.next_rows
        columns = self._taken(capacity, self._columns, capacity)
        c = self.c = ffi.new(RECORD, {"capacity": capacity})
        for name, array in columns.items():
            setattr(c, name, ffi.from_buffer("int[]" if name in COUNTS else "double[]", array, require_writable=True))
        self._further.append((c, columns))

    def _columns(self, capacity: int) -> dict[str, np.ndarray]:
        # One expression: where memory ends within it, the traceback keeps nothing of what was taken.
        shapes = self._layout.shapes
        return {name: np.empty((capacity, *shapes.get(name, ())), np.intc if name in COUNTS else float)
                for name in (*shapes, *COUNTS)}

    def take(self) -> dict[str, np.ndarray]:
        """Samples written so far."""
        return self._joined or self._of_first()

    @property
    def row_bytes(self) -> int:
        """Bytes of one sample."""
        return 8 * self._layout.width

    @property
    def next_rows(self) -> int:
        """Number of samples for which `grow` allocates memory."""
        return self._first.capacity + sum(c.capacity for c, _ in self._further)

    @property
    def columns(self) -> dict[str, tuple[int, tuple[int, ...]]]:
        """Offset and shape of each column in a sample, except the counts."""
        return {name: (self._layout.starts[name], shape) for name, shape in self._layout.shapes.items()}

    def pack(self) -> np.ndarray:
        """Remove and return the samples of the first block (samples, width), the counts as two integers in the last column."""
        columns = self._of_first()
        packed = np.empty((self._first.samples, self._layout.width))
        for name, (start, shape) in self.columns.items():
            width = math.prod(shape)
            packed[:, start:start + width] = columns[name].reshape(len(packed), width)
        packed.view(np.intc)[:, -2:] = np.column_stack([columns[name] for name in COUNTS])
        self._first.samples = 0
        return packed

    def _of_first(self) -> dict[str, np.ndarray]:
        """The columns of the first block."""
        rows, capacity, memory = self._first.samples, self._first.capacity, self._memory
        columns = {name: memory[start * capacity:start * capacity + rows * math.prod(shape)].reshape(rows, *shape)
                   for (name, start), shape in zip(self._layout.starts.items(), self._layout.shapes.values(), strict=True)}
        counts = memory[(self._layout.width - 1) * capacity:].view(np.intc)
        return columns | {"iterations": counts[:rows], "energy_skipped": counts[capacity:capacity + rows]}

    def snapshot(self) -> Snapshot:
        """Copy of the samples so far, for a run that goes on recording."""
        first = self._of_first()
        return Snapshot({name: np.concatenate([column, *(columns[name][: c.samples] for c, columns in self._further)])
                         for name, column in first.items()})

    def join(self) -> None:
        """Join the blocks column by column, releasing the joined parts, as memory may be short."""
        if not self._further:
            return
        for name, first in self._of_first().items():
            self._joined[name] = np.concatenate([first, *(columns[name][: c.samples] for c, columns in self._further)])
            for _, columns in self._further:
                del columns[name]
        self._further.clear()


class Snapshot(NamedTuple):
    """Samples of a run by name, as `Record` gives them."""

    columns: dict[str, np.ndarray]

    def join(self) -> None:
        """Do nothing, as there is one block."""

    def take(self) -> dict[str, np.ndarray]:
        """The samples."""
        return self.columns
