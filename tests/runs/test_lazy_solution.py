"""A solution makes its arrays and statistics at the first access to one of them, invisibly."""

import copy
import dataclasses
import pickle
import threading

import numpy as np
import pytest

import zerodrift as zd
from support import ROWS, assert_same_bits

FIELDS = [field.name for field in dataclasses.fields(zd.Solution)]


def fresh(bar, **options):
    """A solution before any access."""
    return zd.simulate(bar, 0.5, step=0.1, energy=True, **options)


@pytest.mark.parametrize("name", FIELDS)
def test_every_field_may_be_the_first(bar, name):
    whole = fresh(bar)
    assert repr(whole)
    first, expected = getattr(fresh(bar), name), getattr(whole, name)
    if isinstance(expected, np.ndarray):
        assert first.tobytes() == expected.tobytes()
        assert first.shape == expected.shape
        assert not first.flags.writeable
    elif name == "stats":
        assert {**first, "seconds": 0} == {**expected, "seconds": 0}
    else:
        assert first == expected


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda sol: pickle.loads(pickle.dumps(sol)), dataclasses.replace],
                         ids=["copy", "deepcopy", "pickle", "replace"])
def test_copies_of_what_was_not_read(bar, copied):
    sol = copied(fresh(bar))
    assert_same_bits(sol, fresh(bar))
    assert not any(getattr(sol, name).flags.writeable for name in ROWS)


def test_it_lists_all_that_it_has_and_nothing_else(bar):
    assert set(FIELDS) <= set(dir(fresh(bar)))
    for sol in (fresh(bar), copy.copy(fresh(bar))):
        with pytest.raises(AttributeError, match="'Solution' object has no attribute 'momentum'"):
            sol.momentum        # noqa: B018 - to look is the test
        with pytest.raises(dataclasses.FrozenInstanceError):
            sol.p = None


def test_several_threads_may_ask_at_once(bar):
    for _ in range(20):
        sol, seen, barrier = fresh(bar), [], threading.Barrier(4)

        def look(sol=sol, seen=seen, barrier=barrier):
            barrier.wait()
            seen.append((sol.p.sum(), sol.stats["steps"], sol.t[-1]))

        threads = [threading.Thread(target=look) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert seen == [seen[0]] * 4


def test_events_are_read_only_before_anything_is_requested(bar):
    sol = fresh(bar, events=lambda t, p, v: t - 0.25)
    assert not any(array.flags.writeable for group in (sol.t_events, sol.p_events, sol.v_events) for array in group)


def test_settings_of_a_run_belong_to_it(bar):
    """Arguments that are the same are checked once; who changes what a solution says of them changes no other run."""
    fresh(bar).settings["integrator"] = "heun"
    assert fresh(bar).settings["integrator"] == "rk4"
