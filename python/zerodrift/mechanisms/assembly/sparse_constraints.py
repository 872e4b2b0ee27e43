"""Sparse constraints and targets of mechanisms of many bodies, at a cost proportional to the bodies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from ..._gateway.measures import Components
from ..._gateway.mechanisms.plane import MechanismCore
from .dense import Target
from .sparse_least_squares import Rows, least_solution


def are_met(core: MechanismCore, p: np.ndarray, held: Sequence[Target], allowed: float) -> bool:
    """True if all held positions are met."""
    return bool((np.abs(read_targets(core, p, held)[1]) <= allowed).all())


class SparseRows:
    """Nonzero blocks of the rows of C and of targets: groups of rows, with the blocks of velocities that each touches."""

    def __init__(self, sizes: Sequence[int], groups: Sequence[Rows]) -> None:
        self.sizes, self.groups = sizes, groups
        starts = np.cumsum([0, *sizes])
        columns = [np.arange(begin, end) for begin, end in pairwise(starts)]
        self._at = [np.concatenate([np.zeros(0, dtype=int), *(columns[block] for block in blocks)]) for blocks, _ in groups]
        self._ends = np.cumsum([0, *(len(matrix) for _, matrix in groups)])

    def __matmul__(self, x: np.ndarray) -> np.ndarray:
        return np.concatenate([np.zeros(0), *(matrix @ x[at] for (_, matrix), at in zip(self.groups, self._at, strict=True))])

    def __getitem__(self, kept: np.ndarray) -> SparseRows:
        """Rows selected by a mask (k,)."""
        return SparseRows(self.sizes, [Rows(blocks, matrix[kept[begin:end]])
                                       for (blocks, matrix), (begin, end) in self._parted()])

    def __mul__(self, columns: np.ndarray) -> SparseRows:
        """Rows with each column multiplied by a number."""
        return SparseRows(self.sizes, [Rows(blocks, matrix * columns[at])
                                       for (blocks, matrix), at in zip(self.groups, self._at, strict=True)])

    def __truediv__(self, rows: np.ndarray) -> SparseRows:
        """Rows, each divided by a number."""
        return SparseRows(self.sizes, [Rows(blocks, matrix / rows[begin:end, None])
                                       for (blocks, matrix), (begin, end) in self._parted()])

    def lengths(self) -> np.ndarray:
        """Norm of each row."""
        return np.concatenate([np.zeros(0), *(np.linalg.norm(matrix, axis=1) for _, matrix in self.groups)])

    def least(self, right: np.ndarray) -> np.ndarray:
        """Minimum-norm x with self @ x = right, or with least squared residuals of rows scaled to length one."""
        size = self.lengths()
        size[size == 0.0] = 1.0
        right = right / size
        return least_solution(self.sizes, [Rows(blocks, np.column_stack([matrix, right[begin:end]]))
                                           for (blocks, matrix), (begin, end) in (self / size)._parted()])

    def damped(self, right: np.ndarray, is_soft: np.ndarray, damping: float) -> np.ndarray:
        """Minimizer of x . x + (residuals of the soft rows)^2 / damping under all other rows."""
        size = np.where(is_soft, np.sqrt(damping), self.lengths())
        size[size == 0.0] = 1.0
        right, parts = right / size, ([], [])
        for (blocks, matrix), (begin, end) in (self / size)._parted():
            rows = np.column_stack([matrix, right[begin:end]])
            for of, chosen in zip(parts, (~is_soft[begin:end], is_soft[begin:end]), strict=True):
                of.append(Rows(blocks, rows[chosen]))
        return least_solution(self.sizes, *parts)

    def _parted(self) -> Iterator[tuple[Rows, tuple[int, int]]]:
        return zip(self.groups, pairwise(self._ends), strict=True)


def sparse_rows(core: MechanismCore, stored: Mapping[str, np.ndarray], p: np.ndarray,
                held: Sequence[Target]) -> tuple[SparseRows, np.ndarray]:
    """Rows of C and of targets at rest, and the deviation of each target."""
    sizes = [block[1] for block in core.packing.blocks]
    starts, ends = np.cumsum([0, *sizes]), core.packing.offsets["C"]
    groups = [Rows(blocks, stored["C"][begin:end].reshape(count, -1))
              for (count, blocks), (begin, end) in zip(core.packing.groups, pairwise(ends), strict=True)]
    found, off = read_targets(core, p, held)
    touched = np.searchsorted(starts, found.at, side="right") - 1
    for blocks, rows in zip(touched.tolist(), found.row, strict=True):
        parts: dict[int, np.ndarray] = {}
        for block, row in zip(blocks, rows, strict=True):
            if block >= 0:      # of two points of a body both
                parts[block] = parts.get(block, 0.0) + row[: sizes[block]]
        groups.append(Rows(tuple(parts), np.concatenate([[], *parts.values()])[None, :]))
    return SparseRows(sizes, groups), off


def read_targets(core: MechanismCore, p: np.ndarray, held: Sequence[Target]) -> tuple[Components, np.ndarray]:
    """Components of the held measures at rest, and their deviations from the targets."""
    found = core.components(p, np.zeros(core.nv), [(target.measure, target.component) for target in held])
    return found, found.value - np.array([target.value for target in held])
