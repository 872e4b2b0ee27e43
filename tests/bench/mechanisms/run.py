"""Mechanisms from bodies and joints: time against error of zerodrift, Exudyn, MuJoCo and pymunk, on four of them.

Run it with ``python tests/bench/mechanisms/run.py``; it writes ``mechanisms.csv``, ``mechanisms_ratios.csv`` and
``mechanisms.png`` in ``tests/bench/results``. What is not installed is named and left out: ``pip install exudyn mujoco pymunk``
has them all.

All build the same drawing from bodies and joints, start from rest and give every body's centre of mass and angle at the same
times; the error is the largest of any of these at any of them, in rad and m.
"""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from comparing import PEERS, installed, measured, reference, report  # noqa: E402


def main():
    """Measure, print, write and draw."""
    from drawings import all_of_them

    there = [name for name in PEERS if (HERE / f"with_{name}.py").exists()]
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("peers", nargs="*", default=there, help=f"of {', '.join(there)}; zerodrift at least")
    asked.add_argument("--problem", help="one of the mechanisms alone, such as four-bar")
    asked.add_argument("--every", type=int, default=1, help="measure every so many settings of each sweep alone")
    asked = asked.parse_args()
    peers, rows = installed(asked.peers), []
    for drawing in all_of_them():
        if asked.problem in (None, drawing.name):
            rows += measured(drawing, reference(drawing, peers, (128, 256)), peers, asked.every)
    report(rows, "mechanisms")


if __name__ == "__main__":
    sys.exit(main())
