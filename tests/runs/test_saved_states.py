"""Saved states of runs: copies continue with the same bits, in this process and another; what does not fit is refused."""

import warnings

import numpy as np
import pytest

import saved_runs
import zerodrift as zd
from covering import draws
from native_systems import needs_compiler
from zerodrift._private import gateway


def assert_same(keys, least):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        compared, here, elsewhere = saved_runs.compare(keys)
    assert len(compared) >= least
    assert not here
    assert not elsewhere


@needs_compiler
def test_copies_continue_with_the_same_bits():
    """Copies of runs of every kind; `python tests/support/saved_runs.py 0 400` compares more."""
    assert_same(range(draws(40, 80)), draws(30, 60))


def test_copies_with_inputs_continue_with_the_same_bits():
    """Every formulation with eight integrators, fixed and adaptive, while torques and speeds jump."""
    assert_same([(number, 1) for number in range(len(saved_runs.driven()))], 70)    # others do not suit the mechanism


def test_cheap_ones_continue_for_many_steps():
    cheap = [(number, 200) for number, (drive, options) in enumerate(saved_runs.driven()) if drive == "drive.torque"
             and options["formulation"] == "schur" and options["integrator"] in ("rk4", "dop853")]
    assert_same(cheap, 3)


def test_copies_of_runs_with_contacts_continue_with_the_same_bits():
    """Phases are opened before and after the state, and entered again."""
    assert_same([(seed, seed % 2, seed % len(zd.formulations())) for seed in range(draws(10, 200))], draws(6, 120))


@pytest.mark.parametrize("options", [
    {"step": 0.004}, {"step": 0.004, "closed_form": False}, {"rtol": 1e-10, "atol": 1e-12, "max_step": 0.01},
    {"integrator": "radau", "step": 0.01}, {"step": 0.01, "t_eval": np.linspace(0.001, 0.19, 99)},
    {"formulation": "mixed", "step": 0.004, "closed_form": False},
    {"formulation": "mixed", "rtol": 1e-10, "atol": 1e-12, "max_step": 0.01}], ids=",".join)
def test_a_run_that_is_saved_at_every_sample_has_the_bits_of_one(bar, options):
    case = saved_runs.of(bar, options, 0.2)
    run, parts, expected = case.begun(), [], gateway.Record(case.core, 500)
    assert case.begun().advance(expected, 1e3) == gateway.DONE
    status = gateway.FULL
    while status == gateway.FULL:
        record = gateway.Record(case.core, 1)
        status = run.advance(record, 1e3)
        parts.append(record.take())
        run = case.run(run.save("bar")) if status == gateway.FULL else run
    whole = expected.take()
    for name, column in whole.items():
        assert np.concatenate([part[name] for part in parts]).tobytes() == column.tobytes(), name
    assert len(parts) > 10


def test_states_of_equal_runs_are_equal(bar):
    case = saved_runs.of(bar, {"step": 0.004}, 0.2)
    states = []
    for _ in range(2):
        run = case.begun()
        run.advance(gateway.Record(case.core, 10), 1e3)
        states.append(run.save("bar"))
    assert states[0] == states[1]
    assert case.run(states[0]).save("bar") == states[0]


@pytest.mark.parametrize(("change", "sentence"), [
    (lambda state: state[:-8], "must be whole"), (lambda state: state[:3], "must have been saved"),
    (lambda state: state + b"\0" * 8, "must be whole"), (lambda state: b"x" * len(state), "must have been saved"),
    (lambda state: state[:180] + bytes([state[180] ^ 1]) + state[181:], "must be unchanged")],
    ids=["truncated", "very short", "longer", "text", "a bit"])
def test_other_bytes_are_refused(bar, change, sentence):
    case = saved_runs.of(bar, {"step": 0.004}, 0.2)
    saved = case.begun().save("bar")
    with pytest.raises(zd.ZerodriftError, match=f"a saved state {sentence}"):
        case.run(saved._replace(state=change(saved.state)))


def test_states_of_other_runs_are_refused(bar):
    case = saved_runs.of(bar, {"step": 0.004}, 0.2)
    saved = case.begun().save("bar")
    with pytest.raises(zd.ZerodriftError, match="must be of the same system"):
        case.run(saved._replace(fingerprint="another"))
    with pytest.raises(zd.ZerodriftError, match="must be of the same system"):
        saved_runs.of(zd.systems.pendulum(), {"step": 0.004}, 0.2).run(saved)
    with pytest.raises(zd.ZerodriftError, match="must be of a run with the same settings"):
        saved_runs.of(bar, {"step": 0.005}, 0.2).run(saved)


def test_a_state_needs_its_vector_unit(bar):
    units = [unit for unit in ("baseline", "avx2") if unit in saved_runs.units()]
    if len(units) < 2:
        pytest.skip("this processor has one vector unit")
    saved = saved_runs.of(bar, {"step": 0.004, "vector": units[0]}, 0.2).begun().save("bar")
    with pytest.raises(zd.ZerodriftError, match=f"which is {units[0]}"):
        saved_runs.of(bar, {"step": 0.004, "vector": units[1]}, 0.2).run(saved)
