"""Minimum-norm solutions of redundant rows, and their null space, against the singular value decomposition."""

import ctypes

import numpy as np
import pytest

from core_objects import library_of, needs_compiler

pytestmark = needs_compiler

AGREES = 1e-11      # of the largest: rounding times the condition of the rows, which is 1e4 at most


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return library_of(tmp_path_factory.mktemp("row_space"), "row_space", "linalg/row_space", "linalg/lu", "workspace")


def solved(library, A, right, vector):
    """Rank, solution, and the vector turned into rows and null space."""
    (rows, n), x, turned = A.shape, np.full(A.shape[1], np.nan), vector.copy()
    pointers = [ctypes.c_void_p(np.ascontiguousarray(each).ctypes.data) for each in (A, right, x, turned)]
    rank, alone = library.solve(rows, n, *pointers), x.copy()
    assert library.solve(rows, n, *pointers[:3], None) == rank     # by elimination if they are square and regular
    assert np.abs(x - alone).max() <= AGREES * max(1.0, np.abs(x).max())
    return rank, x, turned


@pytest.mark.parametrize(("rows", "n", "rank"), [
    (1, 1, 1), (3, 7, 3), (7, 7, 7), (9, 7, 7), (9, 7, 4), (5, 12, 2), (16, 16, 11), (4, 6, 0), (0, 3, 0), (40, 60, 33)])
@pytest.mark.parametrize("contradict", [0.0, 1.0])
def test_the_pseudoinverse_says_the_same(library, rows, n, rank, contradict):
    rng = np.random.default_rng([rows, n, rank])
    for _ in range(10):
        A = rng.standard_normal((rows, rank)) @ rng.standard_normal((rank, n))
        right = A @ rng.standard_normal(n) + contradict * rng.standard_normal(rows)
        s = np.linalg.svd(A, compute_uv=False)[:rank]
        if rank and s.min() < 1e-4 * s.max():
            continue
        vector = rng.standard_normal(n)
        found, x, turned = solved(library, A, right, vector)
        assert found == rank
        expected = np.linalg.lstsq(A, right, rcond=1e-9)[0] if rows else np.zeros(n)
        assert np.abs(x - expected).max() <= AGREES * max(1.0, np.abs(expected).max())
        along = np.linalg.pinv(A, rcond=1e-9) @ (A @ vector) if rows else np.zeros(n)       # what the rows span
        assert np.linalg.norm(turned[rank:]) == pytest.approx(np.linalg.norm(vector - along), rel=1e-10, abs=1e-10)


def test_rows_of_zeros(library):
    assert solved(library, np.zeros((3, 4)), np.ones(3), np.ones(4))[0] == 0
    assert solved(library, np.zeros((3, 4)), np.ones(3), np.ones(4))[1].tolist() == [0.0] * 4
