"""Ctrl-C at any moment: it is heard at once, and nothing is lost that was computed."""

import contextlib
import gc
import signal
import sys
import traceback
from pathlib import Path

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from covering import draws
from large_mechanisms import chain
from support import assert_same_bits, motion
from watched import At, pendulum
from zerodrift._private import gateway
from zerodrift.runs import simulate as simulation

PACKAGE = str(Path(zd.__file__).parent)


@pytest.fixture
def slices(monkeypatch):
    """Seconds that each slice of the core is given; Ctrl-C is pressed during the twentieth, and each ends after a few steps."""
    given, advance = [], gateway.Run.advance

    def advancing(run, record, seconds):
        given.append(seconds)
        if len(given) == 20:
            signal.raise_signal(signal.SIGINT)      # os.kill would end the process on Windows
        return advance(run, record, 0.0)

    monkeypatch.setattr(gateway.Run, "advance", advancing)
    return given


def test_ctrl_c_keeps_what_was_computed(bar, slices):
    with pytest.raises(zd.errors.Interrupted) as caught:
        zd.simulate(bar, 100.0, step=1e-3)
    sol = caught.value.solution
    assert zd.errors.sentence(caught.value) == sol.message == "interrupted from the keyboard"
    assert not sol.success
    assert sol.status > 0
    assert 20 <= len(sol.t) < 1e5
    assert_same_bits(zd.simulate(bar, sol.t[-1] + 0.01, step=1e-3), sol, slice(len(sol.t)))


def test_ctrl_c_may_return(bar, slices):
    sol = zd.simulate(bar, 100.0, step=1e-3, on_failure="return", integrator="trapezoidal")
    assert sol.message == "interrupted from the keyboard"
    assert len(sol.t) >= 20


def test_ctrl_c_is_heard_at_once(bar, slices):
    """No slice begins after it, and none is given more than a part of what is promised."""
    zd.simulate(bar, 100.0, step=1e-3, on_failure="return")
    assert len(slices) == 20
    assert max(slices) <= tol.KEYBOARD / 2
    del slices[:]
    with pytest.raises(KeyboardInterrupt):
        zd.Run(bar, step=1e-3).advance_to(100.0)
    assert len(slices) == 20
    assert max(slices) <= tol.KEYBOARD / 2


class Presser:
    """Presses Ctrl-C before the k-th bytecode of the package, or at the k-th call of one of its functions; notes whether the core
    had run, and whether the run was over.
    """

    def __init__(self, k, monkeypatch, event="opcode"):
        self.k, self.event, self.count, self.advanced, self.over = k, event, 0, False, False
        advance = gateway.Run.advance

        def advancing(*arguments):
            self.advanced, self.ran = self.ran, True
            return advance(*arguments)

        self.ran = False
        monkeypatch.setattr(gateway.Run, "advance", advancing)

    def trace(self, frame, event, argument):
        if not frame.f_code.co_filename.startswith(PACKAGE):
            return None
        frame.f_trace_opcodes, frame.f_trace_lines = self.event == "opcode", False
        if event == self.event:
            self.count += 1
            if self.count == self.k:
                sys.settrace(None)
                self.over = self.ran and signal.getsignal(signal.SIGINT) is signal.default_int_handler
                self.advanced = self.ran
                signal.raise_signal(signal.SIGINT)
        return self.trace if self.event == "opcode" else None

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
    monkeypatch.setattr("zerodrift.runs.samples.recording.FIRST_BLOCK", 8)

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


def pressed_at_calls(call, monkeypatch, samples):
    """The outcomes of pressing at so many calls of the package's functions in this thread; the collector is off, as a
    KeyboardInterrupt within a watch over it is ignored.
    """
    with monkeypatch.context() as patch:
        presser = Presser(0, patch, "call")
        presser(call)
    for k in np.unique(np.linspace(1, presser.count, samples).astype(int)):
        gc.disable()
        with monkeypatch.context() as patch:
            outcome = (presser := Presser(k, patch, "call"))(call)
        gc.enable()
        if presser.count == k:      # other threads may have left less to do for this one
            yield outcome


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # within a finalizer
@pytest.mark.parametrize("what", ["simulate", "reference", "work_precision", "tune"])
def test_ctrl_c_at_any_time_ends_what_goes_on(what, bar, monkeypatch):
    known, few = zd.reference(bar, 0.1, error=None), {"formulations": ["schur"], "integrators": ["rk4", "dop853"]}
    call = {
        "simulate": lambda: zd.simulate(pendulum(), 0.05, step=1e-3),
        "reference": lambda: zd.reference(bar, 0.1, error=None),
        "work_precision": lambda: zd.work_precision(bar, 0.1, reference=known, rounds=1, **few),
        "tune": lambda: zd.tune(bar, 0.1, error=1e-6, rounds=1, **few),
    }[what]
    kept = 0
    for outcome in pressed_at_calls(call, monkeypatch, draws(8, 30)):
        if isinstance(outcome, zd.Interrupted):
            assert "interrupted from the keyboard" in str(outcome)
            assert repr(outcome.solution)
            kept += 1
    assert kept or what == "reference"      # whose result exists only at the end


@pytest.mark.parametrize("links", [100, 2000])
def test_ctrl_c_ends_an_assembly(links):
    """With dense matrices and without: the core asks while it finds that the end of a chain is held beyond its reach."""
    m = chain(links)
    m.start({f"link{links - 1}.end.position.y": 2.0 * links})
    asked = []

    def press(frame, event, argument):
        if frame.f_code.co_name == "zd_interrupted_in_python" and event == "call":
            asked.append(frame)
            if len(asked) == 3:
                signal.raise_signal(signal.SIGINT)

    sys.setprofile(press)
    try:
        with pytest.raises(KeyboardInterrupt) as caught:
            _ = m.system("absolute").p0
    finally:
        sys.setprofile(None)
    assert len(asked) == 3
    assert "zd_interrupted_in_python" in [frame.name for frame in traceback.extract_tb(caught.value.__traceback__)]


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
