"""Mechanisms in space: time against error of zerodrift, Exudyn and MuJoCo on a Stewart platform and a double wishbone.

Run it with ``python tests/bench/mechanisms_in_space/run.py``; it writes ``mechanisms_in_space.csv``,
``mechanisms_in_space_ratios.csv`` and ``mechanisms_in_space.png`` in ``tests/bench/results``. What is not installed is named and
left out.

All build the same drawing from bodies and joints, start from rest and give every body's centre of mass and rotation at the same
times; the error is the largest of any of these numbers at any of them. What the others cannot do is said where they are.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from comparing import installed, measured, report  # noqa: E402


def references(drawing, peers):
    """The motion at the outputs, certified, and how far Exudyn's, which shares no code, is from it, extrapolated to no step."""
    exact, error = peers["zerodrift"].reference(drawing)
    print(f"{drawing.name}: reference known to {error:.1e}")
    if "exudyn" in peers:
        coarse, fine = (peers["exudyn"].solve(drawing, ("Newmark, index 2", "dense", steps))[0] for steps in (64, 128))
        apart = np.abs(exact - (4 * fine - coarse) / 3).max()       # the method has order two
        print(f"{drawing.name}: Exudyn's runs, extrapolated, are {apart:.1e} away")
        assert apart < 1e-5, "two programs that share no code do not agree"
    return exact


def main():
    """Measure, print, write and draw."""
    from drawings import all_of_them

    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--every", type=int, default=1, help="measure every so many settings of each sweep alone")
    asked = asked.parse_args()
    peers, rows = installed(["zerodrift", "exudyn", "mujoco"]), []
    for drawing in all_of_them():
        rows += measured(drawing, references(drawing, peers), peers, asked.every)
    report(rows, "mechanisms_in_space")


if __name__ == "__main__":
    sys.exit(main())
