"""Structure of a system, found from the zero entries of its matrices.

Bodies are ranges of velocities that M and A do not couple with others, and groups are rows of C that touch the same of these.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby, pairwise
from typing import Any

FEWEST_VELOCITIES = 12  # velocities: below, small dense kernels are faster
SPARSE = 0.5        # of the entries of M and C may be stored: with more, little is saved
PART = 3            # entries that going to one more block costs as much as


class Pattern:
    """Blocks and groups, as `zd.Structure` has them.

    `is_zero` is True for an entry that vanishes identically; `terms` are flat lists of entries by name, and `sizes` are
    (nq, nv, mh, mn).
    """

    def __init__(self, terms: Mapping[str, Sequence[Any]], sizes: tuple[int, int, int, int],
                 is_zero: Callable[[Any], bool]) -> None:
        self._terms, self._sizes, self._is_zero = terms, sizes, is_zero
        self._rows = [frozenset(self._columns("C", k)) for k in range(sizes[2] + sizes[3])]
        self._diagonal = [self._columns("M", i) in ([], [i]) for i in range(sizes[1])]

    def structure(self) -> dict[str, list[Any]] | None:
        """Arguments of `zd.Structure`; None if no structure would save work."""
        _, nv, mh, mn = self._sizes
        if nv < FEWEST_VELOCITIES:
            return None
        ends = self._merged(self._uncoupled())
        coordinates = self._coordinates(ends)
        if coordinates is None or len(ends) < 2:
            return None
        block_of = [b for b, (first, end) in enumerate(ends) for _ in range(first, end)]
        touched = [tuple(sorted({block_of[j] for j in row})) or (0,) for row in self._rows]
        alike = groupby(range(mh + mn), key=lambda k: (k < mh, touched[k]))
        groups = [(len(list(rows)), blocks) for (_, blocks), rows in alike]
        sizes = [end - first for first, end in ends]
        stored = sum(rows * sum(sizes[b] for b in blocks) for rows, blocks in groups) + sum(size * size for size in sizes)
        if stored > SPARSE * (nv + mh + mn) * nv:
            return None
        words = ["diagonal" if all(self._diagonal[first:end]) else "" for first, end in ends]
        return {"blocks": [list(pair) for pair in zip(coordinates, sizes, strict=True)], "mass": words,
                "groups": [[rows, list(blocks)] for rows, blocks in groups]}

    def _columns(self, term: str, row: int) -> list[int]:
        nv, entries = self._sizes[1], self._terms.get(term, ())
        return [j for j, entry in enumerate(entries[row * nv : (row + 1) * nv]) if not self._is_zero(entry)]

    def _uncoupled(self) -> list[tuple[int, int]]:
        """The smallest ranges of velocities, (first, end) each, such that M and A couple none with another."""
        nq, nv, *_ = self._sizes
        coupled = [self._columns("A", i) for i in range(nq)] if "A" in self._terms else []
        coupled += [[i, *self._columns("M", i)] for i in range(nv)]
        starts = set(range(1, nv))
        for columns in coupled:
            starts -= set(range(min(columns, default=0) + 1, max(columns, default=0) + 1))
        edges = [0, *sorted(starts), nv]
        return list(pairwise(edges))

    def _merged(self, ends: list[tuple[int, int]]) -> list[tuple[int, int]]:
        """Merge neighbouring blocks as long as that saves more than it stores, such as the velocities of a body whose M is
        diagonal.
        """
        touching = [{k for k, row in enumerate(self._rows) if not row.isdisjoint(range(*pair))} for pair in ends]
        while len(ends) > 1:
            cost, b = min((self._cost(ends[b], ends[b + 1], touching[b], touching[b + 1]), b) for b in range(len(ends) - 1))
            if cost >= 0:
                break
            ends[b : b + 2] = [(ends[b][0], ends[b + 1][1])]
            touching[b : b + 2] = [touching[b] | touching[b + 1]]
        return ends

    def _cost(self, one: tuple[int, int], other: tuple[int, int], rows: set[int], others: set[int]) -> int:
        """Additional entries that merging two blocks stores, minus the savings."""
        n, m, both = one[1] - one[0], other[1] - other[0], len(rows | others)
        mass = 0 if all(self._diagonal[one[0] : other[1]]) else 2 * n * m
        return mass + (n + m) * both - n * len(rows) - m * len(others) + PART * (both - len(rows) - len(others))

    def _coordinates(self, ends: list[tuple[int, int]]) -> list[int] | None:
        """Number of coordinates of each block; None if they are not in the order of the blocks."""
        owners = list(self._owners(ends)) if "A" in self._terms else [b for b, pair in enumerate(ends) for _ in range(*pair)]
        counts = [owners.count(b) for b in range(len(ends))]
        return counts if owners == sorted(owners) and all(counts) else None

    def _owners(self, ends: list[tuple[int, int]]) -> Iterator[int]:
        """The block of each coordinate; one that never moves goes with the one before it."""
        owner = 0
        for i in range(self._sizes[0]):
            columns = self._columns("A", i)
            owner = next(b for b, (_, end) in enumerate(ends) if columns[0] < end) if columns else owner
            yield owner

