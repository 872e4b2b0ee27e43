"""CVODES and IDAS of SUNDIALS through CasADi: expressions evaluated in C, and exact Jacobians of them.

CVODES has the index-1 equations with accelerations solved for, IDAS the same with accelerations and multipliers as algebraic
unknowns. Neither is stabilized.
"""

import functools
import time

import casadi as ca
import numpy as np
import sympy as sp

TOLERANCES = 10.0 ** -np.arange(2, 12.5, 0.5)
FUNCTIONS = {name: getattr(ca, name) for name in ("sin", "cos", "sqrt")}


def sweeps(problem):
    """The settings of each method."""
    return {f"SUNDIALS {name}": [(name, tolerance) for tolerance in TOLERANCES] for name in ("CVODES", "IDAS")}


def equations(problem):
    """The state, accelerations with multipliers, and what has to vanish of these: matrix times them less the right side."""
    n, m = problem.n, len(problem.constraints)
    y = ca.SX.sym("y", 2 * n)
    p, v = [y[i] for i in range(n)], [y[n + i] for i in range(n)]
    M, force, C, b = sp.lambdify([problem.p, problem.v], problem.terms, modules=[FUNCTIONS], cse=True)(p, v)
    rows = ca.vertcat(*(ca.horzcat(*row) for row in C))
    M = ca.vertcat(*(ca.horzcat(*row) for row in M))
    return y, ca.blockcat(M, rows.T, rows, ca.SX(m, m)), ca.vertcat(*force, *b)


@functools.cache
def integrator_of(problem, name, tolerance):
    """Made beforehand, as a model is."""
    n, m = problem.n, len(problem.constraints)
    y, matrix, right = equations(problem)
    if name == "CVODES":
        dae = {"x": y, "ode": ca.vertcat(y[n:], ca.solve(matrix, right)[:n])}
    else:
        z = ca.SX.sym("z", n + m)
        dae = {"x": y, "z": z, "ode": ca.vertcat(y[n:], z[:n]), "alg": matrix @ z - right}
    options = {"reltol": tolerance, "abstol": tolerance, "max_num_steps": 200_000}
    if name == "IDAS":
        options["suppress_algebraic"] = True    # multipliers are large, and their noise would reject every step of IDAS
    return ca.integrator("run", name.lower(), dae, 0.0, list(problem.times[1:]), options)


def solve(problem, setting):
    """Coordinates (k, n) at the outputs, and seconds."""
    name, tolerance = setting
    run, y0 = integrator_of(problem, name, tolerance), np.concatenate([problem.p0, np.zeros(problem.n)])
    given = {"x0": y0} | ({"z0": start_of(problem)} if name == "IDAS" else {})
    start = time.process_time()
    found = np.array(run(**given)["xf"])
    seconds = time.process_time() - start
    return np.vstack([y0[:problem.n], found[:problem.n].T]), seconds


@functools.cache
def start_of(problem):
    """Accelerations and multipliers at the start."""
    y, matrix, right = equations(problem)
    found = ca.Function("f", [y], [matrix, right])(np.concatenate([problem.p0, np.zeros(problem.n)]))
    return np.linalg.solve(*map(np.array, found)).ravel()
