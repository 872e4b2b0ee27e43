"""Tables of explicit Runge-Kutta methods, and the polynomials between the ends of their steps, against the conditions of order.

With weights b, or b(x) at a share x of a step, a method has order p where for each rooted tree t of at most p vertices
sum_j b_j(x) Phi_j(t) = x^|t| / gamma(t): J. C. Butcher, Numerical Methods for Ordinary Differential Equations, section 31. All is
computed in fractions of what the tables hold, so that nothing is left but the rounding of their entries.
"""

import ctypes
import math
import subprocess
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

import zerodrift as zd
from core_objects import CC, CSRC, needs_compiler
from covering import spread

pytestmark = needs_compiler

METHODS = sorted(path.stem for path in (CSRC / "integrators").glob("*.c")
                 if "\nZD_RUNGE_KUTTA_STEP\n" in path.read_text(encoding="utf-8"))
POLYNOMIALS = {"dormand_prince": 4, "dop853": 6}        # whose conditions they meet
CONDITION_ROUNDING = 1e-13  # entries of up to 1200 are rounded at 2^-53, and multiplied by (x z)^2 <= 1 / 16
OFF = 1e-6

NATIVE = """
#include "integrators/runge_kutta.h"
#define TABLE(name) extern const zd_integrator zd_##name; const void *name##_table(void) { return zd_##name.table; }
@TABLES@
/* b(x), as each stage has a rate of its own */
#define WEIGHTS(name)                                                                            \\
    void name##_weights(double *change, double *identity, int all, double x, double *b)          \\
    {                                                                                            \\
        const double zeros[ZD_MAX_STAGES] = {0};                                                \\
        const zd_runge_kutta self = {.size = all, .k = identity, .h = 1, .change = change};      \\
        zd_##name.dense_output(&self, x, zeros, b);                                                   \\
    }
WEIGHTS(dormand_prince)
WEIGHTS(dop853)
"""


# ---- trees, each the sorted tuple of those that are left without its root ----


@cache
def forests(vertices, largest):
    """Tuples of trees of so many vertices together, none with more than `largest`, and of the same size in one order only."""
    if not vertices:
        return [()]
    found = {tuple(sorted((*rest, tree))) for size in range(1, min(vertices, largest) + 1) for tree in trees(size)
             for rest in forests(vertices - size, size)}
    return sorted(found)


def trees(vertices):
    return forests(vertices - 1, vertices - 1)


def vertices_of(tree):
    return 1 + sum(map(vertices_of, tree))


def gamma(tree):
    return vertices_of(tree) * math.prod(map(gamma, tree))


def sigma(tree):
    """Number of symmetries of a tree: exchanges of equal branches."""
    return math.prod(math.factorial(tree.count(each)) * sigma(each) ** tree.count(each) for each in set(tree))


def up_to(order):
    return [tree for vertices in range(1, order + 1) for tree in trees(vertices)]


def test_there_are_as_many_trees_as_are_known():
    assert [len(trees(n)) for n in range(1, 10)] == [1, 1, 2, 4, 9, 20, 48, 115, 286]       # OEIS A000081
    for n in range(1, 9):       # each orders the n - 1! ways of growing it: Butcher's alpha
        assert sum(Fraction(math.factorial(n), sigma(t) * gamma(t)) for t in trees(n)) == math.factorial(n - 1)


# ---- methods ----


class Tableau(ctypes.Structure):
    _fields_ = [("stages", ctypes.c_int), *((name, ctypes.POINTER(ctypes.c_double)) for name in ("a", "b", "c", "e", "e3")),
                ("more", ctypes.c_int), ("coefficients", ctypes.c_int),
                *((name, ctypes.POINTER(ctypes.c_double)) for name in ("more_a", "more_c", "d"))]


def pointer(array):
    return ctypes.c_void_p(array.ctypes.data)


def fractions(numbers, *shape):
    return np.array([Fraction(numbers[i]) for i in range(math.prod(shape))], object).reshape(shape)


def tables_of(library, method):
    """A (all, all), b and c (all,), and the polynomial's d (coefficients - 3, all): behind the stages stands the end."""
    T = ctypes.cast(getattr(library, f"{method}_table")(), ctypes.POINTER(Tableau)).contents
    s, all_of_them = T.stages, T.stages + 1 + T.more
    A, b, c = (np.full(shape, Fraction(0)) for shape in ((all_of_them, all_of_them), all_of_them, all_of_them))
    A[:s, :s], b[:s], c[:s] = fractions(T.a, s, s), fractions(T.b, s), fractions(T.c, s)
    A[s], c[s] = b, Fraction(1)
    A[s + 1:], c[s + 1:] = fractions(T.more_a, T.more, all_of_them), fractions(T.more_c, T.more)
    return {"A": A, "b": b, "c": c, "d": fractions(T.d, max(T.coefficients - 3, 0), all_of_them), "end": s}


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """Coefficients of each method, and the library with their functions."""
    source = tmp_path_factory.mktemp("tables") / "tables.c"
    source.write_text(NATIVE.replace("@TABLES@", "\n".join(f"TABLE({name})" for name in METHODS)))
    methods = [CSRC / "integrators" / f"{name}.c" for name in (*METHODS, "runge_kutta")]
    flags = ["-O0", "-std=c11", "-ffp-contract=off", "-shared", "-fPIC", "-I", CSRC]
    target = source.with_suffix(".so")
    subprocess.run([CC, *flags, "-o", target, source, *methods, CSRC / "workspace.c", "-lm"], check=True)
    library = ctypes.CDLL(target)
    for name in METHODS:
        getattr(library, f"{name}_table").restype = ctypes.c_void_p
    return {"library": library} | {name: tables_of(library, name) for name in METHODS}


