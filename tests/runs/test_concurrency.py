"""Threads and forked processes that share a system: the same bits as alone, and an exception stays where it was raised."""

import multiprocessing
import os
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import zerodrift as zd
from support import assert_same_bits
from watched import At, pendulum
from zerodrift.runs import simulate as simulation

posix = pytest.mark.skipif(os.name != "posix", reason="there is no fork")


# ---- threads ----


def test_threads_share_a_system_written_in_python():
    system = pendulum()
    alone = zd.simulate(system, 1.0, step=0.01)
    with ThreadPoolExecutor(8) as pool:
        for sol in pool.map(lambda _: zd.simulate(system, 1.0, step=0.01), range(24)):
            assert_same_bits(alone, sol)


def test_an_exception_stays_in_its_thread():
    """Callables of one system, shared: those of one thread fail."""
    failing = threading.local()

    def watch():
        if getattr(failing, "now", False):
            raise ZeroDivisionError(threading.get_ident())

    def run(i):
        failing.now = i % 2 == 1
        try:
            return zd.simulate(system, 0.5, step=0.01)
        except ZeroDivisionError as error:
            return error.args[0] == threading.get_ident()
        finally:
            failing.now = False

    system = pendulum(watch)
    alone = zd.simulate(system, 0.5, step=0.01)
    with ThreadPoolExecutor(8) as pool:
        for i, outcome in enumerate(pool.map(run, range(40))):
            if i % 2:
                assert outcome is True
            else:
                assert_same_bits(alone, outcome)


# ---- forks ----


FORKED = {"core": zd.systems.pendulum(), "Python": pendulum()}


def run_forked(name, **options):
    """The bits of a run."""
    sol = zd.simulate(FORKED[name], 2.0, step=0.01, **options)
    return np.column_stack([sol.t, sol.p, sol.v, sol.multipliers, sol.energy_violation]).tobytes()


@posix
@pytest.mark.parametrize("name", FORKED)
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")     # that it has threads, and forks
def test_forked_processes_give_the_same_bits(name):
    alone = run_forked(name)
    with ThreadPoolExecutor(2) as threads, multiprocessing.get_context("fork").Pool(2) as pool:
        meanwhile = [threads.submit(run_forked, name) for _ in range(4)]
        for bits in [*pool.map(run_forked, [name] * 4), *(run.result() for run in meanwhile)]:
            assert bits == alone


@posix
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
@pytest.mark.parametrize("name", FORKED)
def test_a_run_goes_on_in_parent_and_child_of_a_fork(name, monkeypatch):
    monkeypatch.setattr(simulation, "SLICE", 0.0)
    alone = run_forked(name)
    parent, (read, write), children = os.getpid(), os.pipe(), []
    bits = run_forked(name, progress=At(3, lambda: children.append(os.fork())))
    if os.getpid() != parent:
        os.write(write, b"same" if bits == alone else b"not!")
        os._exit(0)
    os.waitpid(children[0], 0)
    assert os.read(read, 4) == b"same"
    assert bits == alone
