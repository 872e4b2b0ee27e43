"""First and second derivatives with respect to many leaves at once, of random expressions: against SymPy's, and differences."""

import itertools

import numpy as np
import pytest
import sympy as sp

import tolerances as tol
from support import assert_close
from zerodrift.symbolics.emit import program_writer
from zerodrift.symbolics.graph.from_sympy import Reader
from zerodrift.symbolics.graph.gradient import Gradient, Hessian
from zerodrift.symbolics.graph.lowering import Lowering

SIZE = 5
X = sp.symbols(f"x:{SIZE}")
A = sp.Symbol("a")
VALUES = np.array([0.7])
POINTS = np.random.default_rng(3).uniform(0.3, 1.4, (6, SIZE))


def random_expression(chance, depth):
    """Random expression of a few variables, with sums and products more often than functions."""
    if depth == 0:
        return X[chance.integers(SIZE)] if chance.random() < 0.8 else A + sp.Rational(int(chance.integers(1, 9)), 4)
    parts = [random_expression(chance, depth - 1) for _ in range(chance.integers(2, 4))]
    match chance.integers(7):
        case 0 | 1:
            return sum(parts)
        case 2 | 3:
            return sp.Mul(*parts)
        case 4:
            return sp.sin(parts[0]) + sp.cos(parts[1]) * parts[0]
        case 5:
            return sp.Piecewise((parts[0] ** 2, parts[1] < 1), (parts[1], True)) / (2 + parts[0] ** 2)
        case _:
            return sp.sqrt(3 + sum(parts) ** 2) + sp.atan2(parts[0], 2 + parts[1] ** 2)


def energy(chance):
    """Squares and products of sums that are linear in the last variables, as in kinetic energies, and other terms."""
    linear = [sum(sp.sin(X[0] + i) * x if chance.random() < 0.7 else x / 2 for x in X[1:]) for i in range(3)]
    return (A * linear[0] ** 2 / 2 + linear[1] * linear[2] * sp.cos(X[0]) + A * X[1] * X[2] + X[3] ** 2 * linear[1]
            + (linear[2] + X[0] ** 2) ** 2 / 3 + X[4] ** 2 / (1 + X[0] ** 2) + linear[0])


EXPRESSIONS = [*(random_expression(np.random.default_rng(seed), 3) for seed in range(12)),
               *(energy(np.random.default_rng(seed)) for seed in range(4))]


def read(expression):
    """The graph, the leaves and the node."""
    reader = Reader()
    leaves = [reader.graph.leaf("p", i) for i in range(SIZE)]
    known = {**dict(zip(X, leaves, strict=True)), A: reader.graph.leaf("parameter", 0)}
    return reader.graph, leaves, reader.read("expression", expression, known)


def values(graph, nodes, points=POINTS):
    """Values of nodes at points, (points, nodes)."""
    lowering = Lowering(graph)
    evaluate = program_writer.evaluator(lowering, {"of": [lowering.lower(node) for node in nodes]}, VALUES, SIZE)
    return evaluate(np.zeros(len(points)), points)["of"]


def by_sympy(expressions):
    """Their values at the points."""
    evaluate = sp.lambdify([X, A], list(expressions), "math")
    return np.array([evaluate(point, VALUES[0]) for point in POINTS], dtype=float)


@pytest.mark.parametrize("expression", EXPRESSIONS, ids=range(len(EXPRESSIONS)))
def test_first_and_second_derivatives(expression):
    graph, leaves, node = read(expression)
    gradient = Gradient(graph, leaves)
    hessian = Hessian(graph, gradient, node)
    slopes = [gradient(node).get(leaf, graph.zero) for leaf in leaves]
    found, exact = values(graph, slopes), by_sympy(expression.diff(x) for x in X)
    scale = 1 + np.abs(exact).max()
    assert_close(found, exact, tol.EXACT, scale=scale)
    pairs = list(itertools.combinations_with_replacement(range(SIZE), 2))
    second = by_sympy(expression.diff(X[i]).diff(X[j]) for i, j in pairs)
    assert_close(values(graph, [hessian[leaves[i], leaves[j]] for i, j in pairs]), second, tol.EXACT,
                 scale=1 + np.abs(second).max())

    h = 1e-6    # and, of no derivative rule: an error of h^2, and of rounding / h
    for i in range(SIZE):
        ahead, behind = (values(graph, [node], POINTS + sign * h * np.eye(SIZE)[i])[:, 0] for sign in (1, -1))
        assert_close(found[:, i], (ahead - behind) / (2 * h), 1e-8, scale=scale * 10)


@pytest.mark.parametrize("expression", EXPRESSIONS, ids=range(len(EXPRESSIONS)))
def test_the_derivative_along_a_leaf_is_an_entry_of_the_gradient(expression):
    graph, leaves, node = read(expression)
    gradient = Gradient(graph, leaves)(node)
    assert all(entry is not graph.zero for entry in gradient.values())
    for leaf in leaves:
        assert graph.derivative_along({leaf: graph.one})(node) is gradient.get(leaf, graph.zero)


def test_only_leaves_that_are_there_are_gone_through():
    """A sum of n squares, each of one variable, has n slopes and n second derivatives in the graph."""
    graph, leaves, node = read(sum(x**2 for x in X))
    gradient = Gradient(graph, leaves)
    assert list(gradient(node)) == leaves
    hessian = Hessian(graph, gradient, node)
    assert [[hessian[a, b] for b in leaves] for a in leaves] == [
        [graph.number(2) if a is b else graph.zero for b in leaves] for a in leaves]


@pytest.mark.parametrize(("given", "expected"), [
    (sp.sin(X[2]) * (X[0] - X[1]) * X[1] - sp.sin(X[2]) * X[0] * X[1], -sp.sin(X[2]) * X[1]**2),
    (A * (X[0] - X[1]) * (X[0] + X[1]) - A * X[0]**2, -A * X[1]**2),
    ((X[0] + X[1]) * X[2] - X[0] * X[2] - X[1] * X[2], sp.S.Zero),
    ((X[0] + X[1]) * (X[0] + X[2]) * sp.sin(X[3]) + X[0], None), ((X[0] + X[1]) * X[2], None)])
def test_sums_of_leaves_are_multiplied_out_where_that_leaves_fewer_terms(given, expected):
    """Else, which is where nothing is expected, what was given stays."""
    reader = Reader()
    known = {**{x: reader.graph.leaf("p", i) for i, x in enumerate(X)}, A: reader.graph.leaf("parameter", 0)}
    node = reader.read("given", given, known)
    assert reader.graph.collected(node, "p") is (node if expected is None else reader.read("expected", expected, known))
