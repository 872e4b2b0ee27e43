"""Orders of the methods, and of polynomials between steps, on random systems: driven, nonholonomic, with a kinematic matrix."""

import functools

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from random_symbolic import random_system
from support import observed_order

SEEDS = [0, 1, 21]      # first and last driven; two with a row that is not holonomic, two with a kinematic matrix
METHODS = [name for name in zd.integrators() if name not in ("rattle", "taylor")]       # these do not take all of them
POLYNOMIALS = {"dormand_prince": ((10, 40), 4.4), "dop853": ((8, 16), 6.4)}     # steps, and a bound of the slope
pytestmark = pytest.mark.filterwarnings("ignore::zerodrift.AccuracyWarning")    # long steps are meant to err


@functools.cache
def made(seed):
    """A system, and a start that moves."""
    system = random_system(seed)
    p, v = zd.assemble(system, system.p0, np.random.default_rng(seed).uniform(-1, 1, system.nv))
    return system, {"p0": p, "v0": v}


def test_the_seeds_have_all_of_it():
    systems = [made(seed)[0] for seed in SEEDS]
    assert all(system.mh for system in systems)
    assert any(system.mn for system in systems)
    assert any(system.evaluate().A is not None for system in systems)
    assert any(system.evaluate().Phi_t is not None for system in systems)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("method", METHODS)
def test_observed_order_is_the_declared_one(seed, method):
    system, start = made(seed)
    order, declared = observed_order(system, 1.0, integrator=method, **start), zd.integrators()[method].order
    if order is None:
        pytest.skip("the motion is found to round-off")
    assert order >= declared - (tol.ORDER if declared <= 4 else tol.HIGH_ORDER)
    assert declared > 4 or order <= declared + tol.ORDER        # before round-off, terms of even higher order may be what is left


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("method", POLYNOMIALS)
def test_the_order_of_polynomials(seed, method):
    """In steps that nothing but their bound chooses: what polynomials miss in a step is one power of h more than their order."""
    (system, start), times = made(seed), np.linspace(0.026, 0.974, 11)
    (coarse, fine), slope = POLYNOMIALS[method]
    exact = zd.simulate(system, 1.0, step=1 / 400, integrator="dop853", t_eval=times, **start)

    def error(n):
        options = {"rtol": 0.9, "atol": 1e3, "first_step": 1 / n, "max_step": 1 / n}
        sol = zd.simulate(system, 1.0, integrator=method, t_eval=times, **options, **start)
        assert np.abs(sol.position_violation / sol.position_size).max() <= 1e-12
        assert np.abs(sol.velocity_violation).max() <= 1e-12 * (1 + np.abs(sol.v).max())
        return np.abs(sol.p - exact.p).max()

    errors = error(coarse), error(fine)
    assert errors[1] > 1e-13        # else it would be rounding
    assert np.log2(errors[0] / errors[1]) / np.log2(fine / coarse) > slope
