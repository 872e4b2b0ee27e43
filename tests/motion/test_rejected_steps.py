"""A step that is rejected begins again with the rates of its beginning, on either path."""

import numpy as np
import pytest

import zerodrift as zd

TIMES = np.linspace(0, 2, 9)


@pytest.fixture(scope="module")
def stone():
    """The rattleback, whose quaternions have pdot = A v and whose independent velocities change often; its exact positions."""
    system = zd.models.rattleback().system("joint", compiled=True)
    exact = zd.simulate(system, 2.0, t_eval=TIMES, integrator="dop853", rtol=1e-13, atol=1e-13, formulation="schur", direct=False)
    return system, exact.p


@pytest.mark.parametrize("method", ["dop853", "dormand_prince"])
def test_independent_velocities_in_closed_form_err_as_by_matrices(stone, method):
    """After a rejection pdot was that of the last stage: errors were 300 times as large, and every second step was rejected."""
    system, exact = stone
    errors, rejected = [], []
    for direct in (None, False):
        sol = zd.simulate(system, 2.0, t_eval=TIMES, integrator=method, rtol=1e-9, atol=1e-9, formulation="mixed", direct=direct)
        assert (sol.stats["direct_steps"] > 0) == (direct is None)
        errors.append(np.abs(sol.p - exact).max())
        rejected.append(sol.stats["rejected"])
    assert rejected[1] > 0
    assert errors[0] < 2 * errors[1]        # both paths choose nearly the same steps; a fourth less or more is chance
    assert rejected[0] < 1.5 * rejected[1]
