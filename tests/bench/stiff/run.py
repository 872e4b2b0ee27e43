"""Time against error on stiff mechanisms: Radau's method of zerodrift, CVODES, IDAS and SciPy's Radau.

Run it with ``python tests/bench/stiff/run.py``; it writes ``stiff.csv``, ``stiff_ratios.csv`` and ``stiff.png`` in
``tests/bench/results``. What is not installed is named and left out: ``pip install casadi scipy``. All are given the same
equations, derived in SymPy, start from the same state and give the coordinates at the same times; the error is the largest of any
coordinate at any of them. The reference is that of an explicit method near rounding, which CVODES confirms.
"""

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from comparing import installed, measured, report  # noqa: E402


def reference(problem, peers):
    """Coordinates at the outputs, and how far another program's are from them."""
    exact = peers["zerodrift"].reference(problem)
    if "casadi" in peers:
        apart = np.abs(peers["casadi"].solve(problem, ("CVODES", 1e-10))[0] - exact).max()
        print(f"{problem.name}: CVODES at 1e-10 is {apart:.1e} away from dop853 at 1e-12")
    return exact


def main():
    """Measure, print, write and draw."""
    import stiff_problems

    there = ["zerodrift", "scipy", "casadi"]
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("peers", nargs="*", default=there, help=f"of {', '.join(there)}; zerodrift at least")
    asked.add_argument("--problem", action="append", help=f"of {', '.join(stiff_problems.ALL)}; may be repeated")
    asked.add_argument("--every", type=int, default=1, help="measure every so many settings of each sweep alone")
    asked.add_argument("--name", default="stiff", help="name of the files")
    asked = asked.parse_args()
    warnings.simplefilter("ignore")         # of explicit methods on stiff systems, and of loose tolerances
    peers, rows = installed(asked.peers, "stiff_with_"), []
    for name, make in stiff_problems.ALL.items():
        if not asked.problem or name in asked.problem:
            problem = make()
            rows += measured(problem, reference(problem, peers), peers, asked.every)
    report(rows, asked.name)


if __name__ == "__main__":
    sys.path.insert(0, str(HERE))
    sys.exit(main())
