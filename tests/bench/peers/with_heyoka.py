"""heyoka.py: Taylor's method, compiled when it is made, on the equations of motion written out in its expressions.

With as many velocities eliminated as there are constraints, of a chain those of the two rods that are least parallel at the
start; or with the multipliers eliminated as in (13). Nothing is corrected. Outputs are values of the steps' polynomials.
"""

import functools
import time

import heyoka as hy
import numpy as np
from equations import eliminated, with_all

TOLERANCES = 10.0 ** -np.arange(3, 16, 0.5)
FUNCTIONS = {"sin": hy.sin, "cos": hy.cos, "sqrt": hy.sqrt}


def sweeps(chain):
    """The settings of each method."""
    tolerances = TOLERANCES[1::3] if chain.name == "Andrews" else TOLERANCES      # each takes half a minute to compile
    return {f"heyoka, {equations}": [(equations, tolerance) for tolerance in tolerances]
            for equations in ("velocities eliminated", "multipliers eliminated")}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds."""
    integrator, start = _integrator(chain, *setting)
    integrator.time = 0.0
    integrator.state[:] = start
    outputs = chain.outputs
    begin = time.process_time()
    outcome, *_, values = integrator.propagate_grid(outputs)
    seconds = time.process_time() - begin
    if outcome != hy.taylor_outcome.time_limit:
        raise RuntimeError(str(outcome))
    return values[:, :chain.n], seconds


def extended(chain):
    """Angles (k, n) at the outputs, rounded to doubles, of a run in the processor's extended numbers, with digits of 64 bits."""
    integrator, start = _integrator(chain, "multipliers eliminated", 1e-18, np.longdouble)     # wherever the rods go
    integrator.state[:] = np.asarray(start, np.longdouble)
    outcome, *_, values = integrator.propagate_grid(chain.outputs.astype(np.longdouble))
    if outcome != hy.taylor_outcome.time_limit:
        raise RuntimeError(str(outcome))
    return values[:, :chain.n].astype(float)


@functools.cache
def _integrator(chain, equations, tolerance, number=float):
    make = _reduced if equations == "velocities eliminated" else _with_all
    system, start = make(chain)
    return hy.taylor_adaptive(system, [number(x) for x in start], tol=number(tolerance), fp_type=number), start


def _reduced(chain):
    """States are p and those velocities u that are not eliminated."""
    free = eliminated(chain, FUNCTIONS)
    p, u = _variables("p", chain.n), _variables("u", len(free.places))
    v = free.spread(p, u)
    vdot = free.vdot(p, v)
    return [*zip(p, v, strict=True), *zip(u, (vdot[i] for i in free.places), strict=True)], [*chain.p0, *chain.v0[free.places]]


def _with_all(chain):
    """States are p and v."""
    p, v = _variables("p", chain.n), _variables("v", chain.n)
    vdot = with_all(chain, FUNCTIONS)(p, v)
    return [*zip(p, v, strict=True), *zip(v, vdot, strict=True)], [*chain.p0, *chain.v0]


def _variables(name, count):
    return np.atleast_1d(hy.make_vars(*(f"{name}{i}" for i in range(count)))).tolist()
