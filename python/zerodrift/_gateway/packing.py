"""Structures of systems: as the core is told of them, and where the entries of packed matrices belong."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from .._core import ffi, lib

PACKED = ("A", "M", "C")        # the terms that are packed
CONSTANT, DIAGONAL = lib.ZD_CONSTANT, lib.ZD_DIAGONAL


class Packing:
    """The blocks, (coordinates, velocities, mass) each, and groups, (rows, blocks) each, of a structure.

    Attributes
    ----------
    shapes : dict of str to tuple of int
        What A, M and C are as the equations have them.
    offsets : dict of str to tuple of int
        Where, of what is stored, each block of A and M and each group of C begins, and the end.
    """

    def __init__(self, blocks: Sequence[tuple[int, int, int]], groups: Sequence[tuple[int, tuple[int, ...]]]) -> None:
        self.blocks, self.groups = tuple(blocks), tuple(groups)
        at_p, at_v = (np.cumsum([0, *sizes]) for sizes in ([b[0] for b in blocks], [b[1] for b in blocks]))
        at_row = np.cumsum([0, *(rows for rows, _ in groups)])
        ranges = [np.arange(*ends) for ends in pairwise(at_v)]
        parts = {
            "A": [_grid(np.arange(*ends), v) for ends, v in zip(pairwise(at_p), ranges, strict=True)],
            "M": [(v, v) if block[2] & DIAGONAL else _grid(v, v) for block, v in zip(blocks, ranges, strict=True)],
            "C": [_grid(first + np.arange(rows), np.concatenate([ranges[b] for b in touched]))
                  for first, (rows, touched) in zip(at_row[:-1], groups, strict=True)],
        }
        nq, nv, m = int(at_p[-1]), int(at_v[-1]), int(at_row[-1])
        self.shapes = {"A": (nq, nv), "M": (nv, nv), "C": (m, nv)}
        self.offsets = {name: tuple(map(int, np.cumsum([0, *(len(rows) for rows, _ in each)]))) for name, each in parts.items()}
        none = [(np.zeros(0, dtype=int),) * 2]
        self._places = {name: tuple(map(np.concatenate, zip(*none, *each, strict=True))) for name, each in parts.items()}

    @classmethod
    def of(cls, c: Any) -> Packing | None:
        """That of a `zd_structure *`; None where it is NULL."""
        if not c:
            return None
        blocks = [(c.coordinates[b], c.velocities[b], c.mass[b] if c.mass else 0) for b in range(c.blocks)]
        return cls(blocks, [(c.rows[g], tuple(c.block[i] for i in range(c.first[g], c.first[g + 1]))) for g in range(c.groups)])

    def c(self) -> tuple[Any, Any]:
        """A `zd_structure *`, and what has to live as long as it."""
        first = np.cumsum([0, *(len(touched) for _, touched in self.groups)])
        arrays = {"coordinates": [b[0] for b in self.blocks], "velocities": [b[1] for b in self.blocks],
                  "mass": [b[2] for b in self.blocks], "rows": [rows for rows, _ in self.groups], "first": first.tolist(),
                  "block": [b for _, touched in self.groups for b in touched]}
        kept = {name: ffi.new("int[]", array) for name, array in arrays.items()}
        c = ffi.new("zd_structure *", {"blocks": len(self.blocks), "groups": len(self.groups), **kept})
        return c, (c, kept)

    def places(self, name: str) -> list[int]:
        """Where in the dense matrix, row by row, each stored entry stands."""
        rows, columns = self._places[name]
        return (rows * self.shapes[name][1] + columns).tolist()

    def size(self, name: str) -> int:
        """How many entries are stored of A, M or C."""
        return self.offsets[name][-1]

    def expand(self, name: str, packed: np.ndarray) -> np.ndarray:
        """The matrix with its zeros."""
        dense = np.zeros(self.shapes[name])
        dense[self._places[name]] = packed
        return dense

    def pack(self, name: str, dense: np.ndarray) -> np.ndarray:
        """What is stored of a matrix; ValueError where it has an entry elsewhere."""
        packed = dense[self._places[name]]
        if np.count_nonzero(packed) != np.count_nonzero(dense):
            i, j = map(int, np.argwhere((dense != 0) & (self.expand(name, np.ones(packed.size)) == 0))[0])
            raise ValueError(f"[{i}, {j}] is {dense[i, j]:g}, where the structure has nothing")
        return packed

    def times(self, name: str, packed: np.ndarray, x: np.ndarray, *, transposed: bool = False) -> np.ndarray:
        """The product of the matrix, or its transpose, and a vector."""
        to, of = self._places[name][::-1] if transposed else self._places[name]
        return np.bincount(to, weights=packed * x[of], minlength=self.shapes[name][transposed])


def _grid(rows: np.ndarray, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The places of a full matrix, row by row."""
    return np.repeat(rows, len(columns)), np.tile(columns, len(rows))


def declare(system: Any, packing: Packing | None) -> Any:
    """Says in a `zd_system` what its structure is; what it returns has to live as long as that."""
    if packing is None:
        return None
    system.structure, kept = packing.c()
    return kept
