"""Derivatives by parameters beside differences of accelerations, as `zd.check` compares them for every model."""

import numpy as np
import pytest

import zerodrift as zd
from covering import spread
from every_model import moving
from zerodrift.analysis.comparison import Compared, derivatives_by_parameters
from zerodrift.analysis.derivatives import Derivatives

NOT_COMPARED = {    # parameters that cannot be varied individually: others, redundant constraints or coordinates depend on them
    "andrews": {"K1.com.y"}, "bicycle": set(), "coin": {"coin.inertia.xy", "coin.inertia.xz", "coin.inertia.yz"},
    "flyball_governor": {"spindle.com.x", "spindle.com.y", "sleeve.com.x", "sleeve.com.y"}, "four_bar": set(),
    "heavy_top": {"top.inertia.xy", "top.inertia.yz"}, "rattleback": set(), "snakeboard": set(),
    "spatial_slider_crank": {"crank.inertia.yz"}, "whipple_bicycle": {"frame.inertia.xy", "frame.inertia.zz"}}
NEAR = 1e-6     # relative: a parameter on its bound is varied to one side, by differences with errors of 4e-8


@pytest.mark.parametrize("name", spread(NOT_COMPARED, 4))
def test_derivatives_by_every_parameter_equal_differences_of_accelerations(name):
    system, p, v = moving(0.3, name)
    found = derivatives_by_parameters(system, 0.0, p, v)
    assert set(found) == set(system.parameters)
    assert all(each.agrees for each in found.values() if isinstance(each, Compared))
    near = {name for name, each in found.items() if isinstance(each, Compared)
            and max(each.error, np.abs(each.given - each.expected).max()) <= NEAR * each.size}
    assert set(found) - near <= NOT_COMPARED[name]


def test_a_parameter_on_its_bound_is_varied_to_one_side():
    system, p, v = moving(0.3, "four_bar")
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
