"""Cost of a system written in Python beyond its own callables: the split of a run's time, as ratios within one run.

Run it with ``python tests/bench/bench_python_system.py``; it writes ``results/python_system.csv``.
"""

import functools
import inspect
import sys
from collections import Counter
from pathlib import Path

import zerodrift as zd
from measuring import least, record, timed

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from four_bar_in_python import DERIVED, GIVEN, bias, constraints, force, four_bar, jacobian, mass, potential, xi

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
    """Number of calls of each callable in a run."""
    calls = Counter()
    system = four_bar(**{name: counted(calls, name, function) for name, function in CALLABLES.items()})
    calls.clear()
    run(system, **options)
    return calls


def bound(system):
    """The callables with their arguments, as cheap to call as Python can."""
    arguments = {"p": system.p0, "v": system.v0, **GIVEN}
    return {name: functools.partial(function, **{key: arguments[key] for key in inspect.signature(function).parameters})
            for name, function in CALLABLES.items()}


def run(system, **options):
    return zd.simulate(system, STEPS * STEP, step=STEP, **options)


def split(**options):
    """Seconds of a run, and of calling its callables that often; and how often that is a step."""
    system, calls = four_bar(), calls_of_a_run(**options)
    own = bound(system)

    def call_as_often():
        for name, count in calls.items():
            function = own[name]
            for _ in range(count):
                function()

    best = least(ROUNDS, timed(lambda: run(system, **options)), timed(call_as_often))
    return *best, sum(calls.values()) / STEPS


def fastest(system):
    """Seconds of a run among runs of the same system: between slower ones, the core's short run would find its caches cold."""
    return least(ROUNDS, lambda: run(system).stats["seconds"])[0]


def measured():
    """Rows (what, value, limit)."""
    for formulation in zd.formulations():
        whole, own, calls = split(formulation=formulation)
        yield f"{formulation}: run to its own callables", whole / own, 1.5
        yield f"{formulation}: calls of callables a step", calls, None
    given, derived, core = (fastest(system) for system in (four_bar(), four_bar(**DERIVED), zd.systems.four_bar()))
    yield "jacobian and xi derived, to given", derived / given, None
    yield "written in Python, to built in", given / core, None


if __name__ == "__main__":
    record("python_system", measured())
