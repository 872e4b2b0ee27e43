"""10,000 bodies for 1000 steps: energy and constraints are held. ``python tests/stress/ten_thousand.py [bodies [steps]]``.

Four-bars in a row, half as many as bodies, from 60 degrees, and a chain that hangs down and is pushed. Compared are the position
violation with the tolerance of the projection, and the energy with where it began.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import numpy as np

import zerodrift as zd
from structured import chain, four_bars

TOLERANCE = 1e-12       # of the projection, in sizes of rows
ENERGY = 1e-9           # of the largest kinetic energy


def main(bodies, steps):
    """Prints a line for each; returns how many did not hold."""
    failures = 0
    for name, rods, step in (("four-bars", four_bars((bodies - 1) // 2), 1e-4), ("chain", chain(bodies, bend=0.1), 1e-4)):
        began = time.perf_counter()
        sol = zd.simulate(rods.system(), steps * step, step=step, save_every=max(steps // 20, 1))
        violation = (np.abs(sol.position_violation) / sol.position_size).max()
        energy = np.abs(sol.energy_violation).max() / sol.kinetic_energy.max()
        holds = sol.success and violation <= TOLERANCE and energy <= ENERGY
        failures += not holds
        print(f"{name}: {len(rods.masses)} bodies, {sol.stats['steps']} steps, |Phi| {violation:.2g}, energy {energy:.2g} of the "
              f"largest kinetic one, {time.perf_counter() - began:.1f} s: {'holds' if holds else 'DOES NOT HOLD'}")
    return failures


if __name__ == "__main__":
    given = [int(each) for each in sys.argv[1:]]
    sys.exit(main(*[*given, *[10000, 1000][len(given):]]) > 0)
