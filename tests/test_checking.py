"""`zd.check` finds nothing wrong with what is right, and each thing that is wrong."""

import numpy as np
import pytest

import zerodrift as zd
from test_custom import bias, force, four_bar, jacobian, potential, xi


def test_built_in_systems_are_right(system):
    report = zd.check(system)
    assert report, report
    assert report.states == 6


def test_right_custom_systems_are_right():
    assert zd.check(four_bar()), zd.check(four_bar())
    assert zd.check(four_bar(jacobian=None, xi=None))


WRONG = {
    "bias": (lambda p, v, l, m: -bias(p, v, l, m), "v . bias", True),                          # noqa: E741
    "force": (lambda p, l, m, g: -force(p, l, m, g), "v . force", True),                       # noqa: E741
    "jacobian": (lambda p, l: -jacobian(p, l), "C is not dPhi/dp A", True),                    # noqa: E741
    "xi": (lambda p, v, l: 1.01 * xi(p, v, l), "xi is not what C vdot has to be", False),      # noqa: E741
    "potential": (lambda p, l, m, g: 2 * potential(p, l, m, g), "v . force", False),           # noqa: E741
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


def test_dependent_constraints_and_an_indefinite_mass_are_said():
    doubled = four_bar(constraints=lambda p, l: np.array([l @ np.sin(p), 2 * l @ np.sin(p)]), jacobian=None, xi=None)   # noqa: E741
    assert "of 2 constraints only 1 are independent" in repr(zd.check(doubled))
    assert "lowest eigenvalue is -1" in repr(zd.check(four_bar(mass=-np.eye(3))))


def test_a_balance_that_closes_in_another_split_is_no_mistake():
    """Forces may as well stand in bias, with the opposite sign."""
    moved = four_bar(force=None, bias=lambda p, v, l, m, g: bias(p, v, l, m) - force(p, l, m, g))   # noqa: E741
    assert zd.check(moved)
