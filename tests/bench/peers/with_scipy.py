"""SciPy: `solve_ivp` on the index-1 equations in NumPy, without any stabilization."""

import time

import numpy as np
from problems import accelerations
from scipy.integrate import solve_ivp

TOLERANCES = 10.0 ** -np.arange(2, 13.5, 0.5)


def sweeps(chain):
    """The settings of each method."""
    return {f"SciPy {method}": [(method, tolerance) for tolerance in TOLERANCES] for method in ("RK45", "DOP853", "LSODA")}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds."""
    method, tolerance = setting
    n, vdot = chain.n, accelerations(chain)
    y0 = np.concatenate([chain.p0, chain.v0])

    def right_hand_side(t, y):
        p, v = y[:n], y[n:]
        rate = np.empty(2 * n)
        rate[:n], rate[n:] = v, vdot(p, v)
        return rate

    start = time.process_time()
    solution = solve_ivp(right_hand_side, (0, chain.t_end), y0, method, t_eval=chain.outputs, rtol=tolerance, atol=tolerance)
    return solution.y[:n].T, time.process_time() - start
