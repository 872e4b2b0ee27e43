"""Ctrl-C at any moment: it is heard at once, and nothing is lost that was computed."""

import contextlib
import gc
import os
import signal
import sys
import threading
import time
import traceback
from pathlib import Path

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from covering import draws
from large_mechanisms import chain
from support import assert_close, assert_same_bits, motion
from watched import At, pendulum
from zerodrift import _gateway
from zerodrift.runs import simulate as simulation

PACKAGE = str(Path(zd.__file__).parent)
posix = pytest.mark.skipif(os.name != "posix", reason="there is no timer that sends signals")


def interrupted(bar, after=0.15, **options):
    """A long run, Ctrl-C after a while: what came back, and how long that took."""
    sent = []

    def press():
        time.sleep(after)
        sent.append(time.perf_counter())
        signal.raise_signal(signal.SIGINT)      # os.kill would end the process on Windows

    threading.Thread(target=press).start()
    try:
        result = zd.simulate(bar, 1e5, step=1e-3, save_every=1000, **options)
    except KeyboardInterrupt as error:
        result = error
    return result, time.perf_counter() - sent[0]


def interrupted_after_samples(bar, **options):
    """The same with more than one sample: on a busy machine the first one may take longer."""
    for after in (0.15, 1.0, 5.0):
        result, _ = interrupted(bar, after, **options)
        if len(getattr(result, "solution", result).t) > 1:
            break
    return result


def test_ctrl_c_keeps_what_was_computed(bar):
    error = interrupted_after_samples(bar)
    assert isinstance(error, zd.errors.Interrupted)
    sol = error.solution
    assert zd.errors.sentence(error) == sol.message == "interrupted from the keyboard"
    assert not sol.success
    assert sol.status > 0
    assert 1 < len(sol.t) < 1e5
    assert_close(sol.p, zd.simulate(bar, sol.t[-1], step=1e-3, save_every=1000).p, tol.CONVERGED)


def test_ctrl_c_may_return(bar):
    sol = interrupted_after_samples(bar, on_failure="return", integrator="trapezoidal")
    assert sol.message == "interrupted from the keyboard"
    assert len(sol.t) > 1


def test_ctrl_c_is_heard_at_once(bar):
    """The best of a few: a busy machine may delay any one of them."""
    assert min(interrupted(bar)[1] for _ in range(3)) <= tol.KEYBOARD


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
        sys._getframe().f_trace_opcodes = True      # since CPython 3.12 one frame has to ask for bytecodes before others can
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
    counts = [-1, 0]
    while counts[-1] != counts[-2]:     # CPython 3.12 and later tell of a function's bytecodes once it was called before
        with monkeypatch.context() as patch:
            presser = Presser(0, patch)
            whole = presser(call)
        counts.append(presser.count)
    for k in np.unique(np.linspace(1, presser.count, samples).astype(int)):
        with monkeypatch.context() as patch:
            presser = Presser(k, patch)
            outcome = presser(call)
        if presser.count < k and sys.version_info >= (3, 12):   # which does not always tell of as many bytecodes
            continue
        assert presser.count == k
        yield presser, outcome, whole


@pytest.mark.parametrize("written", [zd.systems.pendulum(), pendulum()], ids=["core", "Python"])
@pytest.mark.parametrize("on_failure", ["raise", "return"])
def test_ctrl_c_before_any_bytecode_leaves_what_was_computed(written, on_failure, monkeypatch):
    monkeypatch.setattr(simulation, "SLICE", 0.0)
    monkeypatch.setattr("zerodrift.runs.recording.FIRST_BLOCK", 8)

    def call():
        return zd.simulate(written, 0.2, rtol=1e-7, integrator="dormand_prince", on_failure=on_failure, progress=lambda part: 0)

    partial = over = 0
    for presser, outcome, whole in pressed_everywhere(call, monkeypatch, draws(25, 150)):
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
    assert partial > draws(7, 50)
    assert over < draws(4, 15)


def pressed_after(seconds, call):
    """A call's outcome, Ctrl-C meanwhile. The collector is off: a KeyboardInterrupt within a watch over it is ignored."""
    gc.disable()
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
        gc.enable()


@posix
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # within a finalizer
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
    later = (0.5, 1.0, 2.0)     # on a busy machine it takes longer until there is something to keep
    for seconds in (*np.random.default_rng(2002).uniform(0.001, 0.25, size=12), *later):
        if seconds in later and (kept or what == "reference"):
            break
        outcome = pressed_after(seconds, call)
        if isinstance(outcome, zd.Interrupted):
            assert "interrupted from the keyboard" in str(outcome)
            assert repr(outcome.solution)
            kept += 1
    assert kept or what == "reference"      # whose result exists only at the end


@posix
@pytest.mark.parametrize("links", [100, 2000])
def test_ctrl_c_ends_an_assembly(links):
    """With dense matrices and without: the core finds in seconds that the end of a chain is held beyond its reach."""
    m = chain(links)
    m.start({f"link{links - 1}.end.position.y": 2.0 * links})
    heard = []
    for seconds in (0.3, 0.6, 1.2):     # Python prepares the conditions first, for longer on a busy machine
        outcome = pressed_after(seconds, lambda: m.system("absolute").p0)
        assert isinstance(outcome, KeyboardInterrupt)
        heard = [frame.name for frame in traceback.extract_tb(outcome.__traceback__)]
        if "zd_interrupted_in_python" in heard:
            break
    assert "zd_interrupted_in_python" in heard


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
