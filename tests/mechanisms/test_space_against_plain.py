"""Random mechanisms in space, of all kinds of joints, with loops and redundant rows, against an independent model of bodies."""

import pytest

from mechanisms.plain_space import compare
from support import FORMULATIONS

NEAR = 1e-6     # of the largest acceleration: the model's differences have some 1e-8, more where rows are nearly dependent


@pytest.mark.parametrize(("seed", "wanted"), list(zip((1, 2, 3, 5, 6), FORMULATIONS, strict=True)))
def test_accelerations(seed, wanted):
    off = compare(seed, wanted)
    assert off is not None
    assert off < NEAR
