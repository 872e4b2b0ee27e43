"""Derivatives of residuals by parameters of every model, beside differences of accelerations of systems with other parameters."""

import numpy as np
import pytest

import zerodrift as zd
from zerodrift.analysis import differences
from zerodrift.analysis.derivatives import Derivatives, Direction, of_residuals
from zerodrift.analysis.state import state
from zerodrift.analysis.tangent import Tangent

MODELS = sorted(set(zd.models.__all__) - {"chain"})
DRAWN = 5       # parameters of each model
SMALL = 1e-3    # of the acceleration of gravity: a smaller derivative is compared with that


def dependent(system, p, name, value):
    """True if constraints are redundant and a change of the parameter makes them contradict each other."""
    C = system.evaluate(p).C
    if C is None or np.linalg.matrix_rank(C, tol=1e-9) == len(C):
        return False
    return not np.array_equal(system.with_parameters({name: 1.001 * value}).evaluate(p).C, C)


@pytest.mark.parametrize("name", MODELS)
def test_derivatives_by_parameters_equal_differences_of_accelerations(name):
    system = getattr(zd.models, name)().system()
    p, v = zd.project(system, *system.start_at(0.0), projection=zd.Projection(tol=1e-13))
    at = state(system, 0.0, p, v)
    vdot, lam = zd.acceleration(system, p, v, 0.0, "augmented")
    derivatives = Derivatives(Tangent(at), vdot, lam)
    able = [key for key, value in system.parameters.items() if np.ndim(value) == 0 and abs(value) > 0]      # zeros are bounds
    compared = 0
    for key in np.random.default_rng(1).permutation(able)[:DRAWN]:
        value = float(system.parameters[key])

        def along(h, key=key, value=value):
            return zd.acceleration(system.with_parameters({key: value + h * abs(value)}), p, v, 0.0, "augmented")[0]

        try:
            if dependent(system, p, key, value):
                continue
            expected, error = differences.with_error(along, 1.0)
            given = derivatives.solve(*of_residuals(at, vdot, lam, Direction(dparameters={key: abs(value)})))[0]
        except (ValueError, zd.ZerodriftError):
            continue        # an inertia of no body, or a link that does not close the loop
        size = max(np.abs(expected).max(), np.abs(given).max(), SMALL * 9.81)
        if error < 1e-8 * size:
            assert given == pytest.approx(expected, abs=1e-7 * size), key
            compared += 1
    assert compared
