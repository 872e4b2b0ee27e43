"""Random runs whose states are saved at random steps: any system, input, method, correction, event and times of samples.

    python tests/support/saved_runs.py FIRST LAST [PYTHON_FOLDER]

compares the rest of each run with that of its restored copy, in this process and another, whose package is in that folder. With
that of another build, runs in closed form may differ by 1e-13, unless ZERODRIFT_VECTOR is baseline.
"""

import hashlib
import itertools
import pickle
import subprocess
import sys
import warnings

import numpy as np

import zerodrift as zd
from contact.random_scenes import mechanism_of, scene_of
from every_model import IN_SPACE, MECHANISMS, MODELS
from few_bodies import cart_pole, driven_four_bar, two_links
from random_symbolic import random_system
from zerodrift._private import gateway
from zerodrift.runs.arguments import settings
from zerodrift.runs.open.beginning import prepared

MANY = 60               # velocities: of more, runs take long
DURATION = 0.25         # s
PARTS = 24              # advances of an open run; before each, its input may change
LAST = PARTS - 4        # after this one at the latest, its state is saved
DRIVEN = {
    "drive.torque": lambda rng: driven_four_bar(torque=0.0) if rng.integers(2) else two_links(),
    "drive.speed": lambda rng: driven_four_bar(speed=0.0) if rng.integers(2) else two_links(speed=0.0),
    "drive.force": lambda rng: cart_pole(),
}
REFUSED = (zd.ZerodriftError, ValueError, TypeError)     # systems and methods that do not suit each other
FIXED = ("euler", "rk4", "dop853", "extrapolation", "radau", "rattle", "taylor")
ADAPTIVE = ("dormand_prince", "dop853", "radau", "taylor")


def random_made(rng):
    """A system of any kind, and the name of its input."""
    kind, drive = rng.integers(8), None
    if kind == 0:
        made = getattr(zd.systems, str(rng.choice(zd.systems.__all__)))()
    elif kind == 1:
        made = MODELS[str(rng.choice(sorted(MODELS)))]()
    elif kind == 2:
        made = random_system(int(rng.integers(12)))
    elif kind == 3:     # through bifurcations
        made = zd.systems.four_bar(lengths=(1, 0.3, 1, 0.3), gravity=0, crank_rate=rng.uniform(10, 30))
    elif kind < 6:
        drive = str(rng.choice(sorted(DRIVEN)))
        made = DRIVEN[drive](rng).system(str(rng.choice(["joint", "absolute"])))
    else:
        models = MECHANISMS if kind == 6 else IN_SPACE
        made = models[str(rng.choice(sorted(models)))]().system(str(rng.choice(["joint", "absolute"])))
    return made, drive


def random_events(rng, system):
    """Coordinates and velocities that reach values near their first ones."""
    names = (*system.coordinates, *system.velocities)
    values = np.append(system.p0, system.v0) + rng.normal(0, 0.1, len(names))
    return [zd.Event(names[i], value=values[i], direction=int(rng.integers(-1, 2)), terminal=bool(rng.integers(3) == 0))
            for i in rng.integers(len(names), size=rng.integers(1, 4))]


def random_options(rng, system):
    """Methods that may suit it."""
    integrator = str(rng.choice(list(zd.integrators(system))))
    chosen = {"formulation": str(rng.choice(list(zd.formulations()))), "integrator": integrator,
              "on_singular": str(rng.choice(["stop", "continue"])), "closed_form": None if rng.integers(3) else False,
              "stabilization": [None, "projection", "projection", "baumgarte"][rng.integers(4)]}
    chosen["energy"] = True if chosen["stabilization"] == "projection" and rng.integers(3) == 0 else None
    adaptive = rng.integers(2) and zd.integrators()[integrator].error_order
    return chosen | ({"rtol": 1e-7, "atol": 1e-9} if adaptive else {"step": 0.004})


def start_of(system):
    """A consistent start; a system with contacts has one, which is not assembled."""
    return (system.p0, system.v0) if system._groups else zd.assemble(system, system.p0, system.v0)


