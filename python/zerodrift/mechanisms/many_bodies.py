"""The start of mechanisms of many bodies: what is held, without dense matrices.

Rows are eliminated at a cost in proportion to bodies. Reading a measure is not yet: its row has the length of all velocities.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .._gateway.mechanisms import MechanismCore
from .elimination import Rows, least_solution


class Target(NamedTuple):
    """A component of a measure, and the value it shall have."""

    name: str
    measure: int
    component: int
    value: float


def are_met(core: MechanismCore, t: float, p: np.ndarray, held: Sequence[Target], allowed: float) -> bool:
    """Whether positions that are held are met."""
    return all(abs(_measured(core, t, p, target)["value"][target.component] - target.value) <= allowed for target in held)


class SparseRows:
    """Rows of C and of targets, without their zeros: groups of them, with the blocks of velocities that each touches."""

    def __init__(self, sizes: Sequence[int], groups: Sequence[Rows]) -> None:
        self.sizes, self.groups = sizes, groups
        starts = np.cumsum([0, *sizes])
        columns = [np.arange(begin, end) for begin, end in pairwise(starts)]
        self._at = [np.concatenate([np.zeros(0, dtype=int), *(columns[block] for block in blocks)]) for blocks, _ in groups]
        self._ends = np.cumsum([0, *(len(matrix) for _, matrix in groups)])

    def __matmul__(self, x: np.ndarray) -> np.ndarray:
        return np.concatenate([np.zeros(0), *(matrix @ x[at] for (_, matrix), at in zip(self.groups, self._at, strict=True))])

    def __getitem__(self, kept: np.ndarray) -> SparseRows:
        """The rows of a mask (k,)."""
        return SparseRows(self.sizes, [Rows(blocks, matrix[kept[begin:end]])
                                       for (blocks, matrix), (begin, end) in self._parted()])

    def __mul__(self, columns: np.ndarray) -> SparseRows:
        """With each column multiplied by a number."""
        return SparseRows(self.sizes, [Rows(blocks, matrix * columns[at])
                                       for (blocks, matrix), at in zip(self.groups, self._at, strict=True)])

    def __truediv__(self, rows: np.ndarray) -> SparseRows:
        """With each row divided by a number."""
        return SparseRows(self.sizes, [Rows(blocks, matrix / rows[begin:end, None])
                                       for (blocks, matrix), (begin, end) in self._parted()])

    def lengths(self) -> np.ndarray:
        """The length of each row."""
        return np.concatenate([np.zeros(0), *(np.linalg.norm(matrix, axis=1) for _, matrix in self.groups)])

    def least(self, right: np.ndarray) -> np.ndarray:
        """The least x with self @ x = right, or with the least squares of what is left of rows of length one."""
        size = self.lengths()
        size[size == 0.0] = 1.0
        right = right / size
        return least_solution(self.sizes, [Rows(blocks, np.column_stack([matrix, right[begin:end]]))
                                           for (blocks, matrix), (begin, end) in (self / size)._parted()])

    def _parted(self) -> Iterator[tuple[Rows, tuple[int, int]]]:
        return zip(self.groups, pairwise(self._ends), strict=True)


def sparse_rows(core: MechanismCore, stored: Mapping[str, np.ndarray], t: float, p: np.ndarray,
                held: Sequence[Target]) -> tuple[SparseRows, np.ndarray]:
    """All rows of C and those of targets at rest, and by how much each target is off."""
    sizes = [block[1] for block in core.packing.blocks]
    starts, ends = np.cumsum([0, *sizes]), core.packing.offsets["C"]
    groups = [Rows(blocks, stored["C"][begin:end].reshape(count, -1))
              for (count, blocks), (begin, end) in zip(core.packing.groups, pairwise(ends), strict=True)]
    off, measured, found = np.zeros(len(held)), -1, {}
    for i, target in enumerate(held):
        if target.measure != measured:
            measured, found = target.measure, _measured(core, t, p, target)
        row, off[i] = found["row"][target.component], found["value"][target.component] - target.value
        blocks = np.unique(np.searchsorted(starts, np.flatnonzero(row != 0.0), side="right") - 1)
        touched = [row[starts[block] : starts[block + 1]] for block in blocks]
        groups.append(Rows(tuple(blocks.tolist()), np.concatenate([[], *touched])[None, :]))
    return SparseRows(sizes, groups), off


def _measured(core: MechanismCore, t: float, p: np.ndarray, target: Target) -> dict[str, np.ndarray]:
    """What is held, at rest."""
    return core.measure_at(target.measure, t, p, np.zeros(core.nv))
