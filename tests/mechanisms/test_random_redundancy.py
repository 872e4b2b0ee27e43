"""A fixed sample of the random mechanisms with redundant constraints; `stress/redundant_mechanisms.py` runs two thousand."""

import pytest

import zerodrift as zd
from mechanisms.redundant_mechanisms import InPlane, InSpace, outcome

NEAR_SINGULAR = 1137        # its smallest singular value is 8e-5 of the largest, among 45 constraints
FINDINGS = ["joint: agrees with the model", "absolute: agrees with the model", "both coordinates: agree"]


@pytest.mark.parametrize("seed", [*range(20), NEAR_SINGULAR])
def test_both_coordinates_agree_with_the_dense_model(seed):
    _, words = outcome(seed)
    assert [word for word, _ in words] == FINDINGS


@pytest.mark.parametrize("case", [InPlane, InSpace])
def test_the_sample_has_redundant_constraints(case):
    for seed in range(5):
        assert zd.simulate(case(seed).m.system("absolute"), 1e-6, step=1e-6).stats["redundant"]
