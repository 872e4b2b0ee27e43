"""heyoka.py: Taylor's method, compiled when it is made, on the equations of motion written out in its expressions.

With two velocities eliminated, those of the two rods that are least parallel at the start; or with the multipliers eliminated as
in (13). Nothing is corrected. Outputs are values of the steps' polynomials.
"""

import functools
import time

import heyoka as hy
import numpy as np
from equations import least_parallel, reduced, with_multipliers

TOLERANCES = 10.0 ** -np.arange(3, 14, 0.5)


def sweeps(chain):
    """The settings of each method."""
    return {f"heyoka, {equations}": [(equations, tolerance) for tolerance in TOLERANCES]
            for equations in ("two velocities eliminated", "multipliers eliminated")}


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


@functools.cache
def _integrator(chain, equations, tolerance):
    make = _reduced if equations == "two velocities eliminated" else _with_all
    system, start = make(chain)
    return hy.taylor_adaptive(system, start, tol=tolerance), start


def _reduced(chain):
    """States are p and the velocities u of all rods but two."""
    pair = least_parallel(chain.p0, np.sin)
    free = [i for i in range(chain.n) if i not in pair]
    p, u = _variables("p", chain.n), _variables("u", len(free))
    v = reduced(chain, p, None, pair, hy.sin, hy.cos)(u)
    vdot = reduced(chain, p, v, pair, hy.sin, hy.cos)
    return [*zip(p, v, strict=True), *zip(u, (vdot[i] for i in free), strict=True)], [*chain.p0, *chain.v0[free]]


def _with_all(chain):
    """States are p and v."""
    p, v = _variables("p", chain.n), _variables("v", chain.n)
    vdot = with_multipliers(chain, p, v, hy.sin, hy.cos)
    return [*zip(p, v, strict=True), *zip(v, vdot, strict=True)], [*chain.p0, *chain.v0]


def _variables(name, count):
    return np.atleast_1d(hy.make_vars(*(f"{name}{i}" for i in range(count)))).tolist()
