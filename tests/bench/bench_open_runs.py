"""Steps a second of 1024 open runs that receive new inputs in each call, and the longest step of a program in C.

Run it with ``python tests/bench/bench_open_runs.py``; it writes ``results/open_runs.csv``. Cart-poles in closed form, RK4 at
0.02 s, with AVX2: the minimum of thirty rounds of sixty calls. The program in C is that of `zerodrift.c_source`, whose steps are
timed one by one. All is processor time, which other processes disturb little.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import zerodrift as zd
from few_bodies import cart_pole
from measuring import least, record, timed

RUNS, CALLS, ROUNDS, STEPS = 1024, 60, 30, 1_000_000
FORCES = np.random.default_rng(1).uniform(-1, 1, (CALLS, RUNS))
TIMED = """
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "block/block.h"
#include "data.h"

static double taken[STEPS];

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int order(const void *first, const void *second)
{
    const double a = *(const double *)first, b = *(const double *)second;
    return (a > b) - (a < b);
}

int main(void)
{
    char message[500];
    zd_settings settings;
    zd_block *block = zd_block_create(block_words, sizeof block_words, message, sizeof message);
    if (!block || zd_block_settings(block, &settings, message, sizeof message)) return 1;
    settings.is_open = 1, settings.t1 = settings.t0 + 1;
    const double *start = zd_block_start(block);
    int status;
    zd_run *run = zd_run_create(zd_block_system(block), &settings, start, start + NQ, &status, message, sizeof message);
    for (int i = 0; run && i < STEPS; i++) {
        const double begin = seconds();
        if (zd_run_step(run, 1, NULL)) return 1;
        taken[i] = seconds() - begin;
    }
    qsort(taken, STEPS, sizeof *taken, order);
    printf("%g %g %g", taken[STEPS / 2], taken[STEPS - STEPS / 10000], taken[STEPS - 1]);
    return !run;
}
"""


def processor_seconds(call):
    """Processor time of a call in all threads, s."""
    start = time.process_time()
    call()
    return time.process_time() - start


def rates():
    """Rows of the cart-poles."""
    starts = np.random.default_rng(2).uniform(-0.1, 0.1, (RUNS, 2))
    runs = zd.ManyRuns(cart_pole().system(compiled=True), starts, runs=RUNS, step=0.02, inputs=["drive.force"], vector="avx2")
    for steps in (1, 10):
        def calls(steps=steps):
            for forces in FORCES:
                runs["drive.force"] = forces
                runs.step(steps)

        taken = min(processor_seconds(calls) for _ in range(ROUNDS))
        assert not runs.failed.any()
        rate = 1e-6 * RUNS * CALLS * steps / taken
        yield f"1024 cart-poles, {steps} steps a call: steps a second of one processor", rate, "1e6/s", None


def readings():
    """Rows (what, value, unit, limit) of two measures of all runs, in steps."""
    for compiled in (None, True):
        runs = zd.ManyRuns(zd.models.four_bar().system(compiled=compiled), runs=64, step=1e-3)
        step, read = least(10 * ROUNDS, *map(timed, (lambda runs=runs: runs.step(10), lambda runs=runs: [
            runs[f"coupler.end.{each}"] for each in ("position", "velocity")])))
        yield f"position and velocity of 64 four-bars, compiled={compiled}", 10 * read / step, "steps", 2.0


def program():
    """Rows of the program in C."""
    with tempfile.TemporaryDirectory() as name:
        folder = zd.c_source(zd.models.four_bar(), Path(name) / "bar", step=1e-3)
        (folder / "main.c").write_text(TIMED.replace("STEPS", str(STEPS)))
        sources = sorted(folder.rglob("*.c"))
        options = ["-O2", "-std=gnu11", "-ffp-contract=off", "-I", folder, "-o", folder / "main"]
        subprocess.run(["cc", *options, *sources, "-lm"], check=True)
        printed = subprocess.run([folder / "main"], check=True, capture_output=True, text=True).stdout
    for what, value in zip(("median", "99.99 %", "longest"), map(float, printed.split()), strict=True):
        yield f"four-bar in C, {STEPS} steps: {what} of a step", 1e6 * value, "us", None


if __name__ == "__main__":
    record("open_runs", [*rates(), *readings(), *program()], ("what", "value", "unit", "at most"))