class Case:
    """Runs of a system to an end."""

    def __init__(self, system, options, duration=DURATION, events=None):
        self.system, self.start = system, start_of(system)
        self.ready = prepared(system, (0.0, duration), *self.start, events, None, None, settings.Arguments(**options))
        self.core = self.ready.core

    def run(self, saved=None):
        """A run from the start, or from a saved state."""
        return self.ready.with_own().created(saved=saved)

    def begun(self):
        """A run from the start whose state can be saved."""
        run = self.run()
        run.begin_saving(*self.start)
        return run

    def saved(self, moment):
        """A run and its state, saved after some samples; None: the run ended before."""
        run = self.begun()
        return (run, self.state(run)) if self.rest(run, moment)[0] == gateway.FULL else None

    def state(self, run):
        """The state of a run."""
        return run.save("a case")

    def rest(self, run, rows=10**9):
        """Status, hash of the samples and events up to that many rows, or to the end, and the last state."""
        found, status, left, before = hashlib.sha256(), gateway.FULL, rows, [len(t) for t, *_ in events_of(run)]
        while status == gateway.FULL and left:
            record = gateway.Record(self.core, min(left, 7))
            status = run.advance(record, 1e3)
            taken = record.take()
            left -= len(taken["t"])
            for name in sorted(taken):
                found.update(np.ascontiguousarray(taken[name]).tobytes())
        for count, arrays in zip(before, events_of(run), strict=True):
            for array in arrays:
                found.update(array[count:].tobytes())
        message = run.message if status < 0 else ""
        return status, f"{found.hexdigest()[:16]} {status} {message} {run.results()!r}", np.concatenate(run.place()[1:])

    def compared(self, run, _moment):
        """The hash of the rest of a run, its last state, and how many steps were in closed form."""
        return *self.rest(run)[1:], run.results().statistics.closed_form_steps


def events_of(run):
    """Times and states of the events that were found."""
    watcher = run._watcher
    return [watcher.arrays(event) for event in range(len(watcher.events))] if watcher else []


class OpenCase:
    """Open runs of a system in random advances with random inputs, which go on after failures and events."""

    def __init__(self, system, options, drive, seed, pace=1):
        self.system, self.seed, self.drive, self.options, self.pace = system, seed, drive, options, pace
        self.start = start_of(system)
        self.begun()

    def begun(self):
        """A run from the start."""
        return zd.Run(self.system, *self.start, **self.options)

    def run(self, saved):
        """A run from a saved state."""
        run = self.begun()
        run.restore(saved)
        return run

    def saved(self, moment):
        """A run and its state, saved after some advances."""
        run = self.begun()
        self.advance(run, 0, moment)
        return run, self.state(run)

    def state(self, run):
        """The state of a run."""
        return run.save()

    def advance(self, run, begin, end):
        """Hash of the states after these advances, and their errors."""
        found = hashlib.sha256()
        for part in range(begin, end):
            rng = np.random.default_rng([self.seed, part])
            if self.drive and rng.integers(2):
                run[self.drive] = rng.normal(0, 3)
            try:
                if rng.integers(4):
                    run.step(self.pace * int(rng.integers(1, 9)))
                else:
                    run.advance_to(run.t + rng.uniform(0, 0.02))
            except zd.ZerodriftError as error:
                found.update(str(error).encode())
            for numbers in (run.t, run.p, run.v, run.vdot, run.multipliers):
                found.update(np.asarray(numbers).tobytes())
        return found

    def compared(self, run, moment):
        """The hash of the rest of a run, its last state, and how many steps were in closed form."""
        found = self.advance(run, moment, PARTS).hexdigest()
        return found, np.concatenate([run.p, run.v]), run._core.results().statistics.closed_form_steps


def of(system, options, duration):
    """Runs of a system with these options of `simulate`."""
    return Case(system, options, duration)


def units():
    """Vector units of this processor."""
    return settings.VECTOR_UNITS[:gateway.PROCESSOR_UNIT + 1]


def driven():
    """Both drives with every formulation and integrators of fixed and adaptive steps; a speed needs fixed ones."""
    steps = [(each, {"step": 1e-3}) for each in FIXED] + [(each, {"rtol": 1e-8}) for each in ADAPTIVE]
    return [(f"drive.{drive}", {"formulation": formulation, "integrator": integrator, **step})
            for drive, formulation, (integrator, step) in itertools.product(("torque", "speed"), zd.formulations(), steps)
            if drive == "torque" or "step" in step]


