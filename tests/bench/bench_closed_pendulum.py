"""The closed n-link pendulum for a hundred seconds: what holds, and how the energy error falls with the step.

Run it with ``python tests/bench/bench_closed_pendulum.py``; it needs SymPy, and writes ``results/closed_pendulum.csv``. The
motion is chaotic: no two rows end at the same place, but constraints and energy can be judged.
"""

import csv
import sys
from pathlib import Path

import numpy as np

import zerodrift as zd

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "support")]

import energy_models  # noqa: E402

LINKS, SPAN, STEPS = (4, 5, 6, 8, 10), 100.0, (0.002, 0.001, 0.0005)
METHODS = ("rk4", "dop853")
COLUMNS = ["links", "formulation", "integrator", "step", "end", "max |Phi|", "max |Psi|", "energy error", "largest T",
           "order"]


def measured(links, formulation, integrator):
    """Rows, with the order of the energy error from one step to the next."""
    before = None
    for step in STEPS:
        sol = zd.simulate(energy_models.closed_pendulum(links), SPAN, step=step, formulation=formulation,
                          integrator=integrator)
        error = np.abs(sol.energy_violation).max()
        order = "" if before is None else f"{np.log2(before / error):.2f}"
        before = error
        yield [links, formulation, integrator, step, sol.t[-1], f"{np.abs(sol.position_violation).max():.1e}",
               f"{np.abs(sol.velocity_violation).max():.1e}", f"{error:.2e}", f"{sol.kinetic_energy.max():.4g}", order]


def main():
    """Measure, print and write."""
    with (HERE / "results" / "closed_pendulum.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        print(*COLUMNS)
        for integrator in METHODS:
            for links in LINKS:
                for formulation in zd.formulations() if integrator == "rk4" else ("schur",):
                    for row in measured(links, formulation, integrator):
                        print(*row)
                        table.writerow(row)


if __name__ == "__main__":
    main()
