"""Callables that keep, change, return and raise whatever: nothing crashes, hangs, or is wrong in silence.

Each example makes mischief of one kind, from some call on, in one of the callables of a system or in an event. Then the run is,
to the last bit, that without mischief, or an error says what was wrong; arrays that were kept are what they were; and the run
after it is right. ``ZERODRIFT_EXAMPLES=100000 pytest tests/systems/test_mischief.py`` looks longer than the sample that CI takes.
"""

import contextlib
import functools
import gc
import os
import threading
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zerodrift as zd
from support import FORMULATIONS, assert_same_bits
from watched import At, pendulum, throw
from zerodrift.runs.states import branches
from zerodrift.systems import autodiff

EXAMPLES = int(os.environ.get("ZERODRIFT_EXAMPLES", "40"))

# ---- a bead on a circle, and its runs ----

CALLABLES = {
    "mass": lambda p, v: 2 * np.eye(2), "force": lambda p, v: np.array([0.25, -16.0]), "bias": lambda p, v: np.zeros(2),
    "constraints": lambda p, v: np.array([p @ p - 1.0]) / 2, "kinematics": lambda p, v: np.eye(2),
    "potential": lambda p, v: 16.0 * p[1] - p[0] / 4, "power": lambda p, v: 0.0}
GIVEN = {"jacobian": lambda p, v: p[None], "xi": lambda p, v: -np.array([v @ v])}
STEPS = ({"step": 0.05}, {"step": 0.05, "integrator": "trapezoidal"}, {"rtol": 1e-4, "integrator": "dormand_prince"})


def no_mischief(name, function):
    """The function itself, without mischief."""
    return function


def bead(derived, wrap=no_mischief):
    """The system, each of its callables wrapped."""
    callables = {name: wrap(name, function) for name, function in (CALLABLES if derived else CALLABLES | GIVEN).items()}
    return zd.System(["x", "y"], **callables, p0=[1.0, 0.0], v0=[0.0, 0.5])


def run(system, options, wrap=no_mischief):
    """A run of it, with an event."""
    event = wrap("events", lambda p, v: float(p[1] + 0.1))
    return zd.simulate(system, 0.2, energy=True, events=lambda t, p, v: event(p, v), **options)


@functools.cache
def undisturbed(derived, formulation, steps):
    """The run without mischief."""
    return run(bead(derived), STEPS[steps] | {"formulation": formulation})


class Mischief:
    """Does something when the callable of that name is called, from the k-th call on, but not when it uses the package itself."""

    def __init__(self, name, k, action):
        self.name, self.k, self.action = name, k, action
        self.calls, self.happened, self.kept, self.system = 0, 0, [], None
        self.at_work = threading.local()

    def wrap(self, name, function):
        """The function, with mischief if it is the one."""
        def call(p, v):
            if getattr(self.at_work, "now", False):
                return function(p, v)
            self.calls += 1
            if self.calls < self.k:
                return function(p, v)
            self.at_work.now, self.happened = True, self.happened + 1
            try:
                return self.action(self, function, p, v)
            finally:
                self.at_work.now = False

        return call if name == self.name else function


# ---- harmless callables ----


def keep(self, function, p, v):
    """Keep what is handed over, with a copy to compare it with."""
    self.kept += [(x, x.copy()) for x in (p, v) if x.dtype != object]
    return function(p, v)


WAYS_TO_WRITE = (
    lambda x: x.fill(7.0), lambda x: x.sort(), lambda x: np.add(x, 1.0, out=x), lambda x: x.setflags(write=True),
    lambda x: np.copyto(x.base, 7.0), lambda x: memoryview(x).cast("B").__setitem__(0, 7), lambda x: x.resize(9),
    lambda x: x.__setitem__(0, 7.0), lambda x: x.byteswap(inplace=True), lambda x: np.frombuffer(x).__setitem__(0, 7.0),
    lambda x: np.asarray(x.base).__setitem__(0, 7.0), lambda x: setattr(x.flags, "writeable", True), lambda x: x.partition(0))


def write(self, function, p, v):
    """Use what is handed over, and then try to write into it."""
    value = np.array(function(p, v))
    for array in (p, v):
        for way in WAYS_TO_WRITE:
            with contextlib.suppress(ValueError, TypeError, RuntimeError, IndexError):      # of arrays without a base, too
                way(array)
    return value if self.name != "events" else float(value)


