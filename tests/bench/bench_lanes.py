"""Cost of runs in SIMD lanes, compared with a hand-written step in the same lanes and with heyoka.py's batches of eight, and the
overhead of a run beyond its steps.

Run it with ``python tests/bench/bench_lanes.py``; it needs a C compiler, and heyoka.py for the comparison with that. It writes
``results/lanes.csv``. All but the row of threads is processor time of one thread, least of interleaved rounds, of ensembles of
the paper's four-bar over 8 s whose speeds differ.

The overhead of a run is the mean over runs of 1, 2, 4 and 8 steps of their time less that of so many steps. The time of a step is
that of runs of 72: such a call ends within some milliseconds, so that the minimum of several is undisturbed, whereas during 800
steps the machine may be slow in every round, and too much would be subtracted. A line through the four, extrapolated to zero
steps, would be as steady, but its slope would include the rank checks of the first steps, which are more frequent than later ones
and belong to the overhead.
"""

import ctypes
import functools
import itertools
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from unittest import mock

import numpy as np

import zerodrift as zd
from measuring import least, record
from zerodrift.ensembles import batch
from zerodrift.ensembles.batch import batch_of, batch_range
from zerodrift.ensembles.plan import checked
from zerodrift.ensembles.run_range import run_range
from zerodrift.ensembles.runs import Runs
from zerodrift.runs.open.threads import Threads

sys.path.insert(0, str(Path(__file__).resolve().parent / "peers"))
FLAGS = {"avx2": ["-mavx2", "-mfma", "-DLANES=4"], "avx512": ["-mavx512f", "-mavx512dq", "-mavx512vl", "-mfma", "-DLANES=8",
                                                              "-mprefer-vector-width=512"]}
LANES = {"avx2": 4, "avx512": 8}
RUNS, STEPS, STEP, END = 1024, 800, 0.01, 8.0
RTOLS = {1e-6: 10.0 ** -np.arange(7, 8.6, 0.25), 1e-9: 10.0 ** -np.arange(10, 12.6, 0.25)}
ROUNDS = 20
FEW_STEPS, MORE_STEPS, IN_A_ROW = (1, 2, 4, 8), 72, 5     # steps of short and longer runs; calls of a round
BAR = zd.systems.four_bar()
SPEEDS = np.linspace(0.9, 1.1, RUNS)


def cpu(call):
    """A callable that gives the processor's seconds of another."""
    def seconds():
        start = time.process_time()
        call()
        return time.process_time() - start
    return seconds


def least_in_a_row(call):
    """The least of some calls, of one that takes so little that what was before it counts."""
    return lambda: min(call() for _ in range(IN_A_ROW))


def runs(end=END, count=RUNS, outputs=("alpha1", "alpha2", "alpha3"), **options):
    """A callable that makes all of them in this thread, and gives what came of them."""
    made = Runs(BAR, None, None, SPEEDS[:count, None] * BAR.v0, None, (), assembles=True)
    plan = checked(made, end, list(outputs), None, keeps=False, t_eval=[end], **options)
    return functools.partial(batch_range, plan, batch_of(plan), 0, count, None)


def without_lanes(call):
    """A callable whose runs are made by the core one by one."""
    by_itself = functools.partial(batch.gateway.run_batch, lanes=False)

    def made():
        with mock.patch.object(batch.gateway, "run_batch", by_itself):
            return call()
    return made


