"""The mass matrix of the free velocities, D^T M D, factored as L B L^T.

Blocks B have two rows where these are coupled, else one: two rows so take one division, and not two of which the second waits for
the first.
"""

from __future__ import annotations

from collections.abc import Callable

from ..graph.arithmetic import Arithmetic, Matrix, Vector, adjugate


class ReducedMass:
    """The factors of a symmetric, positive definite matrix S (r, r).

    Attributes
    ----------
    shares : list of operations
        Relative pivots: each pivot over its diagonal entry of S.
    """

    def __init__(self, do: Arithmetic, S: Matrix, inverted: Callable[[int], int]) -> None:
        """Factor S; `inverted` is called for the reciprocal determinant of each block, in order."""
        self._do, self._L = do, [[do.zero] * len(S) for _ in S]
        self._blocks: list[tuple[list[int], Matrix]] = []       # rows, and 1 / B
        self.shares: Vector = []
        left, first = [list(row) for row in S], 0
        while first < len(S):
            rows = [first] if first + 1 == len(S) or left[first + 1][first] == do.zero else [first, first + 1]
            for b in rows:
                for a in range(b):
                    left[a][b] = left[b][a]
            of_block, determinant = adjugate(do, [[left[a][b] for b in rows] for a in rows])
            share = inverted(determinant)
            inverse = [[do.times(entry, share) for entry in row] for row in of_block]
            self._blocks.append((rows, inverse))
            self._note_shares(S, left, rows, determinant)
            self._eliminate(left, rows, inverse)
            first += len(rows)

    def _note_shares(self, S: Matrix, left: Matrix, rows: list[int], determinant: int) -> None:
        do, b = self._do, rows[0]
        self.shares.append(do.one if left[b][b] == S[b][b] else do.over(left[b][b], S[b][b]))
        if len(rows) == 2:
            self.shares.append(do.over(determinant, do.times(left[b][b], S[b + 1][b + 1])))

    def _eliminate(self, left: Matrix, rows: list[int], inverse: Matrix) -> None:
        """Eliminate a block from the rows below it."""
        do = self._do
        for a in range(rows[-1] + 1, len(left)):
            here = [left[a][b] for b in rows]
            for b, row in zip(rows, inverse, strict=True):
                self._L[a][b] = do.dot(row, here)
            for c in range(rows[-1] + 1, a + 1):
                left[a][c] = do.difference(left[a][c], do.dot([self._L[c][b] for b in rows], here))

    def solve(self, right: Vector) -> Vector:
        """X with S x = right."""
        do, x = self._do, list(right)
        for i in range(len(x)):
            x[i] = do.difference(x[i], do.dot(self._L[i][:i], x[:i]))
        for rows, inverse in self._blocks:
            for b, value in zip(rows, [do.dot(row, [x[c] for c in rows]) for row in inverse], strict=True):
                x[b] = value
        for i in reversed(range(len(x))):
            x[i] = do.difference(x[i], do.sum([do.times(self._L[c][i], x[c]) for c in range(i + 1, len(x))]))
        return x
