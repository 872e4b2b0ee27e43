"""Quick checks that all constraints are independent, against the full decision and orientations in NumPy; random matrices."""

import subprocess

import numpy as np
import pytest
from scipy.linalg import qr

from core_objects import linked, needs_compiler
from support import ROOT

RANK_TOLERANCE = 2.0**-23       # of rank.h: rows of which less is left follow from the others
SMALLEST, LARGEST = 9, 60    # velocities: up to eight, `schur` has no look of its own
MATRICES = 24
pytestmark = needs_compiler


@pytest.fixture(scope="module")
def program(tmp_path_factory, core_objects):
    """Program that prints the results of both quick checks; it includes the source file of 'schur'."""
    others = [path for unit, path in core_objects.items() if unit != "formulations/schur"]
    return linked(tmp_path_factory.mktemp("monitor") / "monitor", ROOT / "tests" / "native" / "rank_monitor.c", others)


def path_of_matrices(rng, n, m, pattern=1.0):
    """Matrices one after the other, some nearly the same as the one before, some far from it. Along them a row comes to follow
    from the others that have entries where it has, by any digits, and goes on reversed.
    """
    pattern = np.broadcast_to(pattern, (m, n))
    C, wander = pattern * rng.normal(size=(2, m, n)) * 10 ** rng.uniform(-2, 2, (m, 1))
    row, others = rng.integers(m), rng.normal(size=m)
    others[(pattern != pattern[row]).any(axis=1)] = others[row] = 0
    at, left = 0.0, C[row].copy()
    for i in range(MATRICES):
        at += 10 ** rng.uniform(-4, 0) * 0.3
        moved = C + at * wander
        share = rng.choice([1.0, -1.0]) * 10 ** rng.uniform(-10, 0) if i % 3 == 2 else np.cos(8 * at)
        follows = others @ (moved / np.linalg.norm(moved, axis=1)[:, None]) * np.linalg.norm(left)
        moved[row] = follows + share * left
        yield moved


def of_full_rank(C, start):
    """True if the full decision finds all rows independent: orthogonalization by decreasing residual norm (pivoted QR)."""
    lengths = np.linalg.norm(C, axis=1)
    if not (lengths > RANK_TOLERANCE * start).all():
        return False
    return np.abs(np.diag(qr((C / lengths[:, None]).T, mode="r", pivoting=True)[0])).min() > RANK_TOLERANCE


def orientation(C, before, metric):
    """The sign of det(C1 W C0^T), and 0 where rounding decides it."""
    product = C @ metric @ before.T
    product /= np.sqrt(np.outer(np.einsum("ki,ij,kj->k", C, metric, C), np.einsum("ki,ij,kj->k", before, metric, before)))
    return np.linalg.slogdet(product)[0] if np.linalg.cond(product) < 1e10 else 0.0


def said(program, draws, *options):
    """(matrices, looks, 2): of each whether it is doubtful, and whether rows may have been turned since the matrix before."""
    sent = b"".join(np.concatenate([[C.shape[2], C.shape[1], len(C)], M.ravel(), C.ravel()]).tobytes() for M, C in draws)
    lines = subprocess.run([program, *options], input=sent, capture_output=True, check=True).stdout.decode().splitlines()
    return np.array([line.split()[1:] for line in lines], dtype=int).reshape(-1, 2, 2)


def test_monitors_accept_nothing_that_the_full_decision_refuses(program):
    """Dependent rows are never accepted as independent, nor a reversed orientation as the old one: `rank_monitor.c` decides in
    the plain metric, `schur` in that of M^-1. Each case occurs often enough to count.
    """
    rng, draws = np.random.default_rng(3), []
    for n in [*rng.integers(SMALLEST, LARGEST + 1, 150), LARGEST]:
        root = rng.normal(size=(n, n)) / np.sqrt(n)
        draws.append((root @ root.T + 0.1 * np.eye(n), np.array(list(path_of_matrices(rng, n, int(rng.integers(3, n + 1)))))))
    answers = said(program, draws).reshape(len(draws), MATRICES, 2, 2)
    counts = np.zeros((2, 2, 2), dtype=int)
    for (M, matrices), answer in zip(draws, answers, strict=True):
        start, inverse = np.linalg.norm(matrices[0], axis=1), np.linalg.inv(M)
        for i, C in enumerate(matrices):
            full = of_full_rank(C, start)
            for look, metric in enumerate((np.eye(len(M)), inverse)):
                is_doubtful, was_turned = answer[i, look]
                assert full or is_doubtful
                kept = orientation(C, matrices[i - 1], metric) if i and not is_doubtful and not answer[i - 1, look, 0] else 0.0
                assert kept >= 0 or was_turned
                counts[look] += [[not full, full and not is_doubtful], [kept < 0, kept > 0 and not was_turned]]
    assert (counts > 50).all(), counts


def test_what_is_looked_at_packed_is_what_is_looked_at_dense(program):
    """Chains of bodies, with two or three rows for each two. Packed, shares come from products of rows, and dense, from
    orthogonal ones: neither believes what the full decision refuses, and they disagree at most about shares near their bound,
    from which both look further. The program compares what both let rows change by.
    """
    rng, draws = np.random.default_rng(5), []
    for i, bodies in enumerate(rng.integers(2, 12, 60)):
        pattern = np.kron(np.eye(bodies - 1, bodies) + np.eye(bodies - 1, bodies, 1), np.ones((2 + i % 2, 3)))
        m, n = pattern.shape
        draws.append((np.eye(n), np.array(list(path_of_matrices(rng, n, m, pattern)))))
    answers = said(program, draws, "packed").reshape(len(draws), MATRICES, 2, 2)
    refused = 0
    for (_, matrices), answer in zip(draws, answers, strict=True):
        start = np.linalg.norm(matrices[0], axis=1)
        for i, C in enumerate(matrices):
            full, (is_doubtful, was_turned) = of_full_rank(C, start), answer[i, 1]
            refused += not full
            assert full or is_doubtful
            believed = i and not is_doubtful and not answer[i - 1, 1, 0]
            assert was_turned or not believed or orientation(C, matrices[i - 1], np.eye(C.shape[1])) >= 0
    assert refused > 50
    assert (answers[:, :, 0] == answers[:, :, 1]).mean() > 0.98
