"""A million runs: what they take beside the steps alone, and how much memory.

Run it with ``python tests/bench/bench_many.py [runs]``; it writes ``results/many.csv``. Runs are those of the paper's four-bar
over 1000 steps of RK4 whose gravity differs, of which the last row of one angle is kept, on two threads. The steps alone are
those of few runs over a longer time; they are taken before, between and after a tenth of the runs and all of them. All
is wall time.
"""

import resource
import sys
import time

import numpy as np

import zerodrift as zd
from measuring import record

STEP, STEPS, THREADS, FEW = 0.01, 1000, 2, 256
BAR = zd.systems.four_bar()


def seconds(count, steps):
    """Time of an ensemble of `count` runs, s."""
    start = time.perf_counter()
    ens = zd.ensemble(BAR, steps * STEP, parameters={"gravity": np.linspace(9.7, 9.9, count)}, step=STEP, t_eval=[steps * STEP],
                      outputs=["alpha1"], threads=THREADS)
    taken = time.perf_counter() - start
    assert not ens.failed.any()
    assert np.isfinite(ens["alpha1"]).all()
    assert (ens._part.paths == 1).all()
    return taken


def peak():
    """The most memory so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def rows(count):
    """Rows: rates, and memory of a tenth of the runs and of all."""
    pure = [seconds(FEW, 40 * STEPS) / (FEW * 40) for _ in range(3)]
    begin = peak()
    for share in (10, 1):
        runs, before = count // share, peak()
        taken = seconds(runs, STEPS)
        pure += [seconds(FEW, 40 * STEPS) / (FEW * 40) for _ in range(3)]
        yield f"{runs} runs of {STEPS} steps on {THREADS} threads: wall time", taken, "s", None
        yield f"{runs} runs: a run", 1e6 * taken / runs, "us", None
        yield f"{runs} runs: rate to the steps alone (at least 0.8)", float(np.median(pure)) * runs / taken, "", None
        yield f"{runs} runs: peak memory, of {before:.0f} before", peak(), "MB", None
    yield "memory that a run takes, of all", (peak() - begin) * 2**20 / count, "bytes", None


if __name__ == "__main__":
    given = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    record("many", rows(given), ("what", "value", "unit", "at most"))
