"""Ensembles in other processes: the same bits, functions that travel or are named, workers that die."""

import functools
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from small_studies import dies, locks, lowest, pendulum, waits
from support import environment_of_tests, refused
from zerodrift.ensembles import executors, transport
from zerodrift.ensembles.store import Store

GRAVITIES = np.linspace(5.0, 10.0, 12)
PLAIN = {"parameters": {"gravity": GRAVITIES}, "step": 0.01, "outputs": ["link.angle"]}


@pytest.fixture(scope="module")
def processes():
    """One that is started anew, as a worker elsewhere is."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor:
        yield executor


def same(one, other):
    """True if two ensembles are bitwise the same."""
    return (np.array_equal(one["link.angle"], other["link.angle"], equal_nan=True) and one.messages == other.messages
            and np.array_equal(one.values, other.values))


@pytest.mark.parametrize("chunk", [None, 5])
def test_another_process_gives_the_same_bits(processes, chunk):
    here = zd.ensemble(pendulum, 1.0, reduce=lowest, **PLAIN)
    there = zd.ensemble(pendulum, 1.0, reduce=lowest, executor=processes, chunk=chunk, **PLAIN)
    assert same(here, there)
    assert "by ProcessPoolExecutor" in repr(there)
    assert np.array_equal(there[3]["link.angle"], there["link.angle"][3])


def test_systems_starts_and_solutions_travel(processes):
    m = zd.models.four_bar()
    arguments = {"parameters": {"crank.mass": [1.0, 2.0, 3.0]}, "step": 0.01, "chunk": 2, "outputs": ["C.force"],
                 "start": {"crank.angle": [0.5, 1.0, 1.5]}, "events": [zd.Event("crank.angle", value=2.0)]}
    here = zd.ensemble(m, 0.5, **arguments)
    there = zd.ensemble(m, 0.5, executor=processes, keep="solutions", **arguments)
    assert np.array_equal(here["C.force"], there["C.force"])
    assert np.array_equal(there[2].t, here[2].t)
    assert there[2] is there[2]
    assert [len(times) for times, in there.t_events] == [len(times) for times, in here.t_events]


def test_processes_of_its_own_and_failures():
    """Which are data there, too."""
    arguments = PLAIN | {"parameters": {"length": [1.0, 0.0, 2.0]}}
    here = zd.ensemble(pendulum, 1.0, **arguments)
    there = zd.ensemble(pendulum, 1.0, executor="processes", threads=1, **arguments)
    assert same(here, there)
    assert there.failed.tolist() == [False, True, False]
    assert "in 1 processes" in repr(there)


def test_functions_that_cannot_travel_are_named(monkeypatch, processes):
    """Before anything runs, and only where cloudpickle is missing; those of a script travel to processes that import it."""
    monkeypatch.setattr(transport, "_cloudpickle", lambda: None)
    with refused("not-portable"):
        zd.ensemble(pendulum, 1.0, executor=processes, reduce=lambda sol: 1.0, **PLAIN)
    with refused("not-portable"):
        zd.ensemble(zd.systems.oscillator(), 1.0, executor=processes, step=0.1, hold=threading.Lock())
    monkeypatch.setattr(lowest, "__module__", "__main__")
    monkeypatch.setattr(sys.modules["__main__"], "lowest", lowest, raising=False)
    monkeypatch.setattr(sys.modules["__main__"], "__file__", __file__, raising=False)   # pytest's own workers have none
    with refused("not-portable", "__main__"):
        transport.packed(lowest)
    assert transport.unpacked(transport.packed(lowest, shares_main=True)) is lowest


def test_functions_travel_by_value_with_cloudpickle(processes):
    cloudpickle = pytest.importorskip("cloudpickle")
    factor = 2.0
    ens = zd.ensemble(pendulum, 1.0, executor=processes, reduce=lambda sol: factor * sol.t[-1], **PLAIN)
    assert ens.values.tolist() == [2.0] * 12
    assert transport.is_found(lowest)
    module = sys.modules[lowest.__module__]
    cloudpickle.register_pickle_by_value(module)
    try:
        assert not transport.is_found(lowest)
        assert transport.unpacked(transport.packed(lowest)) is not lowest
    finally:
        cloudpickle.unregister_pickle_by_value(module)


LOCK = threading.Lock()


def refers(gravity=9.81):
    """By a function within it."""
    def is_free():
        return not LOCK.locked()

    return pendulum(gravity=gravity) if is_free() else None


class Holder:
    def __init__(self, held):
        self.held = held

    def __call__(self, sol):
        return 1.0

    def lowest(self, sol):
        return 1.0


def closing_over(held):
    def closed(sol):
        return sol.t[-1] if held else None
    return closed


def by_default(sol, held=LOCK):
    return sol.t[-1]


@pytest.mark.parametrize(("arguments", "named"), [
    ({"reduce": closing_over(LOCK)}, r"closing_over.<locals>.closed of .* refers to <unlocked _thread.lock"),
    ({"reduce": closing_over([{"a": LOCK}])}, r"closing_over.<locals>.closed of .* refers to <unlocked"),
    ({"reduce": functools.partial(closing_over(LOCK), 3)}, r"closing_over.<locals>.closed of .* refers to"),
    ({"reduce": Holder(LOCK).lowest}, r"Holder object at .* refers to <unlocked"),
    ({"reduce": Holder(1.0).lowest, "events": [Holder(LOCK)]}, r"Holder object at .* refers to <unlocked"),
    ({"reduce": by_default}, "by_default of .* refers to <unlocked"),
    ({"system": refers}, "refers of .* refers to <unlocked"),
])
def test_functions_that_refer_to_what_cannot_travel_are_named(processes, arguments, named):
    """Refused before anything runs; cloudpickle also pickles functions of registered modules by value."""
    cloudpickle = pytest.importorskip("cloudpickle")
    cloudpickle.register_pickle_by_value(sys.modules[__name__])
    try:
        with refused("not-portable", f"the ensemble cannot travel to another process: .*{named}.*cannot pickle"):
            zd.ensemble(**{"system": pendulum, "t_span": 1.0, "executor": processes} | PLAIN | arguments)
    finally:
        cloudpickle.unregister_pickle_by_value(sys.modules[__name__])


class Cancels(ThreadPoolExecutor):
    """An executor that drops all that has not begun, once so many tasks have ended."""

    def __init__(self, count, portions):
        super().__init__(1)
        self.left, self.to_come, self.has_all = count, portions, threading.Event()

    def submit(self, function, *arguments):
        def counted():
            self.has_all.wait(tol.HUNG)         # on a busy machine the first are done before the last are submitted
            result = function(*arguments)
            self.left -= 1
            if not self.left:
                self.shutdown(wait=False, cancel_futures=True)
            return result
        future = super().submit(counted)
        self.to_come -= 1
        if not self.to_come:
            self.has_all.set()
        return future


def test_runs_that_an_executor_cancels_are_lost_with_an_error(tmp_path):
    """With those that were done, from which the same call continues them."""
    arguments = PLAIN | {"store": tmp_path / "study", "chunk": 2}
    with pytest.raises(zd.WorkerLost, match=r"did not return the runs 4 ... 5, nor 3 other portions: Cancelled") as caught:
        zd.ensemble(pendulum, 1.0, executor=Cancels(2, 6), **arguments)
    assert caught.value.solution.failed.tolist() == [False] * 4 + [True] * 8
    assert same(zd.ensemble(pendulum, 1.0, **arguments), zd.ensemble(pendulum, 1.0, **PLAIN))


def test_what_a_worker_lacks_is_said(monkeypatch):
    stamp = {"vector": "avx512", "version": executors.version()}
    monkeypatch.setattr(executors.gateway, "PROCESSOR_UNIT", 1)
    with pytest.raises(zd.WorkerLost, match=r'no avx512, .* vector="avx2" \| "baseline" .* baseline and avx2'):
        executors.check_stamp(stamp)
    with pytest.raises(zd.WorkerLost, match="another zerodrift"):
        executors.check_stamp(stamp | {"version": "another"})
    with refused("missing-package", r"No module named 'elsewhere'.*register_pickle_by_value"):
        transport.unpacked(b"celsewhere\nthing\n.")


class Elsewhere:
    """An executor whose workers have another version, and something else besides."""

    def submit(self, function, *arguments):
        future = Future()
        future.set_result(function(*arguments))
        return future


def test_a_worker_of_another_version_is_refused(monkeypatch):
    checked = executors.check_stamp
    executors._plan.cache_clear()       # of what other tests have sent to this process
    monkeypatch.setattr(executors, "check_stamp", lambda stamp: checked(stamp | {"version": "another"}))
    with pytest.raises(zd.WorkerLost, match=r"another zerodrift, .* than .* \(on ") as caught:
        zd.ensemble(pendulum, 1.0, executor=Elsewhere(), **PLAIN)
    assert caught.value.solution.failed.all()
    monkeypatch.undo()
    with pytest.raises(TypeError, match="what locks returned of a run cannot travel"):
        zd.ensemble(pendulum, 1.0, executor=Elsewhere(), reduce=locks, **PLAIN)


def test_workers_that_die_leave_what_was_done(tmp_path):
    """And the same call continues them with it, by threads."""
    arguments = PLAIN | {"store": tmp_path / "study", "reduce": dies, "chunk": 2}
    with (ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor,
          pytest.raises(zd.WorkerLost, match=r"did not return the runs 6 ... 7, nor 2 other portions: Broken") as caught):
        zd.ensemble(pendulum, 1.0, executor=executor, **arguments)
    assert "the same call continues them" in caught.value.__notes__[0]
    assert (~caught.value.solution.failed).sum() == 6
    with pytest.raises(zd.WorkerLost, match=r"did not return the runs 6 ... 7: .*__main__"):
        zd.ensemble(pendulum, 1.0, executor=executor, **arguments)      # which is broken by now
    os.environ["ZERODRIFT_SURVIVES"] = "1"
    try:
        assert not zd.ensemble(pendulum, 1.0, **arguments).failed.any()
    finally:
        del os.environ["ZERODRIFT_SURVIVES"]


def test_ctrl_c_ends_processes_and_keeps_what_they_did(monkeypatch):
    """The flag that tells them so is heard within a run."""
    def look(part):
        if part > 0:
            raise KeyboardInterrupt

    with pytest.raises(zd.Interrupted, match="of 400 runs are done") as caught:
        zd.ensemble(pendulum, 1.0, executor="processes", threads=1, chunk=40, progress=look, reduce=waits,
                    **PLAIN | {"parameters": {"gravity": np.linspace(5, 10, 400)}})
    done = ~caught.value.solution.failed
    assert 40 <= done.sum() < 400
    assert done[:done.sum()].all()


def test_ctrl_c_while_a_part_is_written_does_not_lose_it(tmp_path, monkeypatch):
    """It is written before the error is raised, as what came meanwhile is."""
    presses = iter([False, True])

    def pressed(self, first, part, write=Store.write):
        if next(presses, False):
            raise KeyboardInterrupt
        write(self, first, part)

    monkeypatch.setattr(Store, "write", pressed)
    with pytest.raises(zd.Interrupted, match="12 of 12 runs are done"):
        zd.ensemble(pendulum, 1.0, executor=Elsewhere(), chunk=3, store=tmp_path / "study", **PLAIN)
    assert not zd.load(tmp_path / "study").failed.any()


def test_a_thread_pool_is_an_executor_too():
    with ThreadPoolExecutor(2) as executor:
        assert same(zd.ensemble(pendulum, 1.0, executor=executor, reduce=lowest, **PLAIN),
                    zd.ensemble(pendulum, 1.0, reduce=lowest, **PLAIN))


@pytest.mark.parametrize("executor", [3, "threads", ProcessPoolExecutor])
def test_what_is_not_an_executor(executor):
    if isinstance(executor, type):
        executor = executor.__new__(executor).__class__.__name__
    with refused("wrong-type", "executor"):
        zd.ensemble(pendulum, 1.0, executor=executor, **PLAIN)


CLUSTER = """
import os, signal, sys, threading
import numpy as np
import zerodrift as zd
from dask.distributed import Client, LocalCluster
from small_studies import pendulum, slow

