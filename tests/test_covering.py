"""Covering arrays of the tests' axes."""

import itertools

import pytest

from conftest import TAKEN, is_accepted
from covering import covering, draws, spread
from support import FORMULATIONS, INTEGRATORS, SYSTEMS

TABLES = {"system": SYSTEMS, "integrator": INTEGRATORS, "formulation": FORMULATIONS}


@pytest.mark.parametrize("more", [{}, {"every": range(4)}], ids=["three axes", "four axes"])
def test_each_pair_of_values_occurs(more):
    axes = {name: tuple(values) for name, values in (TABLES | more).items()}
    cases = covering(axes, is_accepted)
    assert len(cases) < 1.3 * max(len(a) * len(b) for a, b in itertools.combinations(axes.values(), 2))
    assert {(case["system"], case["integrator"]) for case in cases} == {pair for pair in TAKEN if pair[1] in INTEGRATORS}
    for (one, values), (other, others) in itertools.combinations(axes.items(), 2):
        if (one, other) != ("system", "integrator"):
            assert {(case[one], case[other]) for case in cases} == set(itertools.product(values, others))


def test_a_single_axis_has_all_its_values():
    assert covering({"formulation": ("schur", "mixed")}) == [{"formulation": "schur"}, {"formulation": "mixed"}]


def test_cases_that_are_not_accepted_are_left_out():
    cases = covering({"a": (1, 2, 3), "b": (1, 2, 3), "c": (1, 2)}, lambda a, b, c: a != b)
    assert all(case["a"] != case["b"] for case in cases)
    assert {(case["a"], case["b"]) for case in cases} == {(a, b) for a in (1, 2, 3) for b in (1, 2, 3) if a != b}


def test_each_value_occurs_with_a_strength_of_one():
    cases = covering({"a": range(4), "b": range(3), "c": range(2)}, lambda a, b, c: (a, c) != (0, 0), strength=1)
    assert len(cases) == 4
    assert [{case[name] for case in cases} for name in "abc"] == [set(range(4)), set(range(3)), set(range(2))]


def test_thinned_values_have_the_first_and_the_last(monkeypatch):
    monkeypatch.setattr("covering.WHOLE", False)
    assert spread(range(12), 5) == [0, 3, 6, 8, 11]
    assert spread("abc", 2) == ["a", "c"]
    assert draws(5, 20) == 5
    monkeypatch.setattr("covering.WHOLE", True)
    assert spread(range(12), 5) == list(range(12))
    assert draws(5, 20) == 20
