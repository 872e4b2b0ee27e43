"""What the core, `simulate` and the import cost on the paper's four-bar: ratios and differences within one run.

Run it with ``python tests/bench/bench_four_bar.py``; it needs a C compiler, and writes ``results/four_bar.csv``.
"""

import functools
import itertools
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import zerodrift as zd
from measuring import least, record, timed

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "python"))
FLOOR_FLAGS = ("-O3", "-std=c11", "-ffp-contract=off")


def compiled(folder):
    """Floor and core in one program: the core with the product's flags, the floor, as a yardstick, always with the same."""
    from build_core import FLAGS

    compiler, floor, program = os.environ.get("CC", "cc"), Path(folder) / "floor.o", Path(folder) / "compare"
    subprocess.run([compiler, *FLOOR_FLAGS, "-c", "-o", floor, HERE / "four_bar_floor.c"], check=True)
    subprocess.run([compiler, *FLAGS, "-fPIC", "-I", ROOT / "csrc", "-o", program, HERE / "compare.c", floor,
                    *sorted((ROOT / "csrc").rglob("*.c")), "-lm"], check=True)
    return program


def steps():
    """Nanoseconds per step of floor and formulations, and that all of them go to the same place."""
    with tempfile.TemporaryDirectory() as folder:
        output = subprocess.run([compiled(folder)], check=True, capture_output=True, text=True).stdout
    lines = [line.split() for line in output.splitlines()]
    angles = [float(angle) for _, _, angle in lines]
    spread = max(angles) - min(angles)
    assert spread < 1e-4, f"alpha_1(8 s) differs by {spread:g} rad"     # by truncation only
    return {name: float(ns) for name, ns, _ in lines}


def simulate_beyond_its_steps(rounds=200):
    """Seconds of a call of 160 steps, less 160 steps at the cost they have in a call of 1600."""
    bar = zd.systems.four_bar()
    short, long = least(rounds, *(timed(functools.partial(zd.simulate, bar, 0.05 * count, step=0.05)) for count in (160, 1600)))
    return short - 160 * (long - short) / 1440


def cheapest(errors, span=8.0, rounds=40):
    """Seconds and settings of the fastest `simulate`, energy uncorrected, whose alpha_1 errs by no more than each error."""
    bar = zd.systems.four_bar()
    exact = zd.reference(bar, span, error=None).solution
    found = dict.fromkeys(errors, (np.inf, ""))
    for integrator, rtol in itertools.product(("dormand_prince", "dop853"), 10.0 ** np.arange(-5, -12.6, -0.1)):
        best, options = np.inf, {"integrator": integrator, "rtol": rtol, "atol": rtol}
        for _ in range(rounds):
            start = time.perf_counter()
            sol = zd.simulate(bar, span, **options)
            best = min(best, time.perf_counter() - start)
        wrong = abs(sol.p[:, 0] - exact(sol.t)[0][:, 0]).max()
        for error in errors:
            if wrong <= error:
                found[error] = min(found[error], (best, f"{integrator}, rtol = {rtol:.2g}"))
    return found


def import_beyond_numpy_and_cffi(rounds=10):
    """Seconds of `import zerodrift` where NumPy and CFFI are imported, and everything is compiled to byte code, already."""
    code = "import time, numpy, cffi; t = time.perf_counter(); import zerodrift; print(time.perf_counter() - t)"
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"PYTHONPYCACHEPREFIX": folder, "PYTHONDONTWRITEBYTECODE": ""}
        return min(float(subprocess.run([sys.executable, "-c", code], env=environment, check=True, capture_output=True).stdout)
                   for _ in range(rounds))


def measured():
    """Rows (what, value, unit, limit)."""
    ns = steps()
    yield "floor, a step", ns["floor"], "ns", None
    for name in zd.formulations():
        yield f"{name}, a step", ns[name], "ns", None
    default = "schur"
    yield f"{default} to floor", ns[default] / ns["floor"], "", 2
    yield f"{default} with every row saved to floor", ns[f"{default}+rows"] / ns["floor"], "", None
    limits = {"nullspace": 2, "mixed": 2, "independent": 3}
    for name in zd.formulations():
        if name != default:
            yield f"{name} to {default}", ns[name] / ns[default], "", limits.get(name)
    limits = {1e-6: 1400, 1e-9: 2800}
    for error, (seconds, how) in cheapest(limits).items():
        yield f"error of {error:g} over 8 s ({how}), in floor's steps", 1e9 * seconds / ns["floor"], "", limits[error]
    yield "simulate of 160 steps beyond its steps", 1e6 * simulate_beyond_its_steps(), "us", 150
    yield "import beyond NumPy and CFFI", 1e3 * import_beyond_numpy_and_cffi(), "ms", 50


if __name__ == "__main__":
    record("four_bar", measured(), ("what", "value", "unit", "at most"), digits=4)
