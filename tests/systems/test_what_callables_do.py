"""Callables and values from users: arrays that they keep stay unchanged, their results and exceptions are checked."""

import gc
import pickle
import threading
from fractions import Fraction

import numpy as np
import pytest

import zerodrift as zd
from bead import MASKED, bead
from support import refused
from watched import At, throw
from zerodrift.studies import compare

# ---- what is kept ----


class Keeper:
    """Keeps all that its callables are handed, and what it was."""

    def __init__(self):
        self.kept = []

    def __call__(self, *arguments):
        self.kept += [(x, x.copy()) for x in arguments if isinstance(x, np.ndarray)]

    def check(self):
        """Check that kept arrays are unchanged after the runs, when their memory is used again; return the number of probes."""
        gc.collect()
        waste = [np.full(size, np.pi) for size in range(1, 200) for _ in range(5)]
        assert all(x.shape == was.shape and (x == was).all() for x, was in self.kept)
        assert len({was.tobytes() for _, was in self.kept if was.dtype == float}) > 5
        return len(waste)


def keeping(keeper, **changes):
    """A bead that keeps everything."""
    def constraints(p):
        keeper(p)
        return np.array([p @ p - 1.0]) / 2

    def force(t, p, v, m, pull):
        keeper(p, v, pull)
        return m * pull

    def kinematics(p):
        keeper(p)
        return np.eye(2)

    return bead(constraints=constraints, force=force, kinematics=kinematics, **changes)


@pytest.mark.parametrize("options", [{"step": 0.02}, {"rtol": 1e-5, "integrator": "dormand_prince"}], ids=["fixed", "chosen"])
def test_what_a_callable_keeps_stays_what_it_was(formulation, options):
    keeper = Keeper()
    system = keeping(keeper)

    def event(t, p, v):
        keeper(p, v)
        return p[1] + 0.1

    for _ in range(2):
        zd.simulate(system, 0.1, **options, formulation=formulation, energy=True, events=event, progress=lambda part: None)
    del system
    assert keeper.check()


def test_what_is_kept_outside_of_runs_stays_what_it_was():
    keeper = Keeper()
    system = keeping(keeper)
    for y in np.linspace(0.0, 0.5, 7):
        p, v = zd.assemble(system, [1.0, y], [0.0, 1.0])
        system.evaluate(p, v)
        zd.acceleration(system, p, v)
        zd.project(system, p, v)
    zd.check(system)
    zd.simulate(system, 0.1, step=0.05)(0.03)
    assert keeper.check()


def test_what_is_handed_out_cannot_be_made_writable():
    seen = []

    def force(p, v, pull):
        for array in (p, v, pull):
            for base in (array, array.base, array.view().base):
                if isinstance(base, np.ndarray):
                    with pytest.raises(ValueError, match="WRITEABLE"):
                        base.flags.writeable = True
            with pytest.raises(ValueError, match="read-only"):
                array += 1.0
            assert memoryview(array).readonly
            assert not np.frombuffer(array).flags.writeable
            seen.append(array)
        return pull

    system = bead(force=force)
    zd.simulate(system, 0.1, step=0.05)
    assert len(seen) > 10


@pytest.mark.filterwarnings("ignore:Setting the shape:DeprecationWarning")      # by NumPy 2.5 and later
def test_an_array_that_is_given_another_shape_is_not_so_for_others():
    def force(p, v, m, pull):
        p.shape = v.shape = pull.shape = (2, 1)
        return (m * pull)[:, 0]

    usual, reshaping = (zd.simulate(system, 0.2, step=0.02, energy=True) for system in (bead(), bead(force=force)))
    assert (usual.p == reshaping.p).all()


def arrays_in_frames(error):
    """Every array that a debugger would find where an error was raised."""
    traceback = error.__traceback__
    while traceback is not None:
        for value in traceback.tb_frame.f_locals.values():
            values = value.values() if isinstance(value, dict) else [value]
            yield from (each for each in values if isinstance(each, np.ndarray))
        traceback = traceback.tb_next


def test_a_debugger_finds_no_memory_of_a_run_that_is_over():
    """No array in a frame of the traceback is a view of the core's memory, which would be a CFFI buffer."""
    raising = bead(force=lambda t, pull: pull if t < 0.1 else 1 / 0)
    for system in (raising, bead(constraints=lambda t, p: [p[0] - 1 if t < 0.1 else None])):
        with pytest.raises((ZeroDivisionError, TypeError)) as caught:
            zd.simulate(system, 1.0, step=0.02)
        found = list(arrays_in_frames(caught.value))
        assert found
        for array in found:
            while isinstance(array, np.ndarray):
                array = array.base
            assert array is None or isinstance(array, bytes)


@pytest.mark.parametrize("call", [
    lambda system: zd.simulate(system, 1.0, step=0.1), lambda system: system.evaluate(),
    lambda system: zd.acceleration(system, [1.0, 0.0], [0.0, 0.0]), lambda system: zd.project(system, [1.0, 0.1], [0.0, 0.0])],
    ids=["simulate", "evaluate", "acceleration", "project"])
