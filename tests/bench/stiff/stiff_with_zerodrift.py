"""zerodrift: the equations derived and compiled from SymPy; Radau's method, and an explicit one beside it."""

import functools
import time

import numpy as np

import zerodrift as zd

TOLERANCES = 10.0 ** -np.arange(2, 11.5, 0.5)


@functools.cache
def system_of(problem):
    """Made once; the compiled code is kept for the next time."""
    return zd.symbolic(list(problem.p), speeds=list(problem.v), kinetic=problem.kinetic, potential=problem.potential,
                       constraints=problem.constraints, force=problem.rayleigh(), p0=problem.p0, v0=np.zeros(problem.n),
                       name=problem.name.replace(" ", "_"))


def sweeps(problem):
    """The settings of each method."""
    explicit = TOLERANCES if problem.name == "Andrews" else TOLERANCES[::8]     # elsewhere stability says what they cost
    methods = {("schur", "radau"): TOLERANCES, ("augmented", "radau"): TOLERANCES, ("schur", "dop853"): explicit}
    return {f"zerodrift: {formulation}, {method}": [(formulation, method, tolerance) for tolerance in tolerances]
            for (formulation, method), tolerances in methods.items()}


def solve(problem, setting):
    """Coordinates (k, n) at the outputs, and seconds."""
    formulation, method, tolerance = setting
    system = system_of(problem)
    start = time.process_time()
    solution = zd.simulate(system, problem.t_end, formulation=formulation, integrator=method, rtol=tolerance, atol=tolerance,
                           t_eval=problem.times)
    return solution.p, time.process_time() - start


def reference(problem):
    """By an explicit method, whose steps stability keeps so short that it errs by rounding."""
    return solve(problem, ("schur", "dop853", 1e-12))[0]
