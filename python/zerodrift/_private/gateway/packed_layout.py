"""Block structures of systems: their tables for the core, and the indices of packed matrix entries."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ...errors import WrongValue
from ..core import ffi, lib

PACKED = ("A", "M", "C")        # the terms that are packed
CONSTANT, DIAGONAL = lib.ZD_CONSTANT, lib.ZD_DIAGONAL


class Packing:
    """The blocks, (coordinates, velocities, mass) each, and groups, (rows, blocks) each, of a structure.

    Attributes
    ----------
    shapes : dict of str to tuple of int
        Shapes of A, M and C as in the equations.
    offsets : dict of str to tuple of int
        Offsets, in the packed storage, of each block of A and M and each group of C, followed by the total size.
    """

    def __init__(self, blocks: Sequence[tuple[int, int, int]], groups: Sequence[tuple[int, tuple[int, ...]]]) -> None:
        self.blocks, self.groups = tuple(blocks), tuple(groups)
        self._places, ends = {}, {}
        self._places["A"], self._places["M"], ends["A"], ends["M"] = _of_blocks(*(_whole(b[i] for b in blocks) for i in range(3)))
        self._places["C"], ends["C"] = _of_groups(_whole(b[1] for b in blocks), _whole(rows for rows, _ in groups),
                                                  [touched for _, touched in groups])
        nq, nv, m = sum(b[0] for b in blocks), sum(b[1] for b in blocks), sum(rows for rows, _ in groups)
        self.shapes = {"A": (nq, nv), "M": (nv, nv), "C": (m, nv)}
        self.offsets = {name: tuple(_begins(sizes).tolist()) for name, sizes in ends.items()}
        self._are_dense = {name for name, (rows, columns) in self.shapes.items()
                           if self.size(name) == rows * columns and self.places(name) == list(range(rows * columns))}

    @classmethod
    def of(cls, c: Any) -> Packing | None:
        """Packing of a `zd_structure *`; None if it is NULL."""
        if not c:
            return None
        coordinates, velocities = ffi.unpack(c.coordinates, c.blocks), ffi.unpack(c.velocities, c.blocks)
        mass = ffi.unpack(c.mass, c.blocks) if c.mass else [0] * c.blocks
        rows, first = (ffi.unpack(c.rows, c.groups), ffi.unpack(c.first, c.groups + 1)) if c.groups else ([], [0])
        block = ffi.unpack(c.block, first[-1]) if first[-1] else []
        touched = [tuple(block[begin:end]) for begin, end in pairwise(first)]
        return cls(list(zip(coordinates, velocities, mass, strict=True)), list(zip(rows, touched, strict=True)))

    def c(self) -> tuple[Any, Any]:
        """A `zd_structure *`, and the memory to keep with it."""
        first = np.cumsum([0, *(len(touched) for _, touched in self.groups)])
        arrays = {"coordinates": [b[0] for b in self.blocks], "velocities": [b[1] for b in self.blocks],
                  "mass": [b[2] for b in self.blocks], "rows": [rows for rows, _ in self.groups], "first": first.tolist(),
                  "block": [b for _, touched in self.groups for b in touched]}
        kept = {name: ffi.new("int[]", array) for name, array in arrays.items()}
        c = ffi.new("zd_structure *", {"blocks": len(self.blocks), "groups": len(self.groups), **kept})
        return c, (c, kept)

    def places(self, name: str) -> list[int]:
        """Index of each stored entry in the dense row-major matrix."""
        rows, columns = self._places[name]
        return (rows * self.shapes[name][1] + columns).tolist()

    def size(self, name: str) -> int:
        """Number of stored entries of A, M or C."""
        return self.offsets[name][-1]

    def expand(self, name: str, packed: np.ndarray) -> np.ndarray:
        """The matrix with its zeros, or several of them (k, ...) from packed ones (k, entries)."""
        if name in self._are_dense:
            return packed.reshape(*packed.shape[:-1], *self.shapes[name]).copy()
        dense = np.zeros((*packed.shape[:-1], *self.shapes[name]))
        dense[(..., *self._places[name])] = packed
        return dense

    def pack(self, name: str, dense: np.ndarray) -> np.ndarray:
        """Stored entries of a dense matrix; ValueError if it is nonzero elsewhere."""
        packed = dense[self._places[name]]
        if np.count_nonzero(packed) != np.count_nonzero(dense):
            i, j = map(int, np.argwhere((dense != 0) & (self.expand(name, np.ones(packed.size)) == 0))[0])
            raise WrongValue(f"[{i}, {j}] is {dense[i, j]:g}, where the structure has nothing", "declared-structure")
        return packed

    def times(self, name: str, packed: np.ndarray, x: np.ndarray, *, transposed: bool = False) -> np.ndarray:
        """The product of the matrix, or its transpose, and a vector."""
        to, of = self._places[name][::-1] if transposed else self._places[name]
        return np.bincount(to, weights=packed * x[of], minlength=self.shapes[name][transposed])


Places = tuple[np.ndarray, np.ndarray]      # the row and the column of each stored entry


def _of_blocks(coordinates: np.ndarray, velocities: np.ndarray,
               mass: np.ndarray) -> tuple[Places, Places, np.ndarray, np.ndarray]:
    """Indices of stored entries of A and M, and the number stored by each block."""
    at_v, every, diagonal = _begins(velocities), np.arange(velocities.sum()), mass & DIAGONAL != 0
    block = np.repeat(np.arange(len(coordinates)), coordinates)     # of each row of A
    A = _places(at_v[block], velocities[block], every)
    block = np.repeat(np.arange(len(velocities)), velocities)       # of each row of M
    M = _places(np.where(diagonal[block], every, at_v[block]), np.where(diagonal, 1, velocities)[block], every)
    return A, M, coordinates * velocities, velocities * np.where(diagonal, 1, velocities)


def _of_groups(velocities: np.ndarray, rows: np.ndarray, touched: Sequence[Sequence[int]]) -> tuple[Places, np.ndarray]:
    """Indices of stored entries of C, and the number stored by each group."""
    blocks = _whole(b for each in touched for b in each)
    _, columns = _places(_begins(velocities)[blocks], velocities[blocks], np.arange(velocities.sum()))
    several = _begins(_whole(len(each) for each in touched))
    counts = np.diff(_begins(velocities[blocks])[several])
    group = np.repeat(np.arange(len(rows)), rows)                   # of each row of C
    return _places(_begins(counts)[group], counts[group], columns), rows * counts


def _places(first: np.ndarray, counts: np.ndarray, columns: np.ndarray) -> Places:
    """Indices of stored entries of a matrix whose row i has entries in the columns `columns[first[i] : first[i] + counts[i]]`."""
    row = np.repeat(np.arange(len(counts)), counts)
    return row, columns[first[row] + np.arange(len(row)) - _begins(counts)[row]]


def _begins(sizes: np.ndarray) -> np.ndarray:
    """Offsets of consecutive parts of these sizes, and the end."""
    return np.concatenate([[0], np.cumsum(sizes)]).astype(int)


def _whole(numbers: Iterable[int]) -> np.ndarray:
    return np.array(list(numbers), dtype=int)


def declare(system: Any, packing: Packing | None) -> Any:
    """Set the structure of a `zd_system`; the returned memory must be kept as long as it."""
    if packing is None:
        return None
    system.structure, kept = packing.c()
    return kept
