"""Minimum-norm solutions of sparse rows, against the dense pseudoinverse."""

import ctypes
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest

from core_objects import library_of, needs_compiler

pytestmark = needs_compiler

AGREES = 1e-11      # of the largest: rounding times the condition of the rows, which is 1e4 at most


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    units = ("linalg/sparse/minimum_norm", "linalg/sparse/ordering", "linalg/sparse/few_columns", "workspace")
    return library_of(tmp_path_factory.mktemp("minimum_norm"), "minimum_norm", *units)


class Rows(NamedTuple):
    """Rows of some blocks: their columns, the matrix (k, columns), and right sides (k,)."""

    at: np.ndarray
    matrix: np.ndarray
    right: np.ndarray


def minimum_norm(library, sizes, rows, squares=(), weight=None):
    """Solution (sum of `sizes`,) of the core."""
    starts = np.cumsum([0, *sizes]).astype(np.int32)
    block_of = np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)
    each = [(group.at[order], row[order], right, square)
            for groups, square in ((rows, False), (squares, True)) for group in groups
            for order in [np.argsort(group.at)] for row, right in zip(group.matrix, group.right, strict=True)]
    begin = np.cumsum([0, *(len(at) for at, *_ in each)]).astype(np.int32)
    column = np.concatenate([np.zeros(0), *(at for at, *_ in each)]).astype(np.int32)
    entries = np.concatenate([np.zeros(0), *(row for _, row, *_ in each)])
    right, is_square = np.array([each[2] for each in each]), np.array([each[3] for each in each], dtype=np.uint8)
    x = np.full(starts[-1], np.nan)
    arrays = (starts, block_of), (begin, entries, column, right, np.ones(len(each)), is_square, weight, x)
    pointers, others = ([None if array is None else ctypes.c_void_p(array.ctypes.data) for array in some] for some in arrays)
    assert library.solve(len(sizes), *pointers, len(each), *others) == 0
    return x


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
        rows.append(Rows(at, matrix, matrix @ x[at] + contradict * rng.standard_normal(len(matrix))))
    dense = np.zeros((sum(len(each.matrix) for each in rows), starts[-1]))
    first = 0
    for each in rows:
        dense[first : first + len(each.matrix), each.at] = each.matrix
        first += len(each.matrix)
    return rows, dense, np.concatenate([each.right for each in rows])


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
def test_the_pseudoinverse_says_the_same(library, graph, redundant, contradict):
    rng = np.random.default_rng(3)
    for _ in range(20):
        n = int(rng.integers(7, 12))
        sizes = rng.integers(1, 7, n).tolist()
        rows, dense, right = sparse_rows(rng, sizes, GRAPHS[graph](n, rng), redundant=redundant, contradict=contradict)
        s = np.linalg.svd(dense, compute_uv=False)
        if s[s > 1e-9].min() < 1e-4 * s.max():
            continue
        expected = np.linalg.lstsq(dense, right, rcond=1e-9)[0]
        assert np.abs(minimum_norm(library, sizes, rows) - expected).max() <= AGREES * np.abs(expected).max() / s[s > 1e-9].min()


@pytest.mark.parametrize("graph", GRAPHS)
def test_squares_besides_are_least(library, graph):
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
        found = minimum_norm(library, sizes, rows, squares)
        assert np.abs(found - expected).max() <= AGREES * np.abs(expected).max() / s[:rank].min()


def test_weights_are_of_the_norm(library):
    """The sum of (weight x)^2 is least."""
    rng = np.random.default_rng(5)
    sizes = [3, 6, 2, 4]
    rows, A, b = sparse_rows(rng, sizes, GRAPHS["ring"](4, rng), redundant=True, contradict=0.0)
    weight = rng.uniform(0.1, 10.0, A.shape[1])
    expected = np.linalg.lstsq(A / weight, b, rcond=1e-9)[0] / weight
    assert np.abs(minimum_norm(library, sizes, rows, weight=weight) - expected).max() <= 1e2 * AGREES * np.abs(expected).max()


def test_without_rows_all_is_zero(library):
    nothing = Rows(np.zeros(0, dtype=int), np.zeros((2, 0)), np.ones(2))
    for rows in ([], [nothing]):
        assert minimum_norm(library, [2, 3], rows).tolist() == [0.0] * 5
        assert minimum_norm(library, [], rows).size == 0
