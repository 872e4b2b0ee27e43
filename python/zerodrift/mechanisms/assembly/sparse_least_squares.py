"""Minimum-norm solutions of sparse linear equations by block elimination with orthogonal transformations.

Unknowns come in small blocks, such as the velocities of one body, and each row touches few blocks. The solution minimizes a sum
of squares among all x with rows @ x = right. Rows may be redundant; where they contradict each other, it minimizes their squared
residuals. A block is eliminated together with the rows that touch it: the singular value decomposition of their columns of the
block gives the independent ones, which determine it for given neighbours; the other rows pass to the neighbours. The part of the
block that no row determines minimizes the sum of squares, which passes on as rows, too. Products of rows with each other, whose
condition number is squared, are never formed.

Blocks with the fewest neighbours are eliminated first: the cost of chains, trees and rows of loops is proportional to their size.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

RANK = 1e-9     # of rows of length one: bound for redundant ones


class Rows(NamedTuple):
    """Rows (k, columns of these blocks in turn, and one more for the right sides)."""

    blocks: tuple[int, ...]
    matrix: np.ndarray


class Eliminated(NamedTuple):
    """Eliminated block as a function of its neighbours: the last column of `of`, minus the others times the neighbours."""

    block: int
    neighbours: tuple[int, ...]
    of: np.ndarray


def least_solution(sizes: Sequence[int], rows: Sequence[Rows], squares: Sequence[Rows] = ()) -> np.ndarray:
    """The least x (sum of `sizes`,) with which the rows, each about of length one, are met, or their squares are least.

    Where there are `squares`, the sum of x^2 and of the squares of what is left of these is what is least.
    """
    elimination = _Elimination(sizes, rows, squares)
    parts = [np.zeros(size) for size in sizes]
    for block, neighbours, of in reversed(elimination.run()):
        parts[block] = of @ np.concatenate([*(-parts[other] for other in neighbours), [1.0]])
    return np.concatenate([*parts, []])


class _Elimination:
    def __init__(self, sizes: Sequence[int], rows: Sequence[Rows], squares: Sequence[Rows]) -> None:
        self.sizes = sizes
        self.neighbours: list[set[int]] = [set() for _ in sizes]
        self.conditions: list[dict[int, Rows]] = [{} for _ in sizes]    # by block: rows that touch it
        self.squares: list[dict[int, Rows]] = [{} for _ in sizes]       # the same for rows whose squares are minimized
        for given, of in ((rows, self.conditions), (squares, self.squares)):
            for each in given:
                _hand_on(of, each)
                for block in each.blocks:
                    self.neighbours[block].update(each.blocks)
        for block, others in enumerate(self.neighbours):
            others.discard(block)

    def run(self) -> list[Eliminated]:
        """All blocks in the order of their elimination."""
        waiting = [(len(others), block, block) for block, others in enumerate(self.neighbours)]
        heapq.heapify(waiting)
        done: list[Eliminated] = []
        was_done, count = [False] * len(self.sizes), len(waiting)
        while waiting:
            fewest, _, block = heapq.heappop(waiting)
            if was_done[block] or fewest != len(self.neighbours[block]):
                continue        # an outdated entry of the heap, with another number of neighbours
            was_done[block] = True
            done.append(self._eliminate(block))
            for other in done[-1].neighbours:
                self._join(other, block, done[-1].neighbours)
                count += 1
                heapq.heappush(waiting, (len(self.neighbours[other]), count, other))
        return done

    def _join(self, other: int, block: int, neighbours: Sequence[int]) -> None:
        """Make a neighbour of an eliminated block a neighbour of the others."""
        self.neighbours[other].update(neighbours)
        self.neighbours[other] -= {other, block}

    def _eliminate(self, block: int) -> Eliminated:
        size, others = self.sizes[block], tuple(sorted(self.neighbours[block]))
        rows, squares = (self._gathered(of, block, others) for of in (self.conditions, self.squares))
        u, s, vt = np.linalg.svd(rows[:, :size])
        rank = int((s > RANK).sum())
        rest = u.T @ rows[:, size:]
        given = rest[:rank] / s[:rank, None]
        squares = np.vstack([np.eye(size, squares.shape[1]), squares])
        turned = squares[:, :size] @ vt.T
        squares = _triangle(np.hstack([turned[:, rank:], squares[:, size:] - turned[:, :rank] @ given]))
        free = size - rank
        least = np.linalg.solve(squares[:free, :free], squares[:free, free:])
        columns = rest.shape[1] - 1
        if columns:
            kept = rest[rank:]
            _hand_on(self.conditions, Rows(others, kept[np.abs(kept[:, :-1]).max(axis=1, initial=0.0) > RANK]))
            _hand_on(self.squares, Rows(others, squares[free : free + columns, free:]))
        return Eliminated(block, others, vt.T @ np.vstack([given, least]))

    def _gathered(self, of: list[dict[int, Rows]], block: int, others: Sequence[int]) -> np.ndarray:
        """All rows that touch a block, its columns first, reduced to a triangle; they are removed from their lists."""
        at, end = {}, 0
        for each in (block, *others):
            at[each] = np.arange(end, end + self.sizes[each])
            end += self.sizes[each]
        parts = [np.zeros((0, end + 1))]
        for number, (blocks, matrix) in list(of[block].items()):
            part = np.zeros((len(matrix), end + 1))
            part[:, np.concatenate([*(at[each] for each in blocks), [end]])] = matrix
            parts.append(part)
            for each in blocks:
                del of[each][number]
        gathered = np.vstack(parts)
        return _triangle(gathered) if len(gathered) > end + 1 else gathered


def _hand_on(of: list[dict[int, Rows]], rows: Rows) -> None:
    if len(rows.matrix):
        for block in rows.blocks:
            of[block][id(rows)] = rows


def _triangle(matrix: np.ndarray) -> np.ndarray:
    """Triangular matrix with the same products of columns."""
    return np.linalg.qr(matrix, mode="r")
