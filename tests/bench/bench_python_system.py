"""What a system written in Python costs beyond its own callables: the split of a run's time, as ratios within one run.

Run it with ``python tests/bench/bench_python_system.py``; it writes ``results/python_system.csv``.
"""

import csv
import functools
import inspect
import sys
import time
from collections import Counter
from pathlib import Path

import zerodrift as zd

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from test_custom import DERIVED, GIVEN, bias, constraints, force, four_bar, jacobian, mass, potential, xi  # noqa: E402

CALLABLES = {"mass": mass, "bias": bias, "force": force, "constraints": constraints, "jacobian": jacobian, "xi": xi,
             "potential": potential}
STEPS, STEP, ROUNDS = 100, 0.01, 30


def counted(calls, name, function):
    """The function, counting its calls."""
    @functools.wraps(function)
    def wrapper(**arguments):
        calls[name] += 1
        return function(**arguments)
    return wrapper


def calls_of_a_run(**options):
    """How often a run calls each callable."""
    calls = Counter()
    system = four_bar(**{name: counted(calls, name, function) for name, function in CALLABLES.items()})
    calls.clear()
    zd.simulate(system, STEPS * STEP, step=STEP, **options)
    return calls


def bound(system):
    """The callables with their arguments, as cheap to call as Python can."""
    arguments = {"p": system.p0, "v": system.v0, **GIVEN}
    return {name: functools.partial(function, **{key: arguments[key] for key in inspect.signature(function).parameters})
            for name, function in CALLABLES.items()}


def split(**options):
    """Seconds of a run, and of calling its callables that often: best of interleaved rounds."""
    system, calls, best = four_bar(), calls_of_a_run(**options), [1e9, 1e9]
    own = bound(system)
    for _ in range(ROUNDS):
        start = time.perf_counter()
        zd.simulate(system, STEPS * STEP, step=STEP, **options)
        middle = time.perf_counter()
        for name, count in calls.items():
            function = own[name]
            for _ in range(count):
                function()
        best = [min(best[0], middle - start), min(best[1], time.perf_counter() - middle)]
    return *best, sum(calls.values()) / STEPS


def fastest(system):
    return min(zd.simulate(system, STEPS * STEP, step=STEP).stats["seconds"] for _ in range(ROUNDS))


def measured():
    """Rows (what, value, limit)."""
    for formulation in zd.formulations():
        run, own, calls = split(formulation=formulation)
        yield f"{formulation}: run to its own callables", run / own, 1.5
        yield f"{formulation}: calls of callables a step", calls, None
    given, derived, core = (fastest(system) for system in (four_bar(), four_bar(**DERIVED), zd.systems.four_bar()))
    yield "jacobian and xi derived, to given", derived / given, None
    yield "written in Python, to built in", given / core, None


def main():
    """Measure, print and write."""
    with (HERE / "results" / "python_system.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["what", "value", "at most"])
        for what, value, limit in measured():
            print(f"{what:46} {value:8.3g}" + (f" (at most {limit})" if limit else ""))
            table.writerow([what, f"{value:.3g}", limit or ""])


if __name__ == "__main__":
    main()
