"""The factorization of symmetric matrices that are not definite, called directly, against NumPy."""

import ctypes
import subprocess

import numpy as np
import pytest

from native_systems import COMPILER, needs_compiler
from support import ROOT

SOURCE = ROOT / "csrc" / "linalg" / "symmetric.c"
SIZES = (1, 2, 3, 7, 12, 40)
LARGEST_OF_L = 1 / (1 - (1 + np.sqrt(17)) / 8)      # by which rook pivoting bounds it
pytestmark = [needs_compiler, pytest.mark.skipif(not SOURCE.exists(), reason="no sources of the core")]
DOUBLES, INTS = (np.ctypeslib.ndpointer(kind, flags="C") for kind in (np.float64, np.int32))


@pytest.fixture(scope="module")
def linalg(tmp_path_factory):
    """The file, compiled by itself."""
    path = tmp_path_factory.mktemp("symmetric") / "symmetric.so"
    subprocess.run([COMPILER, "-O1", "-std=c11", "-ffp-contract=off", "-fPIC", "-shared", "-o", path, SOURCE, "-lm"], check=True)
    library = ctypes.CDLL(str(path))
    library.zd_symmetric_factor.argtypes = [ctypes.c_int, DOUBLES, INTS]
    library.zd_symmetric_solve.argtypes = [ctypes.c_int, DOUBLES, INTS, DOUBLES]
    library.zd_symmetric_solve.restype = None
    library.zd_symmetric_dependent.argtypes = [ctypes.c_int, DOUBLES, INTS, ctypes.c_int, DOUBLES]
    return library


def leading_matrix(rng, n, m):
    """[M C^T; C 0] with an M that is singular, though no motion is left that has no mass."""
    root = rng.normal(size=(n, max(n - m, 0)))
    C = rng.normal(size=(m, n))
    return np.block([[root @ root.T, C.T], [C, np.zeros((m, m))]])


def random_matrices(rng, n):
    """Indefinite ones: any, with nothing on the diagonal, with entries of all sizes, and leading matrices."""
    A = rng.normal(size=(n, n))
    A += A.T
    scale = 10 ** rng.uniform(-1.5, 1.5, n)
    yield A
    yield A * np.outer(scale, scale)
    if n > 1:
        yield A - np.diag(np.diag(A))
        yield leading_matrix(rng, n - n // 3, n // 3)


def triangle(A):
    return np.ascontiguousarray(A[np.triu_indices(len(A))])


@pytest.mark.parametrize("n", SIZES)
def test_solutions_are_right_and_factors_bounded(linalg, n):
    """The residual is of the rounding of A x, as a stable elimination leaves it."""
    rng = np.random.default_rng(n)
    for A in (A for _ in range(20) for A in random_matrices(rng, n)):
        packed, order, b = triangle(A), np.zeros(n, np.int32), rng.normal(size=n)
        assert linalg.zd_symmetric_factor(n, packed, order) == n
        x = b.copy()
        linalg.zd_symmetric_solve(n, packed, order, x)
        assert np.abs(A @ x - b).max() < 100 * n * 2.0**-52 * np.abs(A).max() * np.abs(x).max()
        U = np.zeros((n, n))
        U[np.triu_indices(n)] = packed
        in_block = np.zeros((n, n), bool)
        for k in np.flatnonzero(order < 0)[::2]:
            in_block[k, k + 1] = True
        assert np.abs(U[np.triu(np.ones((n, n), bool), 1) & ~in_block]).max(initial=0) < LARGEST_OF_L + 1e-9


@pytest.mark.parametrize("n", SIZES[1:])
def test_the_column_that_depends_on_others_is_named(linalg, n):
    """As Gaussian elimination in order would do: the first that those before it make up, where all after it are independent."""
    rng = np.random.default_rng(n)
    for _ in range(20):
        last = int(rng.integers(n))
        of_others = np.eye(n - 1)
        of_others = np.insert(of_others, last, np.pad(rng.integers(1, 3, last), (0, n - 1 - last)), axis=1)
        A = rng.integers(-3, 4, size=(n - 1, n - 1)) + np.diag(rng.choice([-7, 7], n - 1))
        packed, order = triangle(of_others.T @ (A + A.T) @ of_others), np.zeros(n, np.int32)    # integers, and so exact
        step = linalg.zd_symmetric_factor(n, packed, order)
        assert step < n
        assert linalg.zd_symmetric_dependent(n, packed, order, step, np.zeros(n)) == last


def test_what_is_not_a_number_is_not_a_pivot(linalg):
    assert linalg.zd_symmetric_factor(3, np.full(6, np.nan), np.zeros(3, np.int32)) == 0
