"""Least solutions of sparse rows, against the dense pseudoinverse."""

from itertools import pairwise

import numpy as np
import pytest

from zerodrift.mechanisms.assembly.sparse_least_squares import Rows, least_solution

AGREES = 1e-11      # of the largest: rounding times the condition of the rows, which is 1e4 at most


def sparse_rows(rng, sizes, graph, *, redundant, contradict):
    """Rows of a random system that touch the blocks of each edge, and the same dense, with right sides."""
    starts = np.cumsum([0, *sizes])
    columns = [np.arange(begin, end) for begin, end in pairwise(starts)]
    x = rng.standard_normal(starts[-1])
    rows = []
    for blocks in graph:
        at = np.concatenate([columns[block] for block in blocks])
        matrix = rng.standard_normal((rng.integers(1, 4), len(at)))
        if redundant:
            matrix = np.vstack([matrix, rng.standard_normal((2, len(matrix))) @ matrix])
        matrix /= np.linalg.norm(matrix, axis=1)[:, None]
        right = matrix @ x[at] + contradict * rng.standard_normal(len(matrix))
        rows.append((blocks, at, matrix, right))
    dense = np.zeros((sum(len(matrix) for _, _, matrix, _ in rows), starts[-1]))
    first = 0
    for _, at, matrix, _ in rows:
        dense[first : first + len(matrix), at] = matrix
        first += len(matrix)
    return ([Rows(blocks, np.column_stack([matrix, right])) for blocks, _, matrix, right in rows], dense,
            np.concatenate([right for *_, right in rows]))


GRAPHS = {
    "chain": lambda n, rng: [(i, i + 1) for i in range(n - 1)],
    "ring": lambda n, rng: [(i, (i + 1) % n) for i in range(n)],
    "star": lambda n, rng: [(0, i) for i in range(1, n)],
    "held": lambda n, rng: [*((i,) for i in range(n)), *((i, i + 1) for i in range(n - 1))],
    "any": lambda n, rng: [tuple(sorted(rng.choice(n, rng.integers(1, 4), replace=False).tolist())) for _ in range(2 * n)],
    "apart": lambda n, rng: [(1, 2), (4,), (5, 6)],
}


@pytest.mark.parametrize("graph", GRAPHS)
@pytest.mark.parametrize(("redundant", "contradict"), [(False, 0.0), (True, 0.0), (True, 1.0)])
def test_the_pseudoinverse_says_the_same(graph, redundant, contradict):
    rng = np.random.default_rng(3)
    for _ in range(20):
        n = int(rng.integers(7, 12))
        sizes = rng.integers(1, 7, n).tolist()
        rows, dense, right = sparse_rows(rng, sizes, GRAPHS[graph](n, rng), redundant=redundant, contradict=contradict)
        s = np.linalg.svd(dense, compute_uv=False)
        if s[s > 1e-9].min() < 1e-4 * s.max():
            continue
        expected = np.linalg.lstsq(dense, right, rcond=1e-9)[0]
        assert np.abs(least_solution(sizes, rows) - expected).max() <= AGREES * np.abs(expected).max() / s[s > 1e-9].min()


@pytest.mark.parametrize("graph", GRAPHS)
def test_squares_besides_are_least(graph):
    """With squares to minimize besides, x is that of a dense matrix in a basis of the null space of the rows."""
    rng = np.random.default_rng(4)
    for _ in range(10):
        n = int(rng.integers(7, 12))
        sizes = rng.integers(3, 7, n).tolist()
        edges = GRAPHS[graph](n, rng)
        rows, A, b = sparse_rows(rng, sizes, edges[::2], redundant=True, contradict=0.0)
        squares, S, r = sparse_rows(rng, sizes, edges, redundant=False, contradict=1.0)
        _, s, vt = np.linalg.svd(A)
        rank = int((s > 1e-9).sum())
        if s[:rank].min() < 1e-4 * s.max():
            continue
        free, x = vt[rank:].T, np.linalg.lstsq(A, b, rcond=1e-9)[0]
        y = np.linalg.lstsq(np.vstack([np.eye(free.shape[1]), S @ free]), np.append(-free.T @ x, r - S @ x), rcond=None)[0]
        expected = x + free @ y
        assert np.abs(least_solution(sizes, rows, squares) - expected).max() <= AGREES * np.abs(expected).max() / s[:rank].min()


def test_without_rows_all_is_zero():
    assert least_solution([2, 3], []).tolist() == [0.0] * 5
    assert least_solution([], []).size == 0
