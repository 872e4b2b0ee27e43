"""Sines and cosines of the core: to a unit in the last place, of angles of any size, and the same bits however compiled."""

import csv
import ctypes
import subprocess

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from angles import CONTRACTED, KINDS, angles_of, assert_accurate, assert_same
from native_systems import COMPILER, needs_compiler
from support import ROOT, assert_close

pytestmark = needs_compiler

SOURCE, TABLE = (ROOT / "tests" / "native" / name for name in ("sines.c", "sines.csv"))
FLAGS = ["-O3", "-std=c11", "-ffp-contract=off"]
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wno-sign-conversion", "-Wshadow", "-Wstrict-prototypes", "-Werror"]
VECTORS = 4.0       # what the C library's say of their own for vectors
SIZES = (1, 2, 3, 4, 5, 8, 11)
COUNT = 4 * 3 * 5 * 8 * 11


def compiled(target, *flags):
    """Linked without the flags: with -ffast-math some compilers have a library change how its whole process rounds."""
    source = target.with_suffix(".o")
    subprocess.run([COMPILER, *flags, "-c", "-fPIC", f"-I{zd.get_include()}", "-o", source, SOURCE], check=True)
    subprocess.run([COMPILER, "-shared", "-o", target, source, "-lm"], check=True)
    return ctypes.CDLL(target)


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return compiled(tmp_path_factory.mktemp("sines") / "sines.so", *FLAGS, *STRICT)


def evaluated(library, angles, beside=None):
    angles = np.ascontiguousarray(angles, float)
    s, c = np.empty_like(angles), np.empty_like(angles)
    arrays = [ctypes.c_void_p(array.ctypes.data) for array in (angles, s, c)]
    if beside is None:
        library.each_by_itself(len(angles), *arrays)
    else:
        assert len(angles) % beside == 0
        library.sines(len(angles), beside, *arrays)
    return s, c


@pytest.mark.parametrize("kind", KINDS)
def test_accuracy(library, kind):
    angles = angles_of(kind)
    found = evaluated(library, angles)
    assert_accurate(found, angles)
    s, c = evaluated(library, -angles)
    assert np.array_equal(s, -found[0])
    assert np.array_equal(c, found[1])


def test_zeros_keep_their_sign_and_infinities_have_no_value(library):
    angles = np.array([0.0, -0.0, 5e-324, -5e-324, np.inf, -np.inf, np.nan, 1.0])
    for beside in (None, 1, 2, 4, 8):
        s, c = evaluated(library, angles, beside)
        assert np.array_equal(s[:4], angles[:4])
        assert np.array_equal(np.signbit(s[:4]), np.signbit(angles[:4]))
        assert (c[:4] == 1).all()
        assert np.isnan([s[4:7], c[4:7]]).all()
        assert abs(s[7] - np.sin(1.0)) < 1e-15


@pytest.mark.parametrize("beside", SIZES)
def test_an_angle_gives_the_same_bits_whatever_stands_beside_it(library, beside):
    random = np.random.default_rng(beside)
    angles = random.uniform(-50, 50, COUNT)
    angles[::17] *= 1e7         # so that some of those beside it are far
    assert_same(evaluated(library, angles, beside), evaluated(library, angles))


@pytest.mark.parametrize("flags", ["-O0", "-Os", "-O3 -march=native", "-O3 -fno-tree-vectorize -fwrapv"])
def test_the_same_bits_however_it_is_compiled(library, tmp_path, flags):
    other = compiled(tmp_path / "other.so", "-std=c11", "-ffp-contract=off", *flags.split())
    for angles in map(angles_of, KINDS):
        assert_same(evaluated(other, angles), evaluated(library, angles))
        whole = angles[: len(angles) // 3 * 3]
        assert_same(evaluated(other, whole, 3), evaluated(library, whole))


@pytest.mark.parametrize(("flags", "ulps"), [("-ffp-contract=fast -march=native", CONTRACTED), ("-ffast-math", VECTORS)])
def test_accurate_even_where_operations_are_contracted_or_reordered(tmp_path, flags, ulps):
    other = compiled(tmp_path / "other.so", "-O3", *flags.split())
    for kind in ("of a few turns", "of many turns", "huge"):
        assert_accurate(evaluated(other, angles_of(kind)), angles_of(kind), ulps)


def test_bits_are_those_of_the_table(library):
    """Which was written on one machine, and holds on all; its values are compared with exact ones, too."""
    with TABLE.open(newline="") as file:
        rows = [[float.fromhex(entry) for entry in row] for row in csv.reader(line for line in file if not line.startswith("#"))]
    angles, *expected = np.array(rows).T
    assert len(angles) > 100
    assert_accurate(expected, angles)
    assert_same(evaluated(library, angles), expected)


@pytest.mark.parametrize("largest", [9.0, 1e7, 1e150])
def test_systems_use_them(library, largest):
    """Built in and symbolic ones, whose compiled functions have those of angles that are far from the core."""
    import sympy as sp

    alpha = np.random.default_rng(1).uniform(-largest, largest, 3)
    alpha[1] = 2.0
    s, c = evaluated(library, alpha)
    C = zd.systems.four_bar().evaluate(alpha).C
    lengths = np.array([0.3, 1.0, 0.6])
    assert_same(C, [-lengths * s, lengths * c])
    p, v = sp.symbols("p:3"), sp.symbols("v:3")
    system = zd.symbolic(p, speeds=v, kinetic=sum(rate**2 for rate in v) / 2, potential=sp.S(0),
                         force=[sp.sin(p[0]), sp.cos(p[1]) * v[0] ** 2, sp.sin(sp.cos(p[2]) - v[1]) + sp.sin(v[0])])
    rates = np.array([2.0, 0.5, 3.0]) * [largest / 9.0, 1.0, 1.0]
    evaluation = system.evaluate(alpha, rates)
    sines = evaluated(library, [c[2] - rates[1], rates[0]])[0]
    assert_same(evaluation.f, [s[0], c[1] * rates[0] ** 2, sines[0] + sines[1]])
    assert_close(evaluation.power, evaluation.f @ rates, tol.SAME)
