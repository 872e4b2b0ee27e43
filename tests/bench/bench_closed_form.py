"""Cost of steps on the closed-form path, compared in one run with a four-bar eliminated by hand and with heyoka.py's best.

Run it with ``python tests/bench/bench_closed_form.py``; it needs a C compiler and SymPy, and heyoka.py for the comparison.
It writes ``results/closed_form.csv``. Problems and settings are those of ``peers``; zerodrift's are those with DOP853.
"""

import ctypes
import functools
import importlib
import math
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np

import zerodrift as zd
from bench_four_bar import FLOORS, compiled_floor
from measuring import least, record

sys.path.insert(0, str(Path(__file__).resolve().parent / "peers"))
STEP, TOLERANCE = 0.01, 1e-12
SHORT_RUN, LONG_RUN = 800, 8000  # steps; the difference leaves out what a call costs
ERRORS = (1e-3, 1e-6, 1e-9)
LIMITS = {"four-bar": (0.9, 0.7, 0.7)}
OTHERS = (0.8, 0.8, 0.8)
ROUNDS = 15


def floors(folder, bar):
    """A step of each yardstick, in seconds, as functions."""
    p, v = bar.p0.copy(), bar.v0.copy()
    pointer = np.ctypeslib.ndpointer(float, flags="C")
    for name in FLOORS:
        run = getattr(ctypes.CDLL(compiled_floor(Path(folder), name, "-shared", "-fPIC")), f"floor_{name}")
        run.argtypes, run.restype = [pointer, pointer, ctypes.c_double, ctypes.c_int, ctypes.c_double], ctypes.c_double
        yield name, lambda count, run=run: run(p, v, STEP, count, TOLERANCE)


def steps(problems, ours):
    """Rows: a step of rk4 with projection, and what that is of the yardstick's that has the same instructions."""
    chain = problems.four_bar()
    best = zd.simulate(zd.systems.four_bar(), STEP, step=STEP).settings["vector"]
    yardsticks = {"baseline": "with_polynomials", best: "of_this_machine"}
    ours_by = {}
    with tempfile.TemporaryDirectory() as folder:
        calls = dict(floors(folder, zd.systems.four_bar()))
        for kind in ours.kinds(chain):
            for name, settings in [*((unit, {"vector": unit}) for unit in yardsticks), ("matrix path", {"closed_form": False})]:
                ours_by[f"{kind}, {name}"] = yardsticks.get(name)
                calls[f"{kind}, {name}"] = functools.partial(simulated, ours.system_of(chain, kind), settings)
        times = least(30, *(functools.partial(processor_time, call, count)
                            for call in calls.values() for count in (SHORT_RUN, LONG_RUN)))
    ns = {name: 1e9 * (times[2 * i + 1] - times[2 * i]) / (LONG_RUN - SHORT_RUN) for i, name in enumerate(calls)}
    for name, value in ns.items():
        yield f"a corrected step of rk4, {name.replace('_', ' ')}", value, "ns", None
        if ours_by.get(name):
            yield f"to the yardstick {ours_by[name].replace('_', ' ')}, {name}", value / ns[ours_by[name]], "", 1.5


def processor_time(call, count):
    """Seconds: what else the machine does is not held against a call."""
    start = time.process_time()
    call(count)
    return time.process_time() - start


def simulated(system, settings, count):
    """So many steps of which the last is saved."""
    projection = zd.Projection(tol=TOLERANCE)
    return zd.simulate(system, count * STEP, step=STEP, save_every=count, stabilization=projection, **settings)


def accurate(chain, module, sweeps, exact):
    """The error by method and setting, of those that reach one at all."""
    errors = {}
    for method, settings in sweeps.items():
        for setting in settings:
            try:
                errors[method, setting] = np.abs(module.solve(chain, setting)[0] - exact).max()
            except Exception as problem:    # whatever a method raises that does not get through
                print(f"{chain.name}, {method}, {setting}: {problem}")
    return {case: error for case, error in errors.items() if error <= max(ERRORS)}


def beside_heyoka(chain, ours, heyoka):
    """Rows of one problem: the best of each kind of system that we have, to heyoka's best, at each error."""
    exact, _ = ours.reference(chain, min(ERRORS))
    contestants = {("heyoka", heyoka): heyoka.sweeps(chain)} if heyoka else {}
    for kind in ours.kinds(chain):
        if "Python" not in kind:
            contestants[kind, ours] = {method: settings for method, settings in ours.sweeps(chain).items()
                                       if f"{kind}: schur, dop853" in method}
    cases = [(name, module, *case, error) for (name, module), sweeps in contestants.items()
             for case, error in accurate(chain, module, sweeps, exact).items()]
    times = least(ROUNDS, *(lambda module=module, setting=setting: module.solve(chain, setting)[1]
                            for _, module, _, setting, _ in cases))
    for limit, error in zip(LIMITS.get(chain.name, OTHERS), ERRORS, strict=True):
        best = {name: min(((seconds, case[2]) for seconds, case in zip(times, cases, strict=True)
                           if case[0] == name and case[4] <= error), default=(math.nan, "no run")) for name, _ in contestants}
        for name, (seconds, method) in best.items():
            what = f"{chain.name}, error of {error:g}: {name}, {method.split(': schur, ')[-1].removeprefix('heyoka, ')}"
            yield what, 1e6 * seconds, "us", 1000 if chain.name == "Andrews" and error == min(ERRORS) else None
            if heyoka and name != "heyoka":
                yield f"{what}, to heyoka's best", seconds / best["heyoka"][0], "", limit


def measured():
    """Rows (what, value, unit, limit)."""
    problems, ours = importlib.import_module("problems"), importlib.import_module("with_zerodrift")
    warnings.simplefilter("ignore", zd.AccuracyWarning)     # of the coarsest: their errors are measured here
    yield from steps(problems, ours)
    # heyoka.py takes half a minute to compile this one, for each tolerance.
    yield from beside_heyoka(importlib.import_module("andrews").Squeezer(), ours, None)
    try:
        heyoka = importlib.import_module("with_heyoka")
    except ImportError as error:
        print(f"heyoka.py is absent: {error}")
        return
    for chain in (problems.four_bar(), problems.pendulum_chain(4), problems.pendulum_chain(6)):
        yield from beside_heyoka(chain, ours, heyoka)


if __name__ == "__main__":
    record("closed_form", measured(), ("what", "value", "unit", "at most"))
