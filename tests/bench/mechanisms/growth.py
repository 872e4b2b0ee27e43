"""Growth of time with the number of bodies: rows of N four-bars and chains of N links, also in MuJoCo, Exudyn and Pinocchio.

Run it with ``python tests/bench/mechanisms/growth.py``; it writes ``growth.csv`` and ``growth_exponents.csv`` in
``tests/bench/results``. Programs that are not installed are named and left out.

* **A step**: 1 ms of a row of four-bars, 0.1 ms of a chain, without the making of the model, from Python. zerodrift's is RK4 with
  corrections of positions to 1e-12 and of velocities. MuJoCo's and Pinocchio's RK4 correct nothing, and MuJoCo's constraints are
  soft; its implicitfast is of order one, with one evaluation a step where RK4 has four. Exudyn's steps are of order two.
* **An error**: rows of hanging four-bars released at sixty degrees, for a second. All hangers turn alike, so the motion is that
  of one pendulum, known to 1e-12 for every N. Time is that of the coarsest setting of a sweep whose error in all positions and
  angles is within the target at each of 20 outputs; none where no setting meets it within 10 s.

Times are processor times; those of steps are the minimum of interleaved rounds of all methods. The exponent is the slope of
log time over log N from N = 10 on.
"""

import argparse
import math
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from comparing import RESULTS, installed, write  # noqa: E402

PEERS = ("zerodrift", "mujoco", "exudyn", "pinocchio")
NUMBERS = (2, 5, 10, 20, 40, 100, 200)
ERRORS = (1e-3, 1e-6)
LIMIT = 10.0            # s: of one run
ROUNDS, SHORT_RUN = 5, 1.0
FEW, MANY, WHILE = 10, 1000, 0.2     # steps, and seconds
DENSE = 40              # four-bars, up to which dense solvers are tried
A_STEP = {              # the setting of each method of which a step is timed, with k steps between outputs
    "zerodrift": {"zerodrift, rk4": lambda k: (None, "schur", "rk4", k, None)},
    "mujoco": {"MuJoCo RK4": lambda k: ("RK4", 2, k), "MuJoCo implicitfast": lambda k: ("implicitfast", 2, k)},
    "exudyn": {"Exudyn Newmark, index 2, sparse": lambda k: ("Newmark, index 2", "sparse", k),
               "Exudyn generalized alpha, sparse": lambda k: ("generalized alpha", "sparse", k)},
    "pinocchio": {"Pinocchio, RK4 by hand": lambda k: ("rk4", k)},
}


def exact(drawing):
    """Displacements and rotations of the bodies of a swing, (k, n, 3), m and rad, from the motion of one pendulum."""
    hangers = (len(drawing.bodies) + 1) // 2
    masses = drawing.bodies[0].mass, drawing.bodies[-1].mass
    length, start = 0.5, math.pi / 3
    pull = hangers * masses[0] / 2 + (hangers - 1) * masses[1]
    rate = drawing.gravity * pull / (hangers * masses[0] / 3 + (hangers - 1) * masses[1]) / length
    motion = solve_ivp(lambda t, y: (y[1], -rate * np.sin(y[0])), (0, drawing.t_end), (start, 0.0), "DOP853", drawing.outputs,
                       rtol=1e-13, atol=1e-14)
    angle = motion.y[0]
    end = length * np.column_stack([np.sin(angle) - np.sin(start), np.cos(start) - np.cos(angle)])
    moved = np.zeros((len(angle), len(drawing.bodies), 3))
    moved[:, :hangers, :2] = end[:, None] / 2
    moved[:, :hangers, 2] = (angle - start)[:, None]
    moved[:, hangers:, :2] = end[:, None]
    return moved


def seconds_of_steps(methods, drawing, step):
    """(method, seconds of a step) of each (module, setting_of): the least of some rounds in which all take their turn, each with
    so many steps that they take a while.
    """
    def seconds(method, steps):
        module, setting_of = methods[method]
        return module.solve(drawing._replace(t_end=step * steps, count=1), setting_of(steps))[1] / steps

    for method in methods:
        seconds(method, FEW)
    least = {method: seconds(method, FEW) for method in methods}
    steps = {method: min(MANY, int(WHILE / once)) for method, once in least.items()}
    for _ in range(ROUNDS):
        least |= {method: min(least[method], seconds(method, steps[method])) for method in methods if steps[method] > FEW}
    return least.items()


