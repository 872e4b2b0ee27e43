"""Mechanisms in space: time against error of zerodrift and other programs on a Stewart platform and a double wishbone.

Run it with ``python tests/bench/mechanisms_in_space/run.py``; it writes ``mechanisms_in_space.csv``,
``mechanisms_in_space_ratios.csv`` and ``mechanisms_in_space.png`` in ``tests/bench/results``. What is not installed is named and
left out: ``pip install exudyn mujoco pin scipy`` has them all.

All build the same drawing from bodies and joints, start from rest and give every body's centre of mass and rotation at the same
times; the error is the largest of any of these numbers at any of them. What the others cannot do is said where they are.
"""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from comparing import installed, measured, reference, report  # noqa: E402


def main():
    """Measure, print, write and draw."""
    from drawings import all_of_them

    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--every", type=int, default=1, help="measure every so many settings of each sweep alone")
    asked = asked.parse_args()
    peers, rows = installed(["zerodrift", "exudyn", "mujoco", "pinocchio"]), []
    for drawing in all_of_them():
        rows += measured(drawing, reference(drawing, peers, (64, 128)), peers, asked.every)
    report(rows, "mechanisms_in_space")


if __name__ == "__main__":
    sys.exit(main())