def test_what_is_not_finite_is_shown_as_it_was(call):
    with refused("not-finite", r"^mass is not finite at t = 0: \[\[ *7. +nan\]\n \[nan +7.\]\] \[zd:not-finite\]$"):
        call(bead(mass=np.array([[7.0, np.nan], [np.nan, 7.0]])))


def test_arrays_that_change_later_do_not_change_the_system():
    pull, mass, p0 = np.array([0.0, -9.81]), 2 * np.eye(2), np.array([1.0, 0.0])
    system = bead(mass=mass, p0=p0, parameters={"m": 2.0, "pull": pull})
    before = zd.simulate(system, 0.2, step=0.02)
    pull[:], mass[:], p0[:] = 0.0, 0.0, 7.0
    for again in (system, system.with_parameters(m=2.0), pickle.loads(pickle.dumps(zd.System(2, mass=np.eye(2), p0=[1.0, 2.0])))):
        with pytest.raises(ValueError, match="WRITEABLE"):
            again.p0.flags.writeable = True
    for again in (system, system.with_parameters(m=2.0)):
        assert (zd.simulate(again, 0.2, step=0.02).p == before.p).all()
    with pytest.raises(ValueError, match="read-only"):
        system.parameters["pull"][0] = 1.0


# ---- arguments that are not callables, results that are not values ----


@pytest.mark.parametrize(("force", "code", "message"), [
    (dict, "user-function", "force.*'dict'"),
    ({"x": 1.0}, "wrong-type", "force.*'x'.*1.0"),
    ("gravity", "wrong-type", "force"),
    ([1j, 0.0], "wrong-type", "force"),
    (MASKED, "not-finite", "force"),
    ([[1.0], [2.0, 3.0]], "shape", "force"),
    (lambda p, /: p, "user-function", "'p'"),
    (lambda *p: p, "user-function", r"'\*p'"),
    (lambda p, **other: p, "user-function", r"'\*\*other'"),
])
def test_what_is_not_a_force(force, code, message):
    with refused(code, message):
        bead(force=force)


def late(value):
    """A callable that returns two zeros, and from t = 0.1 something else."""
    return lambda t: value if t >= 0.1 else np.zeros(2)