def time_to(module, drawing, moved, settings):
    """The least time of a method to reach each error: settings are tried from coarse to fine."""
    found = dict.fromkeys(ERRORS, math.nan)
    last = 0.0
    for setting in settings:
        if 2 * last > LIMIT:
            break
        try:
            with np.errstate(all="ignore"):
                got, last = module.solve(drawing, setting)
        except Exception:       # whatever a peer raises where its steps are too long
            continue
        error = np.abs(got - moved).max() if got.shape == moved.shape and np.isfinite(got).all() else math.inf
        reached = [each for each in ERRORS if error <= each and math.isnan(found[each])]
        if reached:
            again = [module.solve(drawing, setting)[1] for _ in range(0 if last > SHORT_RUN else 3)]
            found |= dict.fromkeys(reached, min([last, *again]))
        if not math.isnan(found[ERRORS[-1]]):
            break
    return found


def exponent(numbers, times):
    """The slope of log time over log N from N = 10 on, of what there is."""
    there = [(math.log(n), math.log(time)) for n, time in zip(numbers, times, strict=True) if n >= 10 and time == time]
    return np.polyfit(*zip(*there, strict=True), 1)[0] if len(there) > 2 else math.nan


def measured(peers, numbers):
    """Rows of (what, method, N, seconds)."""
    from drawings import chain, swing

    for n in numbers:
        methods = {method: (module, setting_of) for name, module in peers.items() for method, setting_of in A_STEP[name].items()}
        for what, drawing, step in (("step of four-bars", swing(n), 1e-3), ("step of a chain", chain(n), 1e-4)):
            for method, seconds in seconds_of_steps(methods, drawing, step):
                yield what, method, n, seconds
        drawing = swing(n)._replace(t_end=1.0, count=20)
        moved = exact(drawing)
        for name, module in peers.items():
            sweeps = module.growth_sweeps() if name == "zerodrift" else module.sweeps(drawing)
            for method, settings in sweeps.items():
                if "dense" in method and n > DENSE:
                    continue
                for error, seconds in time_to(module, drawing, moved, settings).items():
                    yield f"four-bars to {error:.0e}", method, n, seconds


def table(rows, numbers):
    """For each thing that is measured, and of steps each method, of errors each program's best: seconds for each N, their
    exponent, and what they are over zerodrift's.
    """
    for what in dict.fromkeys(row[0] for row in rows):
        here = [row for row in rows if row[0] == what]
        names = dict.fromkeys(row[1] if what.startswith("step") else row[1].split(",")[0].split()[0] for row in here)
        best = {name: [min((row[3] for row in here if row[2] == n and row[1].startswith(name) and row[3] == row[3]),
                           default=math.nan) for n in numbers] for name in names}
        own = next(iter(best.values()))
        for name, times in best.items():
            ratios = (time / mine for time, mine in zip(times, own, strict=True))
            yield (what, name, *(f"{time:.3g}" for time in times), f"{exponent(numbers, times):.2f}",
                   *(f"{ratio:.3g}" for ratio in ratios))


def main():
    """Measure, print and write."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--most", type=int, default=NUMBERS[-1], help="the largest N")
    asked = asked.parse_args()
    numbers, rows = [n for n in NUMBERS if n <= asked.most], []
    for row in measured(installed(PEERS), numbers):
        rows.append(row)
        print(f"{row[0]:24} {row[1]:44} {row[2]:4} {1e6 * row[3]:14.1f} us", flush=True)
    write(RESULTS / "growth.csv", ["what", "method", "N", "seconds"], [(*row[:3], f"{row[3]:.3g}") for row in rows])
    lines = list(table(rows, numbers))
    header = ["what", "program", *(f"s at N = {n}" for n in numbers), "exponent",
              *(f"over zerodrift's at N = {n}" for n in numbers)]
    write(RESULTS / "growth_exponents.csv", header, lines)
    for line in lines:
        print(*line, sep="\t")


if __name__ == "__main__":
    sys.exit(main())
