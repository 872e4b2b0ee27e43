"""What a compiled system of one's own costs, as ratios to the built-in one within one run.

Run it with ``python tests/bench/bench_native.py``; it needs a C compiler, and numba for one row. It writes
``results/native.csv``.
"""

import csv
import importlib.util
import sys
import tempfile
from pathlib import Path

import zerodrift as zd

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from native_systems import GIVEN, PENDULUM, built_in, compile_four_bar, compile_library, pendulum  # noqa: E402

ROUNDS = 60


def seconds(system, steps):
    p0, v0 = ([1.0, 0.0], [0.0, 0.0]) if system.nq == 2 else (None, None)      # pendulums from exactly the same place
    return zd.simulate(system, 0.01 * steps, p0, v0, step=0.01, save_every=steps).stats["seconds"]


def ratio(mine, other, steps=20000):
    """Of the least times of interleaved rounds."""
    times = [(seconds(mine, steps), seconds(other, steps)) for _ in range(ROUNDS)]
    return min(first for first, _ in times) / min(second for _, second in times)


def measured():
    """Rows (what, value, limit)."""
    with tempfile.TemporaryDirectory() as folder:
        bar = zd.native(compile_four_bar(Path(folder) / "four_bar.so"), symbol="four_bar")
        yield "four-bar in C, to built in", ratio(bar, zd.systems.four_bar(), 8000), 1.05
        mine = pendulum(compile_library(PENDULUM, Path(folder) / "pendulum.so"))
        yield "pendulum in C, to built in", ratio(mine, built_in()), 1.05
        if importlib.util.find_spec("numba"):
            from numba_pendulum import compiled

            yield "pendulum by numba, to built in", ratio(zd.native(compiled, ["x", "y"], **GIVEN), built_in()), None


def main():
    """Measure, print and write."""
    with (HERE / "results" / "native.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["what", "value", "at most"])
        for what, value, limit in measured():
            print(f"{what:46} {value:8.3g}" + (f" (at most {limit})" if limit else ""))
            table.writerow([what, f"{value:.3g}", limit or ""])


if __name__ == "__main__":
    main()
