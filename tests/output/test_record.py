"""The record of a run: the same rows whatever its size and however few are saved."""

import numpy as np
import pytest

from support import assert_same_bits, handed, motion
from zerodrift._private import gateway


@pytest.mark.parametrize("times", [None, np.array([0.05, 0.07, 0.5, 1.0])], ids=["steps", "times"])
def test_records_of_any_size_hold_the_same_rows(bar, times):
    """One row at a time, also of several within a step, and none: the start is saved once."""
    options = handed() if times is None else handed(t_eval=times)
    rows = []
    for capacity in (1, 2, 50):
        run, collected = gateway.Run(bar._core, options, bar.p0, bar.v0), []
        assert run.advance(gateway.Record(bar._core, 0), 1.0) == gateway.FULL
        status = gateway.FULL
        while status == gateway.FULL:
            record = gateway.Record(bar._core, capacity)
            status = run.advance(record, 1.0)
            collected.append(record.take())
        assert status == gateway.DONE
        rows.append({name: np.concatenate([part[name] for part in collected]) for name in collected[0]})
    assert len(rows[0]["t"]) == (11 if times is None else 4)
    assert run.results().energy_error == np.abs(rows[1]["energy_violation"]).max() > 0
    for name in rows[0]:
        assert rows[0][name].tobytes() == rows[1][name].tobytes() == rows[2][name].tobytes()


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.pairs(every=[2, 7, 100, 1000])
def test_saving_less_changes_no_bit(system, formulation, integrator, every):
    options = {"formulation": formulation, "integrator": integrator}
    full, sparse = motion(system, 1.0, 100, **options), motion(system, 1.0, 100, save_every=every, **options)
    rows = sorted({*range(0, 101, every), 100})
    assert_same_bits(full, sparse, rows)
    assert sparse.stats["steps"] == 100


def test_a_record_that_grows_joins_all_its_blocks(bar):
    """The first block is one array, the others have an array for each column."""
    grown, wide = (gateway.Record(bar._core, capacity) for capacity in (1, 20))
    for record in (grown, wide):
        run = gateway.Run(bar._core, handed(), bar.p0, bar.v0)
        while run.advance(record, 1.0) == gateway.FULL:
            record.grow()
        record.join()
    one, other = grown.take(), wide.take()
    assert list(one) == list(other)
    for name in one:
        assert one[name].dtype == other[name].dtype
        assert one[name].shape == other[name].shape
        assert one[name].tobytes() == other[name].tobytes(), name