def reshape(self, function, p, v):
    """Use what is handed over, and then give it another shape and kind."""
    value = np.array(function(p, v))
    for array in (p, v):
        array.shape = (2, 1, 1)
        if array.dtype != object:
            array.dtype = np.int64
    return value if self.name != "events" else float(value)


def collect(self, function, p, v):
    """Let go of what can be let go of."""
    value = function(p, v)
    del p, v
    if self.happened % 10 == 1:
        gc.collect()
    return value


def use_meanwhile(self, function, p, v):
    """Use the same system in the middle of its run."""
    if self.system and self.happened % 40 == 1:
        use(self.system)
    return function(p, v)


def use_in_thread(self, function, p, v):
    """Use the same system in another thread, which this one waits for."""
    if self.system and self.happened % 40 == 1:
        done = []

        def work():
            self.at_work.now = True
            use(self.system)
            done.append(True)

        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        assert done
    return function(p, v)


def use(system):
    """A system, in several ways."""
    run(system, {"step": 0.1})
    system.evaluate()
    zd.acceleration(system, [1.0, 0.0], [0.0, 0.0])
    zd.assemble(system, [1.0, 0.1])


def guised(change):
    """Return the same numbers in another guise."""
    return lambda self, function, p, v: change(function(p, v))


def each(change):
    """Another guise of each number that carries no derivatives."""
    def changed(value):
        array = np.array(value, dtype=object)
        for index in np.ndindex(array.shape):
            if not isinstance(array[index], autodiff.Jet):
                array[index] = change(array[index])
        return array
    return changed


def as_buffer(value):
    """A buffer that NumPy can read, but that is not an array."""
    array = np.array(value)
    return value if array.dtype == object else memoryview(array)


HARMLESS = {"keep": keep, "write": write, "reshape": reshape, "collect": collect, "use": use_meanwhile, "thread": use_in_thread}
GUISES = {
    "lists": guised(lambda value: np.asarray(value).tolist()), "objects": guised(each(float)), "buffers": guised(as_buffer),
    "fractions": guised(each(lambda x: Fraction(float(x)))), "decimals": guised(each(lambda x: Decimal(float(x)))),
    "unmasked": guised(np.ma.array), "strided": guised(lambda value: np.repeat(np.asarray(value)[..., None], 3, axis=-1)[..., 1])}

# ---- what is wrong to return ----

WRONG = {
    "none": lambda value: None, "text": lambda value: "text", "bytes": lambda value: b"12345678", "class": lambda value: float,
    "dict": lambda value: {"x": 1.0}, "function": lambda value: lambda: value,
    "complex": lambda value: np.asarray(value) * (1 + 0j),
    "NaN": lambda value: np.asarray(value) * np.nan, "one more": lambda value: np.asarray(value)[None],
    "empty": lambda value: np.zeros((0, 0, 0)), "masked": lambda value: np.ma.array(value, mask=True),
    "ragged": lambda value: [[1.0], [1.0, 2.0]], "bool": lambda value: np.ones(np.shape(value), dtype=bool),
    "generator": lambda value: (x for x in [value]), "date": lambda value: np.zeros(np.shape(value), dtype="M8[s]"),
    "strings": lambda value: np.full(np.shape(value), "1.0"), "record": lambda value: np.zeros(np.shape(value), dtype="f8,f8"),
    "many": lambda value: np.zeros((2, 2, 2, 2)), "too large": lambda value: np.full(np.shape(value), 10**400),
    "set": lambda value: {1.0, 2.0}}

# ---- what may be raised ----


class Order(BaseException):
    """No failure, but an order."""


class Stubborn(Exception):
    """An error that takes nothing along and says nothing."""

    def __setattr__(self, name, value):
        raise RuntimeError

    def __repr__(self):
        raise RuntimeError

    __str__ = add_note = __repr__


ERRORS = (ValueError, ZeroDivisionError, KeyboardInterrupt, SystemExit, MemoryError, RecursionError, StopIteration, GeneratorExit,
          StopAsyncIteration, Order, Stubborn, zd.SingularSystem, zd.StepFailed, AssertionError)

# ---- the examples ----

NAMES = st.sampled_from([*CALLABLES, *GIVEN, "events"])
WHERE = {"derived": st.booleans(), "formulation": st.sampled_from(FORMULATIONS), "steps": st.integers(0, len(STEPS) - 1)}
sample = settings(max_examples=EXAMPLES, deadline=None, derandomize="ZERODRIFT_EXAMPLES" not in os.environ)


