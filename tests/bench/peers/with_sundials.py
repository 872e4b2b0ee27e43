"""SUNDIALS through scikit-SUNDAE: CVODE on the index-1 equations, IDA on the same with the multipliers among its unknowns."""

import time

import numpy as np
from problems import accelerations
from sksundae.cvode import CVODE
from sksundae.ida import IDA

TOLERANCES = 10.0 ** -np.arange(3, 13.5, 0.5)
MIN_TOLERANCE = {"CVODE Adams": 9e-14, "CVODE BDF": 9e-13, "IDA": 9e-8}  # below, they hardly get ahead


def sweeps(chain):
    """The settings of each method."""
    return {f"SUNDIALS {method}": [(method, tolerance) for tolerance in TOLERANCES if tolerance >= MIN_TOLERANCE[method]]
            for method in MIN_TOLERANCE}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds."""
    method, tolerance = setting
    options = {"rtol": tolerance, "atol": tolerance, "max_num_steps": 1_000_000}
    prepared = _ida(chain, options) if method == "IDA" else _cvode(chain, options, method.split()[1])
    start = time.process_time()
    solution = prepared()
    seconds = time.process_time() - start
    if not solution.success:
        raise RuntimeError(solution.message)
    return solution.y[:, :chain.n], seconds


def _cvode(chain, options, method):
    n, vdot = chain.n, accelerations(chain)

    def right_hand_side(t, y, rate):
        p, v = y[:n], y[n:]
        rate[:n], rate[n:] = v, vdot(p, v)

    solver = CVODE(right_hand_side, method=method, **options)
    return lambda: solver.solve(chain.outputs, np.concatenate([chain.p0, chain.v0]))


def _ida(chain, options):
    n, K, w, lengths = chain.n, chain.coupling, chain.weight, chain.lengths
    turn = np.empty((2, n))

    def residual(t, y, rate, res):
        p, v, multipliers = y[:n], y[n:2 * n], y[2 * n:]
        turn[0], turn[1] = np.cos(p), np.sin(p)
        c, s = turn
        vdot, squares = rate[n:2 * n], v * v
        rods = lengths * turn
        res[:n] = rate[:n] - v
        res[n:2 * n] = (c * (K @ (c * vdot - s * squares) + w + lengths * multipliers[1])
                        + s * (K @ (s * vdot + c * squares) - lengths * multipliers[0]))
        res[2 * n], res[2 * n + 1] = -rods[1] @ vdot - rods[0] @ squares, rods[0] @ vdot - rods[1] @ squares

    vdot, multipliers = _start(chain)
    y0 = np.concatenate([chain.p0, chain.v0, multipliers])
    rate0 = np.concatenate([chain.v0, vdot, np.zeros(2)])
    solver = IDA(residual, algebraic_idx=[2 * n, 2 * n + 1], **options)
    return lambda: solver.solve(chain.outputs, y0, rate0)


def _start(chain):
    """Accelerations and multipliers that satisfy (8)."""
    p, v, c, s = chain.p0, chain.v0, np.cos(chain.p0), np.sin(chain.p0)
    vdot = accelerations(chain)(p, v)
    inertial = c * (chain.coupling @ (c * vdot - s * v**2)) + s * (chain.coupling @ (s * vdot + c * v**2))
    C = np.stack([-chain.lengths * s, chain.lengths * c])
    return vdot, np.linalg.lstsq(C.T, -chain.weight * c - inertial, rcond=None)[0]
