"""Events that are kept with their solution, and nonsense that is refused."""

import pickle

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from four_bar_in_python import four_bar as bar_in_python
from output.test_events import OSCILLATOR, event, position
from support import SYSTEMS, assert_close, refused

# ---- keeping ----


ROUND_TRIPS = {"pickle": lambda sol, folder: pickle.loads(pickle.dumps(sol)),
               "save": lambda sol, folder: zd.load(sol.save(folder / "a"))}


@pytest.mark.parametrize("there_and_back", ROUND_TRIPS.values(), ids=ROUND_TRIPS)
@pytest.mark.parametrize("events", [None, [], [position], [position, lambda t, p, v: 1.0]], ids=["none", "empty", "one", "two"])
def test_events_are_kept(there_and_back, events, tmp_path):
    sol = zd.simulate(OSCILLATOR, 5.0, step=0.05, events=events)
    again = there_and_back(sol, tmp_path)
    for name, shape in {"t_events": (), "p_events": (1,), "v_events": (1,)}.items():
        mine, its = getattr(sol, name), getattr(again, name)
        if events is None:
            assert mine is its is None
            continue
        assert len(mine) == len(its) == len(events)
        for a, b in zip(mine, its, strict=True):
            assert a.shape[1:] == shape
            assert a.shape == b.shape
            assert a.tobytes() == b.tobytes()
            assert not b.flags.writeable
    assert again.settings == sol.settings
    assert repr(again) == repr(sol)


def test_one_event_needs_no_list():
    sol = zd.simulate(OSCILLATOR, 1.0, step=0.05, events=position)
    assert len(sol.t_events) == len(sol.p_events) == len(sol.v_events) == 1


def test_states_may_be_kept(bar):
    """An event function owns its arguments."""
    seen = []

    def watch(t, p, v):
        seen.append((t, p, v))
        p[:] = np.nan
        return 1.0

    sol = zd.simulate(bar, 0.1, step=0.05, events=watch)
    assert np.isfinite(sol.p).all()
    at_samples = {t: v for t, _, v in seen if t in sol.t}
    assert list(at_samples) == sol.t.tolist()
    assert np.array_equal(list(at_samples.values()), sol.v)


# ---- nonsense ----


@pytest.mark.parametrize(("value", "error", "shown"), [
    (np.nan, ValueError, "must be finite, not nan"), (-np.inf, ValueError, "must be finite, not -inf"),
    (np.zeros(2), TypeError, "must be a real number, not array"), (1j, TypeError, "must be a real number, not 1j"),
    (None, TypeError, "must be a real number, not None"), ("up", TypeError, "must be a real number, not 'up'"),
    (True, TypeError, "must be a real number, not True"), ([0.5], TypeError, r"must be a real number, not \[0.5\]"),
], ids=str)
def test_values_that_are_not_numbers(bar, value, error, shown):
    with pytest.raises(error, match=r"value of events at t = 0 " + shown):
        zd.simulate(bar, 1.0, step=0.1, events=lambda t, p, v: value)
    with pytest.raises(error, match=r"value of events\[1\] at t = 0\.5 " + shown) as caught:
        zd.simulate(bar, 1.0, step=0.1, events=[position, lambda t, p, v: 1.0 if t < 0.45 else value])
    assert caught.value.solution.t.tolist() == pytest.approx([0, 0.1, 0.2, 0.3, 0.4])
    assert "at t = 0.5 (step 5 of 10): the evaluation of an event failed" in caught.value.__notes__


@pytest.mark.parametrize(("events", "code", "message"), [
    (3.0, "wrong-type", r"events.*zd.Event.*not 3\.0"),
    ("position", "unknown-choice", "events.*'position'.*alpha1"),
    ([position, None], "wrong-type", r"events\[1\].*zd.Event"),
    (event(position, "up"), "wrong-type", "events.direction.*'up'"),
    (event(position, np.nan), "not-finite", "events.direction"),
    (event(position, 2), "unknown-choice", "events.direction.*be -1, 0.*or 1, not 2"),
    ([event(position, None)], "wrong-type", r"events\[0\].direction"),
    (event(position, 0, -1), "out-of-range", "events.terminal.*between 0"),
    (event(position, 0, 1.5), "wrong-type", "events.terminal.*not 1.5"),
    (event(position, 0, "yes"), "wrong-type", "events.terminal.*'yes'"),
])
def test_events_that_are_none(bar, events, code, message):
    with refused(code, message):
        zd.simulate(bar, 1.0, step=0.1, events=events)


class Mine(Exception):
    pass


@pytest.mark.parametrize("which", [SYSTEMS["four_bar"], bar_in_python()], ids=["C", "Python"])
def test_what_an_event_raises_surfaces(which):
    def broken(t, p, v):
        if t > 0.45:
            raise Mine("mine")
        return 1.0

    with pytest.raises(Mine, match=r"^mine") as caught:
        zd.simulate(which, 1.0, step=0.1, events=broken)
    assert len(caught.value.solution.t) == 5
    assert caught.traceback[-1].name == "broken"
    sol = zd.simulate(which, 1.0, step=0.1, events=broken, on_failure="return")
    assert sol.message == "at t = 0.5 (step 5 of 10): the evaluation of an event failed: Mine('mine')"
    assert not sol.success


def test_an_event_of_too_few_arguments(bar):
    with pytest.raises(TypeError, match="positional argument"):
        zd.simulate(bar, 1.0, step=0.1, events=lambda t, y: y[0])


def test_ctrl_c_within_an_event(bar):
    def press(t, p, v):
        if t > 0.45:
            raise KeyboardInterrupt
        return 1.0

    with pytest.raises(zd.errors.Interrupted) as caught:
        zd.simulate(bar, 1.0, step=0.1, events=press)
    assert len(caught.value.solution.t) == 5


def test_failures_while_an_event_is_looked_for(bar):
    """The events found before are kept."""
    events = [event(lambda t, p, v: t - 0.101), event(lambda t, p, v: np.nan if 0.2 < t < 0.25 else t - 0.23)]
    sol = zd.simulate(bar, 1.0, step=0.05, events=events, on_failure="return")
    assert not sol.success
    assert_close(sol.t_events[0], [0.101], tol.SAME)
    assert len(sol.t_events[1]) == 0
