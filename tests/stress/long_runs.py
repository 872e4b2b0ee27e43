"""Long runs: whether violations stay bounded, memory constant and time linear, and how error and energy grow.

Run it with ``python tests/stress/long_runs.py``; it takes some three minutes and writes ``long_pendulum.csv`` and
``long_four_bar.csv`` into ``tests/bench/results/``.
"""

import csv
import json
import os
import sys
import time
from pathlib import Path

import numpy as np

import zerodrift as zd

TESTS = Path(__file__).resolve().parent.parent
REFERENCE = json.loads((TESTS / "references" / "A01_pendulum.json").read_text())["reference_x0_plus1"]
TIMES = (10, 100, 1000, 2000)       # s, where the closed form is known
CORRECTIONS = {
    "none": {"stabilization": None}, "baumgarte": {"stabilization": "baumgarte"}, "projection": {},
    "projection and energy": {"energy": True}}


def growth(t, sizes):
    """The exponent with which something grows in time, by least squares of logarithms; NaN where most of it is round-off."""
    t, sizes = np.asarray(t, dtype=float), np.asarray(sizes)
    clear = sizes > 1e-12
    return np.polyfit(np.log(t[clear]), np.log(sizes[clear]), 1)[0] if clear.sum() >= 3 else np.nan


def largest_until(times, values, ends):
    """The largest of the values, in size, up to each of the ends."""
    return [float(np.abs(values[times <= end]).max()) for end in ends]


def pendulum(integrator, step, correction):
    """The benchmark pendulum for 2000 s: violations, and the errors of position and energy at the times of the reference."""
    options = CORRECTIONS[correction]
    sol = zd.simulate(zd.systems.pendulum(angle=np.pi / 2), 2000.0, step=step, integrator=integrator, save_every=round(1 / step),
                      on_failure="return", **options)
    if not sol.success:
        return {"integrator": integrator, "step": step, "corrections": correction, "outcome": sol.message}
    errors = [np.abs(sol.p[t] - np.array(REFERENCE[str(t)], dtype=float)).max() for t in TIMES]
    energies = largest_until(sol.t, sol.energy_violation, TIMES)
    row = {"integrator": integrator, "step": step, "corrections": correction, "outcome": "done",
           "max |Phi|": np.abs(sol.position_violation).max(), "max |Psi|": np.abs(sol.velocity_violation).max()}
    row |= {f"error at {t} s": error for t, error in zip(TIMES, errors, strict=True)}
    row |= {f"max |Psi_E| to {t} s": energy for t, energy in zip(TIMES, energies, strict=True)}
    return row | {"error grows as t to the": growth(TIMES, errors), "energy as t to the": growth(TIMES, energies)}


def resident():
    """Bytes of memory in use, or 0 if unknown."""
    statm = Path("/proc/self/statm")
    return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if statm.exists() else 0


def four_bar(steps, correction):
    """The paper's four-bar at 1 ms: the same, with time and memory as it goes on."""
    seen = []

    def look(part):
        if part * 100 >= len(seen):
            seen.append((part, time.process_time(), resident()))

    sol = zd.simulate(zd.systems.four_bar(), steps * 1e-3, step=1e-3, save_every=steps // 1000, progress=look,
                      **CORRECTIONS[correction])
    part, seconds, memory = np.array(seen).T
    each = (seconds[-1] - seconds[0]) / ((1 - part[0]) * steps)
    tenths = np.diff(np.interp(np.linspace(part[0], 1, 11), part, seconds))
    ends = [10.0**k for k in range(2, 9) if 10.0**k <= sol.t[-1] * (1 + 1e-9)]
    energies = largest_until(sol.t, sol.energy_violation, ends)
    row = {"steps": steps, "corrections": correction, "max |Phi|": np.abs(sol.position_violation).max(),
           "max |Psi|": np.abs(sol.velocity_violation).max(), "ns a step": 1e9 * each,
           "slowest to fastest tenth": tenths.max() / tenths.min(), "last to first tenth": tenths[-1] / tenths[0],
           "memory grows by MiB": (memory[-1] - memory[0]) / 2**20}
    row |= {f"max |Psi_E| to {end:g} s": energy for end, energy in zip(ends, energies, strict=True)}
    return row | {"energy as t to the": growth(ends, energies)}


def write(name, rows):
    """The rows, printed and as a file."""
    columns = list(dict.fromkeys(column for row in rows for column in row))
    with open(TESTS / "bench" / "results" / name, "w", newline="") as file:
        table = csv.DictWriter(file, columns)
        table.writeheader()
        for row in rows:
            shown = {key: f"{value:.3g}" if isinstance(value, float) else value for key, value in row.items()}
            table.writerow(shown)
            print(*(f"{key}: {value}" for key, value in shown.items()), sep=", ")


def main(steps=10**8):
    """Both tables."""
    write("long_pendulum.csv", [pendulum(integrator, 0.01, correction) for integrator in ("rk4", "dop853")
                                for correction in CORRECTIONS])
    write("long_four_bar.csv", [four_bar(steps, "projection"), four_bar(steps // 10, "projection and energy")])


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
