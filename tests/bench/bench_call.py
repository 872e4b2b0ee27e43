"""Overhead of a call of `simulate` beyond its steps, on the paper's four-bar, and time of the import.

Run it with ``python tests/bench/bench_call.py``; it writes ``results/call.csv``. Calls with few and with many steps are timed in
turn, ten of each in a row; the slope is the time of a step and is subtracted. With adaptive steps the time of the core is
subtracted. Each time is the minimum of many short rounds, the least disturbed by other processes.
"""

import functools
import itertools
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

import zerodrift as zd
from measuring import least, record, timed

FEW, MANY, STEP = 10, 110, 0.01
ROUNDS, IN_A_ROW = 300, 10
RTOL = 1e-6     # with adaptive steps


def in_a_row(call):
    """So many calls."""
    return lambda: [call() for _ in range(IN_A_ROW)] and None


def microseconds(*calls):
    """The least of each call."""
    return [1e6 * seconds / IN_A_ROW for seconds in least(ROUNDS, *(timed(in_a_row(call)) for call in calls))]


def beyond_steps(call):
    """Microseconds of a call with a number of steps, beyond them."""
    few, many = microseconds(*(functools.partial(call, steps) for steps in (FEW, MANY)))
    return few - FEW * (many - few) / (MANY - FEW)


def calls(bar):
    """Calls with a number of steps, by what they are."""
    p0, v0, spans = bar.p0.copy(), bar.v0.copy(), itertools.count()

    def plain(steps, **options):
        return zd.simulate(bar, STEP * steps, step=STEP, **options)

    return {
        "steps of fixed size": plain,
        "the same with energy correction": functools.partial(plain, energy=True),
        "the same by dop853": functools.partial(plain, energy=True, integrator="dop853"),
        "with a start that is given": lambda steps: plain(steps, p0=p0, v0=v0),
        "with a t_span that no call had before": lambda steps: zd.simulate(bar, STEP * steps + 1e-9 * next(spans), step=STEP),
        "with p and stats looked at": lambda steps: (solution := plain(steps)).p.sum() + solution.stats["steps"],
        "with t_eval at the end of every tenth step": lambda steps: plain(steps, t_eval=STEP * np.arange(0, steps + 1, 10)),
    }


def adaptive_steps(bar, times):
    """Microseconds of a call with adaptive steps, beyond those of the core."""
    call = functools.partial(zd.simulate, bar, 8.0, rtol=RTOL, atol=RTOL, integrator="dop853", energy=True, t_eval=times)

    def beyond():
        start = time.perf_counter()
        solution = call()
        return time.perf_counter() - start - solution.stats["seconds"]

    return 1e6 * least(ROUNDS, beyond)[0]


def import_beyond_numpy(rounds=20):
    """Seconds of processor time of `import zerodrift` where NumPy is imported and all byte code there already."""
    code = ("import time, numpy, _cffi_backend; t = time.process_time(); import zerodrift; "
            "print(time.process_time() - t)")
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"PYTHONPYCACHEPREFIX": folder, "PYTHONDONTWRITEBYTECODE": ""}
        return min(float(subprocess.run([sys.executable, "-c", code], env=environment, check=True, capture_output=True).stdout)
                   for _ in range(rounds))


def measured():
    """Rows (what, value, unit, limit)."""
    bar = zd.systems.four_bar()
    for what, call in calls(bar).items():
        yield f"beyond its steps: {what}", beyond_steps(call), "us", 35 if what == "steps of fixed size" else None
    for rows in (2, 161):
        taken = adaptive_steps(bar, np.linspace(0, 8, rows))
        yield f"beyond its steps: dop853, adaptive, {rows} rows by t_eval", taken, "us", None
    event, plain = microseconds(lambda: zd.simulate(bar, STEP * FEW, step=STEP, events=lambda t, p, v: 1.0),
                                lambda: zd.simulate(bar, STEP * FEW, step=STEP))
    yield f"what an event in Python adds to {FEW} steps", event - plain, "us", None
    yield "import beyond NumPy, in a source tree", 1e3 * import_beyond_numpy(), "ms", 31


if __name__ == "__main__":
    record("call", measured(), ("what", "value", "unit", "at most"))
