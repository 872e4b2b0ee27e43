"""Kernels of double-double arithmetic against mpmath, and the bits of both products against each other."""

import ctypes
import math

import mpmath
import numpy as np
import pytest

from native_systems import needs_compiler
from zerodrift.studies import double_double as dd
from zerodrift.symbolics.compile import shared_library

ARITHMETIC, FUNCTIONS = 2.0**-102, 2.0**-98     # errors that the header promises; of functions, of max(1, x, f(x))
BINARY = {"plus": lambda a, b: a + b, "minus": lambda a, b: a - b, "times": lambda a, b: a * b, "over": lambda a, b: a / b}
UNARY = {
    "root": (mpmath.sqrt, 0, 1e6), "sin": (mpmath.sin, -1e4, 1e4), "cos": (mpmath.cos, -1e4, 1e4), "tan": (mpmath.tan, -1.5, 1.5),
    "exp": (mpmath.exp, -30, 30), "log": (mpmath.log, 1e-6, 1e6), "atan": (mpmath.atan, -20, 20), "asin": (mpmath.asin, -1, 1),
    "acos": (mpmath.acos, -1, 1), "sinh": (mpmath.sinh, -20, 20), "cosh": (mpmath.cosh, -20, 20), "tanh": (mpmath.tanh, -20, 20),
    "asinh": (mpmath.asinh, -1e3, 1e3), "acosh": (mpmath.acosh, 1, 1e3), "atanh": (mpmath.atanh, -0.999, 0.999),
    "floor": (mpmath.floor, -1e3, 1e3), "ceil": (mpmath.ceil, -1e3, 1e3), "fabs": (abs, -1e3, 1e3)}
PAIRED = {"pow": (lambda a, b: mpmath.power(a, b), (0.01, 20), (-6, 6)), "atan2": (mpmath.atan2, (-5, 5), (-5, 5))}
COUNT = 400

pytestmark = needs_compiler


def loop(name, arguments):
    """C of a function that applies an operation to pairs of doubles."""
    given = ", ".join(f"((const zd_double_double *){x})[i]" for x in "ab"[:arguments])
    return f"""ZD_DD_ON void each_{name}(int n, const double *a, const double *b, double *to)
{{ (void)b; for (int i = 0; i < n; i++) ((zd_double_double *)to)[i] = zd_dd_{name}({given}); }}"""


@pytest.fixture(scope="module")
def libraries():
    """The kernels with Dekker's product, and with fma where the processor has it."""
    names = {**dict.fromkeys(BINARY, 2), **dict.fromkeys(UNARY, 1), **dict.fromkeys(PAIRED, 2)}
    source = "\n".join(["#include <zerodrift/series.h>", *(loop(*item) for item in names.items()), ""])
    defined = ["ZD_SERIES_DOUBLE_DOUBLE", "ZD_SERIES_SIZE=1"]
    found = [shared_library.library(source, symbols=[f"each_{name}" for name in names], optimized=("-O2",),
                                    defined=[*defined, f"ZD_SERIES_UNIT={unit}"]) for unit in (0, has_fma())]
    return found


def has_fma():
    from zerodrift._private import gateway

    return int(gateway.PROCESSOR_UNIT > 0)


def applied(library, name, a, b=None):
    to = np.empty_like(a)
    pointers = [x.ctypes.data_as(ctypes.c_void_p) for x in (a, a if b is None else b, to)]
    getattr(library, f"each_{name}")(len(a), *pointers)
    return to


def pairs(chance, low, high, count=COUNT):
    """Numbers with all of their 106 bits."""
    x = chance.uniform(low, high, count)
    return np.stack([x, np.spacing(x) * chance.uniform(-0.49, 0.49, count)], axis=-1)


def exact(x):
    return mpmath.mpf(float(x[0])) + mpmath.mpf(float(x[1]))


def wide(chance, exponents):
    """Numbers of any size between powers of ten."""
    x = 10.0**chance.uniform(-exponents, exponents, COUNT) * chance.choice([-1, 1], COUNT)
    return np.stack([x, np.spacing(x) * chance.uniform(-0.49, 0.49, COUNT)], axis=-1)


