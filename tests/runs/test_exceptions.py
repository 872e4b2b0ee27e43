"""Ctrl-C, exceptions and the end of memory at any moment: nothing crashes, leaks or is lost that was computed."""

import contextlib
import dataclasses
import gc
import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import zerodrift as zd
from support import motion
from test_runs import assert_same_bits
from watched import At, pendulum, throw
from zerodrift import _gateway
from zerodrift.runs import simulate as simulation

PACKAGE = str(Path(zd.__file__).parent)
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
posix = pytest.mark.skipif(os.name != "posix", reason="there is no timer that sends signals")


def assert_beginning(part, whole):
    """The rows of one are the first of the other, to the last bit."""
    assert len(part.t) < len(whole.t)
    assert_same_bits(whole, part, slice(len(part.t)))


# ---- exceptions in a callable ----


@pytest.mark.parametrize("options", [{"step": 0.05}, {"rtol": 1e-4, "integrator": "dormand_prince", "t_eval": [0.1, 0.2, 0.3]}],
                         ids=["fixed", "chosen"])
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


# ---- Ctrl-C ----


class Presser:
    """Presses Ctrl-C before the k-th bytecode of the package; notes whether the core had run, and whether the run was over."""

    def __init__(self, k, monkeypatch):
        self.k, self.count, self.advanced, self.over = k, 0, False, False
        advance = _gateway.Run.advance

        def advancing(*arguments):
            self.advanced, self.ran = self.ran, True
            return advance(*arguments)

        self.ran = False
        monkeypatch.setattr(_gateway.Run, "advance", advancing)

    def trace(self, frame, event, argument):
        if not frame.f_code.co_filename.startswith(PACKAGE):
            return None
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        if event == "opcode":
            self.count += 1
            if self.count == self.k:
                sys.settrace(None)
                self.over = self.ran and signal.getsignal(signal.SIGINT) is signal.default_int_handler
                self.advanced = self.ran
                signal.raise_signal(signal.SIGINT)
        return self.trace

    def __call__(self, call):
        sys.settrace(self.trace)
        try:
            return call()
        except KeyboardInterrupt as error:
            return error
        finally:
            sys.settrace(None)


def pressed_everywhere(call, monkeypatch, samples):
    """The outcomes of pressing at so many bytecodes spread over all of a call."""
    call()      # plans how terms are written, once
    with monkeypatch.context() as patch:
        presser = Presser(0, patch)
        whole = presser(call)
    for k in np.unique(np.linspace(1, presser.count, samples).astype(int)):
        with monkeypatch.context() as patch:
            presser = Presser(k, patch)
            outcome = presser(call)
        assert presser.count == k
        yield presser, outcome, whole


@pytest.mark.parametrize("written", [zd.systems.pendulum(), pendulum()], ids=["core", "Python"])
@pytest.mark.parametrize("on_failure", ["raise", "return"])
def test_ctrl_c_before_any_bytecode_leaves_what_was_computed(written, on_failure, monkeypatch):
    monkeypatch.setattr(simulation, "SLICE", 0.0)
    monkeypatch.setattr(simulation, "FIRST_BLOCK", 8)

    def call():
        return zd.simulate(written, 0.2, rtol=1e-7, integrator="dormand_prince", on_failure=on_failure, progress=lambda part: 0)

    partial = over = 0
    for presser, outcome, whole in pressed_everywhere(call, monkeypatch, 150):
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if presser.over:
            over += 1
            assert isinstance(outcome, KeyboardInterrupt)
        elif presser.advanced:
            kept = outcome if isinstance(outcome, zd.Solution) else outcome.solution
            assert "interrupted from the keyboard" in (kept.message if kept is outcome else str(outcome))
            assert kept is not outcome or on_failure == "return"
            partial += len(kept.t) > 1
            assert_same_bits(whole, kept, slice(len(kept.t)))
        else:
            assert isinstance(outcome, KeyboardInterrupt | zd.Solution)
            assert not getattr(outcome, "success", False)
    assert partial > 50
    assert over < 15


def pressed_after(seconds, call):
    """A call's outcome, Ctrl-C meanwhile."""
    before = signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        signal.setitimer(signal.ITIMER_REAL, seconds)
        try:
            return call()
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)     # it may be pressed here, too
    except KeyboardInterrupt as error:
        return error
    finally:
        signal.signal(signal.SIGALRM, before)


