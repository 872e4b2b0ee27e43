"""Roots of the core against long arithmetic, from the smallest double to the largest."""

import ctypes
import subprocess

import mpmath
import numpy as np
import pytest

from core_objects import CC, CSRC, needs_compiler
from support import ROOT

pytestmark = needs_compiler

SOURCES = (ROOT / "tests" / "native" / "roots.c", CSRC / "linalg" / "roots.c")
SMALLEST, LARGEST = 5e-324, np.finfo(float).max
RELATIVE = 2.0**-51     # two units in the last place: roundings of the last iteration, or of both squares, make less


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    target = tmp_path_factory.mktemp("roots") / "roots.so"
    flags = ["-O2", "-std=c11", "-ffp-contract=off", "-shared", "-fPIC", "-I", CSRC]
    subprocess.run([CC, *flags, "-o", target, *SOURCES, "-lm"], check=True)
    return ctypes.CDLL(target)


def pointer(array):
    return ctypes.c_void_p(array.ctypes.data)


def drawn(seed, count=200):
    """Random numbers over the whole range of doubles, with both ends of it and powers of two, which have exact roots."""
    rng = np.random.default_rng(seed)
    exponents = np.concatenate([rng.uniform(-1074, 1023.9, count), np.arange(-1074, 1024, 37.0)])
    return np.append(2.0**exponents, [SMALLEST, LARGEST, 1.0])


@pytest.mark.parametrize("k", range(1, 17))
def test_roots(library, k):
    x = drawn(k)
    found = np.empty_like(x)
    library.roots(len(x), k, pointer(x), pointer(found))
    with mpmath.workdps(40):
        for each, root in zip(x, found, strict=True):
            assert abs(mpmath.mpf(root) / mpmath.root(mpmath.mpf(each), k) - 1) < RELATIVE


@pytest.mark.parametrize("k", [1, 5, 8])
def test_roots_of_what_has_none_but_itself(library, k):
    x = np.array([0.0, np.inf, np.nan])
    found = np.empty_like(x)
    library.roots(len(x), k, pointer(x), pointer(found))
    assert np.array_equal(found, x, equal_nan=True)


def test_hypotenuses(library):
    x = np.minimum(drawn(0), LARGEST / 2)       # beyond, the hypotenuse itself may have no double
    rng = np.random.default_rng(1)
    y = x * 2.0 ** rng.uniform(-60, 0, len(x)) * rng.choice([-1, 1], len(x))
    x, y = np.append(x, y), np.append(y, x)
    found = np.empty_like(x)
    library.hypotenuses(len(x), pointer(x), pointer(y), pointer(found))
    with mpmath.workdps(40):
        for a, b, c in zip(x, y, found, strict=True):
            exact = mpmath.hypot(mpmath.mpf(a), mpmath.mpf(b))
            assert abs(mpmath.mpf(c) - exact) <= max(RELATIVE * exact, SMALLEST)


@pytest.mark.parametrize(("x", "y", "length"), [
    (0.0, 0.0, 0.0), (-0.0, 3.0, 3.0), (-np.inf, 1.0, np.inf), (np.nan, 1.0, np.nan), (3.0, -4.0, 5.0)])
def test_hypotenuses_of_what_is_special(library, x, y, length):
    x, y, found = np.array([x]), np.array([y]), np.empty(1)
    library.hypotenuses(1, pointer(x), pointer(y), pointer(found))
    assert np.array_equal(found, [length], equal_nan=True)
