"""Unit quaternions over a million steps: how far their lengths are from one, said to be quaternions and not.

Run it with ``python tests/stress/quaternions.py``; it takes some three minutes and writes ``quaternions.csv`` into
``tests/bench/results/``.
"""

import csv
import sys
from pathlib import Path

import numpy as np

import zerodrift as zd

TESTS = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(TESTS), str(TESTS / "support")]
from rotating_bodies import about_a_point, held_at_a_point  # noqa: E402

TOP = (15.0, (0.5, 0.5, 0.25), (0.0, 0.0, 0.5), (0.3, 0.0, 30.0))       # mass, inertia, arm, angular velocity
STEP, ROWS = 1e-3, 10_000


def bodies():
    """A top whose tip is held by three constraints, the same in its attitude alone, and that without a word of quaternions."""
    return {"held": held_at_a_point(*TOP), "free": about_a_point(*TOP), "free, not said": about_a_point(*TOP, quaternions=())}


def row(which, system, formulation, integrator, steps):
    """A run, with the largest | |q| - 1 | up to every power of ten of steps."""
    sol = zd.simulate(system, steps * STEP, step=STEP, formulation=formulation, integrator=integrator,
                      save_every=max(1, steps // ROWS))
    off = np.abs(np.sqrt((sol.p[:, -4:] ** 2).sum(axis=1)) - 1)
    powers = [10**k for k in range(3, 10) if 10**k <= steps]
    found = {"top": which, "formulation": formulation, "integrator": integrator, "steps": steps}
    found |= {f"off one after {power:g} steps": off[sol.t <= power * STEP * (1 + 1e-9)].max() for power in powers}
    return found | {"energy violation of T": np.abs(sol.energy_violation).max() / sol.kinetic_energy.max()}


def main(steps=10**6):
    """The table."""
    rows = [row(which, system, formulation, integrator, steps) for which, system in bodies().items()
            for formulation in zd.formulations(system) for integrator in ("rk4", "dop853")]
    with open(TESTS / "bench" / "results" / "quaternions.csv", "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        for each in rows:
            shown = {key: f"{value:.3g}" if isinstance(value, float) else value for key, value in each.items()}
            table.writerow(shown)
            print(*(f"{key}: {value}" for key, value in shown.items()), sep=", ")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