WRONG = {       # value -> what is said of it
    "complex": (np.array([1j, 0.0]), TypeError, "real numbers, not complex128"),
    "complex without an imaginary part": (np.zeros(2, complex), TypeError, "real numbers, not complex128"),
    "text": (np.array(["1", "2"]), TypeError, "real numbers, not <U1"),
    "words": (["1", None], TypeError, "real numbers, not"),
    "none": (None, TypeError, "real numbers, not None"),
    "bool": (np.array([True, False]), TypeError, "real numbers, not bool"),
    "masked": (MASKED, ValueError, "real numbers, none of them masked"),
    "masked rows": ([np.ma.masked, 1.0], ValueError, "real numbers, none of them masked"),
    "ragged": ([[1.0], [2.0, 3.0]], ValueError, "an array of real numbers, not a ragged sequence"),
    "dates": (np.zeros(2, "M8[s]"), TypeError, "real numbers, not datetime64"),
    "dict": ({"x": 1.0}, TypeError, r"real numbers, not \{'x': 1.0\}"),
    "shape": (np.zeros(3), ValueError, r"shape \(2,\), not \(3,\)"),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_a_callable_must_not_return(what):
    value, error, message = WRONG[what]
    with pytest.raises(error, match=rf"(?s)^force must return {message}.*\(at t = 0.1\)") as caught:
        zd.simulate(bead(force=late(value)), 1.0, step=0.02)
    assert len(caught.value.solution.t) > 3
    with pytest.raises(error, match=f"^force must return {message}"):
        bead(force=lambda: value)


@pytest.mark.parametrize("value", [[1, 2], (1.0, 2.0), [Fraction(1), 2], np.array([1, 2], dtype=np.int8), np.ma.array([1.0, 2.0]),
                                   np.array([1.0, 2.0], dtype=object), np.array([1.0, 2.0], dtype=">f4")],
                         ids=lambda value: f"{type(value).__name__}-{getattr(value, 'dtype', '')}")
def test_what_a_callable_may_return(value):
    assert bead(force=lambda: value).evaluate().f.tolist() == [1.0, 2.0]


def test_numbers_too_large_are_not_finite():
    with refused("not-finite"):
        bead(force=lambda: [10**400, 0]).evaluate()


@pytest.mark.parametrize("call", [
    lambda system: zd.simulate(system, 1.0, MASKED, step=0.1), lambda system: zd.simulate(system, 1.0, v0=MASKED, step=0.1),
    lambda system: zd.simulate(system, 1.0, step=0.1, t_eval=MASKED), lambda system: system.evaluate(MASKED),
    lambda system: zd.assemble(system, MASKED), lambda system: zd.project(system, [1.0, 0.0], MASKED),
    lambda system: zd.acceleration(system, MASKED, MASKED), lambda system: bead(p0=MASKED), lambda system: bead(v0=list(MASKED)),
    lambda system: zd.simulate(system, 1.0, step=0.1)(MASKED),
    lambda system: compare.difference(zd.simulate(system, 1.0, step=0.1), lambda t: MASKED)])
def test_masked_arrays_are_refused_everywhere(call):
    with refused("not-finite", r"must (hold|return) real numbers, none of them masked, not "):
        call(bead())


# ---- where an error was raised ----


def zero_division(usual):
    """A callable that returns what is usual, and from t = 0.1 on raises an error."""
    return lambda t, p, v: usual(p, v) if t < 0.1 else 1 / 0


@pytest.mark.parametrize(("name", "usual"), [
    ("mass", lambda p, v: 2 * np.eye(2)), ("force", lambda p, v: np.array([0.0, -19.62])), ("bias", lambda p, v: np.zeros(2)),
    ("constraints", lambda p, v: np.array([p @ p - 1.0])), ("jacobian", lambda p, v: p[None]),
    ("xi", lambda p, v: -np.array([v @ v])), ("nonholonomic", lambda p, v: np.array([p])), ("kinematics", lambda p, v: np.eye(2)),
    ("potential", lambda p, v: 19.62 * p[1]), ("power", lambda p, v: 0.0)])
def test_an_error_in_a_callable_says_in_which_and_when(name, usual):
    given = {name: zero_division(usual)}
    if name == "nonholonomic":
        given["constraints"] = None
    with pytest.raises(ZeroDivisionError, match=f"in {name}, called at t = 0.1") as caught:
        zd.simulate(bead(**given), 1.0, step=0.02, energy=True)
    assert len(caught.value.solution.t) > 3
    sol = zd.simulate(bead(**given), 1.0, step=0.02, energy=True, on_failure="return")
    assert f"ZeroDivisionError('division by zero'); in {name}, called at t = 0.1" in sol.message


def test_an_error_at_the_door_says_in_which_callable():
    with pytest.raises(ZeroDivisionError, match="in force, called at t = 0"):
        bead(force=lambda p: 1 / 0)
    with pytest.raises(ZeroDivisionError, match="in constraints, called at t = 0 for its derivatives"):
        bead(constraints=lambda p: [1 / 0] if p.dtype == object else p[:1]).evaluate()


def test_an_error_of_events_progress_and_reference_says_where():
    with pytest.raises(ZeroDivisionError, match=r"in events\[1\], called at t = 0"):
        zd.simulate(bead(), 1.0, step=0.02, events=[lambda t, p, v: 1.0, lambda t, p, v: 1 / 0])
    with pytest.raises(ZeroDivisionError, match="in progress, called with"):
        zd.simulate(bead(), 1.0, step=0.02, progress=lambda part: 1 / 0)
    with pytest.raises(ZeroDivisionError, match="in reference, called at t = 0"):
        compare.difference(zd.simulate(bead(), 1.0, step=0.1), lambda t: 1 / 0)


class Stop(BaseException):
    """No failure, but an order."""

@pytest.mark.parametrize("error", [SystemExit(3), GeneratorExit(), Stop()], ids=repr)
@pytest.mark.parametrize("on_failure", ["raise", "return"])
def test_an_order_to_stop_is_not_a_failed_run(error, on_failure):
    action = At(60, throw(error))

    def force(pull):
        action()
        return pull

    with pytest.raises(type(error)) as caught:
        zd.simulate(bead(force=force), 1.0, step=0.02, on_failure=on_failure)
    assert caught.value is error
    assert len(error.solution.t) > 3


# ---- deep down, and from many threads ----


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.parametrize("how", ["evaluate", "acceleration", "simulate"])
def test_a_callable_that_calls_its_own_system_for_ever_ends(how):
    outcome, made = [], []

    def force(p):
        if made:
            {"evaluate": lambda: made[0].evaluate(), "acceleration": lambda: zd.acceleration(made[0], [1.0, 0.0], [0.0, 0.0]),
             "simulate": lambda: zd.simulate(made[0], 0.1, step=0.05)}[how]()
        return -p

    def call():
        with pytest.raises(RecursionError):
            made[0].evaluate()
        outcome.append(how)

    made.append(bead(force=force))

    call()
    thread = threading.Thread(target=call)
    thread.start()
    thread.join()
    assert len(outcome) == 2


def test_the_end_of_the_stack_anywhere_is_said():
    """A run started so near the recursion limit that a callback exceeds it raises RecursionError, or is right."""
    system = bead()
    alone = zd.simulate(system, 0.1, step=0.05, events=lambda t, p, v: p[1]).p

    def deep(levels):
        return zd.simulate(system, 0.1, step=0.05, events=lambda t, p, v: p[1]).p if levels == 0 else deep(levels - 1)

    ended = 0
    for levels in range(820, 1000):
        try:
            assert (deep(levels) == alone).all()
        except RecursionError:
            ended += 1
    assert 20 < ended < 170
