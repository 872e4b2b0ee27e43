"""Times that can be compared, and tables of what was measured with them."""

import csv
import time
from pathlib import Path

RESULTS = Path(__file__).resolve().parent / "results"


def least(rounds, *measures):
    """The least that each of these callables gave, called in turn: what slows one down for a while slows down the others, too."""
    return [min(values) for values in zip(*([measure() for measure in measures] for _ in range(rounds)), strict=True)]


def timed(call, clock=time.perf_counter):
    """A callable that gives the seconds of another."""
    def seconds():
        start = clock()
        call()
        return clock() - start
    return seconds


def record(name, rows, columns=("what", "value", "at most"), digits=3):
    """Print rows (what, value, unit if there is a column for it, limit or None), and write them to a file of results."""
    with (RESULTS / f"{name}.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        for what, value, *unit, limit in rows:
            number = f"{value:.{digits}g}"
            print(f"{what:74} {number:>8}", *unit, f"(at most {limit})" if limit else "", flush=True)
            table.writerow([what, number, *unit, limit or ""])
