"""Equations written out for whoever compiles expressions: with floats, symbols, or what records operations.

`Free` has them with velocities eliminated, of every problem; below it stand those of a chain.
"""

import itertools
from typing import Any, NamedTuple

import numpy as np


class Free(NamedTuple):
    """Equations in few velocities: which these are, and how the others and all accelerations follow."""

    places: list[int]
    spread: Any     # (p, u) -> v
    vdot: Any       # (p, v) -> vdot


def eliminated(problem, functions):
    """With velocities eliminated: of a chain, those of the two rods that are least parallel at the start."""
    if hasattr(problem, "reduced"):
        return Free([0], lambda p, u: problem.spread(p, u[0], functions), lambda p, v: problem.reduced(p, v, functions))
    sin, cos = functions["sin"], functions["cos"]
    pair = least_parallel(problem.p0, np.sin)
    return Free([i for i in range(problem.n) if i not in pair], lambda p, u: reduced(problem, p, None, pair, sin, cos)(u),
                lambda p, v: reduced(problem, p, v, pair, sin, cos))


def with_all(problem, functions):
    """The function (p, v) -> vdot with the multipliers eliminated, as in (13)."""
    if hasattr(problem, "with_multipliers"):
        return lambda p, v: problem.with_multipliers(p, v, functions)
    return lambda p, v: with_multipliers(problem, p, v, functions["sin"], functions["cos"])


def reduced(chain, p, v, pair, sin, cos):
    """D u + gamma of (14), (15), from D^T times (2): for rods `pair`, whose velocities follow from the others'.

    Returns a function from the velocities u of the other rods to all of them, and vdot; `v` may be what that function gives.
    """
    n, lengths = chain.n, chain.lengths.tolist()
    (a, b), free = pair, [i for i in range(n) if i not in pair]
    s, c = _differences(p, sin, cos)
    D = {a: [-lengths[j] / lengths[a] * s[j][b] / s[a][b] for j in free],
         b: [lengths[j] / lengths[b] * s[j][a] / s[a][b] for j in free]}

    def spread(u):
        return [dot(D[i], u) if i in D else u[free.index(i)] for i in range(n)]

    if v is None:
        return spread
    pulls = [lengths[i] * v[i] * v[i] for i in range(n)]
    gamma = {a: sum((pulls[i] * c[i][b] for i in range(n) if i != b), pulls[b]) / (lengths[a] * s[a][b]),
             b: -sum((pulls[i] * c[i][a] for i in range(n) if i != a), pulls[a]) / (lengths[b] * s[a][b])}
    M, force = _mass_and_force(chain, p, v, s, c, cos)
    MD = [[M[i][free[k]] + M[i][a] * D[a][k] + M[i][b] * D[b][k] for k in range(len(free))] for i in range(n)]
    rest = [force[i] - M[i][a] * gamma[a] - M[i][b] * gamma[b] for i in range(n)]
    left = [[MD[free[i]][k] + D[a][i] * MD[a][k] + D[b][i] * MD[b][k] for k in range(len(free))] for i in range(len(free))]
    udot, = solved(left, [[rest[free[i]] + D[a][i] * rest[a] + D[b][i] * rest[b] for i in range(len(free))]])
    return [rate + gamma[i] if i in gamma else rate for i, rate in enumerate(spread(udot))]


def with_multipliers(chain, p, v, sin, cos):
    """The accelerations of (13)."""
    n, lengths = chain.n, chain.lengths.tolist()
    M, force = _mass_and_force(chain, p, v, *_differences(p, sin, cos), cos)
    C = [[-lengths[i] * sin(p[i]) for i in range(n)], [lengths[i] * cos(p[i]) for i in range(n)]]
    squares = [rate * rate for rate in v]
    free, first, second = solved(M, [force, *C])
    r = [dot(C[0], free) - dot(C[1], squares), dot(C[1], free) + dot(C[0], squares)]      # C M^-1 (f - d) - xi
    multipliers, = solved([[dot(row, column) for column in (first, second)] for row in C], [r])
    return [free[i] - first[i] * multipliers[0] - second[i] * multipliers[1] for i in range(n)]


def least_parallel(angles, sin):
    """The two rods between which the sine of the angle is largest."""
    pairs = itertools.combinations(range(len(angles)), 2)
    return max(pairs, key=lambda pair: abs(sin(angles[pair[1]] - angles[pair[0]])))


def _differences(p, sin, cos):
    """Sine and cosine of p[j] - p[i]."""
    n = len(p)
    s, c = ([[start] * n for _ in range(n)] for start in (0.0, 1.0))
    for i, j in itertools.combinations(range(n), 2):
        s[i][j], c[i][j] = sin(p[j] - p[i]), cos(p[j] - p[i])
        s[j][i], c[j][i] = -s[i][j], c[i][j]
    return s, c


def _mass_and_force(chain, p, v, s, c, cos):
    """M and f - d of (2)."""
    n, K, w = chain.n, chain.coupling.tolist(), chain.weight.tolist()
    M = [[K[i][j] * c[i][j] if i != j else K[i][i] for j in range(n)] for i in range(n)]
    squares = [rate * rate for rate in v]
    return M, [sum((K[i][j] * s[i][j] * squares[j] for j in range(n) if i != j), -w[i] * cos(p[i])) for i in range(n)]


def dot(a, b):
    """The sum of products, without those of numbers that are zero."""
    products = [x * y for x, y in zip(a, b, strict=True) if not (is_zero(x) or is_zero(y))]
    return sum(products[1:], products[0]) if products else 0


def is_zero(x):
    """True if x is the literal number zero, not a computed expression."""
    return isinstance(x, int | float) and x == 0


def solved(A, right_hand_sides):
    """A x = b for a symmetric positive definite A, by L D L^T."""
    n = len(A)
    L, D = [[None] * n for _ in range(n)], [None] * n
    for i in range(n):
        for j in range(i):
            L[i][j] = A[i][j]
            for k in range(j):
                L[i][j] = L[i][j] - L[i][k] * D[k] * L[j][k]
            L[i][j] = L[i][j] / D[j]
        D[i] = A[i][i]
        for k in range(i):
            D[i] = D[i] - L[i][k] * L[i][k] * D[k]
    for b in right_hand_sides:
        y, x = [], [None] * n
        for i in range(n):
            y.append(b[i])
            for k in range(i):
                y[i] = y[i] - L[i][k] * y[k]
        for i in reversed(range(n)):
            x[i] = y[i] / D[i]
            for k in range(i + 1, n):
                x[i] = x[i] - L[k][i] * x[k]
        yield x
