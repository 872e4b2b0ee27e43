"""numbalsoda: LSODA and DOP853 in compiled code, with the right-hand side of `with_numba`."""

import functools
import time

import numpy as np
from numba import carray, cfunc
from numbalsoda import dop853, lsoda, lsoda_sig
from with_numba import rates_of

TOLERANCES = 10.0 ** -np.arange(2, 13.5, 0.5)
INTEGRATORS = {"LSODA": lsoda, "DOP853": dop853}


def sweeps(chain):
    """The settings of each method."""
    return {f"numbalsoda {integrator}": [(integrator, tolerance) for tolerance in TOLERANCES] for integrator in INTEGRATORS}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds."""
    integrator, tolerance = setting
    address, y0, outputs = _compiled(chain).address, np.concatenate([chain.p0, chain.v0]), chain.outputs
    start = time.process_time()
    y, success = INTEGRATORS[integrator](address, y0, outputs, rtol=tolerance, atol=tolerance)
    seconds = time.process_time() - start
    if not success:
        raise RuntimeError(f"{integrator} did not succeed")
    return y[:, :chain.n], seconds


@functools.cache
def _compiled(chain):
    differentiate, size = rates_of(chain), 2 * chain.n

    @cfunc(lsoda_sig)
    def right_hand_side(t, y, rate, parameters):
        differentiate(carray(y, (size,)), carray(rate, (size,)))

    return right_hand_side
