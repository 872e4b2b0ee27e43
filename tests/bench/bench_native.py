"""Cost of a user's compiled system, as ratios to the built-in one within one run.

Run it with ``python tests/bench/bench_native.py``; it needs a C compiler, and numba for one entry. It writes
``results/native.csv``.
"""

import functools
import importlib.util
import sys
import tempfile
from pathlib import Path

import zerodrift as zd
from measuring import least, record

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from native_systems import GIVEN, PENDULUM, built_in, compile_four_bar, compile_library, pendulum

ROUNDS = 60


def seconds(system, steps):
    p0, v0 = ([1.0, 0.0], [0.0, 0.0]) if system.nq == 2 else (None, None)      # pendulums from exactly the same place
    return zd.simulate(system, 0.01 * steps, p0, v0, step=0.01, save_every=steps).stats["seconds"]


def ratio(mine, other, steps=20000):
    """Ratio of the minimum times of two systems."""
    first, second = least(ROUNDS, *(functools.partial(seconds, system, steps) for system in (mine, other)))
    return first / second


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


if __name__ == "__main__":
    record("native", measured())
