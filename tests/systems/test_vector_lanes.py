"""Numbers in the lanes of vector units: each lane has what it has by itself, and a contraction's bits are those of all units."""

import ctypes
import os
import re
from pathlib import Path

import numpy as np
import pytest

from angles import CONTRACTED, KINDS, angles_of, assert_accurate, assert_same
from native_systems import COMPILER, compile_library
from support import ROOT
from vector_units import SETS, available
from zerodrift._private.core import lib

OF_EACH = 3         # angles of a trajectory, in tests/native/lanes.c
OPERATIONS = 8      # and operations
FMA = ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fma       # of the C library, rounded once
FMA.restype, FMA.argtypes = ctypes.c_double, [ctypes.c_double] * 3
ODD = [0.0, -0.0, 5e-324, np.inf, -np.inf, np.nan, 1e300, 1e-300, 0.5, -2.0]


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    if COMPILER is None or os.name == "nt":
        pytest.skip("there is no C compiler, or with it there are no vector units, as with gcc on Windows")
    target = tmp_path_factory.mktemp("lanes") / "lanes.so"
    return ctypes.CDLL(compile_library(ROOT / "tests" / "native" / "lanes.c", target, "-Wconversion", "-Wno-sign-conversion"))


def function(library, name, of):
    unit, lanes = available(of)
    return getattr(library, f"{name}_{unit}_{lanes}")


def address(array):
    return ctypes.c_void_p(array.ctypes.data)


def sines(library, of, angles):
    """Sines and cosines of angles (groups, OF_EACH, lanes)."""
    angles = np.ascontiguousarray(angles)
    s, c = np.empty_like(angles), np.empty_like(angles)
    function(library, "sines", of)(len(angles), address(angles), address(s), address(c))
    return s, c


def in_groups(angles, lanes):
    """The last group is filled up with the first angles."""
    size = OF_EACH * lanes
    return np.resize(angles, -(-len(angles) // size) * size).reshape(-1, OF_EACH, lanes)


@pytest.mark.parametrize("kind", KINDS)
def test_accuracy_where_products_are_contracted(library, kind):
    """Without contraction they are those of test_sines.py, and all units give the same: see below."""
    angles = in_groups(angles_of(kind), 1)
    found = [values.ravel() for values in sines(library, (1, 1), angles)]
    assert_accurate(found, angles.ravel(), CONTRACTED)
    s, c = sines(library, (1, 1), -angles)
    assert np.array_equal(s.ravel(), -found[0])
    assert np.array_equal(c.ravel(), found[1])


@pytest.mark.parametrize("of", SETS, ids=SETS.get)
def test_zeros_keep_their_sign_and_infinities_have_no_value(library, of):
    angles = np.resize([0.0, -0.0, np.inf, 5e-324, -np.inf, -5e-324, np.nan, 1.0], (8, OF_EACH, of[1]))
    s, c = sines(library, of, angles)
    small = np.abs(angles) < 0.5
    assert np.array_equal(s[small].view(np.int64), angles[small].view(np.int64))
    assert (c[small] == 1).all()
    assert np.isnan(s[~np.isfinite(angles)]).all()
    assert np.isnan(c[~np.isfinite(angles)]).all()
    assert np.abs(s[angles == 1] - np.sin(1.0)).max() < 1e-15


@pytest.mark.parametrize("of", [each for each in SETS if each != (0, 1)], ids=SETS.get)
def test_an_angle_gives_the_same_bits_in_every_lane_and_beside_whatever_stands_there(library, of):
    """Bits equal those of one lane with the same contraction: none for the baseline, and the same for all vector units."""
    angles = np.concatenate([angles_of(kind) for kind in KINDS] + [[np.nan, np.inf]])
    angles = in_groups(np.random.default_rng(8).permutation(angles), 8).ravel()
    by_themselves = [values.ravel() for values in sines(library, (min(of[0], 1), 1), in_groups(angles, 1))]
    is_number = np.isfinite(angles)
    for shift in range(of[1]):
        found = sines(library, of, in_groups(np.roll(angles, shift), of[1]))
        back = [np.roll(values.ravel(), -shift) for values in found]
        assert_same([values[is_number] for values in back], [values[is_number] for values in by_themselves])


@pytest.mark.parametrize("of", SETS, ids=SETS.get)
def test_operations(library, of):
    """Results of each operation in each lane; with a vector unit, products are not rounded before an addition (fused)."""
    operate, lanes = function(library, "operate", of), of[1]
    random = np.random.default_rng(9)
    for _ in range(60):
        a, b, c = random.normal(size=(3, lanes))
        for x in (a, b, c):
            x[random.integers(lanes)] = random.choice(ODD)
        found = np.empty((OPERATIONS, lanes))
        operate(*map(address, (a, b, c, found)))
        for k in range(lanes):
            assert np.array_equal(found[:, k], expected(a[k], b[k], c[k], of[0] > 0), equal_nan=True)
    assert np.signbit(found[7]).all()


def expected(a, b, c, contracts):
    with np.errstate(all="ignore"):
        def sum_of(x, y, z):
            return FMA(x, y, z) if contracts else x * y + z
        return [sum_of(a, b, c), sum_of(a, b, -c), sum_of(-a, b, c), np.sqrt(a), a if a < b else 2.0,
                -0.0 if a < b and not b < c else c, sum_of(a, 0.5, b) if a < b or b == c else 1 / c, -0.0]


def test_the_processor_has_the_unit_that_its_system_says():
    said = Path("/proc/cpuinfo")
    flags = re.search(r"^flags\s*:(.*)$", said.read_text() if said.exists() else "", re.MULTILINE)
    if not flags:
        pytest.skip("nothing here says what the processor has")
    known = set(flags[1].split())
    has = [{"avx2", "fma"}, {"avx512f", "avx512dq", "avx512vl"}]
    assert lib.zd_processor_unit() == (0 if not has[0] <= known else 1 if not has[1] <= known else 2)
