"""Random runs whose states are saved at a random sample: any system, formulation, integrator and correction.

    python tests/support/saved_runs.py FIRST LAST

compares the rest of each run with that of its restored copy, in this process and another.
"""

import hashlib
import pickle
import subprocess
import sys
import warnings

import numpy as np

import zerodrift as zd
from every_model import IN_SPACE, MECHANISMS, MODELS
from random_symbolic import random_system
from zerodrift import _gateway
from zerodrift.runs.arguments import settings
from zerodrift.systems.base import closed_form_core_of

MANY = 60               # velocities: of more, runs take long
LEFT_OUT = "skipped"    # systems that cannot be made in a kind of coordinates, and methods that do not suit them


def random_made(rng):
    """A system of any kind."""
    kind = rng.integers(5)
    if kind == 0:
        return getattr(zd.systems, str(rng.choice(zd.systems.__all__)))()
    if kind == 1:
        return MODELS[str(rng.choice(sorted(MODELS)))]()
    if kind == 2:
        return random_system(int(rng.integers(12)))
    models = MECHANISMS if kind == 3 else IN_SPACE
    return models[str(rng.choice(sorted(models)))]().system(str(rng.choice(["joint", "absolute"])))


def random_options(rng, system):
    """Methods that may suit it."""
    integrator = str(rng.choice(list(zd.integrators(system))))
    chosen = {"formulation": str(rng.choice(list(zd.formulations()))), "integrator": integrator,
              "on_singular": str(rng.choice(["stop", "continue"])), "closed_form": None if rng.integers(3) else False,
              "stabilization": [None, "projection", "projection", "baumgarte"][rng.integers(4)]}
    chosen["energy"] = True if chosen["stabilization"] == "projection" and rng.integers(3) == 0 else None
    adaptive = rng.integers(2) and zd.integrators()[integrator].error_order
    chosen |= {"rtol": 1e-7, "atol": 1e-9} if adaptive else {"step": 0.004}
    if rng.integers(3) == 0:
        chosen["t_eval"] = np.linspace(0.01, 0.24, 40)
    return chosen


class Case:
    """Runs of a system with some methods."""

    def __init__(self, system, options, duration):
        self.system = system
        self.start = zd.assemble(system, system.p0, system.v0)
        self.plan = settings.plan(system, (0.0, duration), settings.Arguments(**options))
        self.core = closed_form_core_of(system, self.plan.settings["vector"], self.plan.core_settings)

    def run(self, saved=None):
        """A run from the start, or from a saved state."""
        p0, v0 = (None, None) if saved else self.start
        return _gateway.Run(self.core, self.plan.core_settings, p0, v0, saved=saved)

    def begun(self):
        """A run from the start whose state can be saved."""
        run = self.run()
        run.begin_saving(*self.start)
        return run

    def rest(self, run, rows=10**9):
        """Hash of the samples up to that many rows, or to the end, with the status."""
        found, status, left = hashlib.sha256(), _gateway.FULL, rows
        while status == _gateway.FULL and left:
            record = _gateway.Record(self.core, min(left, 7))
            status = run.advance(record, 1e3)
            taken = record.take()
            left -= len(taken["t"])
            for name in sorted(taken):
                found.update(np.ascontiguousarray(taken[name]).tobytes())
        message = run.message if status < 0 else ""
        return status, f"{found.hexdigest()[:16]} {status} {message} {run.results()!r}"


class RandomCase(Case):
    """One of the random runs, by its number."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        system = random_made(rng)
        if system.nv > MANY or system.p0 is None or system.v0 is None:
            raise ValueError(LEFT_OUT)
        self.seed, self.options = seed, random_options(rng, system)
        self.rows = int(rng.integers(1, 40))
        super().__init__(system, self.options, 0.25)

    def saved(self):
        """A run with its state, saved after some samples; None: the run ended before."""
        run = self.begun()
        status, _ = self.rest(run, self.rows)
        return (run, run.save(f"case {self.seed}")) if status == _gateway.FULL else None


def of(system, options, duration):
    """Runs of a system with these options of `simulate`."""
    return Case(system, options, duration)


def units():
    """Vector units of this processor."""
    return settings.VECTOR_UNITS[:_gateway.PROCESSOR_UNIT + 1]


def case_of(seed):
    """None where the methods do not suit the system."""
    try:
        return RandomCase(seed)
    except (zd.ZerodriftError, ValueError, TypeError):
        return None


def restored_elsewhere(states):
    """Results of the rests of runs, by their numbers, from saved states in another process."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        program = f"import sys; sys.path[:0] = {sys.path!r}; import saved_runs; saved_runs.answer()"
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", program], input=pickle.dumps(states), capture_output=True,
                              check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.decode()[-2000:])
    return pickle.loads(done.stdout)


def answer():
    """Rests of the runs that another process requests, by its standard input and output."""
    states = pickle.load(sys.stdin.buffer)
    found = {}
    for seed, saved in states.items():
        case = RandomCase(seed)
        found[seed] = case.rest(case.run(saved))[1]
    sys.stdout.buffer.write(pickle.dumps(found))


def compare(first, last):
    """Numbers of the cases compared, and of those that differ here and in another process."""
    expected, states, here = {}, {}, []
    for seed in range(first, last):
        case = case_of(seed)
        try:
            found = case and case.saved()
        except zd.ZerodriftError:
            continue        # its start is refused
        if not found:
            continue
        run, states[seed] = found
        copy = case.run(states[seed])
        if copy.save(states[seed].fingerprint) != states[seed]:
            here.append((seed, "the copy's state"))
        expected[seed] = case.rest(run)[1]
        if case.rest(copy)[1] != expected[seed]:
            here.append((seed, case.system.name, case.options))
    elsewhere = restored_elsewhere(states)
    return expected, here, [seed for seed in expected if elsewhere[seed] != expected[seed]]


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for begin in range(int(sys.argv[1]), int(sys.argv[2]), 50):
        compared, here, elsewhere = compare(begin, min(begin + 50, int(sys.argv[2])))
        print(f"from {begin}: {len(compared)} states; different here: {here}; in another process: {elsewhere}", flush=True)