def floor(folder, unit, *flags):
    """The yardstick's steps, for as many runs."""
    library, n = Path(folder) / f"{unit}{''.join(flags)}.so", LANES[unit]
    source = Path(__file__).with_name("four_bar_lanes_floor.c")
    subprocess.run(["cc", "-O3", "-std=gnu11", *FLAGS[unit], *flags, "-fno-math-errno", "-shared", "-fPIC", "-o", library,
                    source], check=True)
    call, pointer = ctypes.CDLL(str(library)).floor_in_lanes, np.ctypeslib.ndpointer(float, flags="C")
    call.argtypes, call.restype = [ctypes.c_int, ctypes.c_int, ctypes.c_double, pointer, pointer], None
    speeds = SPEEDS.reshape(-1, 1, n)

    def steps():
        p, v = (np.ascontiguousarray(each) for each in (np.broadcast_to(BAR.p0[:, None], (RUNS // n, 3, n)),
                                                        speeds * BAR.v0[:, None]))
        call(RUNS // n, STEPS, STEP, p, v)
        return p[:, 0, :].ravel()
    return steps


def beyond_steps(seconds):
    """Overhead of a run beyond its steps, s, from the times of all runs by number of steps, as described above."""
    step = (seconds[MORE_STEPS] - seconds[FEW_STEPS[-1]]) / (MORE_STEPS - FEW_STEPS[-1])
    return np.mean([seconds[n] - n * step for n in FEW_STEPS]) / RUNS


def steps_of_fixed_size():
    """Rows: a step in lanes, by hand and here, and what a run takes besides."""
    with tempfile.TemporaryDirectory() as folder:
        units = [unit for unit in FLAGS if unit in ("avx2", zd.simulate(BAR, STEP, step=STEP).settings["vector"])]
        calls = {}
        for unit in units:
            calls[unit, "by hand"] = floor(folder, unit)
            calls[unit, "factored by hand"] = floor(folder, unit, "-DSCHUR")
            calls[unit, "here"] = runs(step=STEP, vector=unit)
            for n in (*FEW_STEPS, MORE_STEPS):
                calls[unit, "here", n] = runs(n * STEP, step=STEP, vector=unit)
                calls[unit, "alone", n] = without_lanes(calls[unit, "here", n])
            for hand in ("by hand", "factored by hand"):
                apart = np.abs(calls[unit, "here"]()[0].arrays["alpha1"] - calls[unit, hand]()).max()
                assert apart < 1e-7, apart
        measures = [least_in_a_row(cpu(call)) if len(what) == 3 else cpu(call) for what, call in calls.items()]
        times = dict(zip(calls, least(ROUNDS, *measures), strict=True))
    for unit in units:
        hand, factored, step = (times[unit, what] / RUNS for what in ("by hand", "factored by hand", "here"))
        step = (step - times[unit, "here", FEW_STEPS[-1]] / RUNS) / (STEPS - FEW_STEPS[-1])
        lanes, alone = (beyond_steps({n: times[unit, what, n] for n in (*FEW_STEPS, MORE_STEPS)}) for what in ("here", "alone"))
        yield f"{unit}: a corrected step of rk4 by hand in {LANES[unit]} lanes", 1e9 * hand / STEPS, "ns", None
        yield f"{unit}: the same where M and S are factored", 1e9 * factored / STEPS, "ns", None
        yield f"{unit}: the same here", 1e9 * step, "ns", None
        yield f"{unit}: its rate to that where M and S are factored (at least 0.6)", factored / STEPS / step, "", None
        yield f"{unit}: its rate to that by hand", hand / STEPS / step, "", None
        yield f"{unit}: a run beyond its steps, in lanes", 1e6 * lanes, "us", 1
        yield f"{unit}: a run beyond its steps, by itself", 1e6 * alone, "us", 5


def error_of(values, exact):
    return np.abs(np.asarray(values) - exact).max()


def fastest(options, solve, exact, target):
    """The fastest of the settings whose error is within the target."""
    kept = [option for option in options if error_of(solve(option), exact) <= target]
    times = least(3, *(cpu(functools.partial(solve, option)) for option in kept))
    return kept[int(np.argmin(times))]


def solved(option):
    integrator, rtol = option
    part, _ = runs(integrator=integrator, rtol=rtol, atol=rtol)()
    return np.stack([part.arrays[f"alpha{i}"] for i in (1, 2, 3)])


def heyoka_batches():
    """A function of the tolerance: angles at the end (3, RUNS)."""
    import heyoka as hy
    import problems
    import with_heyoka

    system, start = with_heyoka._reduced(problems.four_bar())
    start = np.array(start)

    @functools.cache
    def integrator(tolerance):
        return hy.taylor_adaptive_batch(system, np.zeros((len(start), 8)), tol=tolerance)

    def solve(tolerance):
        ta, found = integrator(tolerance), np.empty((3, RUNS))
        for first in range(0, RUNS, 8):
            ta.set_time(0.0)
            ta.state[:3] = start[:3, None]
            ta.state[3:] = start[3:, None] * SPEEDS[first:first + 8]
            ta.propagate_until([END] * 8)
            found[:, first:first + 8] = ta.state[:3]
        return found
    return solve


def chosen_steps():
    """Rows: runs per second to a largest error of all angles, here and by heyoka.py's batches."""
    exact = solved(("dop853", 1e-13))
    solve = heyoka_batches()
    for target, rtols in RTOLS.items():
        ours = fastest([*itertools.product(("dop853",), rtols)], solved, exact, target)
        theirs = fastest(10.0 ** -np.arange(4, 14, 0.5), solve, exact, target)
        here, there = least(ROUNDS, cpu(functools.partial(solved, ours)), cpu(functools.partial(solve, theirs)))
        yield f"to {target:g}: runs a second, here ({ours[0]}, rtol = {ours[1]:.1e})", RUNS / here, "1/s", None
        yield f"to {target:g}: heyoka.py in batches of 8 (tol = {theirs:.1e})", RUNS / there, "1/s", None
        yield f"to {target:g}: ours to theirs (at least 1)", there / here, "", None


def both_threads():
    """Row: how much faster two threads make them than one; of wall time, so that other work shows."""
    def by(threads):
        plan = checked(Runs(BAR, None, None, np.tile(SPEEDS, 4)[:, None] * BAR.v0, None, (), assembles=True), END,
                       ["alpha1"], None, keeps=False, t_eval=[END], step=STEP)
        ranges = ((first, first + 64) for first in range(0, 4 * RUNS, 64))
        start = time.perf_counter()
        Threads(lambda taken, stop: run_range(plan, *taken, stop), ranges).run(threads, lambda: None)
        return time.perf_counter() - start
    one, two = least(ROUNDS, functools.partial(by, 1), functools.partial(by, 2))
    yield "two threads to one (at least 1.8, on two free cores)", one / two, "", None


if __name__ == "__main__":
    rows = [*steps_of_fixed_size(), *both_threads()]
    try:
        rows += chosen_steps()
    except ImportError as error:
        print(f"without heyoka.py: {error}")
    record("lanes", rows, ("what", "value", "unit", "at most"))
