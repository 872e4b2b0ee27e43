"""Exceptions in a callable, at any moment: they surface as they are, and nothing is lost that was computed."""

import dataclasses

import pytest

import zerodrift as zd
from support import assert_close, assert_same_bits, motion
from watched import At, pendulum, throw
from zerodrift.runs import simulate as simulation


def assert_beginning(part, whole):
    """The rows of one are the first of the other, to the last bit."""
    assert len(part.t) < len(whole.t)
    assert_same_bits(whole, part, slice(len(part.t)))


@pytest.mark.each_value
@pytest.mark.pairs(options={"fixed": {"step": 0.05},
                            "adaptive": {"rtol": 1e-4, "integrator": "dormand_prince", "t_eval": [0.1, 0.2, 0.3]}})
def test_an_exception_at_any_call_leaves_what_was_computed(formulation, options):
    options = options | {"formulation": formulation, "energy": True}
    watch = At(-1, None)
    system = pendulum(watch)
    watch.calls = 0
    whole = zd.simulate(system, 0.3, **options)
    calls, carried = watch.calls, 0
    for k in range(1, calls + 1):
        error = ArithmeticError(k)
        watch.k, watch.action, watch.calls = k, throw(error), 0
        with pytest.raises(ArithmeticError) as caught:
            zd.simulate(system, 0.3, **options)
        assert caught.value is error
        if hasattr(error, "solution"):
            carried += 1
            assert_beginning(error.solution, whole)
            assert repr(error) in error.solution.message
    assert carried > calls - 30       # before, there was nothing


@pytest.mark.parametrize("method", ["dormand_prince", "dop853"])
def test_an_exception_at_any_call_between_rows_surfaces(method):
    watch = At(-1, None)
    sol = zd.simulate(pendulum(watch), 0.3, rtol=1e-4, integrator=method)
    watch.calls = 0
    there, calls = sol(0.11), watch.calls
    for k in range(1, calls + 1):
        sol(sol.t[0])       # so that the step is made again
        sol(0.29)
        error = ArithmeticError(k)
        watch.k, watch.action, watch.calls = k, throw(error), 0
        with pytest.raises(ArithmeticError) as caught:
            sol(0.11)
        assert caught.value is error
        assert_close(sol(0.11)[0], there[0], 1e-13)


def test_an_exception_of_the_progress_callable_leaves_what_was_computed(bar, monkeypatch):
    monkeypatch.setattr(simulation, "SLICE", 0.0)
    whole = motion(bar, 1.0, 200)
    for k in range(1, 10):
        error = ZeroDivisionError(k)
        with pytest.raises(ZeroDivisionError) as caught:
            motion(bar, 1.0, 200, progress=At(k, throw(error)))
        assert caught.value is error
        assert not error.solution.success
        assert len(error.solution.t) > 10 * k
        assert_beginning(error.solution, whole)


@dataclasses.dataclass(frozen=True)
class Unchangeable(Exception):
    """An error that takes nothing along."""

    number: int


def test_an_exception_that_cannot_be_changed_surfaces_as_it_is():
    action = At(400, throw(Unchangeable(3)))
    with pytest.raises(Unchangeable) as caught:
        zd.simulate(pendulum(action), 10.0, step=0.05)
    assert caught.value.number == 3