@pytest.mark.parametrize("exponents", [1, 140])
@pytest.mark.parametrize("name", BINARY)
def test_sums_products_and_quotients(libraries, name, exponents):
    chance = np.random.default_rng(1)
    a, b = wide(chance, exponents), wide(chance, exponents)
    if name in ("plus", "minus"):       # and what cancels
        b[::2] = a[::2] * (1 + 1e-9) * (1 if name == "minus" else -1)
        b = np.stack([b[:, 0], np.spacing(b[:, 0]) / 5], axis=-1)
    found = applied(libraries[0], name, a, b)
    with mpmath.workdps(80):
        for x, y, z in zip(a, b, found, strict=True):
            true = BINARY[name](exact(x), exact(y))
            assert abs(exact(z) - true) <= ARITHMETIC * abs(true)
            assert z[0] == z[0] + z[1]


@pytest.mark.parametrize("name", UNARY)
def test_functions(libraries, name):
    function, low, high = UNARY[name]
    a = pairs(np.random.default_rng(2), low, high)
    a[:, 0] = np.clip(a[:, 0], low, high)
    a[:3] = [[np.clip(x, low, high), 0] for x in (0, low, high)]
    found = applied(libraries[0], name, a)
    with mpmath.workdps(80):
        for x, z in zip(a, found, strict=True):
            true = function(exact(x))
            bound = (ARITHMETIC * abs(true) if name in ("root", "floor", "ceil", "fabs")
                     else FUNCTIONS * max(1, abs(true), abs(exact(x))))
            assert abs(exact(z) - true) <= bound or not np.isfinite(float(true)), (name, x)


@pytest.mark.parametrize("name", PAIRED)
def test_functions_of_two_numbers(libraries, name):
    function, of_a, of_b = PAIRED[name]
    chance = np.random.default_rng(3)
    a, b = pairs(chance, *of_a), pairs(chance, *of_b)
    b[:20] = np.stack([np.round(b[:20, 0]), np.zeros(20)], axis=-1)
    found = applied(libraries[0], name, a, b)
    with mpmath.workdps(80):
        for x, y, z in zip(a, b, found, strict=True):
            true = function(exact(x), exact(y))
            assert abs(exact(z) - true) <= FUNCTIONS * max(1, abs(true)) * 32, (x, y)      # of y log x, up to 18, the size counts


def test_extreme_operands(libraries):
    large, tiny = np.array([[1e300, 1e283]]), np.array([[1e-140, 1e-157]])
    with mpmath.workdps(80):
        assert abs(exact(applied(libraries[0], "times", large, tiny)[0]) / (exact(large[0]) * exact(tiny[0])) - 1) <= ARITHMETIC
        assert abs(exact(applied(libraries[0], "root", large)[0]) / mpmath.sqrt(exact(large[0])) - 1) <= ARITHMETIC
        small = tiny * 2.0**480
        assert abs(exact(applied(libraries[0], "over", large, small)[0]) / (exact(large[0]) / exact(small[0])) - 1) <= ARITHMETIC
    one = np.array([[1.0, 0.0]])
    assert not math.isfinite(applied(libraries[0], "over", one, 0 * one)[0, 0])
    assert math.isnan(applied(libraries[0], "sin", np.array([[math.inf, 0.0]]))[0, 0])
    assert math.isnan(applied(libraries[0], "root", -one)[0, 0])
    assert applied(libraries[0], "exp", -1000 * one)[0, 0] == 0
    assert applied(libraries[0], "exp", 1000 * one)[0, 0] == math.inf


def test_both_products_have_the_same_bits(libraries):
    if not has_fma():
        pytest.skip("needs a processor with fma")
    chance = np.random.default_rng(4)
    for name in (*BINARY, *UNARY, *PAIRED):
        a, b = (wide(chance, 140), wide(chance, 140)) if name in BINARY else (pairs(chance, 0.1, 0.9), pairs(chance, 0.1, 0.9))
        first, second = (applied(library, name, a, b) for library in libraries)
        assert first.tobytes() == second.tobytes() or np.isnan(first).any(), name


def test_numpys_sums_and_products():
    chance = np.random.default_rng(5)
    a, b = wide(chance, 100), wide(chance, 100)
    with mpmath.workdps(80):
        for found, of in ((dd.plus(a, b), "plus"), (dd.minus(a, b), "minus"), (dd.times(a, b), "times")):
            for x, y, z in zip(a, b, found, strict=True):
                true = BINARY[of](exact(x), exact(y))
                assert abs(exact(z) - true) <= dd.EPS * abs(true)
        total = sum(map(exact, a))
        assert abs(exact(dd.total(a)) - total) <= 400 * dd.EPS * max(abs(exact(x)) for x in a)