@posix
@pytest.mark.parametrize("what", ["simulate", "reference", "work_precision", "tune"])
def test_ctrl_c_at_any_time_ends_what_goes_on(what, bar):
    known = zd.reference(bar, 0.5, error=None)
    call = {
        "simulate": lambda: zd.simulate(pendulum(), 3.0, step=1e-3),
        "reference": lambda: zd.reference(bar, 2.0, error=None),
        "work_precision": lambda: zd.work_precision(bar, 0.5, reference=known, rounds=3),
        "tune": lambda: zd.tune(bar, 0.5, error=1e-6, formulations=["schur"]),
    }[what]
    kept = 0
    for seconds in np.random.default_rng(2002).uniform(0.001, 0.25, size=12):
        outcome = pressed_after(seconds, call)
        if isinstance(outcome, zd.Interrupted):
            assert "interrupted from the keyboard" in str(outcome)
            assert repr(outcome.solution)
            kept += 1
    assert kept or what == "reference"      # which has nothing to show before its end, but for runs of its own


def test_another_handler_of_ctrl_c_is_left_alone(bar):
    heard = []
    before = signal.signal(signal.SIGINT, lambda *_: heard.append(signal.getsignal(signal.SIGINT)))
    try:
        mine = signal.getsignal(signal.SIGINT)
        sol = motion(bar, 1.0, 100, progress=At(1, lambda: signal.raise_signal(signal.SIGINT)))
    finally:
        signal.signal(signal.SIGINT, before)
    assert sol.success
    assert heard == [mine]


def test_a_ctrl_c_that_a_callable_swallows_is_heard_all_the_same():
    def swallow():
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(zd.Interrupted) as caught:
        zd.simulate(pendulum(At(2000, swallow)), 1000.0, step=0.01)
    assert 10 < len(caught.value.solution.t) < 99_000


# ---- memory ----


def limited(code, mebibytes):
    """What a process prints that may take so much memory beyond what importing took."""
    limit = f"""
    import resource, numpy as np, zerodrift as zd
    pages = int(open("/proc/self/statm").read().split()[0])
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + {mebibytes} * 2**20,) * 2)
    """
    code = textwrap.dedent(limit) + textwrap.dedent(code)
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          env=os.environ | {"OPENBLAS_NUM_THREADS": "1"}).stdout


@linux
def test_no_memory_for_a_run_is_an_error_with_its_size():
    output = limited("""
    def system(n):
        return zd.System(n, mass=np.eye(n), p0=np.zeros(n))

    small, large = system(20), system(600)      # M of the latter takes 3 MiB
    for call in (lambda: zd.simulate(large, 1.0, step=0.1), lambda: zd.acceleration(large, large.p0, large.p0),
                 lambda: zd.project(large, large.p0, large.p0)):
        try:
            call()
        except MemoryError as error:
            print(error)
    print(zd.simulate(small, 1.0, step=0.1).message)
    """, 12)
    lines = output.splitlines()
    assert len(lines) == 4
    assert all(line.startswith("there is no memory for this: ") and line.endswith(" MiB") for line in lines[:3])
    assert lines[3] == "done"


@linux
def test_a_record_that_outgrows_memory_keeps_what_was_computed():
    output = limited("""
    try:
        zd.simulate(zd.systems.pendulum(), 1e9, rtol=1e-9, max_step=1e-3, integrator="dormand_prince")
    except MemoryError as error:
        sol = error.solution
        print(error)
        print(len(sol.t) > 1000, bool(np.isfinite(sol.p).all()), sol.success, sol.message.startswith("stopped by MemoryError"))
    """, 48)
    lines = output.splitlines()
    assert "saved rows need" in lines[0]
    assert lines[1] == "True True False True"


def resident():
    """Bytes of memory in use."""
    gc.collect()
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def wide(n=40):
    """A system whose runs take some 100 KiB."""
    return zd.System(n, mass=np.eye(n), force=lambda v: np.full(n, 1 / (1 - v[0])), p0=np.zeros(n), potential=0.0)


def diverging():
    with pytest.raises(zd.ZerodriftError):
        zd.simulate(zd.systems.four_bar(), 8.0, step=0.5, stabilization=None)


def raising():
    with pytest.raises(ZeroDivisionError):
        zd.simulate(pendulum(At(60, throw(ZeroDivisionError()))), 1.0, step=0.05)


def refused():
    with pytest.raises(zd.InconsistentStart):
        zd.simulate(zd.systems.four_bar(), 8.0, [1, 1, 1], step=0.1)


def stopped():
    with pytest.raises(ZeroDivisionError):
        zd.simulate(wide(), 0.1, step=0.05, progress=At(1, throw(ZeroDivisionError())))


def succeeding():
    zd.simulate(wide(), 0.1, step=0.05)


@linux
@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.parametrize("what", [diverging, raising, refused, stopped, succeeding])
def test_nothing_leaks(what):
    for _ in range(50):
        what()
    before = resident()
    for _ in range(300):
        what()
    assert resident() - before < 2**20      # 300 runs of the smallest system, with what Python keeps of each, take more