# ---- conditions ----


def weights_between(of, x):
    """b(x) by y0 + x (F0 + z (F1 + x (F2 + z (F3 + ...)))), where each F is a sum over the stages."""
    F = [of["b"], 0 - of["b"], 2 * of["b"], *of["d"]]
    F[1][0] += 1
    F[2][[0, of["end"]]] -= 1
    b = F[-1]
    for i in range(len(F) - 2, -1, -1):
        b = F[i] + (x if i % 2 else 1 - x) * b
    return x * b


def elementary_weights(A, order):
    """Phi (all,) of each tree."""
    of = {}
    for tree in up_to(order):
        of[tree] = math.prod((A @ of[branch] for branch in tree), start=A[0] * 0 + 1)
    return of


def misses(of, order, shares=None):
    """For each order up to this, by how much the conditions of its trees are missed: over sigma, as they stand in the error of a
    step, the root of the sum of squares; the largest at these shares of the step, or that at its end.
    """
    Phi = elementary_weights(of["A"], order)
    points = [(1, of["b"])] if shares is None else [(x, weights_between(of, x)) for x in shares]

    def missed(n, x, b):
        return np.linalg.norm([float(b @ Phi[t] - Fraction(x**n) / gamma(t)) / sigma(t) for t in trees(n)])
    return [max(missed(n, x, b) for x, b in points) for n in range(1, order + 1)]


# More than any of the polynomials has coefficients: what holds there holds everywhere.
SHARES = [Fraction(k, 16) for k in range(1, 17)]


def worst(of, method, orders):
    """Largest violation of the conditions that a table must meet."""
    rows = np.abs((of["A"].sum(axis=1) - of["c"]).astype(float)).max()
    between = misses(of, POLYNOMIALS[method], SHARES) if method in POLYNOMIALS else []
    return max([rows, *misses(of, orders), *between])


@pytest.mark.parametrize("method", METHODS)
def test_tables_meet_all_conditions_of_their_orders_and_no_more(tables, method):
    order = zd.integrators()[method].order
    assert worst(tables[method], method, order) <= CONDITION_ROUNDING
    assert misses(tables[method], order + 1)[-1] > 1e-6


def test_what_the_polynomial_of_dop853_misses(tables):
    """Two stages more cannot meet all of order seven: csrc/integrators/dop853.c says by how much, and how much of order eight."""
    *_, seven, eight = misses(tables["dop853"], 8, SHARES)
    assert 7e-8 < seven < 8e-8
    assert 1.3e-5 < eight < 1.4e-5
    for x in SHARES:        # but the quadrature
        assert abs(float(weights_between(tables["dop853"], x) @ tables["dop853"]["c"] ** 6 - x**7 / 7)) <= CONDITION_ROUNDING


def test_what_the_polynomial_of_dormand_prince_misses(tables):
    assert 1e-4 < misses(tables["dormand_prince"], 5, SHARES)[-1] < 1e-3


@pytest.mark.parametrize("method", POLYNOMIALS)
def test_polynomials_are_those_that_the_core_sums(tables, method):
    of = tables[method]
    count = len(of["b"])
    change, identity, found = of["b"].astype(float), np.eye(count), np.empty(count)
    for x in SHARES:
        arguments = [pointer(change), pointer(identity), count, ctypes.c_double(x), pointer(found)]
        getattr(tables["library"], f"{method}_weights")(*arguments)
        assert found == pytest.approx(weights_between(of, x).astype(float), rel=0, abs=CONDITION_ROUNDING)


def in_doubles(of):
    return {name: value.astype(float) if name != "end" else value for name, value in of.items()}


def entries(of):
    """Nonzero entries of a table, as (name, index), without the weights of a step that A repeats."""
    found = [(name, at) for name in ("A", "b", "c", "d") for at in zip(*np.nonzero(of[name]), strict=True)]
    return [(name, at) for name, at in found if (name, at[0]) != ("A", of["end"])]


@pytest.mark.parametrize("method", METHODS)
def test_an_entry_that_is_off_is_noticed(tables, method):
    for name, at in spread(entries(tables[method]), 8):
        of = in_doubles(tables[method])
        of[name][at] += OFF
        if name == "b":
            of["A"][of["end"]] = of["b"]
        assert worst(of, method, zd.integrators()[method].order) > 1000 * CONDITION_ROUNDING, (name, at)
