"""The core's list of terms: what it says of them is so, in every system there is."""

import numpy as np
import pytest

from support import consistent_states
from zerodrift._private.gateway import TERMS
from zerodrift.systems.native import SLOT


@pytest.mark.parametrize("name", [name for name, term in TERMS.items() if not term.depends_on_v])
def test_what_is_kept_where_only_v_changes_does_not_depend_on_it(name, system):
    for t, p, v in consistent_states(system, 2):
        here, faster = (getattr(system.evaluate(p, w, t), name) for w in (v, 3 * v + 1))
        assert np.array_equal(here, faster) if here is not None else faster is None


def test_each_term_has_a_bit_and_a_pointer_of_its_own():
    bits = [term.bit for term in TERMS.values()]
    assert all(bit.bit_count() == 1 for bit in bits)
    assert len({*bits}) == len({term.symbol for term in TERMS.values()}) == len(TERMS)
    pointer = np.dtype(np.intp).itemsize        # `zerodrift.systems.native.SLOT` counts pointers
    assert [term.offset for term in TERMS.values()] == [slot * pointer for slot in SLOT]


def test_terms_are_introduced(bar):
    assert all(f"\n{name} : ndarray {term.sizes}\n" in type(bar.evaluate()).__doc__ for name, term in TERMS.items())