def outcome(mischief, derived, options):
    """The solution, or what was raised."""
    try:
        mischief.system = bead(derived, mischief.wrap)
        return run(mischief.system, options, mischief.wrap)
    except BaseException as error:
        return error


def check_afterwards(mischief, derived, formulation, steps):
    """That nothing was left behind: kept arrays are what they were, and another run is right."""
    assert all(array.tobytes() == was.tobytes() for array, was in mischief.kept)
    again = run(bead(derived), STEPS[steps] | {"formulation": formulation})
    assert_same_bits(undisturbed(derived, formulation, steps), again)


@sample
@given(name=NAMES, k=st.integers(1, 80), what=st.sampled_from([*HARMLESS, *GUISES]), **WHERE)
def test_harmless_mischief_changes_no_bit(name, k, what, derived, formulation, steps):
    if name == "events" and what in GUISES:
        return      # these are to return a number
    mischief = Mischief(name, k, (HARMLESS | GUISES)[what])
    found = outcome(mischief, derived, STEPS[steps] | {"formulation": formulation})
    assert isinstance(found, zd.Solution), found
    assert_same_bits(undisturbed(derived, formulation, steps), found)
    check_afterwards(mischief, derived, formulation, steps)


@sample
@given(name=NAMES, k=st.integers(4, 80), what=st.sampled_from([*WRONG]), **WHERE)
def test_what_is_wrong_to_return_is_refused_by_name(name, k, what, derived, formulation, steps):
    mischief = Mischief(name, k, lambda self, function, p, v: WRONG[what](function(p, v)))
    found = outcome(mischief, derived, STEPS[steps] | {"formulation": formulation})
    if mischief.happened:
        assert isinstance(found, ValueError | TypeError), found
        assert name in str(found)
    else:
        assert_same_bits(undisturbed(derived, formulation, steps), found)
    check_afterwards(mischief, derived, formulation, steps)


@sample
@given(name=NAMES, k=st.integers(1, 80), kind=st.sampled_from(ERRORS), on_failure=st.sampled_from(["raise", "return"]), **WHERE)
def test_whatever_is_raised_surfaces(name, k, kind, on_failure, derived, formulation, steps):
    error = kind()

    def throw(self, function, p, v):
        raise error

    mischief = Mischief(name, k, throw)
    found = outcome(mischief, derived, STEPS[steps] | {"formulation": formulation, "on_failure": on_failure})
    if not mischief.happened:
        assert_same_bits(undisturbed(derived, formulation, steps), found)
    elif isinstance(found, zd.Solution):
        assert on_failure == "return"
        assert not found.success
        assert kind is KeyboardInterrupt or issubclass(kind, Exception)
        assert kind.__name__ in found.message or "interrupted" in found.message
    else:
        assert found is error or (kind is KeyboardInterrupt and isinstance(found, zd.Interrupted))
    check_afterwards(mischief, derived, formulation, steps)


@pytest.mark.parametrize("derived", [True, False], ids=["derived", "given"])
@pytest.mark.parametrize("steps", range(len(STEPS)))
def test_no_call_can_hide_an_error(derived, steps, formulation):
    """The same at every seventh call of any callable of a run, one after the other."""
    counting = Mischief("constraints", 10**9, None)
    outcome(counting, derived, STEPS[steps] | {"formulation": formulation})
    for k in range(1, counting.calls + 1, 7):
        error = ZeroDivisionError(k)

        def throw(self, function, p, v, error=error):
            raise error

        assert outcome(Mischief("constraints", k, throw), derived, STEPS[steps] | {"formulation": formulation}) is error


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.parametrize("how", [{"formulation": "schur"}, {"formulation": "independent", "integrator": "euler"}], ids=str)
def test_no_call_can_hide_an_error_where_steps_are_made_in_parts(how, monkeypatch):
    """There the core goes on after a failure of its own, and must not after one of a callable.

    The paths to other branches, which are followed after the run and beside its motion, are left out: a callable may be
    undefined there.
    """
    monkeypatch.setattr(branches._Branch, "_path", lambda *_: 0.0)

    def fast(watch):
        return zd.simulate(pendulum(watch), 0.2, v0=[0.0, 10.0], step=0.1, stabilization=zd.Projection(max_iterations=2), **how)

    watch = At(-1, None)
    assert fast(watch).stats["subdivided"]
    for k in range(1, watch.calls + 1, 3):
        error = ZeroDivisionError(k)
        with pytest.raises(ZeroDivisionError) as caught:
            fast(At(k, throw(error)))
        assert caught.value is error
