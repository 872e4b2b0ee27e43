"""Saved runs with inputs continue with the same bits, here and in another process, whatever the methods."""

import warnings

import restored_runs
from covering import draws


def test_restored_runs_with_inputs_continue_with_the_same_bits():
    """200 or 1,000 steps of every formulation with eight integrators, fixed and adaptive, while torques and speeds jump."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        compared, here, elsewhere = restored_runs.compare(range(len(restored_runs.cases())), draws(200, 1000))
    drives = [restored_runs.cases()[number][0] for number in compared]
    assert drives.count("torque") >= 50     # others do not suit the mechanism
    assert drives.count("speed") >= 25
    assert not here
    assert not elsewhere


def test_cheap_ones_for_many_steps():
    wanted = [("torque", {"formulation": "schur", "integrator": "rk4", "step": 1e-3}),
              ("torque", {"formulation": "schur", "integrator": "dop853", "rtol": 1e-8})]
    compared, here, elsewhere = restored_runs.compare([restored_runs.cases().index(each) for each in wanted],
                                                     draws(20_000, 100_000))
    assert len(compared) == 2
    assert not any("zd:" in each for each in compared.values())     # they have made their steps
    assert not here
    assert not elsewhere