if __name__ == "__main__":
    with (LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                       local_directory=os.path.dirname(sys.argv[1])) as cluster,
          Client(cluster) as client):
        victim, executor, submitted, stored = next(iter(cluster.workers.values())).pid, client.get_executor(), [], {}
        class Counting:
            def submit(self, *portion):
                submitted.append(portion)
                return executor.submit(*portion)
        def look(part):
            global victim
            if part > 0.2 and victim:
                stored.update((file.path, file.stat().st_mtime_ns) for file in os.scandir(sys.argv[1])
                              if file.name.startswith("runs_"))
                os.kill(victim, signal.SIGKILL)
                victim = None
        ens = zd.ensemble(pendulum, 1.0, parameters={"gravity": np.linspace(5.0, 10.0, 60)}, step=0.01, reduce=slow,
                          outputs=["link.angle"], executor=Counting(), chunk=4, store=sys.argv[1], progress=look)
        assert victim is None and not ens.failed.any(), ens
        assert len(submitted) == 15 and len(stored) >= 3, (len(submitted), stored)
        assert stored == {path: os.stat(path).st_mtime_ns for path in stored}
        os._exit(0)     # Dask may fail to close a cluster of which a worker is just starting; they end with this process
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="processes of this system are not killed by signals")
def test_a_cluster_whose_worker_is_killed(tmp_path):
    """Another worker process takes the runs of the killed one. Portions are submitted once, and stored ones not written again.

    Dask itself may repeat a portion that is stored, if the worker is lost before its scheduler hears that the result was fetched.
    """
    pytest.importorskip("distributed", reason="needs dask's cluster: pip install 'zerodrift[cluster]'")
    counted, script = tmp_path / "counted", tmp_path / "script.py"
    script.write_text(CLUSTER)
    ended = subprocess.run([sys.executable, script, tmp_path / "study"], timeout=tol.HUNG, capture_output=True, text=True,
                           env=environment_of_tests(ZERODRIFT_COUNTED=str(counted)))
    assert ended.returncode == 0, ended.stderr
    found = zd.load(tmp_path / "study")
    alone = zd.ensemble(pendulum, 1.0, parameters={"gravity": np.linspace(5.0, 10.0, 60)}, step=0.01, outputs=["link.angle"])
    assert np.array_equal(found["link.angle"], alone["link.angle"])
    assert set(counted.read_text().splitlines()) == {repr(angle) for angle in alone["link.angle"][:, -1]}
