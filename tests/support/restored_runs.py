"""Open runs with inputs that are saved, and go on from their states.

    python tests/support/restored_runs.py STEPS

compares the rest of each run with that of its restored copy, in this process and another.
"""

import hashlib
import pickle
import subprocess
import sys
import warnings

import numpy as np

import zerodrift as zd
from few_bodies import driven_four_bar

FIXED = ("euler", "rk4", "dop853", "extrapolation", "radau", "rattle", "taylor")
ADAPTIVE = ("dormand_prince", "dop853", "radau", "taylor")
CORRECTIONS = ({"stabilization": None}, {"stabilization": "baumgarte"}, {"energy": True})
BEFORE, CHUNKS = 37, 10     # steps before a state is saved; inputs set after it


def methods():
    """Settings by their names: every formulation with integrators of fixed and adaptive steps, and corrections of one of them."""
    for formulation in zd.formulations():
        for integrator in FIXED:
            yield {"formulation": formulation, "integrator": integrator, "step": 1e-3}
        for integrator in ADAPTIVE:
            yield {"formulation": formulation, "integrator": integrator, "rtol": 1e-8}
    for correction in CORRECTIONS:
        for steps in ({"step": 1e-3}, {"rtol": 1e-8}):
            yield {**correction, **steps}


def cases():
    """Drive and settings of each run; a speed that is an input needs fixed steps."""
    return [(drive, each) for each in methods() for drive in ("torque", "speed") if drive == "torque" or "step" in each]


def begun(case):
    """A run at its start; None where the methods do not suit the mechanism."""
    drive, settings = case
    try:
        return zd.Run(driven_four_bar(**{drive: 0.0}), inputs=[f"drive.{drive}"], **settings)
    except (zd.UnsuitedFormulation, zd.UnsuitedIntegrator, zd.UnreachableTolerance):
        return None


def saved(run, drive):
    """State after some steps, the last of which is the first one with a new input."""
    run.step(BEFORE)
    run[f"drive.{drive}"] = 1.5
    run.step()
    return run.save()


def rest(run, drive, steps):
    """Hash of the states that follow, while inputs jump, and of all that is saved of the last; or the message of a failure."""
    found = hashlib.sha256()
    for k in range(CHUNKS):
        try:
            run.step(steps // CHUNKS)
        except zd.ZerodriftError as error:
            return f"{found.hexdigest()} {error}"
        for numbers in (run.t, run.p, run.v, run.vdot, run.multipliers):
            found.update(np.asarray(numbers).tobytes())
        run[f"drive.{drive}"] = 1.5 * (-1)**k + 0.1 * k
    found.update(run.save())
    return found.hexdigest()


def of_states(states, steps):
    """Rests of runs by their cases' numbers, from their states."""
    found = {}
    for number, state in states.items():
        run = begun(cases()[number])
        run.restore(state)
        found[number] = rest(run, cases()[number][0], steps)
    return found


def elsewhere(states, steps):
    """The same in another process."""
    program = f"import sys; sys.path[:0] = {sys.path!r}; import restored_runs; restored_runs.answer()"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", program], input=pickle.dumps((states, steps)),
                          capture_output=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.decode()[-2000:])
    return pickle.loads(done.stdout)


def answer():
    """Rests of the runs that another process requests, by its standard input and output."""
    sys.stdout.buffer.write(pickle.dumps(of_states(*pickle.load(sys.stdin.buffer))))


def compare(numbers, steps):
    """Cases compared, and those that differ here and in another process."""
    expected, states = {}, {}
    for number in numbers:
        run = begun(cases()[number])
        if run is not None:
            states[number] = saved(run, cases()[number][0])
            expected[number] = rest(run, cases()[number][0], steps)
    return expected, *([cases()[number] for number, each in found.items() if each != expected[number]]
                       for found in (of_states(states, steps), elsewhere(states, steps)))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for number in range(len(cases())):
        compared, here, there = compare([number], int(sys.argv[1]))
        print(f"{cases()[number]}: {compared.get(number, 'not suited')}; different: here {here}, elsewhere {there}", flush=True)
