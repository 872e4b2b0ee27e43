"""Time of studies of one motion by the core's batch call and in threads, compared with calls of `simulate` one after another.

Run it with ``python tests/bench/bench_studies.py``. It writes ``results/studies.csv``. Both ways are timed in turn, in one
process, and give the same results. Threads are measured by processor time, as they wait for others on a busy machine: the sum
over all threads, and the longest thread plus the main thread, which is their wall-clock time on as many free cores.
"""

import functools
import threading
import time
from unittest import mock

import zerodrift as zd
from measuring import record
from zerodrift.runs.open import threads
from zerodrift.studies.bench import Bench
from zerodrift.studies.reference_runs import Motion

ROUNDS = 5
THREADS = 2
METHODS = {"formulations": ["schur", "independent"], "integrators": ["rk4", "dop853"]}
BAR = zd.systems.four_bar()


def studies():
    """Each with what it is called."""
    for name, system, end in (("four-bar, 1 s", BAR, 1.0), ("four-bar, 4 s", BAR, 4.0),
                              ("Hoecken's linkage, 1 s", zd.models.hoecken().system(), 1.0)):
        reference = zd.reference(system, end)
        yield f"reference: {name}", functools.partial(zd.reference, system, end)
        yield f"stability_map: {name}, 112 cells", functools.partial(zd.stability_map, system, end, reference=reference)
        yield f"stability_map: {name}, with its reference", functools.partial(zd.stability_map, system, end)
        yield f"work_precision: {name}, 46 rows, one round", functools.partial(
            zd.work_precision, system, end, reference=reference, rounds=1, **METHODS)
        yield f"tune: {name}, error 1e-6", functools.partial(zd.tune, system, end, error=1e-6, rounds=1, **METHODS)


def one_by_one(call):
    """As if Python were in the way of all runs."""
    with mock.patch.object(Bench, "needs_python", True), mock.patch.object(Motion, "run_side_by_side"):
        return call()


def times(call):
    """Processor time of all threads, and that of this one with the longest of each group of others."""
    longest, groups = [0.0], []

    class Timed(threading.Thread):
        def run(self):
            super().run()
            longest[-1] = max(longest[-1], time.thread_time())

    class Group(threads.Threads):
        def run(self, count, look):
            longest.append(0.0)
            groups.append(count)
            super().run(count, look)

    with mock.patch.object(threads.threading, "Thread", Timed), mock.patch.object(threads, "Threads", Group):
        begin, own = time.process_time(), time.thread_time()
        call()
        return time.process_time() - begin, time.thread_time() - own + sum(longest)


def rows():
    with mock.patch.object(threads, "processors", return_value=THREADS):
        for what, call in studies():
            found = [(times(functools.partial(one_by_one, call)), times(call)) for _ in range(ROUNDS)]
            before, together, longest = (min(each) for each in zip(*((a[0], *b) for a, b in found), strict=True))
            yield what, 1e3 * before, "ms, one by one", None
            yield what, before / together, "times as fast on one core", None
            yield what, before / longest, f"times as fast with {THREADS} threads", None


if __name__ == "__main__":
    record("studies", rows(), ("what", "value", "unit", "at most"))