def driven_case(number, pace):
    """One of these with a four-bar, and the moment at which its state is saved."""
    drive, options = driven()[number]
    return OpenCase(driven_four_bar(**{drive[6:]: 0.0}).system(), {**options, "inputs": [drive]}, drive, number, pace), PARTS // 4


def contact_case(seed, step, formulation):
    """A scene with contacts, whose record or open run is saved after some of its changes of phase."""
    rng, m = np.random.default_rng(seed), mechanism_of(scene_of(seed)[1])
    system = m.system("joint" if rng.integers(2) else "absolute")
    options = {"formulation": list(zd.formulations())[formulation], **({"step": 1e-3} if step else {"rtol": 1e-8, "atol": 1e-10})}
    events = random_events(rng, system) if rng.integers(2) else None
    if rng.integers(2):
        return OpenCase(system, options, None, seed, 60), int(rng.integers(LAST))
    if step:
        options["t_eval"] = np.linspace(0.01, 1.0, 80)
    return Case(system, options, 1.0, events), int(rng.integers(20, 60))


def case_of(key):
    """A random case, or one by arguments of `driven_case` or `contact_case`, and the moment at which its state is saved.

    None: none suits.
    """
    rng = np.random.default_rng(key)
    try:
        if isinstance(key, tuple):
            return driven_case(*key) if len(key) == 2 else contact_case(*key)
        system, drive = random_made(rng)
        if system.nv > MANY or system.p0 is None or system.v0 is None:
            return None
        options, events = random_options(rng, system), random_events(rng, system) if rng.integers(3) == 0 else None
        if drive or rng.integers(3) == 0:
            followed = {} if "step" in options else {"ramp": 0.01}
            speeds = {} if drive != "drive.speed" else {"hold": True} if rng.integers(2) else followed
            given = {**options, **speeds, "events": events} | ({"inputs": [drive]} if drive else {})
            return OpenCase(system, given, drive, key), int(rng.integers(LAST))
        if rng.integers(3) == 0:
            options["t_eval"] = np.linspace(0.01, 0.24, 40)
        return Case(system, options, DURATION, events), int(rng.integers(1, 40))
    except REFUSED:
        return None


def restored_elsewhere(states, folder=""):
    """Rests of runs as `compared` has them, by their keys, from saved states in another process."""
    path = [folder, *sys.path] if folder else sys.path
    program = f"import sys; sys.path[:0] = {path!r}; import saved_runs; saved_runs.answer()"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", program], input=pickle.dumps(states), capture_output=True,
                          check=False)
    if done.returncode:
        raise RuntimeError(f"{done.returncode}: {done.stderr.decode()[-2000:]}")
    return pickle.loads(done.stdout)


def answer():
    """Rests of the runs that another process requests, by its standard input and output."""
    found = {}
    for key, saved in pickle.load(sys.stdin.buffer).items():
        case, moment = case_of(key)
        found[key] = case.compared(case.run(saved), moment)
    sys.stdout.buffer.write(pickle.dumps(found))


def agree(one, other, folder):
    """True if two rests of a run agree: to the bit, except those in closed form by two builds."""
    return one[0] == other[0] or bool(folder and one[2] and np.allclose(one[1], other[1], rtol=1e-13, atol=1e-13))


def compare(keys, folder=""):
    """Cases compared by their keys, and keys of those that differ here and in another process."""
    cases, expected, states, here = {}, {}, {}, []
    for key in keys:
        case, moment = case_of(key) or (None, 0)
        try:
            found = case and case.saved(moment)
        except zd.ZerodriftError:
            continue        # its start is refused
        if not found:
            continue
        run, states[key] = found
        copy = case.run(states[key])
        if case.state(copy) != states[key]:
            here.append((key, "the copy's state"))
        cases[key], expected[key] = case, case.compared(run, moment)
        if not agree(expected[key], case.compared(copy, moment), ""):
            here.append(key)
    elsewhere = restored_elsewhere(states, folder)
    return cases, here, [key for key in expected if not agree(expected[key], elsewhere[key], folder)]


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for begin in range(int(sys.argv[1]), int(sys.argv[2]), 50):
        compared, here, elsewhere = compare(range(begin, min(begin + 50, int(sys.argv[2]))), *sys.argv[3:])
        print(f"from {begin}: {len(compared)} states; different here: {here}; in another process: {elsewhere}", flush=True)
