"""`zd.check` finds nothing wrong with what is right, and each thing that is wrong."""

import numpy as np
import pytest

import zerodrift as zd
from four_bar_in_python import bias, force, four_bar, jacobian, potential, xi
from zerodrift._private.gateway import CoreSystem


def test_built_in_systems_are_right(system):
    report = zd.check(system)
    assert report, report
    assert report.states == 6


def test_right_custom_systems_are_right():
    assert zd.check(four_bar()), zd.check(four_bar())
    assert zd.check(four_bar(jacobian=None, xi=None))


WRONG = {
    "bias": (lambda p, v, L, m: -bias(p, v, L, m), "v . bias", True),
    "force": (lambda p, L, m, g: -force(p, L, m, g), "v . force", True),
    "jacobian": (lambda p, L: -jacobian(p, L), "C is not dPhi/dp A", True),
    "xi": (lambda p, v, L: 1.01 * xi(p, v, L), "xi is not what C vdot has to be", False),
    "potential": (lambda p, L, m, g: 2 * potential(p, L, m, g), "v . force", False),
    "mass": (np.triu(np.ones((3, 3))), "M is not its own transpose", False),
    "power": (1.0, "v . force is not power - dV/dt", False),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_said(name):
    value, sentence, sign = WRONG[name]
    report = zd.check(four_bar(**{name: value}))
    assert not report
    assert sentence in repr(report)
    assert ("the sign is wrong" in repr(report)) == sign


def doubled(p, t, L, contradiction=0.0):
    return np.array([L @ np.sin(p), 2 * L @ np.sin(p) - contradiction * t**2])


def test_redundant_constraints_are_right_and_contradicting_ones_are_not():
    assert zd.check(four_bar(constraints=doubled, jacobian=None, xi=None))
    report = zd.check(four_bar(constraints=lambda p, t, L: doubled(p, t, L, 0.1), jacobian=None, xi=None))
    assert "agreement of constraints: they contradict each other" in repr(report)


def test_an_indefinite_mass_is_said():
    assert "lowest eigenvalue is -1" in repr(zd.check(four_bar(mass=-np.eye(3))))
    assert "M is singular, even where" in repr(zd.check(four_bar(mass=np.zeros((3, 3)))))


def test_a_balance_that_closes_in_another_split_is_not_a_mistake():
    """Forces may as well stand in bias, with the opposite sign."""
    moved = four_bar(force=None, bias=lambda p, v, L, m, g: bias(p, v, L, m) - force(p, L, m, g))
    assert zd.check(moved)


def test_a_wrong_jacobian_of_a_system_is_said(monkeypatch):
    system = zd.models.four_bar().system("joint", compiled=True)
    if not system.compiled:
        pytest.skip("there is no compiler")
    assert zd.check(system)
    right = CoreSystem.jacobian
    monkeypatch.setattr(CoreSystem, "jacobian", lambda *args: right(*args) * (1 + 1e-6))
    assert "derivatives of accelerations: that of the acceleration of" in repr(zd.check(system))
