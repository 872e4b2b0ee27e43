"""SciPy's Radau on the index-1 equations in NumPy, without any stabilization."""

import time

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

TOLERANCES = 10.0 ** -np.arange(2, 8.5, 2)      # finer ones take minutes
LONGEST = 10.0          # s: a run that takes longer is given up, as on a hard spring at 1e-8, whose differences are rounding


def sweeps(problem):
    """The settings of each method."""
    return {"SciPy Radau": [("Radau", tolerance) for tolerance in TOLERANCES]}


def rate_of(problem):
    """The function (t, y) -> ydot."""
    n, m = problem.n, len(problem.constraints)
    evaluate = sp.lambdify([problem.p, problem.v], problem.terms, cse=True)

    def rate(t, y):
        M, force, C, b = evaluate(y[:n], y[n:])
        matrix = np.zeros((n + m, n + m))
        matrix[:n, :n], matrix[n:, :n] = M, C
        matrix[:n, n:] = matrix[n:, :n].T
        return np.concatenate([y[n:], np.linalg.solve(matrix, np.concatenate([force, b]))[:n]])

    return rate


def solve(problem, setting):
    """Coordinates (k, n) at the outputs, and seconds."""
    method, tolerance = setting
    rate, y0 = rate_of(problem), np.concatenate([problem.p0, np.zeros(problem.n)])
    start = time.process_time()

    def bounded(t, y):
        if time.process_time() - start > LONGEST:
            raise TimeoutError(f"had not ended after {LONGEST:g} s")
        return rate(t, y)

    solution = solve_ivp(bounded, (0, problem.t_end), y0, method, t_eval=problem.times, rtol=tolerance, atol=tolerance)
    return solution.y[:problem.n].T, time.process_time() - start
