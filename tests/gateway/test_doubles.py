"""The gateway is the last line of defence: CFFI itself would reinterpret whatever memory it is given."""

import numpy as np
import pytest

from support import refused
from zerodrift._private import gateway


@pytest.mark.parametrize(("array", "message"), [
    (np.zeros(3, dtype=np.float32), r"expected 3 contiguous float64 values, got float32 of shape \(3,\)"),
    (np.zeros(3, dtype=np.int64), "expected 3 contiguous float64 values, got int64"),
    (np.zeros(3, dtype=">f8"), "expected 3 contiguous float64 values, got >f8"),
    (np.zeros(6)[::2], "expected 3 contiguous float64 values, got float64"),
    (np.zeros(4), r"expected 3 contiguous float64 values, got float64 of shape \(4,\)"),
    (np.zeros((3, 3)).T[:1], r"expected 3 contiguous float64 values, got float64 of shape \(1, 3\)"),
])
def test_the_gateway_takes_contiguous_doubles_only(array, message):
    with refused("shape", message):
        gateway.doubles(array, 3)


def test_the_gateway_writes_to_writable_memory_only():
    array = np.zeros(3)
    array.flags.writeable = False
    assert len(gateway.doubles(array, 3)) == 3
    with refused("shape"):
        gateway.doubles(array, 3, writable=True)


TABLE = np.arange(12.0).reshape(4, 3)


def test_columns_of_a_table_are_read_in_place():
    """From the address of their first entry."""
    pointer = gateway.base.strided_doubles(TABLE[:, 1:], 8)
    assert [pointer[3 * row + i] for row in range(4) for i in range(2)] == TABLE[:, 1:].ravel().tolist()


@pytest.mark.parametrize("array", [TABLE[:, 1:].astype(np.float32), TABLE[:, ::2], TABLE[::-1, 1:], TABLE[:3, 1:], TABLE.T[:2],
                                   np.zeros((4, 17), np.uint8)[:, 1:].view(float)])
def test_columns_of_other_memory_are_refused(array):
    """Other types of numbers, rows that are not contiguous or run backwards, another size, and unaligned memory."""
    with refused("shape", "expected 8"):
        gateway.base.strided_doubles(array, 8)
