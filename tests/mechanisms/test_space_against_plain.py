"""Random mechanisms in space, of all kinds of joints, with loops and redundant rows, against an independent model of bodies."""

from itertools import cycle, repeat

import pytest

from mechanisms.plain_space import ON_GROUND, Compared
from support import FORMULATIONS

NEAR = 1e-6     # of the largest acceleration: the model's differences have some 1e-8, more where rows are nearly dependent
FAR = 1e-7      # m: what two steps of two different RK4 end apart, and those differences


@pytest.mark.parametrize(("seed", "wanted", "coordinates"), [
    (5, "augmented", "joint"), *zip(cycle((1, 2, 3, 5, 6)), FORMULATIONS, repeat("absolute"))])
def test_accelerations_and_reactions(seed, wanted, coordinates):
    case = Compared(seed, coordinates=coordinates)
    assert case.can_be
    assert max(case.accelerations(wanted)) < NEAR


@pytest.mark.parametrize("kind", [*ON_GROUND, "blade"])
def test_rolling_and_gliding(kind):
    case = Compared(1, kind, coordinates="absolute")
    assert case.can_be
    assert max(case.accelerations("nullspace")) < NEAR


def test_motion():
    assert Compared(1).motion("mixed") < FAR
