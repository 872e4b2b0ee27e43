"""A run that cannot be built is data, in whatever place it is; the others have the bits that they have without it."""

import numpy as np
import pytest

import zerodrift as zd
from small_studies import pendulum
from support import assert_same_bits

NAN = np.nan
BAR, DRAWN, OSCILLATOR = zd.systems.four_bar(), zd.models.four_bar(), zd.systems.oscillator()
GOOD, OPEN = [1.0, 0.3, 1.0, 0.6], [1.0, 5.0, 1.0, 0.6]


def raises(length=1.0):
    if length > 2:
        raise RuntimeError("no link is that long")
    return pendulum()


def closes(crank=0.3):
    return DRAWN.with_parameters({"crank.length": crank})


def is_a_system(mass=1.0):
    return OSCILLATOR.with_parameters(mass=mass) if mass < 2 else mass


def of(name, values):
    return {"parameters": {name: np.array(values)}}


CASES = {      # system, what differs of three runs, of which the last cannot be built, and how its message begins
    "links that cannot close": (BAR, of("lengths", [GOOD, GOOD, OPEN]), "ValueError: four_bar: links of these lengths"),
    "a length that is not finite": (BAR, of("lengths", [GOOD, GOOD, [1, NAN, 1, 1]]), "ValueError: lengths must be finite"),
    "a number that is not finite": (BAR, of("gravity", [9.0, 9.5, NAN]), "ValueError: gravity must be finite"),
    "a negative mass": (OSCILLATOR, of("mass", [1.0, 2.0, -1.0]), "ValueError: mass must be positive"),
    "a start that is not finite": (OSCILLATOR, {"v0": np.array([[1.0], [2.0], [NAN]])}, "ValueError: v0 must be finite"),
    "a start after a change": (BAR, of("gravity", [9.0, 9.5, 9.7]) | {"p0": np.array([BAR.p0, BAR.p0, BAR.p0 * NAN])},
                               "ValueError: p must be finite"),
    "a measure that is not finite": (DRAWN, {"start": {"crank.angle": np.array([0.3, 0.4, NAN])}}, "ValueError: held"),
    "a mechanism that cannot close": (DRAWN, of("crank.length", [0.3, 0.31, 5.0]), "CorrectionFailed: the loop of ground, crank"),
    "a mechanism with a negative mass": (DRAWN, of("crank.mass", [1.0, 1.1, -3.0]), "ValueError: parameter 'crank.mass' must"),
    "a mass that is not finite": (DRAWN, of("crank.mass", [1.0, 1.1, NAN]), "ValueError: parameter 'crank.mass' must be finite"),
    "a link without length": (DRAWN, of("crank.length", [0.3, 0.31, 0.0]), "ValueError: parameter 'crank.length' must"),
    "a function that raises": (raises, of("length", [1.0, 1.5, 3.0]), "RuntimeError: no link is that long"),
    "a function whose mechanism cannot close": (closes, of("crank", [0.3, 0.31, 5.0]), "CorrectionFailed: the loop of ground"),
    "a function that returns something else": (is_a_system, of("mass", [1.0, 1.5, 3.0]), "TypeError: is_a_system must return"),
}
OPTIONS = {"lanes": {"step": 0.01, "t_eval": np.array([0.05, 0.1])}, "one by one": {"rtol": 1e-8, "integrator": "dop853"},
           "reduced": {"step": 0.01, "reduce": lambda sol: sol.t[-1]}}


def some(differing, runs):
    """The arguments of some of the runs."""
    return {key: {name: each[runs] for name, each in value.items()} if isinstance(value, dict) else value[runs]
            for key, value in differing.items()}


@pytest.mark.parametrize("way", OPTIONS)
@pytest.mark.parametrize("name", CASES)
def test_its_place_does_not_matter(name, way):
    system, differing, message = CASES[name]
    alone = zd.ensemble(system, 0.1, **some(differing, [0, 1]), **OPTIONS[way])
    for order in ([0, 1, 2], [2, 0, 1], [0, 2, 1]):
        ens = zd.ensemble(system, 0.1, **some(differing, order), **OPTIONS[way])
        assert ens.failed.tolist() == [run == 2 for run in order]
        assert ens.messages[order.index(2)].startswith(message)
        for column in () if way == "reduced" or "start" in name else alone._part.arrays:
            for run in (0, 1):
                assert np.array_equal(ens[column][order.index(run)], alone[column][run])
        if way == "lanes":
            assert_same_bits(alone[1], ens[order.index(1)])


@pytest.mark.parametrize("chunk", [1, 2])
def test_nor_does_the_portion_that_a_worker_makes(chunk):
    values = np.array([0.0, 0.3, NAN, 5.0, 0.31, 0.32])
    alone = zd.ensemble(DRAWN, 0.1, parameters={"crank.length": values}, **OPTIONS["lanes"], threads=1)
    split = zd.ensemble(DRAWN, 0.1, parameters={"crank.length": values}, **OPTIONS["lanes"], chunk=chunk)
    assert alone.failed.tolist() == split.failed.tolist() == [True, False, True, True, False, False]
    assert [each.split(":")[0] for each in split.messages] == [each.split(":")[0] for each in alone.messages]
    (name, *_) = alone._part.arrays
    for run in (1, 4, 5):
        assert np.array_equal(alone[name][run], split[name][run])


@pytest.mark.parametrize(("made", "differing", "error", "message"), [
    (BAR, of("lengths", [OPEN, OPEN]), ValueError, "links of these lengths cannot close"),
    (BAR, of("lengths", [[1.0, 2.0], [1.0, 3.0]]), ValueError, "lengths must have shape"),
    (DRAWN, of("crank.mass", [-1.0, NAN]), ValueError, "parameter 'crank.mass' must be at least 0, not -1"),
    (lambda mass=1.0: mass, of("mass", [1.0, 2.0]), TypeError, "must return a system or a Mechanism, not 1.0"),
    (OSCILLATOR, {"v0": np.array([[NAN], [NAN]])}, None, ""),
    (DRAWN, {"start": {"crank.angel": np.array([0.1, 0.2])}}, ValueError, "crank.angel"),
])
def test_what_no_run_accepts_is_an_error_before_anything_runs(made, differing, error, message):
    if error is None:       # a start is a run's own
        assert zd.ensemble(made, 0.1, **differing, step=0.01).failed.all()
        return
    with pytest.raises(error, match=message):
        zd.ensemble(made, 0.1, **differing, step=0.01)
