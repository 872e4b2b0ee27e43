"""Derivatives by parameters beside differences of accelerations, as `zd.check` compares them for every model."""

import numpy as np
import pytest

import zerodrift as zd
from covering import spread
from zerodrift.analysis.comparison import Compared, derivatives_by_parameters
from zerodrift.analysis.derivatives import Derivatives
from zerodrift.analysis.state import state
from zerodrift.analysis.tangent import Tangent

NOT_COMPARED = {    # parameters that cannot be varied individually, and how many of each model
    "andrews": 1, "bicycle": 0, "coin": 3, "flyball_governor": 4, "four_bar": 0, "heavy_top": 2, "rattleback": 0, "snakeboard": 0,
    "spatial_slider_crank": 1, "whipple_bicycle": 2}


def moving(name):
    """A state of a model that moves in all its free directions."""
    system = getattr(zd.models, name)().system()
    p, v = system.start_at(0.0)
    V = Tangent(state(system, 0.0, p, v)).velocities
    push = 0.3 * V @ np.random.default_rng(3).standard_normal(V.shape[1])
    return system, *zd.project(system, p, v + push, projection=zd.Projection(tol=1e-13))


@pytest.mark.parametrize("name", spread(NOT_COMPARED, 4))
def test_derivatives_by_every_parameter_equal_differences_of_accelerations(name):
    system, p, v = moving(name)
    found = derivatives_by_parameters(system, 0.0, p, v)
    assert set(found) == set(system.parameters)
    assert all(each.agrees for each in found.values() if isinstance(each, Compared))
    compared = [each for each in found.values() if isinstance(each, Compared) and each.is_clear]
    assert len(compared) == len(found) - NOT_COMPARED[name]


def test_a_parameter_on_its_bound_is_varied_to_one_side():
    system, p, v = moving("four_bar")
    assert system.parameters["A.damping"] == 0.0
    found = derivatives_by_parameters(system, 0.0, p, v)["A.damping"]
    h = 1e-6        # the acceleration is linear in it
    expected = (zd.acceleration(system.with_parameters({"A.damping": h}), p, v)[0] - zd.acceleration(system, p, v)[0]) / h
    assert found.given == pytest.approx(expected, rel=1e-7)
    assert np.abs(found.given).max() > 0.1


@pytest.mark.parametrize("wrong", [1 + 1e-6, -1.0])
def test_check_notices_a_wrong_derivative(monkeypatch, wrong):
    solve = Derivatives.solve
    monkeypatch.setattr(Derivatives, "solve", lambda self, r, s: tuple(wrong * each for each in solve(self, r, s)))
    problem, = zd.check(zd.models.four_bar()).problems
    assert "derivatives of accelerations: that of the acceleration of " in problem


def test_products_of_inertia_may_be_negative():
    fork = zd.models.whipple_bicycle().system()
    assert fork.parameters["fork.inertia.xz"] < 0
    assert fork.with_parameters({"fork.inertia.xz": -0.007}).parameters["fork.inertia.xz"] == -0.007
