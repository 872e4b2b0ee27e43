"""Random events with known instants: how many are missed, found twice or off, by integrator and way of running. Writes events.md.

OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support python tests/stress/events.py [how many [commit]]
"""

import sys
import time
import warnings
from pathlib import Path

import zerodrift as zd
from timed_events import STEPS, check, draw, times_of

TABLE = Path(__file__).with_suffix(".md")
WAYS = ("single", "open", "ensemble")


def row(steps, way, many):
    """One line of the table."""
    cases = [case for case in (draw(seed, steps) for seed in range(many)) if way != "ensemble" or hasattr(case.system, "v0")]
    faults = [(case.name, fault) for case in cases if (fault := check(times_of(case, way), case))]
    for name, fault in faults:
        print(name, way, fault)
    return f"| {steps} | {way} | {len(cases)} | {sum(len(case.expected) for case in cases)} | {len(faults)} |"


def main():
    """Runs them and writes the table."""
    warnings.simplefilter("ignore")
    many = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    commit = f", commit {sys.argv[2]}" if len(sys.argv) > 2 else ""
    lines = [f"# {many} random events for each integrator", "",
             f"Written by `tests/stress/events.py`, zerodrift {zd.__version__}{commit}, {time.strftime('%d %B %Y')}.", "",
             "| steps | runs | events | instants | missed, found twice or off |", "|---|---|---|---|---|",
             *(row(steps, way, many) for steps in STEPS for way in WAYS)]
    TABLE.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
