"""Time and memory saved by a declared structure: ``python tests/bench/bench_structure.py [formulation ...]``.

Chains of rods and rows of parallelograms in absolute coordinates, compiled once with packed matrices and once with dense ones.
Time is that of a corrected step of rk4, the minimum of interleaved rounds; memory is that of a run, reported by glibc (2.33 and
later).
"""

import ctypes
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import numpy as np

import zerodrift as zd
from measuring import RESULTS, least
from structured import chain, four_bars
from support import handed
from zerodrift._private import gateway

ROUNDS, SECONDS, STEP = 7, 0.05, 1e-4
CASES = {
    "chain of 2": chain(2), "chain of 3": chain(3), "chain of 4": chain(4), "chain of 6": chain(6), "chain of 10": chain(10),
    "chain of 20": chain(20), "closed chain of 20": chain(20, closed=True), "9 four-bars": four_bars(9), "chain of 60": chain(60),
}


class Allocated(ctypes.Structure):
    """`struct mallinfo2`."""

    _fields_ = [(name, ctypes.c_size_t) for name in (
        "arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost")]


def allocated():
    """Bytes that are allocated now."""
    mallinfo = ctypes.CDLL(None).mallinfo2
    mallinfo.restype = Allocated
    found = mallinfo()
    return found.uordblks + found.hblkhd


def memory(system, p, v, formulation):
    """KiB that a run takes when it is created; it is let go at once."""
    options = handed(formulation=list(zd.formulations()).index(formulation), step=STEP)
    before = allocated()
    run = gateway.Run(system._core, options, p, v)
    taken = allocated() - before
    del run
    return taken / 1024


def seconds_of(system, p, v, steps, formulation):
    """A callable that gives the processor's seconds of a run."""
    def seconds():
        start = time.process_time()
        zd.simulate(system, steps * STEP, p, v, step=STEP, save_every=steps, formulation=formulation)
        return time.process_time() - start
    return seconds


def measured(rods, formulation):
    """(n, m, microseconds dense and packed, KiB dense and packed)."""
    systems = [rods.system(packed=packed) for packed in (False, True)]
    p, v = rods.p0, np.zeros(systems[0].nv)
    steps = max(2, int(3 * SECONDS / seconds_of(systems[0], p, v, 3, formulation)()))
    times = least(ROUNDS, *(seconds_of(each, p, v, steps, formulation) for each in systems))
    return (systems[0].nv, systems[0].m, *(1e6 * time / steps for time in times),
            *(memory(each, p, v, formulation) for each in systems))


def main(formulations):
    columns = ("mechanism", "formulation", "n", "m", "dense us", "packed us", "times as fast", "dense KiB", "packed KiB")
    lines = []
    for name, rods in CASES.items():
        for formulation in formulations:
            n, m, dense, packed, taken, taken_packed = measured(rods, formulation)
            lines.append((name, formulation, n, m, f"{dense:.3g}", f"{packed:.3g}", f"{dense / packed:.2f}", f"{taken:.0f}",
                          f"{taken_packed:.0f}"))
            print(*lines[-1], sep="\t", flush=True)
    (RESULTS / "structure.csv").write_text("\n".join(",".join(map(str, line)) for line in (columns, *lines)) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:] or ["schur"])
