"""Error of the settings that `zd.tune` chooses for every built-in system, and their time relative to an exhaustive sweep's best.

Run it with ``python tests/bench/bench_tune.py``; it writes ``results/tune.csv``.
"""

import csv
from pathlib import Path

import numpy as np

import zerodrift as zd
from zerodrift.studies import compare
from zerodrift.studies.bench import Bench
from zerodrift.studies.work_precision import default_steps
from zerodrift.studies.work_precision import measured as measured_by

HERE = Path(__file__).resolve().parent
SPAN = (0.0, 2.0)
TARGETS = (1e-4, 1e-6, 1e-8)
FINER = 4               # settings of the sweep between two of `work_precision`
FINALISTS = 12          # cheapest of the sweep, timed again beside what was picked
SWEEPS, ROUNDS = 2, 40
AT_MOST = 1.3
TIMES = np.linspace(*SPAN, 1001)


def exhaustive(system, reference):
    """All methods, with steps and tolerances as fine as no search needs."""
    steps = np.array(default_steps(system, SPAN, None, None))
    steps = np.geomspace(steps[0], steps[-1], FINER * (len(steps) - 1) + 1)
    tolerances = np.geomspace(1e-3, 1e-13, FINER * 10 + 1)
    return zd.work_precision(system, SPAN, steps=steps, tolerances=tolerances, reference=reference, rounds=SWEEPS)


def error_of(system, settings, reference):
    """At times that no search looked at."""
    p, _ = zd.simulate(system, SPAN, **settings)(TIMES)
    return np.abs(p - compare.states_of(reference, TIMES, system.nq)[:, :system.nq]).max()


def compared(name):
    """Rows (system, target, error, ratio to the cheapest, how)."""
    system = getattr(zd.systems, name)()
    reference = zd.reference(system, SPAN, error=None)
    sweep, bench = exhaustive(system, reference), Bench(system, SPAN, None, None, reference)
    for target in TARGETS:
        picked = zd.tune(system, SPAN, error=target).row.setting
        there = [row for row in sweep.rows if row.success and row.error + reference.error <= target]
        rivals = [row.setting for row in sorted(there, key=lambda row: row.seconds)[:FINALISTS]]
        measured = {row.setting: row for row in measured_by(bench, [picked, *rivals], ROUNDS).rows}
        cheapest = min(rivals, key=lambda setting: measured[setting].seconds)
        yield (name, target, error_of(system, picked.settings, reference) + reference.error,
               measured[picked].seconds / measured[cheapest].seconds, described(measured[picked]), described(measured[cheapest]))


def described(row):
    """Method, number of steps and kind of steps, as text."""
    setting = row.setting
    kind = "fixed" if setting.tolerance is None else "adaptive"
    return f"{setting.formulation} {setting.integrator} {row.steps} {kind}"


def main():
    """Measure, print and write."""
    with (HERE / "results" / "tune.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["system", "target", "error", "time to the cheapest", "at most", "picked", "cheapest"])
        for name in zd.systems.__all__:
            for system, target, error, ratio, picked, cheapest in compared(name):
                met = "" if error <= target else "  NOT MET"
                slow = "" if ratio <= AT_MOST else "  SLOW"
                print(f"{system:18} {target:.0e}  error {error:.1e}{met}  time {ratio:.2f}{slow}  {picked}  |  {cheapest}",
                      flush=True)
                table.writerow([system, target, f"{error:.2g}", f"{ratio:.3g}", AT_MOST, picked, cheapest])


if __name__ == "__main__":
    main()
